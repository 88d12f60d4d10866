# SPDX-License-Identifier: MIT
"""The generated register definitions: up to date, consistent, without clashes, accepted by all tools."""

import re
import shutil
import subprocess
import sys
from itertools import combinations
from pathlib import Path

import pytest
from passo import registers
from passo.compiler import CC, call, includes
from passo.toolchain import environment, paths
from systemrdl import RDLCompiler
from systemrdl.node import RegNode

ROOT = Path(__file__).resolve().parents[1]
SOURCE = "spec/passo.rdl"
GENERATOR = "spec/generate_registers.py"
HELPER = "spec/generated.py"
VERILOG = "rtl/passo_registers.vh"
C = "c_model/protocol/passo_registers.h"
PAGE = "docs/reference/registers.md"
RULES = ["rtl/passo_register_rules.vh", "c_model/core/passo_register_rules.h"]
OUTPUTS = [VERILOG, C, *RULES, "c_model/protocol/passo_words.h", "sim/passo/registers.py", PAGE]
ENUMS = registers.DescribedEnum.__subclasses__()


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def verilog_constants(text: str) -> dict[str, tuple[int, int]]:
    """Name to (width, value); numbers without a width have 32 bits."""
    constants = {}
    for name, bits, base, number in re.findall(r"^localparam (\w+) *= (?:(\d+)'([hd]))?(\w+);", text, re.M):
        constants[name] = (int(bits or 32), int(number, 16 if base == "h" else 10))
    assert len(constants) == len(re.findall("^localparam", text, re.M)), (
        "a name twice, or a line not understood"
    )
    return constants


def c_constants(text: str) -> dict[str, int]:
    found = re.findall(r"^#define PASSO_(\w+) +(\w+)u$", text, re.M)
    found += re.findall(r"^\tPASSO_(\w+) += (\d+),? +/\*", text, re.M)
    return {name: int(number, 0) for name, number in found}


def fields(verilog: dict[str, tuple[int, int]]) -> dict[str, range]:
    """Name to bit numbers."""
    lsbs = {name.removesuffix("_LSB"): lsb for name, (_, lsb) in verilog.items() if name.endswith("_LSB")}
    return {name: range(lsb, lsb + verilog[f"{name}_BITS"][1]) for name, lsb in lsbs.items()}


def word_addresses(verilog: dict[str, tuple[int, int]]) -> list[int]:
    """Every word address that the constants describe, of all channels and axes."""

    def words(prefix: str) -> list[int]:
        found = []
        for name, (_, word) in verilog.items():
            stem = name.removesuffix("_BASE")
            if not name.startswith(prefix) or f"{stem}_STRIDE" in verilog:
                continue
            if name.endswith("_BASE"):
                found += range(word, word + verilog[f"{stem}_COUNT"][1])
            elif not re.search("_(LSB|BITS|RESET|DEFINED|COUNT|STRIDE)$", name):
                found.append(word)
        return found

    def bases(name: str) -> list[int]:
        base, count, stride = (verilog[f"{name}_{part}"][1] for part in ("BASE", "COUNT", "STRIDE"))
        return [base + n * stride for n in range(count)]

    channel = words("CHANNEL_")
    for block in ("AXIS", "ENCODER"):
        channel += [base + word for base in bases(f"CHANNEL_{block}") for word in words(f"{block}_")]
    return words("ADDRESS_") + [base + word for base in bases("ADDRESS_CHANNEL") for word in channel]


@pytest.fixture(scope="module")
def verilog() -> dict[str, tuple[int, int]]:
    return verilog_constants(read(VERILOG))


@pytest.fixture(scope="module")
def rdl() -> list[RegNode]:
    """All registers of the source, one by one."""
    compiler = RDLCompiler()
    compiler.compile_file(str(ROOT / SOURCE))
    return [node for node in compiler.elaborate().descendants(unroll=True) if isinstance(node, RegNode)]


def run(*command: str | Path, cwd: Path = ROOT) -> subprocess.CompletedProcess:
    return subprocess.run(
        command, cwd=cwd, env=environment(), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )


def test_generated_files_are_fresh():
    result = run(sys.executable, GENERATOR, "--check")
    assert (result.returncode, result.stdout) == (0, "")


