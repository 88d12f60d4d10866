# SPDX-License-Identifier: MIT
"""passo_open_linux(): at the socket of `passo serve`, and at spidev, whose kernel a library plays."""

import fcntl
import os
import socket
import subprocess
import sys
import textwrap
import threading
import time
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from passo.build import Parameters, engine_sources
from passo.compiler import compile_to, includes, sources
from passo.engine import model_engine, moves_of
from passo.native import ffi, planner
from passo.serve import GREETING
from passo.toolchain import paths

from tests.helpers.serving import serving

CLOCK_HZ = 100_000_000
CORE = Parameters(clock_hz=CLOCK_HZ)
DEVICE = "/dev/spidev9.9"
ARRIVED = "x = 120.500 mm\ny = -40.000 mm\nz = 2.250 mm\nx = 0.000 mm\ny = 0.000 mm\nz = 0.000 mm\n"
ABORTED = """
    import sys
    from passo.native import ffi, planner
    c, n = planner(), ffi().new
    passo, host, link = n("struct passo *"), n("struct passo_host *"), n("struct passo_linux *")
    names = [n("char[]", text) for text in (b"/dev/spidev9.9", b"/dev/gpiochip9")]
    device = n("struct passo_linux_options *",
        {"device": names[0], "irq_chip": names[1], "irq_line": int(sys.argv[1])})
    error = c.passo_open_linux(passo, host, link, device, n("struct passo_options *"))
    if error:
        sys.exit(ffi().string(link.problem).decode())
    irq = host.hardware.irq
    before = irq(link)
    c.passo_abort(passo)
    print(before, irq(link))
    c.passo_clear(passo)
    print(irq(link))
"""


@cache
def example() -> Path:
    """The program of examples/linux."""
    program = paths.build / "linux"
    folder = paths.examples / "linux"
    made = subprocess.run(
        ["make", "-C", folder, "CC=cc -Werror", f"OUT={program}"], capture_output=True, text=True
    )
    assert made.returncode == 0, made.stderr
    return program


@cache
def shim() -> Path:
    """The library that plays the kernel."""
    folders = (paths.engine, paths.core, paths.protocol)
    files = [
        paths.tests / "spidev_shim.c",
        *sources(paths.core, paths.protocol),
        *engine_sources(),
        paths.engine / "engine_model.c",
    ]
    flags = ("-std=c11", "-Wall", "-Wextra", "-Werror", "-O2", "-fPIC", "-shared", *includes(*folders))
    return compile_to(paths.build / "spidev_shim.so", *flags, *files)


def run(*command: str | Path, **shimmed: str) -> subprocess.CompletedProcess[str]:
    env = os.environ | {"LD_PRELOAD": str(shim())} | {f"SHIM_{key}": text for key, text in shimmed.items()}
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, env=env, timeout=60)


def open_linux(device: str, axes: int = 0, clock_hz: int = 0) -> tuple[str, str]:
    """The error of passo_open_linux(), and its sentence."""
    c, new = planner(), ffi().new
    name = new("char[]", device.encode())
    host = new("struct passo_linux *")
    options = new("struct passo_linux_options *", {"device": name, "axes": axes})
    wanted = new("struct passo_options *", {"clock_hz": clock_hz})
    error = c.passo_open_linux(new("struct passo *"), new("struct passo_host *"), host, options, wanted)
    c.passo_close_linux(host)
    return ffi().string(c.passo_error_name(error)).decode(), ffi().string(host.problem).decode()


@pytest.mark.parametrize("real_time", [False, True])
def test_the_example_at_a_socket(tmp_path: Path, real_time: bool) -> None:
    """It arrives, in simulated time immediately; the pins made the way there and back."""
    path = tmp_path / "core"
    with model_engine(CORE, CLOCK_HZ) as engine:
        with serving(engine, path, real_time=real_time, keep=True) as server:
            began = time.monotonic()
            done = subprocess.run([example(), f"unix:{path}"], capture_output=True, text=True, timeout=60)
            took = time.monotonic() - began
        events = server.events
    assert (done.returncode, done.stderr, done.stdout) == (0, "", ARRIVED)
    steps = moves_of(events, 0)
    assert (int(np.abs(steps).sum()), int(steps.sum())) == (2 * 9640, 0)
    moving = (events["clock"][-1] - events["clock"][1]) / CLOCK_HZ
    assert took > moving or not real_time


