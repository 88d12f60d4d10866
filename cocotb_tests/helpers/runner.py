# SPDX-License-Identifier: MIT
"""Builds a Verilog top and runs the cocotb tests of a Python module in it.

Environment variables:

- `PASSO_SEED`: seed of all random cases, default 1; the same seed gives the same run.
- `PASSO_RTL`: another folder instead of `rtl/`, to test that a fault in the RTL is found.
- `PASSO_WAVES`: if set, waveforms are written into the test's folder below `build/cocotb`.
- `PASSO_ICARUS`: if set, Icarus Verilog runs all tests of the whole core, not just some (skip_icarus).
- `PASSO_NETLIST`: if set, all tests of the whole core run on the netlist, not just some (test_netlist.py).
- `PASSO_COVERAGE`: if set, Verilator writes coverage.dat into the test's folder below `build/cocotb`.
"""

import fcntl
import hashlib
import os
import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

import pytest
from cocotb_tools.check_results import get_results
from cocotb_tools.runner import Verilator, get_runner
from passo.build import ONE_FILE
from passo.random_cases import SEED_VARIABLE, seed
from passo.toolchain import environment, paths
from passo_fpga.netlist import CELLS, netlist_folder

SIMULATORS = ("verilator", "icarus")
ICARUS_VARIABLE = "PASSO_ICARUS"
NETLIST_VARIABLE = "PASSO_NETLIST"
COVERAGE_VARIABLE = "PASSO_COVERAGE"

_BUILD = paths.build / "cocotb"
_TOPS = paths.cocotb_tests / "tops"
_PROBES = paths.cocotb_tests / "probes"
CORE_TOP = "passo_spi_top"
BUS_TOPS = ("passo_wishbone", "passo_axi_lite")
ONE_CHANNEL = {"CHANNELS": 1, "AXES": 3, "TICK_LOG2": 7, "LINE_QUEUE_LOG2": 5, "RAMP_QUEUE_LOG2": 4}
WITH_INPUTS = ONE_CHANNEL | {"INPUTS": 1}
WITH_PINS = {"INPUTS": 1, "ENCODERS": 1, "OUTPUTS": 1, "COMPARE": 1}  # all parts that have pins
BUS_CORE = {"CHANNELS": 1, "AXES": 2, "TICK_LOG2": 7, "LINE_QUEUE_LOG2": 5, "RAMP_QUEUE_LOG2": 4} | WITH_PINS
WITH_ENCODERS = ONE_CHANNEL | {"ENCODERS": 1}
WITH_OUTPUTS = ONE_CHANNEL | {"OUTPUTS": 1, "RASTER": 1, "COMPARE": 1}
WITH_TRACKERS = ONE_CHANNEL | {"TRACKERS": 1}
WITH_TRACKED = WITH_TRACKERS | {"OUTPUTS": 1, "TRACKED": 2}
WITH_ALL = WITH_INPUTS | WITH_ENCODERS | WITH_OUTPUTS
MOST_AXES = WITH_ALL | {"AXES": 8, "TRACKERS": 1}
TWO_CHANNELS = {"CHANNELS": 2, "AXES": 2, "TICK_LOG2": 7, "LINE_QUEUE_LOG2": 2, "RAMP_QUEUE_LOG2": 2}
TWO_CHANNELS |= {"CLOCK_HZ": 108_000_000, "BUILD": 0x5EADBEEF}  # what this one tells


