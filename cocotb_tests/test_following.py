# SPDX-License-Identifier: MIT
"""passo_following: the error is position * ratio - count, in fractions; the limit and the largest error."""

from fractions import Fraction

import cocotb
import pytest
from cocotb.handle import HierarchyObject

from cocotb_tests.helpers.bench import patience, rng
from cocotb_tests.helpers.encoder_model import Pair
from cocotb_tests.helpers.runner import run

ONE = 1 << 16
JUDGED = 4  # clocks from a step or count to `exceeded`
SCALE = 1 << 16  # counts
RATIOS = (1, 3, ONE, ONE // 3, ONE * 200 // 4096, 7 * ONE + 12345, ONE * 3000, (1 << 32) - 1)
OUTPUTS = {
    "error": lambda model, _wires: model.error & ((1 << 35) - 1),
    "exceeded": lambda model, _wires: model.exceeded,
    "greatest": lambda model, _wires: model.greatest,
}


@pytest.mark.sample(1)
def test_following(simulator: str) -> None:
    run(__name__, "passo_following", simulator=simulator)


class Servo:
    """Module and model, and the error in fractions of a count."""

    def __init__(self, pair: Pair, ratio: int) -> None:
        self.pair = pair
        self.ratio = Fraction(ratio, ONE)
        self.position = self.count = 0
        self.errors = [Fraction(0)] * JUDGED  # before each of the last clocks, latest last
        self.outputs = pair.compare()

    @classmethod
    async def begin(cls, dut: HierarchyObject, ratio: int, limit: int) -> "Servo":
        """Reset."""
        pair = await Pair.begin(dut, "following", OUTPUTS)
        pair.set(ratio=ratio, limit=limit)
        return cls(pair, ratio)

    async def clock(self, step: int = 0, count: int = 0, **inputs: int) -> None:
        """One clock with a step and a count of -1, 0 or 1."""
        self.outputs = await self.pair.clock(
            step_made=abs(step),
            step_direction=int(step < 0),
            count_made=abs(count),
            count_down=int(count < 0),
            **inputs,
        )
        self.position += step
        self.count += count
        self.errors = [*self.errors[1:], self.position * self.ratio - self.count]

    @property
    def shown(self) -> Fraction:
        """The error as the module has it."""
        value = self.outputs["error"]
        return Fraction(value - (value >> 34 << 35), ONE)

    def judge(self, limit: int) -> None:
        """Error two clocks late, its limit four."""
        assert self.shown == self.errors[-2]
        judged = self.errors[0]
        assert self.outputs["exceeded"] == (judged >= limit or judged < -limit), f"{float(judged)}"


@cocotb.test()
@cocotb.parametrize(ratio=RATIOS)
async def the_error_is_exact_in_fractions(dut: HierarchyObject, ratio: int) -> None:
    """An encoder that follows, lags and wanders; every clock is judged."""
    random = rng(f"following, {ratio}")
    limit = max(2, min(60000, 2 * ratio // ONE + 3))
    servo = await Servo.begin(dut, ratio, limit)
    exceeded = greatest = 0
    for _ in range(patience(8000, 2000)):
        error = servo.errors[-1]
        toward = 1 if error > 0 else -1
        step = random.choice((0, 0, 1, -1))
        if abs(error) > 1.5 * limit:
            step = -toward
        if abs(error + step * servo.ratio) > SCALE - 4:
            step = 0
        count = random.choice((0, toward, toward, -toward))
        await servo.clock(step, count)
        servo.judge(limit)
        exceeded += servo.outputs["exceeded"]
        judged = servo.errors[0]
        greatest = max(greatest, int(judged) if judged >= 0 else int(-judged - Fraction(1, ONE)))
        assert servo.outputs["greatest"] == greatest
    assert exceeded or ratio < ONE


@cocotb.test()
async def the_limit_decides_to_the_last_bit(dut: HierarchyObject) -> None:
    """At the limit it is exceeded, 2^-16 of a count below it is not; on the other side one 2^-16 later."""
    servo = await Servo.begin(dut, 1, 3)
    for sign in (1, -1):
        for _ in range(3):
            await servo.clock(count=-sign)
        await servo.clock()
        for step in (-sign, sign, -sign, -sign, sign, sign, sign, -sign) * 3:
            await servo.clock(step=step)
            servo.judge(3)
        for _ in range(JUDGED):
            await servo.clock()
        assert abs(servo.errors[-1]) == 3 and servo.outputs["exceeded"] == (sign > 0)
        for _ in range(3):
            await servo.clock(count=sign)


@cocotb.test()
async def an_encoder_that_is_not_connected_exceeds_the_limit(dut: HierarchyObject) -> None:
    """After as many steps as the limit has; the step of the last one is seen 4 clocks later."""
    servo = await Servo.begin(dut, ONE * 5 // 2, 100)
    for n in range(1, 41):
        await servo.clock(step=1)
        for _ in range(JUDGED - 1):
            assert servo.outputs["exceeded"] == 0
            await servo.clock()
        assert servo.outputs["exceeded"] == (n == 40)


@cocotb.test()
async def off_the_scale_it_stays_until_zero(dut: HierarchyObject) -> None:
    """An error of 2^16 counts is lost: it does not wrap, and no way home looks like none."""
    servo = await Servo.begin(dut, (1 << 32) - 1, 65535)
    await servo.clock(step=1, count=-1)
    await servo.clock(step=1, count=-1)
    await servo.clock(step=1, count=-1)
    for _ in range(6):
        await servo.clock()
    lost = servo.outputs["error"]
    assert servo.shown >= SCALE and servo.outputs["exceeded"] == 1
    for _ in range(200):
        await servo.clock(step=-1, count=1)
    assert servo.outputs["error"] == lost and servo.outputs["exceeded"] == 1
    await servo.clock(zero=1)
    assert servo.outputs == {"error": 0, "exceeded": 0, "greatest": 0}
    await servo.clock(zero=0, step=-1)
    await servo.clock(step=-1)
    for _ in range(6):
        await servo.clock()
    assert servo.shown < -SCALE and servo.outputs["exceeded"] == 1


@cocotb.test()
async def clear_forgets_the_greatest_error_only(dut: HierarchyObject) -> None:
    """What is still there is seen again."""
    servo = await Servo.begin(dut, 3 * ONE, 10)
    for step in (1, 1, 1, 1, -1, -1, 0, 0, 0, 0):
        await servo.clock(step=step)
    assert servo.outputs["greatest"] == 12 and servo.shown == 6
    await servo.clock(clear=1)
    assert servo.outputs["greatest"] == 0
    await servo.clock(clear=0)
    assert servo.outputs["greatest"] == 6 and servo.shown == 6


@cocotb.test()
async def random_inputs_match_the_model(dut: HierarchyObject) -> None:
    """Anything at any clock."""
    random = rng("following")
    servo = await Servo.begin(dut, ONE, 5)
    for _ in range(patience(8000, 2000)):
        changes = {"zero": int(random.random() < 0.005), "clear": int(random.random() < 0.01)}
        if random.random() < 0.01:
            changes["ratio"] = random.randrange(1, 1 << random.randrange(1, 33))
        if random.random() < 0.01:
            changes["limit"] = random.randrange(1, 1 << random.randrange(1, 17))
        await servo.clock(random.randint(-1, 1), random.randint(-1, 1), **changes)