def test_check_names_stale_files(tmp_path: Path):
    """Each alone, without writing it; the generator mends them all."""
    for name in [SOURCE, GENERATOR, HELPER, *OUTPUTS]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
    for name in [SOURCE, GENERATOR, HELPER]:
        shutil.copy(ROOT / name, tmp_path / name)
    shutil.copytree(paths.spec / "rdl", tmp_path / "spec" / "rdl")
    assert run(sys.executable, GENERATOR, cwd=tmp_path).returncode == 0
    fresh = {name: (tmp_path / name).read_text(encoding="utf-8") for name in OUTPUTS}
    for stale, text in fresh.items():
        (tmp_path / stale).write_text(text + "\n", encoding="utf-8")
        result = run(sys.executable, GENERATOR, "--check", cwd=tmp_path)
        assert result.returncode == 1
        assert [name for name in OUTPUTS if name in result.stdout] == [stale]
        assert (tmp_path / stale).read_text(encoding="utf-8") == text + "\n"
        (tmp_path / stale).write_text(text, encoding="utf-8")

    for name in OUTPUTS:
        (tmp_path / name).write_text("stale\n", encoding="utf-8")
    assert run(sys.executable, GENERATOR, cwd=tmp_path).returncode == 0
    assert {name: (tmp_path / name).read_text(encoding="utf-8") for name in OUTPUTS} == fresh
    assert run(sys.executable, GENERATOR, "--check", cwd=tmp_path).returncode == 0


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        (
            "nonzero; maximum = 0x800000;",
            "nonzero; maximum = 0x7FFFFF;",
            "PWM_STEP: a maximum is a power of 2",
        ),
        ("} filter[7:0] = 3;", "} filter[7:2] = 3;", "ENCODER_FILTER: only bit 0"),
        ("part = part_e::ENCODERS; needs = needs_e::QUIET;", "needs = needs_e::IDLE;", "FOLLOW: IDLE is"),
        ("ease[256]    @", "ease[128]    @", "EASE: not as COSINE"),
    ],
)
def test_what_the_rules_cannot_say_is_refused(tmp_path: Path, old: str, new: str, says: str):
    for name in [GENERATOR, HELPER]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    shutil.copytree(paths.spec / "rdl", tmp_path / "spec" / "rdl")
    source = read(SOURCE)
    assert source.count(old) == 1
    (tmp_path / SOURCE).write_text(source.replace(old, new), encoding="utf-8")
    result = run(sys.executable, GENERATOR, cwd=tmp_path)
    assert result.returncode == 1 and says in result.stdout


@pytest.mark.parametrize("name", OUTPUTS)
def test_generated_files_say_so(name: str):
    assert f"Generated from {SOURCE} by {GENERATOR}." in "".join(read(name).splitlines(keepends=True)[:3])


def test_everything_is_described(rdl: list[RegNode]):
    for register in rdl:
        for node in [register, *register.fields()]:
            assert node.get_property("desc"), node.get_path()


