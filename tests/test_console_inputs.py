# SPDX-License-Identifier: MIT
"""The console on a core with inputs: switches, e-stop, watchdog, home, probe, jog, trigger."""

import re
import subprocess
import sys
from collections.abc import Iterator

import pytest
from passo.engine import model_engine
from passo.machine import Switch
from passo.toolchain import paths

from tests.test_console import CLOCK_HZ, Bench, passo_console

HOME = "home axis=0 back_off=50 speed=5000 slow_speed=500 acceleration=200_000"
JOG = "jog axis=0 speed=4000 acceleration=100_000"
PROBE = "probe steps=0,0,-1000 speed=2000 acceleration=200_000"
TRIGGER = "trigger home axis=0"


@pytest.fixture
def bench() -> Iterator[Bench]:
    switches = (
        Switch("home", 0, -500),
        Switch("limit_high", 0, 400, above=True),
        Switch("probe", 2, -300),
    )
    made = Bench(inputs=1, switches=switches)
    assert made.ask("config stop_time=5ms") == "ok"
    assert made.ask("input axis=0 home=active_high limit_high=active_high limit_soft=1") == "ok"
    assert made.ask("input probe=active_high") == "ok"
    made.ask("enable")
    yield made
    made.close()


def axis_0(bench: Bench) -> int:
    return int(bench.tell("position")["position"].split(",")[0])


def test_a_core_without_inputs_says_so() -> None:
    """Each line of the inputs; status and config are as without them."""
    bench = Bench()
    for line in (
        "inputs",
        "input axis=0 home=active_low",
        "input probe=active_low",
        "trigger",
        TRIGGER,
        "wait_trigger",
        "config watchdog=1s",
        f"{HOME} distance=-9",
        PROBE,
    ):
        assert bench.ask(line).startswith("error: NO_INPUTS: "), line
    assert "inputs" not in bench.tell("status") and "watchdog" not in bench.tell("config")
    assert bench.ask(JOG) == "ok"  # this one needs none


def test_only_the_inputs_that_are_given_change(bench: Bench) -> None:
    """What `input` shows can be typed, and is applied again by `open`."""
    shown = bench.ask("input axis=0")
    assert shown == (
        "ok axis=0 limit_low=none limit_high=active_high home=active_high alarm=none limit_soft=1 "
        "alarm_soft=0 alarm_disables=0"
    )
    assert bench.ask("input axis=0 alarm=active_low") == "ok"
    bench.machine.set("alarm", 1)
    bench.ask("run 0.001")
    assert bench.ask("clear") == "ok"
    shown = shown.replace("alarm=none", "alarm=active_low")
    assert bench.ask("input axis=0") == shown
    assert bench.ask(shown.replace("ok", "input")) == "ok"
    assert bench.ask("input") == "ok probe=active_high"
    assert bench.ask("open") == "ok"
    assert bench.tell("status")["inputs"] == "none"
    assert bench.ask("input axis=1 limit_low=maybe") == (
        "error: limit_low must be one of none|active_high|active_low, not 'maybe'"
    )
    assert bench.ask("input home=active_low") == "error: axis is missing"
    assert bench.ask("input axis=1 probe=active_low") == "error: axis and probe are mutually exclusive"
    assert bench.ask("input probe=none") == "error: probe must be active_high or active_low"


def test_open_sets_up_a_core_that_was_reset(bench: Bench) -> None:
    """The inputs of each axis, and the probe, are as they were."""
    assert bench.ask("input axis=2 alarm=active_high") == "ok"
    with model_engine(bench.engine.parameters, CLOCK_HZ) as fresh:
        bench.machine.engine = fresh
        assert bench.ask("move steps=5 profile=linear total_time=1 ramp_time=0.1").startswith("error: ")
        assert bench.ask("open") == "ok"
        bench.ask("enable")
        assert bench.tell(PROBE)["touched"] == "1"
        assert bench.ask(f"{HOME} distance=-3000") == "ok"
        bench.machine.set("alarm", 4)
        bench.ask("run 0.01")
        assert bench.tell("status")["cause"] == "ALARM"
        bench.machine.engine = bench.engine


