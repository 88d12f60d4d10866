# SPDX-License-Identifier: MIT
"""Motions from their first clock to their last."""
from cocotb_tests.core_bench import ONE, V_MAX, Core, Line, PinTiming, Ramp, Shape, core_test


@core_test
def running_is_high_for_the_length_of_the_profile(core: Core) -> None:
    """`running` is high for just the ticks of the ramps."""
    channel = core.channel()
    channel.pins(PinTiming())
    core.watch(PinTiming())
    channel.lines(Line(200, (200, -100, 1), last=True))
    channel.ramps(Ramp(ONE // 8, 13), Ramp(0, 13, last=True))
    channel.start()
    core.wait_end()
    print(core.motions(), core.steps(0)[:10], core.checker.positions, channel.state())
