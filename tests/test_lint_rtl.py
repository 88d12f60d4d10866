# SPDX-License-Identifier: MIT
"""The front ends of `make lint` detect the faults they are used for."""

import re
import shutil
import sys
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from passo.toolchain import paths

sys.path.insert(0, str(paths.tools))
import lint_rtl

ALL = tuple(lint_rtl.READERS)
ANY_VALUE = ("STEPS_REGISTER",)  # is 0 or not


@dataclass(frozen=True)
class Fault:
    """`new` replaces `old` in the file; the readers in `seen_by` must report it when they read `top`."""

    file: str
    old: str
    new: str
    seen_by: tuple[str, ...]
    parameters: lint_rtl.Parameters = field(default_factory=dict)
    top: str = lint_rtl.TOPS[0]


FAULTS = {
    "name_is_not_declared": Fault("passo_link_frame.v", "  wire crc_top;\n", "", ALL, top="passo_link"),
    "port_is_not_there": Fault("passo_link_frame.v", ".restart(", ".begin_again(", ALL, top="passo_link"),
    "module_is_not_there": Fault(
        "passo_link_frame.v", "passo_crc u_crc", "passo_crc32 u_crc", ALL, top="passo_link"
    ),
    "name_is_used_before_its_declaration": Fault(
        "passo_link_frame.v", "  passo_crc u_crc", "  assign late = 1'b0;\n  wire late;\n  passo_crc u_crc",
        ("slang",),
    ),
    "time_scale_is_missing": Fault(
        "passo_crc.v", "`timescale 1ns / 1ps\n", "", ("Icarus Verilog", "slang")
    ),
    "widths_differ": Fault("passo_crc.v", "output wire top", "output wire [1:0] top", ("Verilator", "slang")),
    "only_at_the_end_of_a_parameter": Fault(
        "passo_registers.v", "({1'b0, bus_data[7:0]} >> CHANNELS) != 9'd0",
        "(bus_data[7:0] >> CHANNELS) != 8'd0", ("slang",), lint_rtl.HIGHEST,
    ),
}  # fmt: skip


def below(top: str) -> set[str]:
    """The files of a module and of all that it mentions, with the headers."""
    found, waiting = {path.name for path in paths.rtl.glob("*.vh")}, [f"{top}.v"]
    while waiting:
        name = waiting.pop()
        if name not in found and (paths.rtl / name).exists():
            found.add(name)
            text = re.sub(r"//.*", "", (paths.rtl / name).read_text())
            waiting += [f"{module}.v" for module in re.findall(r"\bpasso_\w+", text)]
    return found


@pytest.mark.parametrize(
    ("fault", "reader"),
    [(fault, reader) for fault, facts in FAULTS.items() for reader in facts.seen_by],
)
def test_fault_is_seen(fault: str, reader: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By each front end that must see it, with the parameters that show it."""
    facts = FAULTS[fault]
    monkeypatch.setattr(lint_rtl, "SURELOG", tmp_path)
    rtl = tmp_path / "rtl"
    rtl.mkdir()
    for name in below(facts.top):
        shutil.copy(paths.rtl / name, rtl)
    source = (rtl / facts.file).read_text()
    assert facts.old in source
    read, sets = lint_rtl.READERS[reader]
    assert facts.parameters in sets
    assert not read(rtl, facts.top, facts.parameters)
    (rtl / facts.file).write_text(source.replace(facts.old, facts.new, 1))
    assert read(rtl, facts.top, facts.parameters)


@pytest.mark.parametrize("name", [name for name in lint_rtl.ENDS if name not in ANY_VALUE])
def test_corners_are_the_ends_of_the_parameters(name: str) -> None:
    """The limits are accepted; values beyond them are rejected."""
    low, high = lint_rtl.ENDS[name]
    taken = [value for value in (low - 1, low, high, high + 1)
             if not lint_rtl.read_with_slang(paths.rtl, lint_rtl.TOPS[0], {name: value})]  # fmt: skip
    assert taken == [low, high]


@pytest.mark.parametrize(
    ("parameters", "taken"),
    [
        ({"AXES": 3, "TRACKERS": 1, "TRACKED": 2}, True),
        ({"AXES": 3, "TRACKERS": 1, "TRACKED": 3}, False),
        ({"AXES": 3, "TRACKERS": 1, "TRACKED": -1}, False),
        ({"AXES": 3, "TRACKERS": 0, "TRACKED": 1}, False),
    ],
)
def test_axes_without_lines(parameters: dict[str, int], taken: bool) -> None:
    """An axis with lines at least, and trackers."""
    assert (not lint_rtl.read_with_slang(paths.rtl, lint_rtl.TOPS[0], parameters)) == taken


@pytest.mark.parametrize("top", ["passo_core", *lint_rtl.TOPS])
def test_every_number_of_the_core_has_its_corners(top: str) -> None:
    """A parameter that is added to the core is added to its tops and here."""
    head = (paths.rtl / f"{top}.v").read_text().partition(") (")[0]
    assert set(re.findall(r"^ *parameter .*?(\w+) *=", head, re.M)) == {
        *lint_rtl.ENDS,
        *lint_rtl.DEPENDENT,
        *lint_rtl.LEVELS,
        *lint_rtl.TOLD,
    }