def test_home_is_answered_at_its_end(bench: Bench) -> None:
    """The position is that of the switch; other lines wait, short ones are answered."""
    bench.machine.positions[0] = 0
    assert bench.tell("status")["homed"] == "none"
    assert bench.ask(f"{HOME} distance=-3000 position=-777 pull_off=20") == "ok"
    assert bench.tell("status")["homed"] == "0"
    assert axis_0(bench) == -757
    assert bench.machine.positions[0] == pytest.approx(-480, abs=1)
    bench.ask("disable 0")
    assert bench.tell("status")["homed"] == "none"


def test_lines_during_a_home(bench: Bench) -> None:
    """Short ones pass; others are refused by name; a stop answers the home."""
    bench.terminal.type(f"{HOME} distance=-3000\n".encode())
    assert bench.take() == ""
    bench.terminal.type(b"status\n")
    status = bench.take()
    assert "moving=1" in status and "waiting=1" in status
    bench.terminal.type(b"move steps=5 profile=linear total_time=1 ramp_time=0.1\n")
    assert bench.take() == "error: WAITING: home is in progress: send move after its answer\n"
    bench.terminal.type(b"stop\n")
    assert bench.take() == "ok\n"
    bench.terminal.wait()
    assert bench.take().endswith("error: STOPPED: the channel is stopped: clear it first\n")
    assert bench.tell("status")["homed"] == "none"
    assert bench.ask("clear") == "ok"
    there = axis_0(bench)
    bench.ask("run 0.1")
    assert axis_0(bench) == there


def test_a_home_that_fails_is_told_once(bench: Bench) -> None:
    """In its answer, not in a note as well; the next home is not blamed for it."""
    bench.terminal.line(f"{HOME} distance=-100")
    assert bench.take() == ("error: SWITCH_MISSED: the switch or probe did not trigger within the distance\n")
    assert bench.ask(f"{HOME} distance=-3000") == "ok"
    assert bench.ask(f"{HOME.replace('axis=0', 'axis=1')} distance=-1").startswith("error: NO_SWITCH: ")
    assert bench.ask(f"{HOME} distance=0").startswith("error: NO_DISTANCE: ")
    assert bench.ask(f"{HOME} distance=5 source=probe").startswith("error: ARGUMENT: ")
    assert bench.ask("config flow=refuse") == "ok"
    assert bench.ask(f"{HOME} distance=-3000") == "ok"  # it has begun
    assert bench.tell("status")["moving"] == "1"
    assert bench.ask(f"{HOME} distance=-3000").startswith("error: MOVING: ")
    assert bench.ask("wait") == "ok"
    assert bench.tell("status")["homed"] == "0"


@pytest.mark.parametrize(("stuck", "distance"), [(True, 300), (False, 700)])
def test_home_with_a_switch_that_sticks(bench: Bench, stuck: bool, distance: int) -> None:
    """Never left, or never found: at the end of the distance, not homed; the drive holds."""
    bench.machine.switches[0].stuck = stuck
    bench.ask("run 0.1")
    assert bench.ask(f"{HOME} distance={-distance}").startswith("error: SWITCH_MISSED: ")
    assert axis_0(bench) == (distance if stuck else -distance)
    status = bench.tell("status")
    assert status["homed"] == "none" and status["moving"] == "0" and bench.machine.enable & 1


def test_home_ends_with_the_core(bench: Bench) -> None:
    """A reset of the core: its position is unknown, its drives are off."""
    bench.terminal.type(f"{HOME} distance=-3000\n".encode())
    old = bench.machine.engine
    with model_engine(old.parameters, old.clock_hz) as other:
        bench.machine.engine = other
        bench.terminal.run(200_000)
        assert "error: CORE_RESET: " in bench.take() and not other.drain()["enable"].any()
        assert bench.ask("open") == "ok"
        assert bench.tell("status")["homed"] == "none"
        bench.machine.engine = old


def test_home_ends_with_its_host(bench: Bench) -> None:
    """The watchdog stops the axis on its path; it is not homed."""
    bench.machine.switches[0].stuck = False
    bench.terminal.type(f"{HOME} distance=-6000\n".encode())
    bench.machine.run(3 * CLOCK_HZ)
    assert -6000 < bench.machine.positions[0] < 0
    bench.terminal.run(200_000)
    assert "error: WATCHDOG: " in bench.take() and bench.tell("status")["homed"] == "none"
    assert bench.machine.enable & 1