def test_addresses_are_unique_and_those_of_the_source(verilog: dict, rdl: list[RegNode]):
    addresses = word_addresses(verilog)
    assert len(addresses) == len(set(addresses))
    assert sorted(addresses) == sorted(register.absolute_address // 4 for register in rdl)


def test_addresses_fit_their_widths(verilog: dict):
    assert max(word_addresses(verilog)) < 1 << verilog["ADDRESS_RUN"][0]
    for block, offset in [("ADDRESS_CHANNEL", "CHANNEL_STATE"), ("CHANNEL_AXIS", "AXIS_PINS")]:
        assert verilog[f"{block}_STRIDE"][1] == 1 << verilog[offset][0]


def test_values_fit_their_widths(verilog: dict):
    for name, (bits, value) in verilog.items():
        assert value < 1 << bits, name


def test_fields_do_not_overlap(verilog: dict):
    for paragraph in read(VERILOG).split("\n\n"):
        of_register = fields(verilog_constants(paragraph))
        for name, bits in of_register.items():
            assert 0 <= bits.start < bits.stop <= 32, name
        for (one, ones), (other, others) in combinations(of_register.items(), 2):
            assert not set(ones) & set(others), f"{one}, {other}"


def test_resets_have_the_width_of_their_field(verilog: dict):
    of_field = {name: bits for name, bits in fields(verilog).items() if f"{name}_RESET" in verilog}
    assert len(of_field) == sum(name.endswith("_RESET") for name in verilog)
    for name, bits in of_field.items():
        assert verilog[f"{name}_RESET"][0] == len(bits), name


def test_fields_are_those_of_the_source(verilog: dict, rdl: list[RegNode]):
    of_verilog = fields(verilog)
    for register in rdl:
        *_, block = register.parent.inst_name.upper().split("[")[:1]
        level = "" if block == "PASSO" else f"{block}_"
        stem = f"{level}{register.inst_name}".upper()
        for field in register.fields():
            long = f"{stem}_{field.inst_name}".upper()
            name = long if long in of_verilog else stem
            assert of_verilog[name] == range(field.lsb, field.msb + 1), field.get_path()
            reset = field.get_property("reset")
            expected = None if reset is None else (field.width, reset)
            assert verilog.get(f"{name}_RESET") == expected, field.get_path()
        writable = sum(((1 << f.width) - 1) << f.lsb for f in register.fields() if f.is_sw_writable)
        assert verilog.get(f"{stem}_DEFINED", (32, 0)) == (32, writable), register.get_path()


@pytest.mark.parametrize(
    ("name", "width", "value"),
    [
        ("ADDRESS_IDENTIFICATION", 12, 0),
        ("ADDRESS_CHANNEL_BASE", 12, 0x100),
        ("ADDRESS_EASE_BASE", 12, 0xF00),
        ("CHANNEL_POSITION_BASE", 8, 0x40),
        ("CHANNEL_AXIS_BASE", 8, 0x80),
        ("CHANNEL_RATE_TARGET_RESET", 17, 0x10000),
        ("AXIS_DIR_TIMING", 3, 2),
        ("STATE_STOPPED", 3, 6),
        ("VERDICT_BAD_VALUE", 4, 9),
        ("OPERATION_PUSH", 4, 3),
    ],
)
def test_some_constants_by_hand(verilog: dict, name: str, width: int, value: int):
    assert verilog[name] == (width, value)


def test_verilog_and_c_agree(verilog: dict):
    assert c_constants(read(C)) == {name: value for name, (_, value) in verilog.items()}


def test_verilog_and_python_agree(verilog: dict):
    python = {n: value for n, value in vars(registers).items() if n.isupper() and isinstance(value, int)}
    for enum in ENUMS:
        prefix = re.sub(r"\B([A-Z])", r"_\1", enum.__name__).upper()
        python |= {f"{prefix}_{member.name}": int(member) for member in enum}
        assert all(member.description.endswith(".") for member in enum)
    assert python == {name: value for name, (_, value) in verilog.items()}


def test_verdicts_of_the_link_page():
    section = read("docs/link.md").split("| verdict | name | reason |")[1]
    table = re.findall(r"^\| (\d+) \| `(\w+)` \|", section, re.M)
    assert [(int(value), name) for value, name in table] == [(v.value, v.name) for v in registers.Verdict]


@pytest.mark.parametrize(
    "command",
    [
        "iverilog -g2005 -Wall -t null",
        "verilator --lint-only -Wall --language 1364-2005",
    ],
    ids=lambda command: command.split()[0],
)
def test_verilog_is_accepted(tmp_path: Path, command: str):
    tiny = tmp_path / "tiny.v"
    tiny.write_text(f'module tiny;\n`include "{Path(VERILOG).name}"\nendmodule\n')
    result = run(*command.split(), f"-I{ROOT / 'rtl'}", tiny)
    errors = [line for line in result.stdout.splitlines() if not line.startswith("- ")]
    assert (result.returncode, errors) == (0, [])


@pytest.mark.parametrize("language", ["c", "c++"])
def test_c_is_accepted(tmp_path: Path, language: str):
    tiny = tmp_path / "tiny.c"
    tiny.write_text(f'#include "{Path(C).name}"\n' * 2 + "int main(void) { return PASSO_VERDICT_OK; }\n")
    flags = ("-x", language, "-fsyntax-only", "-Wall", "-Wextra", "-Werror", *includes(paths.protocol))
    assert call([CC, *flags, tiny]) == ""
