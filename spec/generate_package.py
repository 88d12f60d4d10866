# SPDX-License-Identifier: MIT
"""Generate what other tools ask for: the list of the core's sources, the core for FuseSoC, the release in C.

Their sources are the folder rtl/ and the file VERSION.

The release is the version of the whole repository. The register VERSION (spec/passo.rdl) is that of the
register map and the link, and changes only with them.
"""

import sys
from pathlib import Path

from generated import is_check, keep

ROOT = Path(__file__).resolve().parent.parent
SOURCES = "rtl/ and VERSION"
GENERATED = f"Generated from {SOURCES} by spec/generate_package.py."

TOPS = {"lint": "passo_spi_top", "lint_wishbone": "passo_wishbone", "lint_axi_lite": "passo_axi_lite"}
BENCH, BENCH_TOP = "tests/passo_bench.v", "passo_bench"
PARAMETERS = {
    "CHANNELS": "Channels, 1 .. 8",
    "AXES": "Axes per channel, 1 .. 8",
    "TICK_LOG2": "Clocks per tick as a power of two, 7 .. 16",
    "LINE_QUEUE_LOG2": "Places for lines as a power of two, 2 .. 8",
    "RAMP_QUEUE_LOG2": "Places for ramps as a power of two, 2 .. 8",
    "STEPS_REGISTER": "1: the block RAMs have a register behind their data",
    "INPUTS": "1: limits, home, alarm, probe, e-stop",
    "ENCODERS": "1: encoders",
    "OUTPUTS": "1: outputs bound to the path",
    "RASTER": "1, with OUTPUTS: raster lines, whose power comes from a queue",
    "COMPARE": "1, with OUTPUTS: pulses at positions of an axis",
    "TRACKERS": "1: a second hand on every axis",
    "TRACKED": "The last axes of a channel, without lines, 0 .. AXES - 1",
    "CLOCK_HZ": "Clock in Hz, for the host to read; 0: not told",
    "BUILD": "Identifier of the bitstream, for the host to read",
    "STEP_RESET": "Polarity of each STEP from configuration on",
    "DIR_RESET": "Polarity of each DIR from configuration on",
    "ENABLE_RESET": "Polarity of each EN from configuration on",
}


def names(suffix: str) -> list[str]:
    """The files of rtl/, as seen from the root."""
    return sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / "rtl").glob(f"*{suffix}"))


def write_list() -> str:
    """For simulators that are called in the root: verilator -f, iverilog -c."""
    head = [f"// {GENERATED}", "// Paths are as seen from the root."]
    return "\n".join([*head, "+incdir+rtl", *names(".v"), ""])


def write_core(release: str) -> str:
    """For FuseSoC."""
    lines = [
        "CAPI=2:",
        f"# {GENERATED}",
        "",
        f"name: ::passo:{release}",
        "description: STEP/DIR pulses for stepper and servo drives, with S-curve ramps and coordinated axes",
        "",
        "filesets:",
        "  rtl:",
        "    file_type: verilogSource-2005",
        "    files:",
        *(f"      - {name}: {{is_include_file: true}}" for name in names(".vh")),
        *(f"      - {name}" for name in names(".v")),
        "  bench:",
        "    file_type: verilogSource-2005",
        "    files:",
        f"      - {BENCH}",
        "",
        "targets:",
        "  default:",
        "    filesets: [rtl]",
        f"    parameters: [{', '.join(PARAMETERS)}]",
        f"    toplevel: {TOPS['lint']}",
    ]
    for target, top in TOPS.items():
        lines += [
            f"  {target}:",
            f"    description: Read {top} with Verilator, all warnings on",
            "    flow: lint",
            "    flow_options: {tool: verilator, verilator_options: [-Wall]}",
            "    filesets: [rtl]",
            f"    parameters: [{', '.join(PARAMETERS)}]",
            f"    toplevel: {top}",
        ]
    lines += [
        "  sim:",
        "    description: Make one move behind SPI in Icarus Verilog; says `passed`",
        "    flow: sim",
        "    flow_options: {tool: icarus, iverilog_options: [-g2005, -Wall]}",
        "    filesets: [rtl, bench]",
        f"    toplevel: {BENCH_TOP}",
        "",
        "parameters:",
    ]
    for name, text in PARAMETERS.items():
        lines.append(f'  {name}: {{paramtype: vlogparam, datatype: int, description: "{text}"}}')
    return "\n".join([*lines, ""])


def write_header(release: str) -> str:
    """For the console."""
    return f"""\
/* SPDX-License-Identifier: MIT
 * {GENERATED}
 */
#ifndef PASSO_RELEASE_H
#define PASSO_RELEASE_H

#define PASSO_RELEASE "{release}"

#endif
"""


def main() -> int:
    check = is_check(f"Generate file list, FuseSoC core and release from {SOURCES}.")
    release = (ROOT / "VERSION").read_text(encoding="utf-8").strip()
    made = {
        "rtl/passo.f": write_list(),
        "passo.core": write_core(release),
        "c_model/protocol/passo_release.h": write_header(release),
    }
    return keep(ROOT, made, check)


if __name__ == "__main__":
    sys.exit(main())
