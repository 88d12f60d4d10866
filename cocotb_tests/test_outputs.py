# SPDX-License-Identifier: MIT
"""passo_outputs: every clock as the C model, and what must hold by closed forms that know neither."""

from fractions import Fraction

import cocotb
import pytest
from cocotb.handle import HierarchyObject

from cocotb_tests.helpers.bench import patience, rng
from cocotb_tests.helpers.outputs import HALF, PERIOD, PIN, RATE_ONE, Outputs, word
from cocotb_tests.helpers.runner import run

AXES = 3
QUEUE_FULL = 7
BUSY = 8
FULL = 65535
SPEEDS = ((100, 100), (100, 5), (5, 100), (50, 50), (37, 81), (140, 100), (140, 60))  # % of velocity and rate


@pytest.mark.sample(1)
def test_outputs(simulator: str) -> None:
    run(__name__, "passo_outputs", {"AXES": AXES, "RASTER": 1, "COMPARE": 1}, simulator)


def duty(power: int) -> Fraction:
    """Share of the clocks."""
    return Fraction(power + (power >> 15), 65536)


@cocotb.test()
@cocotb.parametrize(power=[0, 1, 300, 32767, 32768, 50000, 65534, FULL])
async def a_power_is_its_share_of_the_clocks(dut: HierarchyObject, power: int) -> None:
    """From the clock of the STEP pin on, to the clock; 0 never, 65535 always; one pulse per period."""
    outputs = await Outputs.begin(dut)
    for step in (PERIOD // 64, PERIOD // 100 + 1, PERIOD // 1000, PERIOD // 2, PERIOD // 3):
        outputs.set(pwm_step=step)
        at = await outputs.motion(word(0, power))
        clocks = patience(3000, 600)
        await outputs.run(clocks + PIN)
        assert 1 not in outputs.seen.power[at - 3 : at]
        seen = outputs.seen.power[at : at + clocks]
        periods = -(-clocks * step // PERIOD)
        on = Fraction(power + (power >> 15), 65536) * PERIOD / step  # clocks per period
        assert abs(sum(seen) - on * clocks * step / PERIOD) <= on + 1
        assert power == 0 or seen[0] == 1
        assert power != FULL or sum(seen) == clocks
        assert power != 0 or sum(seen) == 0
        assert sum(a < b for a, b in zip([0, *seen], seen, strict=False)) <= periods
        await outputs.rest()


@cocotb.test()
async def long_pulses_are_exact_and_short_ones_on_the_average(dut: HierarchyObject) -> None:
    """The part of a clock that a pulse cannot have is not lost."""
    outputs = await Outputs.begin(dut, pwm_step=PERIOD // 32)
    for power in (100, 1000, 2048 * 3 + 511, 30001):
        at = await outputs.motion(word(0, power))
        await outputs.run(PIN + 32 * patience(400, 100))
        for periods in (25, 100):
            on = sum(outputs.seen.power[at : at + 32 * periods])
            assert 0 <= on - duty(power) * 32 * periods < 1
        await outputs.rest()


@cocotb.test()
async def changes_of_duty_and_period_make_no_glitch(dut: HierarchyObject) -> None:
    """Changes of period, velocity, power and mode: a pulse begins with a period or a change of power."""
    random = rng("outputs, glitches")
    outputs = await Outputs.begin(dut)
    power, mode = 20000, True
    restarts = {await outputs.motion(word(0, power, proportional=mode))}
    steps: list[int] = [outputs.inputs["pwm_step"]] * len(outputs.seen)
    for _ in range(patience(20000, 10000)):
        if random.random() < 0.003:
            outputs.set(pwm_step=random.randrange(1, (PERIOD >> random.randrange(1, 12)) + 1))
        if random.random() < 0.003:
            outputs.set(velocity=random.randrange(1, HALF))
        await outputs.clock(line_begins=int(change := random.random() < 0.002))
        if change:
            wanted = random.choice((power, 0, FULL, random.randrange(65536))), random.random() < 0.5
            await outputs.clock()
            outputs.set(word=word(0, wanted[0], proportional=wanted[1]))
            at = await outputs.substep()
            if wanted != (power, mode):
                restarts.add(at)
            power, mode = wanted
        steps += [outputs.inputs["pwm_step"]] * (len(outputs.seen) - len(steps))
    # where periods begin: the sum of the steps from the last change of power on passes a whole number
    pulses = phase = 0
    for clock in range(1, len(outputs.seen)):
        phase += steps[clock - 1]
        begins = phase >= PERIOD
        phase %= PERIOD
        if clock in restarts:
            begins, phase = True, 0
        if outputs.seen.power[clock] > outputs.seen.power[clock - 1]:
            pulses += 1
            assert begins, clock
    assert pulses > 20


@cocotb.test()
@cocotb.parametrize(lag=[0, 1, 2, 7, 300, 65535])
async def a_word_changes_on_the_clock_of_the_step_pin_and_lag(dut: HierarchyObject, lag: int) -> None:
    """Lines as short as one substep of two clocks, each with its word, until the queue would be full."""
    random = rng("outputs, lag")
    outputs = await Outputs.begin(dut, lag=lag)
    await outputs.run(4)  # a lag counts two clocks after it was written
    outputs.set(running=1, running_next=1)
    expected: dict[int, tuple[int, int]] = {}
    await outputs.clock(line_begins=1)
    for n in range(250):
        levels, power = random.randrange(256), random.choice((0, FULL))
        await outputs.clock()
        outputs.set(word=word(levels, power))
        for _ in range(random.choice((0, 0, 0, 1, 9))):
            await outputs.clock()
        at = await outputs.substep(line_begins=int(n != 249))
        expected[at + lag] = (levels, power)
    await outputs.run(PIN + 3)
    while len(outputs.seen) <= max(expected):
        await outputs.clock()
    levels, power = 0, 0
    for clock in range(len(outputs.seen)):
        levels, power = expected.get(clock, (levels, power))
        assert (outputs.seen.outputs[clock], outputs.seen.power[clock]) == (levels, int(power == FULL)), clock
    assert outputs.now["quiet"] == 1 and outputs.now["overflow"] == 0


@cocotb.test()
async def a_change_that_finds_no_room_is_lost_and_power_stays_off(dut: HierarchyObject) -> None:
    """256 changes may wait; one more sets the flag, and there is no power until clear."""
    outputs = await Outputs.begin(dut, lag=5000)
    await outputs.run(4)
    await outputs.motion(word(1, FULL))
    for n in range(255):
        await outputs.line(word(n & 1, FULL))
        await outputs.substep()
    await outputs.run(8)
    assert outputs.now["overflow"] == 0
    await outputs.line(word(7, FULL))
    await outputs.substep()
    await outputs.run(8)
    assert outputs.now["overflow"] == 1
    await outputs.run(5000)
    assert outputs.now["outputs"] == 0 and 1 not in outputs.seen.power
    await outputs.clock(clear=1)
    await outputs.run(3)
    assert outputs.now["power"] == 1 and outputs.now["overflow"] == 0


@cocotb.test()
async def power_in_proportion_to_the_velocity(dut: HierarchyObject) -> None:
    """From 5 % to 100 % of the reference, by velocity and by rate: within 1 %; above, saturated."""
    outputs = await Outputs.begin(dut, pwm_step=PERIOD // 200)
    clocks = 16_000
    for power, top in ((FULL, HALF), (40000, HALF // 3))[-patience(2, 1) :]:
        outputs.set(power_reference=top)
        for velocity, rate in SPEEDS:
            outputs.set(velocity=min(HALF, top * velocity // 100), rate=RATE_ONE * rate // 100)
            await outputs.motion(word(0, power, proportional=True))
            await outputs.run(200)
            first = len(outputs.seen)
            await outputs.run(clocks)
            share = Fraction(sum(outputs.seen.power[first:]), clocks)
            scale = min(Fraction(1), Fraction(min(HALF, top * velocity // 100) * rate, top * 100))
            assert abs(share / (duty(power) * scale) - 1) < Fraction(1, 100), (velocity, rate, float(share))
            await outputs.rest()


@cocotb.test()
async def no_power_when_nothing_moves(dut: HierarchyObject) -> None:
    """At rate 0, at velocity 0, at the end of a motion and on the clock of a stop; back with the motion."""
    outputs = await Outputs.begin(dut)
    await outputs.motion(word(3, FULL))
    await outputs.run(20)
    for still in ({"rate": 0}, {"velocity": 0}):
        outputs.set(**still)
        await outputs.run(7)
        first = len(outputs.seen)
        await outputs.run(500)
        assert 1 not in outputs.seen.power[first:]
        outputs.set(rate=RATE_ONE, velocity=HALF)
        await outputs.run(7)
        assert outputs.now["power"] == 1
    await outputs.clock(running_next=0)
    assert outputs.now["power"] == 0 and outputs.now["outputs"] == 3
    outputs.set(running=0, running_next=0, stopped=1)
    await outputs.run(100)
    outputs.set(stopped=0)
    # the next motion has none before its first substep
    outputs.set(running=1, running_next=1)
    first = len(outputs.seen)
    await outputs.run(100)
    assert 1 not in outputs.seen.power[first:]
    assert outputs.now["outputs"] == 3


@cocotb.test()
async def a_stop_drops_what_waits(dut: HierarchyObject) -> None:
    """Neither the levels nor the power of a line whose time had not come, and no raster value."""
    outputs = await Outputs.begin(dut, lag=100)
    await outputs.push([1] * 8)
    assert outputs.now["raster_room"] == 254
    await outputs.motion(word(3, FULL))
    await outputs.run(50)
    outputs.set(running=0, running_next=0, stopped=1)
    await outputs.run(3)
    outputs.set(stopped=0)
    outputs.set(running=1, running_next=1)
    await outputs.run(200)
    assert 3 not in outputs.seen.outputs and 1 not in outputs.seen.power
    assert outputs.now["quiet"] == 1 and outputs.now["raster_room"] == 256


@cocotb.test()
@cocotb.parametrize(pitch=[1, 2, 3, 50])
async def a_raster_takes_a_value_on_the_exact_substep(dut: HierarchyObject, pitch: int) -> None:
    """0 and 255 as levels of the pin: value k is there from substep k * pitch on; each line begins a word."""
    random = rng("outputs, raster")
    outputs = await Outputs.begin(dut, pitch=pitch, lag=3)
    await outputs.run(4)
    outputs.set(running=1, running_next=1)
    expected: dict[int, int] = {}
    for _ in range(12):
        count = random.randrange(1, 24)
        values = [random.choice((0, 255)) for _ in range(count)]
        await outputs.push(values + [255] * (-count % 4))
        await outputs.line(word(0, 0, raster=True))
        for substep in range((count - 1) * pitch + random.randrange(1, pitch + 1)):
            at = await outputs.substep()
            if substep % pitch == 0:
                expected[at + 3] = values[substep // pitch]
            await outputs.run(random.choice((1, 1, 1, 2, 7)))
    await outputs.run(20)
    level = 0
    for clock, seen in enumerate(outputs.seen.power):
        level = expected.get(clock, level)
        assert seen == int(level == 255), clock
    assert outputs.now["raster_empty"] == 0


@cocotb.test()
async def every_raster_value_is_its_power(dut: HierarchyObject) -> None:
    """v / 255, as the share of the clocks."""
    outputs = await Outputs.begin(dut, pwm_step=PERIOD // 128)
    for value in (1, 2, 77, 128, 200, 254):
        await outputs.push([value, 0, 0, 0])
        at = await outputs.motion(word(0, 0, raster=True))
        await outputs.run(128 * 40 + PIN)
        on = sum(outputs.seen.power[at : at + 128 * 40])
        assert abs(on - Fraction(value, 255) * 128 * 40) <= 1
        await outputs.rest()


@cocotb.test()
async def an_empty_raster_is_no_power_and_a_flag(dut: HierarchyObject) -> None:
    """Never a stall; values that come later are taken; the flag stays until clear."""
    outputs = await Outputs.begin(dut)
    outputs.set(running=1, running_next=1)
    await outputs.push([255, 255, 255, 255])
    await outputs.line(word(0, 0, raster=True))
    clocks = []
    for n in range(12):
        clocks.append(await outputs.substep())
        await outputs.run(19)
        assert outputs.now["raster_empty"] == int(n >= 4)
    assert [outputs.seen.power[clock] for clock in clocks] == [1] * 4 + [0] * 8
    await outputs.push([255, 255, 255, 255])
    at = await outputs.substep()
    await outputs.run(9)
    assert outputs.seen.power[at] == 1
    await outputs.clock(clear=1)
    assert outputs.now["raster_empty"] == 0


@cocotb.test()
async def the_raster_queue_refuses_what_it_has_no_room_for(dut: HierarchyObject) -> None:
    """256 words; a frame counts as a whole; nothing is taken while the channel is stopped."""
    outputs = await Outputs.begin(dut)
    for _ in range(4):
        await outputs.push([9] * 240)
    await outputs.run(3)
    assert outputs.now["raster_room"] == 16
    await outputs.clock(bus_frame=1)
    answers = []
    for _ in range(17):
        await outputs.run(2)
        await outputs.clock(bus_check=1, select=1)
        answers.append(outputs.now["refusal"])
        await outputs.clock()
    assert answers == [0] * 16 + [QUEUE_FULL]
    outputs.set(stopped=1)
    await outputs.run(2)
    await outputs.clock(bus_check=1, select=1)
    assert outputs.now["refusal"] == BUSY
    outputs.set(stopped=0)
    await outputs.run(3)
    assert outputs.now["raster_room"] == 256


@cocotb.test()
async def compare_pulses_at_positions(dut: HierarchyObject) -> None:
    """At the point and every interval after it, once each, however the axis turns."""
    random = rng("outputs, compare")
    for _ in range(patience(30, 8)):
        axis = random.randrange(AXES)
        width = random.choice((1, 2, 5, 40))
        interval = random.choice((1, 2, 3, 10, -1, -4))
        distance = random.randrange(-12, 12)
        outputs = await Outputs.begin(
            dut, compare_axis=axis, compare_width=width, compare_interval=interval % (1 << 32)
        )
        await outputs.clock(bus_data=distance % (1 << 32), write_distance=1)
        position, point, arrivals = 0, distance, []
        drift = random.choice((0.5, 0.9, 0.1))
        for _ in range(200):
            made = random.randrange(1 << AXES)
            down = sum((random.random() < drift) << a for a in range(AXES))
            outputs.set(step_direction=down)
            await outputs.run(random.choice((1, 1, 2, 9)))
            await outputs.clock(step_made=made)
            if made >> axis & 1:
                position += -1 if down >> axis & 1 else 1
                if position == point:
                    arrivals.append(len(outputs.seen) - 1)
                    point += interval
        await outputs.run(50)
        high = {clock + n for clock in arrivals for n in range(width)}
        assert {n for n, level in enumerate(outputs.seen.compare) if level} == high
        outputs.clocks.stop()


@cocotb.test()
async def compare_of_width_0_is_off(dut: HierarchyObject) -> None:
    """No pulses, but the points move on."""
    outputs = await Outputs.begin(dut, compare_interval=3)
    await outputs.clock(bus_data=2, write_distance=1)
    for n in range(20):
        outputs.set(compare_width=int(n >= 10))
        await outputs.run(3)
        await outputs.clock(step_made=1)
    await outputs.run(3)
    assert sum(outputs.seen.compare) == len([n for n in (2, 5, 8, 11, 14, 17, 20) if n > 10])


@cocotb.test()
async def anything_on_any_clock_is_as_in_the_model(dut: HierarchyObject) -> None:
    """Random inputs of all kinds, as fast as they may come; stops, clears, settings."""
    random = rng("outputs, all")
    outputs = await Outputs.begin(dut)
    substep_may = step_may = begun = 0
    for now in range(patience(40000, 8000)):
        strobes: dict[str, int] = {}
        if now >= substep_may and now >= begun and random.random() < 0.4:
            strobes["substep"], substep_may = 1, now + 2
        if now >= begun and random.random() < (0.3 if "substep" in strobes else 0.02):
            strobes["line_begins"], begun = 1, now + 2
        if now == begun - 1:
            kind = random.random()
            raster = kind < 0.4
            power = 0 if raster else random.choice((0, FULL, random.randrange(65536)))
            outputs.set(word=0)
            next_word = word(random.randrange(256), power, proportional=random.random() < 0.5, raster=raster)
        if now == begun and begun:
            outputs.set(word=next_word)
        if now >= step_may and random.random() < 0.3:
            strobes["step_made"], step_may = random.randrange(8), now + 2
        if random.random() < 0.05:
            strobes |= {"bus_data": random.getrandbits(32)}
            queue = {"select": 1, "bus_write": 1}, {"select": 1, "bus_check": 1}
            strobes |= random.choice((*queue, {"write_levels": 1}, {"write_pulse": 1}))
        if random.random() < 0.01:
            strobes |= {"bus_data": random.choice((0, 1, 2**32 - 1, 7)), "write_distance": 1}
        if random.random() < 0.01:
            strobes |= {"bus_frame": 1, "bus_commit": random.randrange(2)}
        if random.random() < 0.002:
            strobes["clear"] = 1
        if random.random() < 0.0005:
            strobes["rst"], substep_may, step_may, begun = 1, now + 3, now + 3, 0
            outputs.set(word=0)
        if random.random() < 0.01:
            setting = random.choice(
                (
                    {"lag": random.choice((0, 1, 50, 700))},
                    {"pwm_step": random.randrange(1, PERIOD >> random.randrange(1, 20))},
                    {"power_reference": random.randrange(1, HALF >> random.randrange(10))},
                    {"velocity": random.choice((0, HALF, random.randrange(HALF)))},
                    {"rate": random.choice((0, RATE_ONE, random.randrange(RATE_ONE)))},
                    {"pitch": random.choice((1, 2, 3, 100))},
                    {"compare_width": random.choice((0, 1, 30)), "compare_axis": random.randrange(AXES)},
                    {"compare_interval": random.choice((1, 2, 2**32 - 3))},
                    {"stopped": int(random.random() < 0.2)},
                )
            )
            if "step_made" in strobes:
                setting.pop("compare_axis", None)  # it is written at rest
            outputs.set(**setting)
        outputs.set(running=outputs.inputs["running_next"])
        if random.random() < (0.1 if not outputs.inputs["running"] else 0.002):
            outputs.set(running_next=1 - outputs.inputs["running_next"])
        await outputs.clock(**strobes)
        # a direction is there a clock before its step
        if "step_made" in strobes:
            outputs.set(step_direction=random.randrange(8))
