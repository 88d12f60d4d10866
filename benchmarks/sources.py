# SPDX-License-Identifier: MIT
"""Four published methods of making step pulses with the timers of an STM32, with their original arithmetic.

Integer divisions truncate, as in C, and errors of the publications are kept. Where a publication leaves
something open, the interpretation that favours it is used and documented. Common to all: a pulse is placed in
the middle of its period, where it belongs on the ideal curve.
"""

import math
from dataclasses import dataclass
from functools import cache

import numpy as np

MILLISECONDS = 1000  # in a second


@dataclass(frozen=True)
class Pulses:
    """Pulses of a move. Frequencies (Hz) are those of the timer at the start, in cruise and at the end."""

    times: np.ndarray  # of each pulse, in seconds since the start
    seconds: float
    start: float
    run: float
    stop: float
    followers: tuple[np.ndarray, ...] = ()  # times of the pulses of each other axis


def pulses_from_periods(periods: np.ndarray, clock_hz: float) -> tuple[np.ndarray, float]:
    """Time of each pulse, in the middle of its period, and the time of all (s)."""
    ends = np.cumsum(periods, dtype=np.int64)
    return (ends - periods / 2) / clock_hz, float(ends[-1] / clock_hz) if len(ends) else 0.0


# ---------------------------------------------------------------------------------------------------- A ----


@dataclass(frozen=True)
class Trapezoid:
    """A move by angle and rpm: 200 full steps of 8 microsteps are 1600 pulses or 3200 updates a turn."""

    degrees: float
    rpm: int
    rpm_min: int

    ACCELERATION = 40_000  # updates/s^2
    UPDATES = 3200  # per turn
    TIMER_HZ = 1_000_000

    @property
    def v_target(self) -> int:
        """Updates per second at full speed."""
        return self.rpm * self.UPDATES // 60

    @property
    def v_min(self) -> int:
        """Updates per second at the start and at the end."""
        return self.rpm_min * self.UPDATES // 60

    @property
    def n_target(self) -> int:
        """Updates in all."""
        return int(abs(self.degrees) / 360 * self.UPDATES)

    @property
    def n_acc(self) -> int:
        """Updates for speeding up."""
        return (self.v_target**2 - self.v_min**2) // 2 // self.ACCELERATION

    @property
    def cruises(self) -> bool:
        """Whether the move has a middle part."""
        return self.n_acc < self.n_target // 2


def trapezoid_speeds(move: Trapezoid) -> list[int]:
    """v before the first update and after each but the last. On update n, from 1 to n_target:

        n < n_acc                               v = sqrt(v^2 + 2 a)
        n_target - n > n_acc, if it cruises     v = v_target
        else                                    v = sqrt(v^2 - 2 a)

    and v is kept within v_min .. v_target. It is an integer, so that each root is truncated: from 40000
    updates/s on it does not grow at all. In a move that does not cruise, n_acc still is what v_target would
    take, so that such a move slows down too late, or not at all. (A root of less than 0 is taken as 0.)
    """
    low, target, twice = move.v_min, move.v_target, 2 * move.ACCELERATION
    n_acc, n_target = move.n_acc, move.n_target
    v, speeds = low, [low]
    for _ in range(1, min(n_acc, n_target)):
        v = min(math.isqrt(v * v + twice), target)
        speeds.append(v)
    if move.cruises:
        cruise = n_target - n_acc - len(speeds)
        if cruise > 0:
            v = target
            speeds += [v] * cruise
    for _ in range(n_target - len(speeds)):
        v = max(math.isqrt(max(v * v - twice, 0)), low)
        speeds.append(v)
    return speeds


def trapezoid(move: Trapezoid) -> Pulses:
    """Timer at 1 MHz with `reload = 1000000 / v - 1`; every other update, from the first on, is a pulse."""
    periods = move.TIMER_HZ // np.array(trapezoid_speeds(move), dtype=np.int64)
    updates = np.cumsum(periods)
    start, run, stop = (move.TIMER_HZ / 2 / period for period in (periods[0], periods.min(), periods[-1]))
    return Pulses(updates[::2] / move.TIMER_HZ, updates[-1] / move.TIMER_HZ, start, run, stop)


