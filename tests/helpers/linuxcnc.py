# SPDX-License-Identifier: MIT
"""A headless LinuxCNC with the component at a simulated core (examples/linuxcnc)."""

import fcntl
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from passo.engine import NUMBERS
from passo.grbl_setup import served
from passo.linuxcnc_files import HAL, linuxcnc_files
from passo.machine_file import MachineFile, read_machine
from passo.native import ffi
from passo.rig import CHANGE, CHANGES_PER_DRAIN
from passo.toolchain import paths

from tests.helpers.serving import serving

COMPONENT = paths.linux / "linuxcnc"
EXAMPLE = paths.examples / "linuxcnc"
MODULES = Path("/usr/lib/linuxcnc/modules")
HEADERS = Path("/usr/include/linuxcnc/hal.h")
NOBODY = 65534
SECONDS_MAX = 450  # of homing, and of a program
SAMPLES = "samples.txt"


@dataclass(frozen=True)
class Result:
    """What LinuxCNC saw, and what the pins of the core did."""

    homed: bool
    ended: bool
    said: list[str]
    positions: list[float]
    ferror: list[float]
    pins: dict[str, str]
    events: Any
    turns: Any  # clocks of the index of the spindle
    samples: Any  # period x (commands of the joints, then their feedback), mm
    log: str


