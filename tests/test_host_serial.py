# SPDX-License-Identifier: MIT
"""Machine at an STM32F103 with the grbl image, behind a serial port."""

import asyncio
import os
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest
from passo import Machine
from passo.engine import moves_of
from passo.failure import BadInputError, Failure
from passo.grbl import Grbl, pseudo_terminal, serve
from passo.grbl_setup import machine_at
from passo.host_serial import SerialCore, is_serial
from passo.machine_file import MachineFile, read_machine
from passo.serial_port import SerialPort

from tests.test_host_machine import COREXY, HOMES, PLAIN


class Firmware:
    """The protocol of the firmware on a simulated core with its switches; time passes in `read`."""

    real_time = False

    def __init__(self, engine: object, machine: MachineFile):
        self.engine, self.said, self.events = engine, "", [engine.drain()]  # type: ignore[attr-defined]
        drain = engine.drain  # type: ignore[attr-defined]

        def kept() -> np.ndarray:
            self.events.append(drain())
            return self.events[-1]

        engine.drain = kept  # type: ignore[attr-defined]
        self.grbl = Grbl(engine, machine, self._hear)
        self.closed = False

    def _hear(self, text: str) -> None:
        self.said += text

    def write(self, data: bytes) -> None:
        self.grbl.type(data)

    def read(self, seconds: float) -> str:
        self.grbl.wait(lambda: False, seconds)
        said, self.said = self.said, ""
        return said

    def close(self) -> None:
        self.closed = True

    def steps(self, motor: int) -> int:
        """At the pins so far."""
        return int(moves_of(np.concatenate(self.events), motor).sum())


@pytest.fixture
def at(tmp_path: Path) -> Iterator[Callable[..., tuple[Machine, Firmware]]]:
    """A machine of the text of a file; the firmware may have another one."""
    stack = []

    def make(text: str, of_firmware: str = "") -> tuple[Machine, Firmware]:
        for name, part in (("machine", text), ("firmware", of_firmware or text)):
            (tmp_path / f"{name}.toml").write_text(part)
        own = read_machine(tmp_path / "firmware.toml")
        opened = machine_at("model", own)
        firmware = Firmware(opened.__enter__(), own)
        stack.append(opened)
        file = read_machine(tmp_path / "machine.toml")
        return Machine(file, SerialCore(firmware, file)), firmware

    yield make
    for opened in stack:
        opened.__exit__(None, None, None)


def test_a_move_and_a_path(at: Callable[..., tuple[Machine, Firmware]]) -> None:
    """As on a core: planned, run, exact at the pins."""
    machine, firmware = at(PLAIN)
    with machine:
        motion = machine.move(X=4, z=-2, speed=40)
        assert motion.seconds > 0.1
        assert motion.run().end == {"X": 4.0, "Y": 0.0, "Z": -2.0}
        assert [firmware.steps(motor) for motor in range(3)] == [320, 0, -160]
        corner = [[10 + 0.01 * k, 0.02 * k, 0] for k in range(100)]
        done = machine.path([*corner, [1, 1, 1]]).run()
        assert done.end == {"X": 1.0, "Y": 1.0, "Z": 1.0}
        assert [firmware.steps(motor) for motor in range(3)] == [80, 80, 80]
        with pytest.raises(Failure, match="only a simulation sees the pins"):
            done.seconds  # noqa: B018
        assert machine.move(X=1).run().end == done.end
    assert firmware.closed


@pytest.mark.parametrize("text", [HOMES, COREXY], ids=["cartesian", "corexy"])
def test_homing(at: Callable[..., tuple[Machine, Firmware]], text: str) -> None:
    """The low end is 0, the high end the travel, less the pull-off; before, it is refused to move."""
    machine, _ = at(text)
    with pytest.raises(Failure, match=r"error:9 \(docs/gcode.md\)"):
        machine.move(X=30).run()
    with pytest.raises(BadInputError, match="the firmware homes X, Y, Z together"):
        machine.home("x").run()
    assert machine.home().run().end == pytest.approx({"X": 1, "Y": 59, "Z": 1}, abs=0.02)
    assert machine.move(X=30, Y=30).run().end == pytest.approx({"X": 30, "Y": 30, "Z": 1}, abs=0.02)