def test_home_without_its_drive(bench: Bench) -> None:
    """As a move: a note, or refused."""
    bench.ask("disable")
    bench.terminal.line(f"{HOME} distance=-100")
    assert bench.take().startswith("note: axis 0 is not enabled\n")
    bench.ask("config need_enable=1")
    for line in (f"{HOME} distance=-100", JOG, PROBE):
        assert bench.ask(line).startswith("error: NOT_ENABLED: "), line


def test_probe_answers_with_the_touch(bench: Bench) -> None:
    """Positions at the edge; a probe that touches nothing; one that touches already."""
    said = bench.tell(PROBE)
    assert said["touched"] == "1" and said["position"] == "0,0,-300,0"
    assert bench.ask(PROBE).startswith("error: SWITCH_LEVEL: ")
    assert bench.tell(PROBE.replace("-1000", "1000") + " away=1")["touched"] == "1"
    assert bench.ask(PROBE.replace("-1000", "50")).startswith("error: SWITCH_MISSED: ")
    assert bench.tell(PROBE.replace("-1000", "50") + " optional=1")["touched"] == "0"


def test_jog_into_a_limit_and_back(bench: Bench) -> None:
    """status names the switch and the axis; clear, and it can be driven off."""
    assert bench.ask(JOG) == "ok"
    bench.ask("run 0.5")
    status = bench.tell("status")
    assert (status["state"], status["cause"], status["fault"]) == ("STOPPED", "LIMIT", "LIMIT")
    assert (status["inputs"], status["stopped_by"]) == ("limit_high:0", "0")
    assert bench.ask(JOG).startswith("error: STOPPED: ")
    bench.ask("clear")
    assert bench.ask(f"{JOG} steps=-600") == "ok"
    bench.ask("wait")
    inputs = bench.tell("inputs clear=1")
    assert (inputs["inputs"], inputs["were"], inputs["stopped_by"]) == ("none", "limit_high:0", "none")
    assert bench.tell("inputs")["were"] == "none"


def test_jog_changes_its_speed_and_ends_when_told(bench: Bench) -> None:
    """No clear after it; contradictions are refused."""
    assert bench.ask("jog axis=1 speed=1000 top_speed=4000 acceleration=100_000 backward=1") == "ok"
    bench.ask("run 0.1")
    assert bench.ask("jog_speed 3000") == "ok"
    bench.ask("run 0.2")
    assert bench.ask("jog_speed 5000").startswith("error: ABOVE_TOP: ")
    assert bench.ask("jog_cancel") == "ok"
    assert bench.ask("wait") == "ok"
    way = int(bench.tell("position")["position"].split(",")[1])
    assert way == pytest.approx(-1000 * 0.1 - 3000 * 0.2, rel=0.2)
    assert bench.tell("status")["state"] == "IDLE"
    assert bench.ask("jog_cancel") == "ok"
    assert bench.ask(f"{JOG} steps=0") == "error: steps must not be 0; omit it for an endless jog"
    assert bench.ask(f"{JOG} steps=5 backward=1") == "error: steps and backward are mutually exclusive"
    assert bench.ask(f"{JOG} steps=1.5") == "error: steps must be a whole number, not '1.5'"
    assert bench.ask(f"{JOG} steps=1073741824") == "error: steps must be at most 1073741823 in magnitude"


def test_wait_for_a_trigger(bench: Bench) -> None:
    """Answered at the edge, or after a time; nothing is armed after disarming."""
    assert bench.ask("wait_trigger").startswith("error: NO_SOURCE: ")
    assert bench.ask(TRIGGER) == "ok"
    assert bench.tell("trigger")["armed"] == "1"
    bench.ask("run 0.2")
    began = bench.engine.clock
    assert bench.ask("wait_trigger 50ms") == ("error: TIMEOUT: the trigger has not fired and stays armed")
    assert (bench.engine.clock - began) / CLOCK_HZ == pytest.approx(0.05, rel=0.1)
    assert bench.ask(f"{JOG} steps=-700") == "ok"
    assert bench.tell("wait_trigger")["position"] == "-500,0,0,0"
    assert bench.tell("status")["moving"] == "1"
    bench.ask("wait")
    assert axis_0(bench) == -700
    assert bench.tell("trigger")["fired"] == "1"
    assert bench.ask("trigger none") == "ok"
    assert bench.ask("trigger edge=falling") == "error: source is missing"
    assert bench.ask("trigger limit_low axis=0").startswith("error: NO_SWITCH: ")
    assert bench.ask("trigger home axis=0 edge=falling action=soft_stop") == "ok"
    bench.ask(f"{JOG} steps=1000")
    bench.terminal.line("wait_trigger")
    assert "position=-499,0,0,0" in bench.take()
    bench.ask("run 0.1")
    assert bench.tell("status")["fault"] == "TRIGGER"


