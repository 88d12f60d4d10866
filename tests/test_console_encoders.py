# SPDX-License-Identifier: MIT
"""The console on a core with encoders: settings, readings, following error and recovery, threads."""

import subprocess
import sys
from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pytest
from passo.build import Parameters
from passo.engine import rtl_engine
from passo.shafts import Shaft

from tests.test_console import CLOCK_HZ, Bench, passo_console

MOVE = "move steps=500,-90 profile=linear speed=20_000 acceleration=400_000"
ENCODER = "encoder axis=0 counts_per_step=4 limit=20"
PER_TURN = 400
RPM = 600
THREAD = f"thread encoder=2 counts_per_turn={PER_TURN} steps=1000,-333 turns=5 top_rpm=700"
LONGEST = "thread encoder=2 counts_per_turn=65535 steps=1000,-333 turns=65537 top_rpm=70"
FOLLOWING = "note: FOLLOWING: stopped: following error over its limit, or thread lost the spindle phase\n"


@pytest.fixture
def bench() -> Iterator[Bench]:
    """Axis 0 has an encoder, axis 1 none, axis 2 that of a spindle."""
    shafts = (
        Shaft(0, counts_per_step=Fraction(4)),
        Shaft(2, rpm=Fraction(RPM), counts_per_turn=PER_TURN),
    )
    made = Bench(encoders=1, shafts=shafts)
    made.ask("enable")
    assert made.ask("config stop_time=1ms") == "ok"
    yield made
    made.close()


def axis_0(bench: Bench) -> int:
    return int(bench.tell("position")["position"].split(",")[0])


def of_axis(bench: Bench, name: str, axis: int = 0) -> str:
    return bench.tell("encoders")[name].split(",")[axis]


def steps(bench: Bench, axis: int) -> list[int]:
    """Clocks of the steps of an axis."""
    events = bench.terminal.pulses()
    level = (events["step"] >> np.uint64(axis) & np.uint64(1)).astype(int)
    return events["clock"][np.diff(level, prepend=0) > 0].astype(int).tolist()


def test_a_core_without_encoders_says_so() -> None:
    """Each line."""
    bench = Bench()
    for line in (ENCODER, "encoder filter=5", "encoders", "adopt 0", THREAD):
        assert bench.ask(line).startswith("error: NO_ENCODERS: "), line


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("encoder filter=256", "ENCODER_FILTER: "),
        ("encoder filter=4294967296", "filter must be 0 to 4294967295"),
        ("encoder filter=-1", "filter must be 0 to "),
        ("encoder axis=0 filter=1", "axis and filter are mutually exclusive"),
        ("encoder counts_per_step=1", "axis is missing"),
        ("encoder axis=4 counts_per_step=1", "axis must be 0 to 3"),
        ("encoder axis=0 counts_per_step=0", "RATIO: "),
        ("encoder axis=0 counts_per_step=0.000007", "RATIO: "),
        ("encoder axis=0 limit=5", "RATIO: "),
        ("encoder axis=0 counts_per_step=-4", "counts_per_step must not be negative"),
        ("encoder axis=0 counts_per_step=65536", "counts_per_step must be below 65536"),
        ("encoder axis=0 counts_per_step=4 limit=0", "FOLLOWING_LIMIT: "),
        ("encoder axis=0 counts_per_step=4 limit=0.1", "FOLLOWING_LIMIT: "),
        ("encoder axis=0 counts_per_step=4 limit=16384", "limit must be at most 65535 counts"),
        ("encoder axis=0 counts_per_step=4 limit=4294967295", "limit must be at most 65535 counts"),
        ("encoder axis=0 counts_per_step=4 stop=hard", "stop needs limit"),
        (
            "encoder axis=0 counts_per_step=4 limit=5 stop=now",
            "stop must be one of none|soft|hard, not 'now'",
        ),
        ("adopt", "axis is missing"),
        ("adopt 4", "axis must be 0 to 3"),
        ("adopt 1", "RATIO: "),
        (THREAD.replace("1000,-333", "0,0"), "NO_STEPS: "),
        (THREAD.replace("1000", "1073741824"), "axis 0 has too many steps"),
        (THREAD.replace("turns=5", "turns=0"), "NO_COUNTS: "),
        (THREAD.replace("turns=5", "turns=0.01"), "STEEP: "),
        (THREAD.replace("turns=5", "turns=4e9"), "turns must be at most 4294967295 counts"),
        (LONGEST.replace("65535", "65536"), "turns must be at most 4294967295 counts"),
        (THREAD.replace("top_rpm=700", "top_rpm=0"), "FOLLOW_SPEED: "),
        (THREAD.replace("top_rpm=700", "top_rpm=4e9"), "FOLLOW_SPEED: "),
        (THREAD.replace("top_rpm=700", "top_rpm=2e5"), "PINS_TOO_SLOW: "),
        (THREAD.replace("=400", "=0"), "counts_per_turn must be 1 to "),
        (THREAD.replace("encoder=2", "encoder=4"), "encoder must be 0 to 3"),
        (THREAD.replace(" turns=5", ""), "turns is missing"),
        (THREAD.replace("encoder=2", ""), "encoder is missing"),
    ],
)
def test_what_is_refused(bench: Bench, line: str, problem: str) -> None:
    """Each has its error, and nothing has changed."""
    before = [bench.ask("encoder"), bench.ask("encoder axis=0")]
    assert before[0] == "ok filter=3"
    assert bench.ask(line).startswith(f"error: {problem}"), bench.ask(line)
    assert [bench.ask("encoder"), bench.ask("encoder axis=0")] == before
    assert bench.tell("status")["moving"] == "0"