def run(
    module: str,
    toplevel: str,
    parameters: Mapping[str, int] | None = None,
    simulator: str = "verilator",
    *,
    environment_variables: Mapping[str, str] | None = None,
    netlist: bool = False,
) -> None:
    """Run the cocotb tests of `module` in `toplevel`, built with `parameters`; AssertionError if one fails.

    `module` is the `__name__` of the Python module. `toplevel` is a module of `cocotb_tests/tops/`, or of
    `rtl/` with what `cocotb_tests/probes/` has for it included at its end; it is built again only when one of
    the sources below it has changed. Tests see its pins and nothing below: what can be seen takes long to
    compile, all of a netlist an hour. With `netlist` the core is what synthesis makes of it for an iCE40,
    with exactly these parameters.
    """
    os.environ.update(environment())
    parameters = dict(parameters or {})
    rtl = netlist_folder(parameters) if netlist else Path(os.environ.get("PASSO_RTL", paths.rtl)).resolve()
    waves = bool(os.environ.get("PASSO_WAVES"))
    coverage = bool(os.environ.get(COVERAGE_VARIABLE)) and simulator == "verilator"
    variants = ["netlist"] if netlist else _variant(rtl)
    variants += [name for name, chosen in (("waves", waves), ("coverage", coverage)) if chosen]
    folder = _BUILD / _folder_name(toplevel, parameters, simulator, variants)
    test_folder = folder / module.rpartition(".")[2]
    test_folder.mkdir(parents=True, exist_ok=True)

    with _lock(folder):
        _build(simulator, toplevel, parameters, rtl, waves, coverage, folder)

    print(f"{SEED_VARIABLE}={seed()}")
    results = test_folder / "results.xml"
    results.unlink(missing_ok=True)
    try:
        get_runner(simulator).test(
            test_module=module,
            hdl_toplevel=toplevel,
            hdl_toplevel_lang="verilog",
            build_dir=folder,
            test_dir=test_folder,
            results_xml=str(results),
            seed=seed(),
            waves=waves,
            extra_env={SEED_VARIABLE: str(seed()), **(environment_variables or {})},
        )
    except SystemExit as error:
        print(f"the simulator ended with {error.code}")
    assert results.exists(), f"{module} in {simulator}: no results, the simulator ended early"
    tests, failed = get_results(results)
    assert tests > 0, f"{module}: no cocotb test found"
    assert failed == 0, (
        f"{module} in {simulator}, {SEED_VARIABLE}={seed()}: {failed} of {tests} cocotb tests failed"
    )


def skip_icarus(simulator: str) -> None:
    """Skip the running test on Icarus Verilog, up to ten times slower, unless all tests run there."""
    if simulator == "icarus" and not os.environ.get(ICARUS_VARIABLE):
        pytest.skip("part of 'make icarus'")


def _folder_name(
    toplevel: str, parameters: Mapping[str, int], simulator: str, variants: Sequence[str]
) -> str:
    settings = [f"{name}{value}" for name, value in sorted(parameters.items())]
    return "-".join([toplevel, *settings, simulator, *variants])


def _variant(rtl: Path) -> list[str]:
    return [] if rtl == paths.rtl else [hashlib.sha256(str(rtl).encode()).hexdigest()[:8]]