def test_an_alarm_disables_its_own_drive(bench: Bench) -> None:
    """The other drives stay on; a motion of this one is noted."""
    assert bench.ask("input axis=1 alarm=active_high alarm_disables=1") == "ok"
    bench.ask("clear")
    bench.machine.set("alarm", 2)
    bench.ask("run 0.01")
    bench.machine.set("alarm", 0)
    bench.ask("run 0.01")
    assert bench.ask("clear") == "ok"
    said = []
    for axis in (0, 1, 2):
        bench.terminal.line(f"jog axis={axis} steps=-5 speed=4000 acceleration=100_000")
        said.append(bench.take())
        bench.ask("wait")
    assert said == ["ok\n", "note: axis 1 is not enabled\nok\n", "ok\n"]


def test_estop_and_the_way_back(bench: Bench) -> None:
    """A note with its sentence; clear refuses until it is released; the drives are off."""
    bench.ask(f"{HOME} distance=-3000")
    bench.ask(JOG)
    bench.ask("run 0.05")
    bench.machine.set("estop_n", 0)
    bench.terminal.line("run 0.01")
    assert bench.take() == (
        "note: ESTOP: e-stop: release it, clear it, clear the channel, enable the drives\nok\n"
    )
    status = bench.tell("status")
    assert (status["estop"], status["homed"], status["cause"]) == ("1", "none", "ESTOP")
    assert bench.ask("clear").startswith("error: ESTOP: ")
    bench.machine.set("estop_n", 1)
    assert bench.ask("clear") == "ok"
    assert bench.machine.enable == 0
    there = axis_0(bench)
    bench.ask("run 0.1")
    assert axis_0(bench) == there
    bench.terminal.line(f"{JOG} steps=-10")
    assert bench.take() == "note: axis 0 is not enabled\nok\n"


@pytest.mark.parametrize("pin", ["estop_n", "alarm"])
def test_a_pin_stuck_at_the_start(pin: str) -> None:
    """The console opens the core all the same, so that the level can be set, and its settings are applied."""
    bench = Bench(inputs=1)
    bench.machine.set(pin, 0 if pin == "estop_n" else 15)
    bench.machine.run(10_000)
    bench.terminal.close()
    bench.terminal.__init__(bench.machine, bench.said.append)  # type: ignore[misc]
    name = "ESTOP" if pin == "estop_n" else "ALARM"
    assert f"note: {name}: " in bench.take()
    assert bench.tell("version")["channels"] == "1"
    assert bench.ask("clear").startswith(f"error: {name}: ")
    bench.machine.set("estop_n", 1)
    for axis in range(4):
        assert bench.ask(f"input axis={axis} alarm={'active_low' if pin == 'alarm' else 'none'}") == "ok"
    bench.ask("run 0.001")
    assert bench.ask("clear") == "ok"
    assert bench.ask(f"{JOG} steps=10") == "ok"  # its pins are configured
    bench.ask("wait")
    assert axis_0(bench) == 10
    if pin == "alarm":
        bench.ask("open")  # the settings are kept
        assert bench.tell("status")["state"] == "IDLE"


