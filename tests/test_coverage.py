# SPDX-License-Identifier: MIT
"""`make coverage`: evaluation of Verilator's counts, and checks of the list of constant bits."""

from pathlib import Path

import pytest
from passo.toolchain import paths

from cocotb_tests import coverage
from cocotb_tests.coverage_points import (
    Exclusion,
    Module,
    bits_of,
    ranges,
    read,
    read_exclusions,
    wrong_exclusions,
)

FILE = "passo_dda.v"


def point(kind: str, name: str, count: int, file: Path = paths.rtl / FILE, line: str = "1") -> str:
    """A line of coverage.dat."""
    facts = {"f": str(file), "l": line, "n": "3", "page": f"v_{kind}/x", "o": name, "S": line}
    return "C '" + "".join(f"\1{key}\2{value}" for key, value in facts.items()) + f"' {count}\n"


def toggles(name: str, rises: int, falls: int) -> str:
    """Both points of a bit."""
    return point("toggle", f"{name}:0->1", rises) + point("toggle", f"{name}:1->0", falls)


@pytest.fixture
def modules(tmp_path: Path) -> dict[str, Module]:
    """Two runs: a[0] rises in one and falls in the other, a[1] only rises, b does nothing."""
    first, second = tmp_path / "1.dat", tmp_path / "2.dat"
    top = paths.cocotb_tests / "tops" / "passo_link_top.v"
    first.write_text(
        "# SystemC::Coverage-3\n"
        + toggles("a[0]", 1, 0)
        + toggles("a[1]", 1, 0)
        + point("line", "block", 3, line="30,32-33")
        + point("line", "elsif", 0, line="33")
        + point("toggle", "c:0->1", 0, top)
    )
    second.write_text(toggles("a[0]", 0, 2) + toggles("a[1]", 5, 0) + toggles("b", 0, 0))
    return read([first, second])


def test_points_of_all_runs_are_added_up(modules: dict[str, Module]) -> None:
    """Only those of rtl/; a bit has to rise and to fall, a line needs each of its branches."""
    assert list(modules) == [FILE]
    assert modules[FILE].missed_bits() == ["a[1]", "b"]
    assert modules[FILE].missed_lines() == [33]
    assert {line for line, _ in modules[FILE].lines} == {30, 32, 33}


def test_constant_bits_are_no_holes(modules: dict[str, Module]) -> None:
    """Listed bits are neither missed nor counted, and the page gives the reason."""
    exclusions = [Exclusion(FILE, ("b",), "It is tied.")]
    assert wrong_exclusions(modules, exclusions) == []
    assert coverage.missed_bits(modules, []) == {FILE: ["a[1]", "b"]}
    assert coverage.missed_bits(modules, exclusions) == {FILE: ["a[1]"]}
    page = coverage.page(modules, exclusions)
    assert f"| `{FILE}` | 3 | 66.7% | 2 | 1 | 50.0% |" in page
    assert f"* `{FILE}`: `b`. It is tied." in page
    assert f"* `{FILE}`: `a[1]`\n" in page


@pytest.mark.parametrize(
    ("file", "bits", "complaint"),
    [
        (FILE, ("a[0]",), "a[0] is excluded and rises and falls"),
        (FILE, ("a[2]",), "a[2] is excluded and does not exist"),
        ("passo_gone.v", ("b",), "b is excluded and does not exist"),
        (FILE, ("b", "b"), "b is excluded twice"),
    ],
)
def test_a_wrong_list_is_an_error(
    modules: dict[str, Module], file: str, bits: tuple[str, ...], complaint: str
) -> None:
    """Bits that do not exist or are not constant, or listed twice."""
    assert wrong_exclusions(modules, [Exclusion(file, bits, "No.")]) == [f"{file}: {complaint}"]


def test_every_entry_needs_a_reason(tmp_path: Path) -> None:
    """An empty one will not do."""
    path = tmp_path / "list.toml"
    path.write_text('[[bits]]\nfile = "x.v"\nnames = ["a[2:1]", "b"]\nreason = "Tied."\n')
    assert read_exclusions(path) == [Exclusion("x.v", ("a[2]", "a[1]", "b"), "Tied.")]
    path.write_text('[[bits]]\nfile = "x.v"\nnames = ["a"]\nreason = " "\n')
    with pytest.raises(ValueError, match="without a reason"):
        read_exclusions(path)


def test_the_list_names_files_of_the_rtl() -> None:
    """Each of them is there."""
    assert all((paths.rtl / exclusion.file).is_file() for exclusion in read_exclusions())


@pytest.mark.parametrize(
    ("words", "bits"),
    [
        ("a", ["a"]),
        ("a[3]", ["a[3]"]),
        ("a[7:6,3,1:0]", ["a[7]", "a[6]", "a[3]", "a[1]", "a[0]"]),
        ("g[2].x[8][1:0]", ["g[2].x[8][1]", "g[2].x[8][0]"]),
    ],
)
def test_bits_of_a_signal_are_written_together(words: str, bits: list[str]) -> None:
    """And taken apart again."""
    assert bits_of(words) == bits
    assert ranges(bits) == [words]
