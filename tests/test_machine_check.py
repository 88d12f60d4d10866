# SPDX-License-Identifier: MIT
"""`passo check`: what it tries, what it finds, and that nothing moves more than a step."""

import os
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from passo import machine_check
from passo.cli import main
from passo.failure import Failure
from passo.grbl import Grbl, pseudo_terminal, serve
from passo.grbl_setup import core_for
from passo.machine_check import Input, SimulatedPort, all_inputs, check, simulated
from passo.machine_file import MachineFile, read_machine
from passo.serial_port import Conversation, SerialPort
from passo.toolchain import paths

MACHINES = sorted((paths.examples / "machines").glob("*.toml"))
ROUTER = read_machine(paths.examples / "machines" / "router.toml")
INVERTED = replace(ROUTER, switches=replace(ROUTER.switches, inverted=True))


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """A person presses immediately, and sees short blinks."""
    for name, seconds in (("PRESSED", 0.3), ("GREETING", 0.2), ("BLINK", 0.02)):
        monkeypatch.setattr(machine_check, name, seconds)
    monkeypatch.setattr(Conversation, "LOOK", 0.01)


class Watched(SimulatedPort):
    """Keeps the events of the pins, which the console itself drops."""

    def __init__(self, engine: object, machine: MachineFile):
        self.events: list[np.ndarray] = []
        drain = engine.drain  # type: ignore[attr-defined]

        def watched() -> np.ndarray:
            self.events.append(drain())
            return self.events[-1]

        engine.drain = watched  # type: ignore[attr-defined]
        super().__init__(engine, machine)


