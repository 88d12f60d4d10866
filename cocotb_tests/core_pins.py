# SPDX-License-Identifier: MIT
"""What a motion looks like at its pins: timings, polarities, edges, the fastest steps."""

from passo import registers as r
from passo.cocotb.clocks import read

from cocotb_tests.helpers.core_bench import ONE, V_MAX, Core, Line, PinTiming, Ramp, Shape, core_test
from cocotb_tests.helpers.core_expected import distance, totals
from cocotb_tests.helpers.core_moves import check_clocks, make


@core_test
def every_axis_steps_every_second_clock(core: Core) -> None:
    """N = M at velocity 1/2 with step_high = step_low = 1: none of thousands of steps is lost or late."""
    channel = core.channel()
    channel.pins(PinTiming())
    checker = core.watch(PinTiming())
    ramps = [Ramp(V_MAX, 0), Ramp(V_MAX, 20), Ramp(0, 0, last=True)]
    count = 10 * core.tick
    begin = make(core, channel, [Line(count, (count, -count, count)[: core.axes], last=True)], ramps)
    check_clocks(core, begin, [[2 * k for k in range(1, count + 1)]] * core.axes)
    assert checker.positions[: core.axes] == [count, -count, count][: core.axes]


@core_test
def reversals_keep_all_pin_timings(core: Core) -> None:
    """Steps that have to wait for DIR are made later, in order, each with its own direction."""
    channel = core.channel()
    timings = [PinTiming(3, 4, 7, 5), PinTiming(1, 9, 2, 11), PinTiming(10, 1, 20, 1)][: core.axes]
    channel.pins(*timings)
    checker = core.watch(*timings)
    ramps = [Ramp(ONE // 14, 4, Shape.COSINE), Ramp(ONE // 14, 12), Ramp(0, 4, Shape.COSINE, last=True)]
    total = distance(ramps, core.tick)
    count = 12
    lines = [
        Line(total // count, (total // count * (-1) ** i, -5 * (-1) ** (i // 2), 3 * (-1) ** i)[: core.axes])
        for i in range(count - 1)
    ]
    lines.append(Line(total - (count - 1) * (total // count), (-2, 1, 0)[: core.axes], last=True))
    make(core, channel, lines, ramps)
    assert checker.positions == totals(lines)
    for axis in range(core.axes):
        ups = sum(max(0, line.steps[axis]) for line in lines)
        assert sum(direction > 0 for _, direction in checker.steps(axis)) == ups
    assert checker.turns(0) == count - 1


@core_test
def both_edges_and_polarities(core: Core) -> None:
    """Every edge is a step, and every pin can be active low."""
    channel = core.channel()
    timings = [
        PinTiming(2, 5, 3, 4, both_edges=True),
        PinTiming(3, 2, 4, 3, step_inverted=True, direction_inverted=True),
        PinTiming(4, 3, 2, 5, both_edges=True, step_inverted=True),
    ]
    ramps = [Ramp(ONE // 11, 3, Shape.COSINE), Ramp(ONE // 11, 7), Ramp(0, 2, last=True)]
    total = distance(ramps, core.tick)
    # of even numbers, so that STEP is inactive in the end
    first, rest = total // 4 * 2, total - total // 4 * 2
    lines = [
        Line(first, (first, -(first // 4 * 2), first - 2)[: core.axes]),
        Line(rest, (-12, 12, -(rest // 2 * 2))[: core.axes], last=True),
    ]
    for _ in range(core.axes):
        timings = [*timings[1:], timings[0]]
        core.finish_watch()
        channel.pins(*timings[: core.axes])
        checker = core.watch(*timings[: core.axes])
        make(core, channel, lines, ramps)
        assert checker.positions == totals(lines)


@core_test
def pins_follow_their_registers(core: Core) -> None:
    """EN is what ENABLE says, and each pin of each axis has its own polarity."""
    channel = core.channel()
    channel.pins(PinTiming())
    for axis in range(core.axes):
        core.link.write(channel.axis_base(axis) + r.AXIS_ENABLE, 0)
    for axis in range(core.axes):
        address = channel.axis_base(axis)
        table = (
            (0, 1, 4),
            (0, 0, 0),
            (8, 0, 4),
            (8, 1, 0),
            (8, 0, 4),
            (2, 0, 1),
            (4, 0, 2),
            (0xE, 0, 7),
            (0, 0, 0),
        )
        for flags, enable, pins in table:
            core.link.write(address, flags)
            core.link.write(address + r.AXIS_ENABLE, enable)
            core.run(4)
            levels = [read(signal) for signal in (core.dut.step, core.dut.dir, core.dut.enable)]
            assert levels == [(pins >> bit & 1) << axis for bit in range(3)]