def test_other_tasks_go_on(at: Callable[..., tuple[Machine, Firmware]]) -> None:
    """Hold, resume, override and stop while a motion is awaited; then it continues from there."""
    machine, firmware = at(PLAIN)
    clock = firmware.engine.__class__.clock.fget  # type: ignore[attr-defined]

    async def until(there: Callable[[float], bool], motion: asyncio.Future[object]) -> None:
        while not there(machine.position["X"]):
            assert not motion.done()
            await asyncio.sleep(0)

    async def run() -> None:
        moved = asyncio.ensure_future(_run(machine.move(X=10, speed=20)))
        await until(lambda place: place > 2, moved)
        machine.hold()
        for _ in range(10):
            await asyncio.sleep(0)
        held = machine.position["X"]
        for _ in range(10):
            await asyncio.sleep(0)
        assert machine.position["X"] == held < 5
        machine.override(50)
        machine.resume()
        begin = clock(firmware.engine)
        assert (await moved) == {"X": 10.0, "Y": 0.0, "Z": 0.0}
        assert clock(firmware.engine) - begin > (10 - held) / 10 * 16_000_000
        machine.override(100)
        moved = asyncio.ensure_future(_run(machine.move(X=0)))
        await until(lambda place: place < 9, moved)
        machine.stop()
        with pytest.raises(Failure, match="stopped"):
            await moved
        machine.clear()
        rest = machine.position["X"]
        assert 0 < rest < 9 and firmware.steps(0) == round(rest * 80)
        assert machine.move(X=3).run().end["X"] == 3

    async def _run(motion: object) -> dict[str, float]:
        return (await motion).end  # type: ignore[misc, no-any-return]

    asyncio.run(run())


def test_what_is_refused(at: Callable[..., tuple[Machine, Firmware]]) -> None:
    """Each in a sentence, and nothing moves."""
    machine, firmware = at(PLAIN)
    motion = machine.follow([0, 0.5, 1], [[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]], smooth=True)
    with pytest.raises(BadInputError, match="no timed points: wire the core to this computer's SPI"):
        motion.run()
    with pytest.raises(BadInputError, match="override is 5: the firmware takes 10 to 100"):
        machine.override(5)
    assert not any(firmware.steps(motor) for motor in range(3))
    with pytest.raises(BadInputError, match=r"the firmware has \$101=40, .* 80: send it the settings.txt"):
        at(PLAIN, PLAIN.replace("steps_per_mm = 80", "steps_per_mm = 40").replace("40", "80", 1))
    with pytest.raises(BadInputError, match=r"the core runs at 16000000 Hz, .* has 20000000"):
        at(PLAIN.replace("16_000_000", "20_000_000"), PLAIN)


def test_a_port(tmp_path: Path) -> None:
    """In real time; a second program is refused, as is a port where nobody answers."""
    (tmp_path / "machine.toml").write_text(PLAIN)
    file, link, over = read_machine(tmp_path / "machine.toml"), tmp_path / "tty", threading.Event()
    with machine_at("model", file) as engine, pseudo_terminal(link) as ours:
        grbl = Grbl(engine, file, lambda text: os.write(ours, text.encode()))
        thread = threading.Thread(target=serve, args=(grbl, ours, over.is_set))
        thread.start()
        try:
            with Machine.from_file(file.path, str(link)) as machine:
                with pytest.raises(BadInputError, match="another program holds it"):
                    SerialPort(link)
                assert machine.move(X=1, Y=-1).run().end == {"X": 1.0, "Y": -1.0, "Z": 0.0}
        finally:
            over.set()
            thread.join()
    with pytest.raises(BadInputError, match="No such file"):
        Machine.from_file(file.path, "/dev/ttyNONE")
    with pseudo_terminal(link), pytest.raises(Failure, match="is it the grbl image, at 115200 baud"):
        Machine.from_file(file.path, str(link))


def test_devices() -> None:
    assert is_serial("/dev/ttyUSB0") and is_serial("/dev/serial/by-id/usb-x")
    assert not is_serial("/dev/spidev0.0") and not is_serial("unix:/tmp/passo")