@pytest.mark.parametrize("machine", [*map(read_machine, MACHINES), INVERTED], ids=lambda m: m.path.stem)
def test_a_good_machine(machine: MachineFile, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each input is asked for, each output toggles, each motor makes single steps to and fro; no power."""
    monkeypatch.setattr(machine_check, "SimulatedPort", Watched)
    told: list[str] = []
    with simulated(machine) as port:
        check(machine, port, told.append)
    assert [line[6:] for line in told if line.startswith("press ")] == [
        one.name for one in all_inputs(machine)
    ]
    assert told[-1] == "all inputs, outputs and motors answer"
    events = np.concatenate(port.events)
    for axis in range(len(machine.ends)):
        steps, back = (events[name] >> np.uint64(axis) & np.uint64(1) for name in ("step", "dir"))
        rises = np.flatnonzero(np.diff(steps.astype(int), prepend=0) > 0)
        assert back[rises].tolist() == [0, 1] * (len(rises) // 2) and len(rises) >= 2
    bits = (0, 2, 3) if machine.laser else range(4 if "outputs" in machine.parts else 0)
    for bit in bits:
        level = (events["outputs"] >> np.uint64(bit) & np.uint64(1)).astype(int)
        assert np.count_nonzero(np.diff(level, prepend=0) > 0) >= machine_check.BLINK_COUNT
    assert not events["power"].any()


class Faulty(SimulatedPort):
    """A hand that presses what is wired wrong: another input in the place of one, or none."""

    def __init__(self, engine: object, machine: MachineFile, at: str, instead: Input | None):
        super().__init__(engine, machine)
        self.at, self.instead = at, instead

    def press(self, pressed: Input, active: bool) -> None:
        if pressed.name != getattr(self, "at", ""):
            super().press(pressed, active)
        elif self.instead:
            super().press(self.instead, active)


@pytest.mark.parametrize(
    ("at", "instead", "said"),
    [
        ("Y: home switch", "X: home switch", "Y: home switch: X answers instead; check the wires"),
        ("Z: home switch", None, "Z: home switch does not answer; check its wires"),
        ("probe", None, "probe does not answer"),
        ("e-stop", None, "e-stop does not answer"),
    ],
)
def test_wrong_wires(monkeypatch: pytest.MonkeyPatch, at: str, instead: str | None, said: str) -> None:
    """The first that is wrong, and no motor has moved."""
    other = next((one for one in all_inputs(ROUTER) if one.name == instead), None)
    monkeypatch.setattr(
        machine_check, "SimulatedPort", lambda engine, machine: Faulty(engine, machine, at, other)
    )
    with simulated(ROUTER) as port, pytest.raises(Failure, match=said):
        check(ROUTER, port, lambda words: None)


def test_wrong_polarity() -> None:
    """A contact of the other kind is active at rest."""
    with simulated(ROUTER) as port:
        for one in all_inputs(ROUTER)[:2]:
            port.press(one, True)
        with pytest.raises(
            Failure, match=r"active at rest: X: home switch, Y: home switch; check the contact"
        ):
            check(ROUTER, port, lambda words: None)


def test_the_core_of_another_file() -> None:
    """Its clock is not that of this one."""
    other = replace(ROUTER, settings=replace(ROUTER.settings, clock_hz=48_000_000))
    with (
        simulated(ROUTER) as port,
        pytest.raises(Failure, match="the core runs at 96000000 Hz, the machine file has 48000000"),
    ):
        check(other, port, lambda words: None)


@pytest.mark.parametrize("right", [True, False])
def test_the_bitstream_of_another_file(monkeypatch: pytest.MonkeyPatch, right: bool) -> None:
    """Its identifier is not that of the one that `passo make` makes of this file."""
    wanted = machine_check.build_of(ROUTER)
    build = wanted if right else wanted ^ 1
    monkeypatch.setattr(machine_check, "core_for", lambda machine: replace(core_for(machine), build=build))
    with simulated(ROUTER) as port:
        if right:
            check(ROUTER, port, lambda words: None)
            return
        said = f"the bitstream is build {build}, that of the machine file {wanted}: load that one"
        with pytest.raises(Failure, match=said):
            check(ROUTER, port, lambda words: None)
    assert wanted != machine_check.build_of(replace(ROUTER, ends=ROUTER.ends[:2]))


@pytest.fixture
def terminal(tmp_path: Path) -> Iterator[Path]:
    """The console behind a pseudo-terminal, in real time; no hand."""
    over = threading.Event()
    with simulated(ROUTER) as port, pseudo_terminal(tmp_path / "serial") as ours:
        grbl = Grbl(port.engine, ROUTER, lambda text: os.write(ours, text.encode()))
        thread = threading.Thread(target=serve, args=(grbl, ours, over.is_set))
        thread.start()
        yield tmp_path / "serial"
        over.set()
        thread.join()


def test_a_serial_port(
    terminal: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same words; a person who does not press is told so."""
    monkeypatch.setattr(machine_check, "GREETING", 0.5)
    monkeypatch.setattr(Conversation, "LOOK", 0.05)
    assert main(["check", str(ROUTER.path), "--port", str(terminal)]) == 1
    told = capsys.readouterr()
    assert "core 0.4.0, 96 MHz" in told.out and "press X: home switch" in told.out
    assert told.err == "X: home switch does not answer; check its wires\n"


def test_no_port(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    """No such file, a file that is no terminal, a terminal where nobody answers."""
    assert main(["check", str(ROUTER.path), "--port", str(tmp_path / "none")]) == 2
    assert "No such file" in capsys.readouterr().err
    (tmp_path / "file").touch()
    assert main(["check", str(ROUTER.path), "--port", str(tmp_path / "file")]) == 2
    assert str(tmp_path / "file") in capsys.readouterr().err
    monkeypatch.setattr(machine_check, "GREETING", 0.1)
    monkeypatch.setattr(Conversation, "ANSWER", 0.1)
    silent = tmp_path / "silent"
    no_answer = pytest.raises(Failure, match=r"no answer to \$X: is it the grbl image")
    with pseudo_terminal(silent), SerialPort(silent) as port, no_answer:
        check(ROUTER, port, lambda words: None)
