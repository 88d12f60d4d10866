# SPDX-License-Identifier: MIT
"""Axes without lines, which only their trackers move. The model agrees on every clock."""

import itertools

from passo import registers as r
from passo.registers import Operation, State, Verdict

from cocotb_tests.core_trackers import STEP, begin
from cocotb_tests.helpers.bench import rng
from cocotb_tests.helpers.core_bench import ONE, Core, Line, PinTiming, Ramp, core_test
from cocotb_tests.helpers.core_frames import ack, request


@core_test
def lines_have_no_word_for_them(core: Core) -> None:
    """A line is control word, substeps, the steps of the axes with lines, output word."""
    channel = core.channel()
    lined = core.parameters.lined
    assert 0 < lined < core.axes
    push = channel.base + r.CHANNEL_LINE
    words = [1, 9, *(9 for _ in range(lined)), 0]
    raster = 1 << r.LINE_OUTPUT_RASTER_LSB
    cases = [
        (Verdict.BAD_VALUE, [1 | 1 << 8 + lined, *words[1:]]),  # it would go down
        (Verdict.BAD_VALUE, [*words[:-2], 10, 0]),  # more steps than substeps
        (Verdict.BAD_VALUE, [*words[:-1], raster | 1]),  # the output word follows the steps
        (Verdict.BAD_VALUE, [*words, 4, *words[1:]]),  # the next line follows it
        (Verdict.BAD_LENGTH, words[:-1]),
        (Verdict.BAD_LENGTH, [*words, 0]),
        (Verdict.OK, [*words, *words]),
    ]
    room = channel.room()[0]
    for sequence, (verdict, sent) in enumerate(cases):
        miso = core.transfer(request(Operation.PUSH, 20 + sequence, len(sent), push, sent), 8)
        assert ack(miso)[1] == verdict, f"{sent}"
    assert channel.room()[0] == room - 2
    channel.abort()
    core.run_until(lambda: channel.state().state == State.STOPPED, 4000)
    channel.clear()


@core_test
def only_trackers_move_them(core: Core) -> None:
    """Beside a path each makes its own steps, which the path neither delays nor turns."""
    timing = PinTiming(high=6, low=6, setup=9, hold=5)
    trackers, random = begin(core, timing), rng("only_trackers_move_them")
    channel, lined = trackers.channel, core.parameters.lined
    for axis in range(core.axes):
        trackers.limit(axis, STEP // 2, STEP // 50)
    trackers.go(*(0 for _ in range(core.axes)))
    trackers.enable()
    path, targets = [0] * core.axes, [0] * core.axes
    for _ in range(4):
        substeps = random.randint(500, 2000)
        steps = [random.choice([substeps, -substeps, substeps // 3]) for _ in range(lined)]
        ticks = substeps * random.choice([30, 60]) // core.tick + 1
        velocity = substeps * ONE // (ticks * core.tick)
        channel.lines(Line(substeps, tuple(steps), last=True))
        channel.ramps(Ramp(velocity, 0), Ramp(velocity, ticks, last=True))
        channel.start()
        core.run_until(lambda: bool(core.is_running()), 4000)
        while core.is_running():
            axis = random.randrange(lined, core.axes)
            targets[axis] = random.randint(-200, 200)
            trackers.go(*targets)
            core.run(int(2 ** random.uniform(6, 12)))
        core.run_until(lambda: channel.state().state == State.IDLE, 400_000)
        trackers.wait()
        path = [was + step for was, step in zip(path, [*steps, *[0] * core.axes], strict=False)]
        assert trackers.positions() == targets
        assert channel.positions() == [a + b for a, b in zip(path, targets, strict=True)]
    assert core.checker is not None
    assert core.checker.positions == channel.positions()


@core_test
def what_it_does_alone_it_does_beside_a_path(core: Core) -> None:
    """The clocks between its steps are the same with a path and without one."""
    trackers = begin(core, PinTiming(high=4, low=4))
    channel, axis = trackers.channel, core.axes - 1
    lined = core.parameters.lined
    trackers.limit(axis, STEP // 3, STEP // 50)
    zeros = [0] * (core.axes - 1)
    gaps = []
    for beside, target in ((False, 150), (True, 300)):
        channel.rest()
        if beside:
            channel.lines(Line(4000, tuple(4000 for _ in range(lined)), last=True))
            velocity = ONE // 40
            ticks = 4000 * 40 // core.tick + 1
            channel.ramps(Ramp(velocity, 0), Ramp(velocity, ticks, last=True))
            channel.start()
            core.run_until(lambda: bool(core.is_running()), 4000)
        since = core.clock
        trackers.go(*zeros, target)
        trackers.enable(1 << axis)
        core.run(400)
        trackers.wait()
        made = core.steps(axis, since)
        gaps.append([b - a for a, b in itertools.pairwise(made)])
    assert len(gaps[0]) == 149
    assert gaps[0] == gaps[1]