def test_the_example_at_spidev(tmp_path: Path) -> None:
    """The same binary; the mode that another program has left does not matter."""
    log = tmp_path / "log"
    done = run(example(), DEVICE, FILE="/dev/null", LOG=str(log))
    assert (done.returncode, done.stderr, done.stdout) == (0, "", ARRIVED)
    assert set(log.read_text().split()) == {"4000000"}


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        ("denied", "no permission: add the user to the group of the device (sudo usermod -aG spi $USER)"),
        ("plain", "this is no SPI device: give one such as /dev/spidev0.0"),
        ("modeless", "it does not do SPI mode 0 with 8 bits: use another controller"),
        ("low", "STUCK_LOW: MISO stays low: no core, no power or no connection: is the FPGA configured? "),
        ("high", "STUCK_HIGH: MISO stays high: no core, no power or no connection: is the FPGA configured? "),
        ("shifted", "DAMAGED: the reply failed its check: lower the speed of SCLK, shorten the wires, and "),
    ],
)
def test_what_is_wrong_at_spidev(fault: str, sentence: str) -> None:
    """One sentence that says what to do."""
    done = run(example(), DEVICE, FILE="/dev/null", FAULT=fault)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"{DEVICE}: {sentence}")
    assert len(done.stderr.splitlines()) == 1


def test_a_core_with_too_few_axes() -> None:
    done = run(example(), DEVICE, FILE="/dev/null", AXES="2")
    assert done.stderr == f"{DEVICE}: the core has 2 axes, the program needs 3: build it with AXES=3\n"


def test_another_program_holds_the_device(tmp_path: Path) -> None:
    """Until it ends."""
    held = tmp_path / "device"
    held.touch()
    with held.open() as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        done = run(example(), DEVICE, FILE=str(held))
        assert done.stderr == f"{DEVICE}: another program holds it: end that one first\n"
    assert run(example(), DEVICE, FILE=str(held)).stdout == ARRIVED


def test_irq_is_a_gpio_line() -> None:
    """High while the channel is stopped; a line that is missing is refused."""
    script = textwrap.dedent(ABORTED)
    planner()  # builds it
    done = run(sys.executable, "-c", script, "25", FILE="/dev/null")
    assert (done.stderr, done.stdout) == ("", "False True\nFalse\n")
    done = run(sys.executable, "-c", script, "24", FILE="/dev/null")
    assert done.stderr.startswith("/dev/gpiochip9, line 24: Invalid argument: give the chip and the line")


def test_what_is_wrong_without_a_device(tmp_path: Path) -> None:
    path = tmp_path / "none"
    name, sentence = open_linux(str(path))
    assert name == "TRANSFER"
    assert sentence.startswith(f"{path}: there is no such device: switch SPI on")
    name, sentence = open_linux(f"unix:{path}")
    assert name == "TRANSFER"
    assert sentence == f"unix:{path}: No such file or directory: start the simulation: passo serve {path}"
    assert "has at most 107 letters" in open_linux(f"unix:{'x' * 108}")[1]
    path.touch()
    assert open_linux(str(path))[1] == f"{path}: this is no SPI device: give one such as /dev/spidev0.0"


def test_what_is_wrong_at_a_socket(tmp_path: Path) -> None:
    """A second host, another core, a core of another clock; the first host is not disturbed."""
    path = tmp_path / "core"
    device = f"unix:{path}"
    with model_engine(CORE, CLOCK_HZ) as engine, serving(engine, path) as server:
        assert open_linux(device) == ("OK", "")
        assert open_linux(device, axes=4) == ("OK", "")
        name, sentence = open_linux(device, axes=6)
        assert name == "PARAMETERS"
        assert sentence == f"{device}: the core has 4 axes, the program needs 6: build it with AXES=6"
        name, sentence = open_linux(device, clock_hz=1000)
        assert name == "CLOCK"
        assert sentence.endswith("build the bitstream with what the program expects, or change its options")
        with socket.socket(socket.AF_UNIX) as first:
            first.connect(str(path))
            assert int.from_bytes(first.recv(8, socket.MSG_WAITALL)[:4]) == GREETING
            assert open_linux(device)[1] == f"{device}: another program holds it: end that one first"
            first.sendall(bytes([0, 0, 0, 0, 0, 0, 0, 9]))
            assert int.from_bytes(first.recv(8, socket.MSG_WAITALL)[:4]) >= 9
        assert server.hosts == 5
    with socket.socket(socket.AF_UNIX) as other:
        other.bind(str(path))
        other.listen()

        def answer() -> None:
            peer, _ = other.accept()
            peer.sendall(b"220 mail")
            peer.close()

        thread = threading.Thread(target=answer)
        thread.start()
        assert open_linux(device)[1] == f"{device}: this is not the socket of passo serve"
        thread.join()


def test_a_host_that_is_no_driver_is_let_go(tmp_path: Path) -> None:
    """A frame that is too long; the next host finds the core as it was."""
    path = tmp_path / "core"
    with model_engine(CORE, CLOCK_HZ) as engine, serving(engine, path):
        with socket.socket(socket.AF_UNIX) as host:
            host.connect(str(path))
            host.recv(8, socket.MSG_WAITALL)
            host.sendall(bytes([0, 0, 0, 65]))
            assert host.recv(1) == b""
        assert open_linux(f"unix:{path}") == ("OK", "")