def component() -> Path:
    """The component, made with its own Makefile; skips without LinuxCNC."""
    if not HEADERS.exists() or not shutil.which("linuxcnc"):
        pytest.skip("LinuxCNC is not installed: tools/setup.sh linuxcnc")
    made = paths.build / "linuxcnc" / "passo.so"
    made.parent.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(
        ["make", "-s", "-C", COMPONENT, "CC=cc -Werror", f"OUT={made}"], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return made


def installed() -> None:
    """The component is where LinuxCNC finds it; skips if it may not be put there."""
    made, place = component(), MODULES / "passo.so"
    if place.exists() and place.read_bytes() == made.read_bytes():
        return
    if not os.access(MODULES, os.W_OK):
        pytest.skip("the component is not installed: sudo make -C linux/linuxcnc install")
    shutil.copy(made, place)


@contextmanager
def alone() -> Iterator[Path]:
    """A folder of the user that runs LinuxCNC, of which a computer has one at a time."""
    with (Path(tempfile.gettempdir()) / "passo_linuxcnc.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        folder = Path(tempfile.mkdtemp(prefix="passo_linuxcnc_"))
        try:
            yield folder
        finally:
            shutil.rmtree(folder, ignore_errors=True)


def sampled(joints: str) -> str:
    """Lines of HAL that record the commands and the feedback of all joints in each period."""
    signals = [f"{letter.lower()}-{what}" for what in ("cmd", "fb") for letter in joints]
    nets = (f"net {signal} sampler.0.pin.{number}" for number, signal in enumerate(signals))
    load = f"loadrt sampler depth=4000 cfg={'f' * len(signals)}"
    return "\n".join([load, "addf sampler.0 servo-thread", *nets, f"loadusr halsampler -t {SAMPLES}", ""])


def read_samples(file: Path) -> Any:
    """They are complete, and each of one period; the last line may be cut."""
    rows = [line.split() for line in file.read_text().splitlines()[:-1]]
    found = np.array([[float(word) for word in row] for row in rows])
    assert np.all(np.diff(found[:, 0]) == 1), "a sample was lost"
    return found[:, 1:]


def prepare(folder: Path, machine: MachineFile, program: str, device: str, changes: dict[str, str]) -> None:
    """The configuration that `passo make` makes, without its screen, and with changes of its files."""
    for name, lines in linuxcnc_files(machine).items():
        text = "\n".join([*lines, ""])
        for old, new in changes.items():
            text = text.replace(old, new)
        text += sampled(machine.letters) if name == HAL else ""
        text = re.sub(r"^DISPLAY = .*", "DISPLAY = ./ui.py", text, flags=re.M)
        text = re.sub(r"^DEVICE = .*", f"DEVICE = {device}", text, flags=re.M)
        (folder / name).write_text(text)
    shutil.copy(paths.tests / "linuxcnc" / "ui.py", folder)
    (folder / "program.ngc").write_text(program)
    folder.chmod(0o777)


def _call(folder: Path, *command: str, seconds: int = SECONDS_MAX) -> subprocess.CompletedProcess[str]:
    # it refuses to run as root
    user = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]
    called = subprocess.Popen(
        [*(user if os.geteuid() == 0 else []), *command],
        cwd=folder,
        env=os.environ | {"HOME": str(folder), "SECONDS_MAX": str(seconds)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,  # all that it starts ends with it
    )
    try:
        out, err = called.communicate(timeout=2 * seconds)
    except subprocess.TimeoutExpired:
        os.killpg(called.pid, signal.SIGKILL)
        called.communicate()
        raise
    return subprocess.CompletedProcess(command, called.returncode, out, err)


def run_hal(script: str, device: str = "", text: str = "", real_time: bool = False) -> tuple[str, Any]:
    """What is said to a script of halcmd, and the events of the pins; CORE in it is the device.

    `text`: of another machine file than that of the example; `real_time`: time passes without the program.
    """
    with alone() as folder:
        installed()
        place = folder / "core"
        (folder / "script.hal").write_text(script.replace("CORE", device or f"unix:{place}"))
        folder.chmod(0o777)
        (folder / "machine.toml").write_text(text or (EXAMPLE / "machine.toml").read_text())
        with served("model", read_machine(folder / "machine.toml")) as core:
            with serving(core, place, keep=True, real_time=real_time) as server:
                place.chmod(0o777)
                done = _call(folder, "halrun", "-f", "script.hal")
            events = server.events
        return done.stdout + done.stderr, events


SIX_AXES = 'host = "linuxcnc"\nclock_hz = 16_000_000\n' + "".join(
    f'[[axis]]\nname = "{letter}"\nsteps_per_mm = 80\nspeed = 100\nacceleration = 500\nswitches = ["home"]\n'
    for letter in "XYZABC"
)
WIRE = """
loadrt threads name1=servo period1=1000000
loadrt passo device=CORE axes=6
loadrt integ
addf passo.0.read servo
addf integ.0 servo
addf passo.0.write servo
setp integ.0.in 1
"""
ON = "setp passo.0.stepgen.00.enable 1\nstart\nloadusr -w sleep 2\n"
LOOK = "getp passo.0.link.words\ngetp integ.0.out\n"


def share_of_wire(sclk_hz: int = 4_000_000) -> float:
    """What the frames of six axes with inputs take of it, at 1 kHz."""
    settings = "".join(
        f"setp passo.0.stepgen.{axis:02}.{key} {value}\n"
        for axis in range(6)
        for key, value in {"position-scale": 80, "maxvel": 100, "maxaccel": 1000}.items()
    )
    script = WIRE + settings + ON + LOOK + "loadusr -w sleep 8\n" + LOOK + "getp passo.0.fault\n"
    said, _ = run_hal(script, text=SIX_AXES)
    first, begun, last, ended = (number_of(word) for word in re.findall(r"^[\dx.A-F]+$", said, re.M))
    assert "FALSE" in said.split(), said
    return (last - first) * 32 / sclk_hz / (ended - begun)


def number_of(text: str) -> float:
    """Of halcmd: hexadecimal, or not."""
    return int(text, 16) if text.startswith("0x") else float(text)


def indexes(library: Any, rig: Any) -> Any:
    """Clocks at which the index of a spindle rises."""
    buffer, found = ffi().new("struct passo_rig_change[]", CHANGES_PER_DRAIN), [np.empty(0, CHANGE)]
    while count := library.passo_rig_drain(rig, buffer, CHANGES_PER_DRAIN):
        found.append(np.frombuffer(ffi().buffer(buffer), CHANGE, count).copy())
    changes = np.concatenate(found)
    return changes["clock"][(changes["input"] == NUMBERS["encoder_index"]) & (changes["levels"] != 0)]


def run_linuxcnc(
    program: str,
    engine: str = "model",
    changes: dict[str, str] | None = None,
    text: str = "",
    per_turn: int = 0,
    seconds: int = SECONDS_MAX,
) -> Result:
    """Home and run a program; `changes`: of the text of its files; `text`: of another machine file.

    `per_turn`: counts from index to index of the encoders of motors; `seconds`: that the program may take.
    """
    with alone() as folder:
        installed()
        place = folder / "core"
        (folder / "machine.toml").write_text(text or (EXAMPLE / "machine.toml").read_text())
        machine = read_machine(folder / "machine.toml")
        prepare(folder, machine, program, f"unix:{place}", changes or {})
        rigs: list[Any] = []
        with served(engine, machine, per_turn, rigs.extend) as core:
            with serving(core, place, keep=True) as server:
                place.chmod(0o777)
                done = _call(folder, "linuxcnc", "machine.ini", seconds=seconds)
            events, turns = server.events, indexes(*rigs[0]) if rigs else np.empty(0)
        logs = [file.read_text() for file in folder.glob("linuxcnc_*.txt")]
        samples = read_samples(folder / SAMPLES) if (folder / SAMPLES).exists() else np.empty(0)
        result = folder / "result.json"
        found = json.loads(result.read_text()) if result.exists() else {}
        empty = {"homed": False, "ended": False, "said": [], "positions": [], "ferror": [], "pins": {}}
        log = "\n".join([done.stdout, done.stderr, *logs])
        return Result(**(empty | found), events=events, turns=turns, samples=samples, log=log)