def test_the_watchdog_is_fed_and_can_be_set(bench: Bench) -> None:
    """A console that polls is never stopped; one that does not is, and its drives too if so set."""
    assert bench.tell("config")["watchdog"] == "500000us"
    assert bench.ask("config watchdog=50ms watchdog_disable=20ms input_filter=5us") == "ok"
    config = bench.tell("config")
    assert (config["watchdog"], config["watchdog_disable"], config["input_filter"]) == (
        "50000us",
        "20000us",
        "5us",
    )
    for line in ("config watchdog=100s", "config watchdog_disable=100s"):
        assert bench.ask(line).startswith("error: WATCHDOG_TOO_LONG: ")
    assert bench.ask("config input_filter=1s").startswith("error: FILTER_TOO_LONG: ")
    assert bench.tell("config") == config
    bench.ask("jog axis=1 speed=1000 acceleration=100_000")
    bench.ask("run 1")
    assert bench.tell("status")["state"] == "RUN"
    bench.machine.run(CLOCK_HZ // 2)
    bench.terminal.line("run 0.01")
    assert bench.take().startswith("note: WATCHDOG: ")
    assert bench.machine.enable == 0
    assert bench.ask("clear") == "ok"
    bench.terminal.line("jog axis=1 steps=5 speed=1000 acceleration=100_000")
    assert bench.take().startswith("note: axis 1 is not enabled\n")
    bench.ask("wait")
    assert bench.ask("config watchdog=0").startswith("error: ARGUMENT")
    assert bench.ask("config watchdog=0 watchdog_disable=0") == "ok"


def test_the_watchdog_of_a_fast_clock() -> None:
    """Half a second, or what the core can count."""
    bench = Bench(inputs=1)
    assert bench.ask("config clock_hz=1_000_000_000") == "ok"
    assert bench.tell("config")["watchdog"] == "67043us"


def test_a_home_with_a_wire_that_fails(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its line is answered with the error of the link, and the console continues."""
    transfer = bench.machine.transfer
    bench.terminal.type(f"{HOME} distance=-3000\n".encode())
    monkeypatch.setattr(bench.machine, "transfer", lambda words, _: [0] * len(words))
    for _ in range(40):
        bench.terminal._poll()
        bench.terminal._advance(None, 1000)
    assert bench.take().count("error: STUCK_LOW: ") == 1
    monkeypatch.setattr(bench.machine, "transfer", transfer)
    bench.ask("run 0.1")
    bench.ask("stop")
    bench.ask("run 0.1")
    assert bench.ask("clear") == "ok"


def test_two_channels_home_each() -> None:
    """The line names the channel, and its switch is that of the channel."""
    bench = Bench(inputs=1, channels=2, axes=2, switches=(Switch("home", 3, -200),))
    bench.ask("config stop_time=5ms")
    assert bench.ask("input axis=1 home=active_high channel=1") == "ok"
    line = HOME.replace("axis=0", "axis=1") + " distance=-900"
    assert bench.ask(line).startswith("error: NO_SWITCH: ")
    assert bench.ask(f"{line} channel=1") == "ok"
    assert bench.tell("status channel=1")["homed"] == "1" and bench.tell("status")["homed"] == "none"
    bench.machine.set("estop_n", 0)
    bench.terminal.line("run 0.01")
    said = bench.take()
    assert "channel 0: ESTOP" in said and "channel 1: ESTOP" in said
    bench.machine.set("estop_n", 1)
    bench.ask("run 0.01")
    assert bench.ask("clear") == "ok" and bench.ask("clear channel=1") == "ok"


def test_the_session_in_the_documentation_is_real() -> None:
    """What docs/console.md shows of the inputs, with the options that it shows."""
    page = (paths.docs / "console.md").read_text(encoding="utf-8")
    part = page.partition("## Inputs, home, probe, jog")[2]
    command = re.search(r"```sh\npasso console (.*?)\n```", part)[1]
    shown = re.search(r"```text\n(.*?)```", part, re.S)[1]
    typed = "".join(f"{line}\n" for line in re.findall(r"^> (.*)$", shown, re.M))
    assert typed.count("\n") > 12
    assert passo_console(typed, *command.split()).partition("\n")[2] == shown


def test_what_the_console_of_the_pc_refuses() -> None:
    """Switches that cannot be, with what is wrong; pins that do not exist."""
    for options, problem in (
        (["--switch", "home:0:..5"], "--switch needs --inputs"),
        (["--inputs", "--switch", "home:4:..5"], "the core has no such axis"),
        (["--inputs", "--switch", "home:0:5"], "a switch is PIN:AXIS:..POSITION"),
    ):
        words = [sys.executable, "-m", "passo.cli", "console", *options]
        done = subprocess.run(words, input="", capture_output=True, text=True)
        assert done.returncode != 0 and problem in done.stderr, done
    bench = Bench(inputs=1)
    for line in ("pin", "pin estop_n", "pin step 1", "pin home -1"):
        assert bench.ask(line).startswith("error: pin needs a name and levels, ")
    assert bench.ask("pin home 4") == "ok"
    bench.ask("run 0.001")
    assert bench.tell("inputs")["inputs"] == "home:2"