def test_settings_and_threads_need_rest(bench: Bench) -> None:
    """While it moves, encoders can be read; the filter can be set."""
    assert bench.ask(ENCODER) == "ok"
    bench.ask(MOVE)
    for line in (ENCODER, "adopt 0", THREAD):
        assert bench.ask(line).startswith("error: MOVING: "), line
    assert bench.ask("encoder filter=9") == "ok"
    assert bench.ask("encoder") == "ok filter=9"
    assert "counts" in bench.tell("encoders")


def test_what_encoder_shows_can_be_typed(bench: Bench) -> None:
    """Only what is given changes; `open` keeps it."""
    assert bench.ask("encoder axis=0") == (
        "ok axis=0 counts_per_step=0.000 inverted=0 index_inverted=0 index_gated=0"
    )
    assert bench.ask("encoder axis=0 counts_per_step=2.5 index_gated=1") == "ok"
    assert bench.ask("encoder axis=0 limit=8.4") == "ok"
    shown = bench.ask("encoder axis=0")
    assert shown == (
        "ok axis=0 counts_per_step=2.500 limit=8.400 stop=soft inverted=0 index_inverted=0 index_gated=1"
    )
    assert bench.ask(shown.replace("ok", "encoder")) == "ok" and bench.ask("encoder axis=0") == shown
    assert bench.ask("encoder filter=20") == bench.ask("open") == "ok"
    assert bench.ask("encoder axis=0") == shown and bench.ask("encoder") == "ok filter=20"