@contextmanager
def _lock(folder: Path) -> Iterator[None]:
    """Keep parallel test runs from building in the same folder."""
    with open(folder.with_suffix(".lock"), "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        yield


def _sources(toplevel: str, rtl: Path) -> list[Path]:
    """Return the source of `toplevel` and of all modules it mentions, itself last."""
    found: dict[str, Path] = {}

    def visit(name: str) -> None:
        path = next((p for p in (_TOPS / f"{name}.v", rtl / f"{name}.v") if p.exists()), None)
        if path is None or name in found:
            return
        found[name] = path
        code = re.sub(r"//.*", "", path.read_text())
        for mentioned in re.findall(r"\bpasso_\w+", code):
            visit(mentioned)

    visit(toplevel)
    assert found, f"no Verilog module {toplevel}"
    models = rtl / CELLS  # of a netlist
    return [*([models] if models.exists() else []), *reversed(found.values())]


def _probed(source: Path, probe: Path, folder: Path) -> Path:
    """A copy of a module with the probe at its end; messages and coverage name the lines of the source."""
    code, end, rest = source.read_text().rpartition("endmodule")
    copy = folder / source.name
    copy.write_text(f'`line 1 "{source}" 0\n{code}`include "{probe}"\n{end}{rest}')
    return copy


def _build(
    simulator: str,
    toplevel: str,
    parameters: Mapping[str, int],
    rtl: Path,
    waves: bool,
    coverage: bool,
    folder: Path,
) -> None:
    sources = _sources(toplevel, rtl)
    probe = _PROBES / f"{toplevel}.vh"
    if probe.exists():
        sources[-1] = _probed(sources[-1], probe, folder)
    netlist = (rtl / CELLS).exists()
    arguments = [*ONE_FILE] if simulator == "verilator" else []
    if coverage:
        # with all its counters, a function of a large core would take a compiler ten minutes
        arguments += ["--coverage-line", "--coverage-toggle", "--output-split-cfuncs", "2000"]
    if netlist and simulator == "verilator":
        arguments += ["-Wno-fatal", "-Wno-lint"]  # the models of the cells are not ours to warn about
    digest = hashlib.sha256(Path(__file__).read_bytes())
    for path in [*sources, *sorted(rtl.glob("*.vh")), *sorted(_PROBES.glob("*.vh"))]:
        digest.update(str(path).encode() + path.read_bytes())
    stamp = folder / "built"
    if stamp.exists() and stamp.read_text() == digest.hexdigest():
        return

    stamp.unlink(missing_ok=True)
    runner = _Verilator() if simulator == "verilator" else get_runner(simulator)
    runner.build(
        sources=sources,
        build_args=arguments,
        # every pin of the netlist is connected
        defines={"NO_ICE40_DEFAULT_ASSIGNMENTS": 1} if netlist else {},
        includes=[rtl],
        hdl_toplevel=toplevel,
        parameters=parameters,
        always=True,
        build_dir=folder,
        timescale=("1ns", "1ps"),
        waves=waves,
    )
    if isinstance(runner, _Verilator):
        runner.keep_runtime()
    stamp.write_text(digest.hexdigest())


class _Verilator(Verilator):
    """Compiles the Verilator runtime, which takes longer than any of the models, only in the first build.

    cocotb's main program is not part of it: it allocates the model, so that it has to know how large that is.
    """

    def _runtime(self) -> Path:
        versions = [f"{package}{version(package)}" for package in ("verilator", "cocotb")]
        kinds = [kind for kind in ("waves", "coverage") if f"-{kind}" in self.build_dir.name]
        return _BUILD / "-".join(["runtime", *versions, *kinds])

    def _build_command(self) -> list[list[str]]:
        """Put what is there between Verilator's makefile, which it has to be newer than, and make."""
        verilate, make = super()._build_command()
        if "coverage" not in self.build_dir.name:
            verilate = [part for part in verilate if part != "--public-flat-rw"]
            public = self.build_dir / "public.vlt"
            public.write_text(f'`verilator_config\npublic_flat_rw -module "{self.hdl_toplevel}" -var "*"\n')
            verilate.insert(verilate.index(str(self.sources[0])), str(public))
            # more takes longer than it saves
            make = [*make, f"OPT_FAST={'-O0' if 'netlist' in self.build_dir.name else '-O1'}"]
        else:
            make = [*make, "OPT_FAST=-O1"]  # the counters of a large core take minutes to optimize
        objects = [str(path) for path in self._runtime().glob("verilated*.o")]
        return [verilate, *([["cp", *objects, str(self.build_dir)]] if objects else []), make]

    def keep_runtime(self) -> None:
        """Keep the runtime of this build for the next ones."""
        runtime = self._runtime()
        runtime.mkdir(exist_ok=True)
        for name in ("verilated", "verilated_dpi", "verilated_vpi", "verilated_threads", "verilated_cov"):
            built, kept = self.build_dir / f"{name}.o", runtime / f"{name}.o"
            if built.exists() and not kept.exists():
                part = kept.with_suffix(f".{os.getpid()}")
                shutil.copy(built, part)
                part.rename(kept)