# ---------------------------------------------------------------------------------------------------- B ----


@dataclass(frozen=True)
class Sigmoid:
    """A move by frequencies (Hz) and whole ramp times (ms); alpha says how sharply the S is bent."""

    steps: int
    start: int
    run: int
    stop: int
    up_ms: int
    down_ms: int
    alpha: float

    TIMER_HZ = 12_000_000


def sigmoid_formula(alpha: float, i: float, half: float) -> float:
    """1 / (1 + exp(-alpha (i - N) / N)), i = 0 .. 2N: which part of the change of frequency is made.

    It neither starts at 0 nor ends at 1: 0.7 % are missing at either end for alpha = 5, 4.7 % for alpha = 3.
    """
    return 1 / (1 + math.exp(-alpha * (i - half) / half))


@cache
def sigmoid_table() -> tuple[int, ...]:
    """1024 values of 65535 / (1 + exp(-x)), x evenly over -5 .. 5."""
    return tuple(int(65535 / (1 + math.exp(5 - 10 * i / 1023))) for i in range(1024))


def sigmoid_index(alpha: float, n: int, half: int) -> int:
    """Where in the table the ramp is after n ms, if half of it takes `half` ms.

    With alpha in 1/4096: `d = alpha n / half`, at most 32767; `x = 4 * 4096 - (alpha - d)`, at least 0;
    `index = x / 32`, at most 1023. A full table would be -5 .. 5, but x is made for -4 .. 4: at alpha = 5
    the ramp goes from index 0 to 895, which is 2.3 % short of its end.
    """
    fixed = round(alpha * 4096)
    d = min(fixed * n // half, 32767)
    return min(max(4 * 4096 - (fixed - d), 0) // 32, 1023)


@dataclass(frozen=True)
class _Runs:
    """So many pulses of so many timer clocks each, one after the other; `last` is the last frequency."""

    periods: list[int]
    counts: list[int]
    last: int

    @property
    def pulses(self) -> int:
        return sum(self.counts)

    @property
    def clocks(self) -> int:
        return sum(period * count for period, count in zip(self.periods, self.counts, strict=True))


def _sigmoid_ramp(move: Sigmoid, begin: int, end: int, ms: int, clock: int) -> _Runs:
    """From one frequency to another, where a ms began `clock` ago. Pulses begun in the same ms are equal."""
    table, tick = sigmoid_table(), move.TIMER_HZ // MILLISECONDS
    periods, counts, f = [], [], begin
    while (n := clock // tick) < ms:
        part = abs(end - begin) * table[sigmoid_index(move.alpha, n, ms // 2)] // 65535
        f = max(begin + part if end >= begin else begin - part, 200)
        periods.append(move.TIMER_HZ // f)
        counts.append(-(-((n + 1) * tick - clock) // periods[-1]))
        clock += counts[-1] * periods[-1]
    return _Runs(periods, counts, f)


def sigmoid(move: Sigmoid) -> Pulses:
    """A timer of 1 ms counts n, and the interrupt of a pulse takes the frequency of the next from it:

        speed up    f = (run - start) table[index] / 65535 + start, at least 200, until n is the ramp time
        run         the frequency reached, until `total <= steps + stop_remain_steps`
        slow down   f = reached - (reached - stop) table[index] / 65535, until n is the ramp time
        stop        f = stop, until all steps are made

    stop_remain_steps is left to the user, who here has found out what slowing down takes. The clock of the
    pulse timer is open; here it is the fastest at which 200 Hz fit 16 bits, 72 MHz / 6.
    """
    up = _sigmoid_ramp(move, move.start, move.run, move.up_ms, 0)
    stop_remain_steps = _sigmoid_ramp(move, up.last, move.stop, move.down_ms, 0).pulses
    period, cruise = move.TIMER_HZ // up.last, max(move.steps - stop_remain_steps - up.pulses, 0)
    clock = (up.clocks + cruise * period) % (move.TIMER_HZ // MILLISECONDS)
    down = _sigmoid_ramp(move, up.last, move.stop, move.down_ms, clock)
    rest = max(move.steps - up.pulses - cruise - down.pulses, 0)

    periods = [*up.periods, period, *down.periods, move.TIMER_HZ // max(move.stop, 200)]
    every = np.repeat(periods, [*up.counts, cruise, *down.counts, rest])[: move.steps]
    times, seconds = pulses_from_periods(every, move.TIMER_HZ)
    return Pulses(times, seconds, *(move.TIMER_HZ / float(p) for p in (every[0], period, every[-1])))


# ---------------------------------------------------------------------------------------------------- C ----


@dataclass(frozen=True)
class MultiAxis:
    """A coordinated move; speeds of the main axis in pulses per ms, `1 <= v0`, `vmax <= 100`."""

    steps: tuple[int, ...]  # the main axis, that with the most, comes first
    v0: int
    vmax: int
    t_acc: int  # ms, at most 250: the length of the table

    TIMER_HZ = 72_000_000
    PRESCALER = 1

    @property
    def acceleration(self) -> np.float32:
        """Pulses per ms, per ms."""
        return np.float32(self.vmax - self.v0) / np.float32(self.t_acc)

    @property
    def cruises(self) -> bool:
        """Whether it has the length for vmax."""
        return float((2 * self.v0 + self.acceleration * (self.t_acc - 1)) * self.t_acc) < self.steps[0]


def multi_axis_pulses(move: MultiAxis, ms: int) -> np.ndarray:
    """Pulses in each ms of a ramp, `v0 + acc i` truncated."""
    return (np.float32(move.v0) + move.acceleration * np.arange(ms, dtype=np.float32)).astype(np.int64)


def multi_axis_period(move: MultiAxis, pulses: np.ndarray) -> np.ndarray:
    """Of a pulse, in timer clocks: two interrupts with `reload = 36000 / pulses / (psc + 1) - 1`."""
    return 2 * (36000 // pulses // move.PRESCALER)


def follower(v_main: int, v_sub: int) -> np.ndarray:
    """The pulses of the main axis, from 0, on which a follower makes one, for v_main of them.

    From `sy = ceil(v_main / 2)`, with `st = v_main - v_sub`, on each pulse of the main axis:
    `sy >= st`: a pulse and `sy -= st`, else `sy += v_sub`. So after m of them `sy` is
    `ceil(v_main / 2) + m v_sub - v_main * pulses`, and pulse k (from 1) comes with the first m for which
    `ceil(v_main / 2) + m v_sub >= k v_main`.
    """
    if v_sub == 0:
        return np.empty(0, np.int64)
    return -((-(-v_main // 2) - np.arange(1, v_sub + 1, dtype=np.int64) * v_main) // v_sub) - 1


def multi_axis(move: MultiAxis) -> Pulses:
    """Trapezoid if `(2 v0 + acc (t_acc - 1)) t_acc < L`; else the ramps take t_up ms,
    `t_up = (sqrt(4 v0^2 + 4 acc L) - 2 v0) / (2 acc)` truncated.

    What the ramps leave of L is made at vmax or, in a triangle, at the speed then reached, v0 + acc t_up.
    Followers go by their steps, so that their number is right for any ratio.
    """
    length, acc = move.steps[0], float(move.acceleration)
    ms, peak = move.t_acc, move.vmax
    if not move.cruises:
        ms = int((math.sqrt(4 * move.v0**2 + 4 * acc * length) - 2 * move.v0) / (2 * acc))
        peak = int(move.v0 + acc * ms)
    pulses = multi_axis_pulses(move, ms)
    counts = np.concatenate([pulses, [length - 2 * pulses.sum()], pulses[::-1]])
    speeds = np.concatenate([pulses, [peak], pulses[::-1]])
    periods = np.repeat(multi_axis_period(move, speeds), counts)
    clock_hz = move.TIMER_HZ / move.PRESCALER
    times, seconds = pulses_from_periods(periods, clock_hz)
    followers = tuple(times[follower(length, sub)] for sub in move.steps[1:])
    start, run, stop = (clock_hz / period for period in (periods[0], periods.min(), periods[-1]))
    return Pulses(times, seconds, start, run, stop, followers)


# ---------------------------------------------------------------------------------------------------- D ----


@dataclass(frozen=True)
class Cosine:
    """A move of n pulses in a given time (ms), speeding up and slowing down in ramp_ms each."""

    steps: int
    total_ms: int
    ramp_ms: int

    TIMER_HZ = 48_000_000

    @property
    def f_max(self) -> float:
        """n / (t_i - t_s)."""
        return self.steps * MILLISECONDS / (self.total_ms - self.ramp_ms)


@cache
def _cosine_shape(total_ms: int, ramp_ms: int) -> np.ndarray:
    """f(t) / f_max at the start of each slice."""
    t = np.arange(total_ms, dtype=float)
    nearest = np.minimum(np.minimum(t, total_ms - t), ramp_ms)  # to an end of the move
    return (1 - np.cos(np.pi * nearest / max(ramp_ms, 1))) / 2 if ramp_ms else np.ones(total_ms)


def cosine_slices(move: Cosine, f_max: float) -> np.ndarray:
    """Pulses in each slice of TS = 1 ms: `floor(f(i TS) TS)`, with
    `f(t) = f_max / 2 (1 - cos(pi t / t_s))`, then f_max, then the mirror image.
    """
    return (_cosine_shape(move.total_ms, move.ramp_ms) * (f_max / MILLISECONDS)).astype(np.int64)


def cosine_repaired(move: Cosine) -> np.ndarray:
    """The slices after both repairs; their sum is n, but their number need not be t_i any more.

    The sum of the slices falls short of n. Coarse: raise f_max (by 1 Hz) until the sum brackets n, and take
    the nearer bracket. Fine: make up for the rest with slices of the cruise or, where there is none, with a
    pulse more or less in each of the last slices (which gives the published times). Pulses that do not fill
    a slice of the cruise have one to themselves.
    """
    low, high = math.floor(move.f_max), 2 * math.ceil(move.f_max) + 2 * MILLISECONDS
    while high - low > 1:  # the sum grows with f_max
        middle = (low + high) // 2
        low, high = (low, middle) if cosine_slices(move, middle).sum() >= move.steps else (middle, high)
    below, above = cosine_slices(move, low), cosine_slices(move, high)
    slices = below if move.steps - below.sum() < above.sum() - move.steps else above
    rest = int(move.steps - slices.sum())
    cruise_begin, cruise_end = move.ramp_ms, move.total_ms - move.ramp_ms
    if cruise_end > cruise_begin:
        full, part = divmod(rest, int(slices[cruise_begin]))  # rest < 0: slices less, and one in part
        cruise = slices[cruise_begin:cruise_end]
        cruise = cruise[-full:] if full < 0 else np.concatenate([cruise, np.full(full, cruise[0])])
        cruise = np.concatenate([cruise, np.full(min(part, 1), part)])
        return np.concatenate([slices[:cruise_begin], cruise, slices[cruise_end:]])
    while rest:
        changed = np.flatnonzero(slices > 0 if rest < 0 else slices >= 0)[-abs(rest) :]
        slices[changed] += 1 if rest > 0 else -1
        rest = int(move.steps - slices.sum())
    return slices


def cosine(move: Cosine) -> Pulses:
    """The pulses of a slice are even, at `48000 / pulses` timer clocks; the rest of the slice is empty."""
    slices = cosine_repaired(move)
    begins = np.repeat(np.arange(len(slices)), slices) * (move.TIMER_HZ // MILLISECONDS)
    periods = np.repeat(move.TIMER_HZ // MILLISECONDS // np.maximum(slices, 1), slices)
    number = np.arange(len(periods)) - np.repeat(np.cumsum(slices) - slices, slices)  # within its slice
    times = (begins + (number + 0.5) * periods) / move.TIMER_HZ
    run = move.TIMER_HZ / (move.TIMER_HZ // MILLISECONDS // int(slices.max()))
    return Pulses(times, len(slices) / MILLISECONDS, 0.0, run, 0.0)


Move = Trapezoid | Sigmoid | MultiAxis | Cosine


def simulate(move: Move) -> Pulses:
    """What the source makes of its own move."""
    makers = {Trapezoid: trapezoid, Sigmoid: sigmoid, MultiAxis: multi_axis, Cosine: cosine}
    return makers[type(move)](move)