def test_an_axis_that_follows(bench: Bench) -> None:
    """Counts, speed and following error of each axis."""
    assert bench.ask(ENCODER) == "ok"
    first = bench.tell("encoders")
    assert "speed" not in first and first["counts"].startswith("0,0,")
    bench.ask(MOVE)
    bench.ask("run 0.03")
    said = bench.tell("encoders")
    assert float(said["speed"].split(",")[2]) == pytest.approx(RPM * PER_TURN / 60, rel=0.05)
    bench.ask("wait")
    bench.ask("run 0.001")
    said = bench.tell("encoders")
    assert said["counts"].startswith("2000,0,") and said["error"].startswith("0.000,-90.000,")
    assert 2 <= int(said["greatest"].split(",")[0]) < 80
    assert (said["exceeded"], said["illegal"]) == ("none", "0,0,0,0")
    counts, indexes, latch = (int(said[name].split(",")[2]) for name in ("counts", "indexes", "latch"))
    assert (indexes, latch) == (counts // PER_TURN, counts // PER_TURN * PER_TURN)
    assert bench.ask("zero") == "ok"
    assert of_axis(bench, "counts") == "0"


def test_an_inverted_encoder_counts_down(bench: Bench) -> None:
    """Its axis is stopped within the limit."""
    assert bench.ask(f"{ENCODER} stop=hard inverted=1") == "ok"
    bench.ask(MOVE)
    bench.terminal.line("wait")
    assert bench.take() == FOLLOWING + "ok\n"
    assert int(of_axis(bench, "counts")) < 0 and len(steps(bench, 0)) == pytest.approx(10, abs=2)


@pytest.mark.parametrize("stop", ["soft", "hard"])
def test_a_slip_and_the_way_back(bench: Bench, stop: str) -> None:
    """FOLLOWING; clear alone moves nothing; adopt makes the position that of the shaft, and moves nothing."""
    assert bench.ask(f"{ENCODER} stop={stop}") == "ok"
    bench.ask(MOVE)
    bench.ask("run 0.01")
    assert bench.ask("slip 0 -60") == "ok"
    bench.ask("run 0.001")
    assert bench.tell("status")["state"] == "RUN"
    assert bench.ask("slip 0 -27") == "ok"
    bench.terminal.line("wait")
    assert bench.take() == FOLLOWING + "ok\n"
    bench.ask("run 0.01")
    status = bench.tell("status")
    assert (status["cause"], status["fault"]) == ("FOLLOWING_ERROR", "FOLLOWING")
    made = len(steps(bench, 0))
    said = bench.tell("encoders")
    assert (said["exceeded"], said["error"].split(",")[0]) == ("0", "87.000")
    assert axis_0(bench) == made
    assert bench.ask(MOVE).startswith("error: STOPPED: ")
    assert bench.ask("clear") == "ok"
    bench.ask(MOVE)
    bench.terminal.line("wait")
    assert bench.take() == FOLLOWING + "ok\n"
    assert len(steps(bench, 0)) == made
    assert bench.ask("adopt 0") == bench.ask("clear") == "ok"
    bench.ask("run 0.01")
    assert len(steps(bench, 0)) == made
    assert axis_0(bench) == pytest.approx(made - 87 / 4, abs=0.5)
    said = bench.tell("encoders")
    assert (said["exceeded"], said["error"].split(",")[0]) == ("none", "0.000")
    assert bench.ask(MOVE) == bench.ask("wait") == "ok"
    assert len(steps(bench, 0)) == made + 500


def test_an_encoder_that_is_not_connected(bench: Bench) -> None:
    """The shaft is stationary: the axis is stopped after the steps of the limit, and reported by name."""
    assert bench.ask("encoder axis=1 counts_per_step=4 limit=20 stop=hard") == "ok"
    bench.ask(MOVE)
    bench.terminal.line("wait")
    assert bench.take() == FOLLOWING + "ok\n"
    assert bench.tell("encoders")["exceeded"] == "1"
    assert len(steps(bench, 1)) == pytest.approx(20, abs=1)


def test_a_limit_that_only_shows(bench: Bench) -> None:
    """stop=none: the motion continues."""
    assert bench.ask("encoder axis=1 counts_per_step=4 limit=20 stop=none") == "ok"
    assert bench.ask(MOVE) == bench.ask("wait") == "ok"
    assert bench.tell("encoders")["exceeded"] == "1"
    assert bench.tell("position")["position"] == "500,-90,0,0"


def test_an_error_off_its_scale(bench: Bench) -> None:
    """It cannot tell where the axis is."""
    assert bench.ask("encoder axis=1 counts_per_step=65535") == "ok"
    assert bench.ask(MOVE) == bench.ask("wait") == "ok"
    assert bench.ask("adopt 1").startswith("error: OFF_SCALE: ")


def test_threads_have_their_pitch_and_phase(bench: Bench) -> None:
    """A pass is exact, and begins at the index: each pass with the same phase."""
    clocks_per_count = CLOCK_HZ * 60 / (RPM * PER_TURN)
    phases = []
    for turn in range(2):
        assert bench.ask(THREAD) == "ok"
        assert bench.tell("status")["moving"] == "1"
        assert bench.ask("wait") == "ok"
        made = steps(bench, 0)[1000 * turn :]
        assert len(made) == 1000
        pitch = 5 * PER_TURN / 1000
        late = [clock / clocks_per_count - k * pitch for k, clock in enumerate(made)]
        assert max(late) - min(late) < 1.1
        phases.append(made[0] / clocks_per_count % PER_TURN)
        said = bench.tell("encoders")
        assert (said["behind"], said["lost"]) == ("0", "0")
        bench.ask(f"run 0.0{turn + 1}3")
    assert phases[0] == pytest.approx(phases[1], abs=1)
    assert bench.tell("position")["position"] == "2000,-666,0,0"
    assert bench.ask(MOVE) == bench.ask("wait") == "ok"  # with the clock of the core
    assert axis_0(bench) == 2500


def test_an_electronic_gear(bench: Bench) -> None:
    """Without end, until it is stopped."""
    assert bench.ask(f"{THREAD} endless=1 wait_index=0") == "ok"
    bench.ask("run 1")
    assert axis_0(bench) == pytest.approx(RPM / 60 * 200, rel=0.02)
    assert bench.ask("stop") == "ok"
    bench.ask("run 0.1")
    assert bench.ask("clear") == "ok"
    assert axis_0(bench) == len(steps(bench, 0))


def test_the_longest_thread(bench: Bench) -> None:
    """2^32 - 1 counts are taken."""
    assert bench.ask(LONGEST) == "ok"
    assert bench.ask("abort") == "ok"


def test_a_thread_without_its_drives(bench: Bench) -> None:
    """As a move: a note, or refused."""
    bench.ask("disable 1")
    bench.terminal.line(THREAD)
    assert bench.take() == "note: axis 1 is not enabled\nok\n"
    bench.ask("wait")
    bench.ask("config need_enable=1")
    assert bench.ask(THREAD).startswith("error: NOT_ENABLED: ")


def test_a_spindle_by_hand() -> None:
    """The pins of an encoder that is not simulated can be set."""
    bench = Bench(encoders=1)
    for a, b in ((2, 0), (2, 2), (0, 2)):
        assert bench.ask(f"pin encoder_a {a}") == bench.ask(f"pin encoder_b {b}") == "ok"
        bench.ask("run 0.0001")
    assert bench.tell("encoders")["counts"] == "0,3,0,0"
    assert bench.ask("slip 0 5") == "error: axis 0 has no --encoder"


def test_what_slip_refuses(bench: Bench) -> None:
    """It is for encoders that follow an axis."""
    for line in ("slip", "slip 0", "slip 0 x", "slip -1 5", "slip 0 5 5"):
        assert bench.ask(line) == "error: slip needs an axis and counts, such as slip 0 -40", line
    for axis in (1, 2, 9):
        assert bench.ask(f"slip {axis} 5") == f"error: axis {axis} has no --encoder"


def test_each_channel_has_its_encoders() -> None:
    """The line names it; the axes of the options are counted through all channels."""
    bench = Bench(encoders=1, channels=2, axes=2, shafts=(Shaft(3, counts_per_step=Fraction(2)),))
    assert bench.ask("encoder axis=1 counts_per_step=2 limit=5 stop=hard channel=1") == "ok"
    assert bench.ask("encoder axis=1").startswith("ok axis=1 counts_per_step=0.000 ")
    assert bench.ask("move steps=0,70 profile=linear speed=900 acceleration=9000 channel=1") == "ok"
    assert bench.ask("wait") == "ok"
    assert bench.tell("encoders channel=1")["counts"] == "0,140"
    assert bench.tell("encoders")["counts"] == "0,0"


def test_the_command_has_a_core_with_encoders() -> None:
    """--encoders, --encoder, --spindle, on the model and on both engines."""
    typed = f"enable\n{ENCODER}\n{MOVE}\nwait\nslip 0 -4\n{THREAD}\nwait\nencoders\n"
    rtl_engine(Parameters(encoders=1)).close()  # is built before
    options = ["--encoders", "--encoder", "0:4", "--spindle", f"2:{RPM}:{PER_TURN}", "--clock", "4000000"]
    said = [passo_console(typed, "--engine", engine, *options) for engine in ("model", "both")]
    assert said[0] == said[1]
    assert "\nok counts=5996,0," in said[0] and " lost=0\n" in said[0]


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (["--encoder", "0:4"], "--encoder needs --encoders"),
        (["--spindle", "0:60:400"], "--spindle needs --encoders"),
        (["--encoders", "--encoder", "4:4"], "--encoder: the core has no such axis"),
        (["--encoders", "--encoder", "0:0"], "an encoder is AXIS:COUNTS_PER_STEP, above 0"),
        (["--encoders", "--encoder", "0:x"], "an encoder is AXIS:COUNTS_PER_STEP, above 0"),
        (["--encoders", "--spindle", "0:60"], "a spindle is AXIS:RPM:COUNTS_PER_TURN"),
        (["--encoders", "--spindle", "0:60:3"], "with 4 to 65535 counts"),
        (["--encoders", "--spindle", "0:0:400"], "a spindle is AXIS:RPM:COUNTS_PER_TURN"),
        (["--encoders", "--spindle", "0:60000:65535"], "one count every 1.53 clocks; must be at least 8"),
        (["--encoders", "--encoder", "0:4", "--spindle", "0:60:400"], "an axis has one encoder"),
    ],
)
def test_what_the_command_refuses(options: list[str], problem: str) -> None:
    """Machines that cannot be, with what is wrong."""
    words = [sys.executable, "-m", "passo.cli", "console", *options]
    done = subprocess.run(words, input="", capture_output=True, text=True)
    assert done.returncode == 2 and problem in done.stderr, done
