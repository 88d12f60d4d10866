# SPDX-License-Identifier: MIT
"""What the tests of the driver share: a core behind a wire that can fail in every way, and a pulse count."""

import random
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from passo import frame
from passo.build import Parameters
from passo.driver import Driver, DriverError
from passo.engine import Engine, bits_of, model_engine
from passo.link import Hardware
from passo.native import ffi, planner
from passo.registers import Operation

CLOCK_HZ = 72_000_000
PARAMETERS = Parameters()
Q32 = 1 << 32
GAP = 3  # clocks between two frames, hardly more than the core needs


class Wire:
    """The C model behind SPI; an engine for passo.link."""

    def __init__(self, parameters: Parameters = PARAMETERS, clock_hz: int = CLOCK_HZ):
        self.parameters, self.clock_hz = parameters, clock_hz
        self.engine: Engine = model_engine(parameters, clock_hz)
        self.before = 0  # clocks of cores before their reset
        self.frames = 0
        self.requests: list[list[int]] = []
        self.stuck: int | None = None  # level of MISO; then nothing arrives at the core either
        # What the wire makes of a request (None: nothing arrives) and of its reply.
        self.there: Callable[[list[int]], list[int] | None] = list
        self.back: Callable[[list[int]], list[int]] = list
        self.before_frame: Callable[[int], None] = lambda _: None
        self.pulses = np.zeros(8, np.int64)
        self.net = np.zeros(8, np.int64)
        self.turns = np.zeros(8, np.int64)  # of DIR
        self._step = self._dir = np.uint64(0)
        self.enable = 0  # levels of the EN pins

    @property
    def clock(self) -> int:
        """Clocks since the beginning, resets of the core included."""
        return self.before + self.engine.clock

    def transfer(self, mosi: Sequence[int], _: int = 0) -> list[int]:
        """One chip select. The next may follow immediately."""
        self.frames += 1
        self.requests.append(list(mosi))
        self.before_frame(self.frames)
        sent = None if self.stuck is not None else self.there(list(mosi))
        if sent is None:
            self.engine.run(128 * len(mosi) + GAP)
            return [0xFFFFFFFF * (self.stuck or 0)] * len(mosi)
        miso = self.engine.transfer(sent, GAP)
        miso += [0xFFFFFFFF] * (len(mosi) - len(miso))
        return self.back(miso)

    def run(self, clocks: int) -> int:
        """Let time pass."""
        done = 0
        while done < clocks:
            done += self.engine.run(clocks - done)
            self.collect()
        return clocks

    def reset_core(self) -> None:
        """The core loses all it knew."""
        self.collect()
        self.before += self.engine.clock
        self.engine.close()
        self.engine = model_engine(self.parameters, self.clock_hz)
        self._step = self._dir = np.uint64(0)

    def collect(self) -> None:
        """Count the pulses at the pins so far: all active edges are rising ones."""
        events = self.engine.drain()
        if not len(events):
            return
        step, dir_ = (
            np.concatenate([[was], events[pin]]) for was, pin in ((self._step, "step"), (self._dir, "dir"))
        )
        rising, down, turning = (
            bits_of(levels, 8) for levels in (~step[:-1] & step[1:], dir_[1:], dir_[:-1] ^ dir_[1:])
        )
        pulses = rising.sum(axis=0, dtype=np.int64)
        self.pulses += pulses
        self.net += pulses - 2 * (rising & down).sum(axis=0, dtype=np.int64)
        self.turns += turning.sum(axis=0, dtype=np.int64)
        self._step, self._dir = step[-1], dir_[-1]
        self.enable = int(events["enable"][-1])

    def counted(self) -> tuple[list[int], list[int]]:
        """Pulses of each axis so far, and the sum of their directions."""
        self.collect()
        axes = self.parameters.axes
        return self.pulses[:axes].tolist(), self.net[:axes].tolist()


class Dma(Hardware):
    """Exchanges in two halves: each is over after some calls of `finish`, and the frame must stay until then.

    Of a reply only the words that matter arrive.
    """

    CALLS = 3
    REPLY_WORDS, GARBAGE = 5, 0xA5A5A5A5

    def __init__(self, engine: Any, tries: int = 0, clock_hz: int = 0):
        super().__init__(engine, tries, clock_hz)
        self._exchange: tuple[Any, Any, list[int]] | None = None
        self._calls = 0  # of `finish` until the exchange is over
        self._spare = ffi().new("uint32_t[]", frame.PAYLOAD_MAX + frame.OVERHEAD)
        self._halves = (
            ffi().callback("bool(void *, const uint32_t *, uint32_t *, size_t)", self._start),
            ffi().callback("enum passo_error(void *)", self._finish),
        )
        self.c.start, self.c.finish = self._halves
        self.c.spare = self._spare

    @property
    def on_wire(self) -> bool:
        """An exchange is under way."""
        return self._exchange is not None

    def _transfer(self, context: Any, send: Any, receive: Any, words: int) -> bool:
        return self._idle() and super()._transfer(context, send, receive, words)

    def _start(self, _: Any, send: Any, receive: Any, words: int) -> bool:
        if not self._idle():
            return False
        self._exchange, self._calls = (send, receive, ffi().unpack(send, words)), self.CALLS
        return True

    def _finish(self, context: Any) -> int:
        if self._exchange is None:
            return planner().PASSO_OK
        self._calls -= 1
        if self._calls:
            return planner().PASSO_PENDING
        (send, receive, sent), self._exchange = self._exchange, None
        if ffi().unpack(send, len(sent)) != sent:
            self._raised = AssertionError("a frame changes while it is on the wire")
        good = super()._transfer(context, send, receive, len(sent))
        for i in range(len(sent) - self.REPLY_WORDS):
            receive[i] = self.GARBAGE
        return planner().PASSO_OK if good else planner().PASSO_ERROR_TRANSFER

    def _idle(self) -> bool:
        if self._exchange is not None:
            self._raised = AssertionError("two exchanges at a time")
        return self._exchange is None


class Noise:
    """Flips each bit with a probability, and now and then does worse."""

    def __init__(self, rng: random.Random, rate: float, worse: float = 0):
        self.rng, self.rate, self.worse = rng, rate, worse
        self.flips = self.bursts = self.cuts = 0

    def bits(self, words: list[int]) -> list[int]:
        """Independent flips; the gaps between them are drawn."""
        at = int(self.rng.expovariate(self.rate))
        while at < 32 * len(words):
            words[at // 32] ^= 1 << at % 32
            self.flips += 1
            at += 1 + int(self.rng.expovariate(self.rate))
        return words

    def there(self, words: list[int]) -> list[int]:
        """Of a request: also bursts, and words that are missing."""
        words = self.bits(words)
        if self.rng.random() < self.worse:
            if self.rng.random() < 0.5:
                self.bursts += 1
                first = self.rng.randrange(len(words))
                for i in range(first, min(len(words), first + self.rng.randrange(1, 5))):
                    words[i] = self.rng.getrandbits(32)
            else:
                self.cuts += 1
                words = words[: self.rng.randrange(1, len(words))]
        return words

    def back(self, words: list[int]) -> list[int]:
        """Of a reply: also bursts."""
        words = self.bits(words)
        if self.rng.random() < self.worse:
            self.bursts += 1
            first = self.rng.randrange(len(words))
            for i in range(first, min(len(words), first + self.rng.randrange(1, 5))):
                words[i] = self.rng.getrandbits(32)
        return words

    def on(self, wire: Wire) -> None:
        """Disturb a wire."""
        wire.there, wire.back = self.there, self.back


def answer_reads(wire: Wire, change: Callable[[int, int], int]) -> None:
    """Change what the registers read as: change(address, word); replies stay undamaged."""

    def back(miso: list[int]) -> list[int]:
        request = wire.requests[-1]
        if request[0] >> 28 == Operation.READ:
            data = range(frame.DATA, len(miso) - 1)
            for i in data:
                miso[i] = change((request[0] & 0xFFF) + i - frame.DATA, miso[i])
            miso[-1] = frame.crc([request[0], *(miso[i] for i in data)])
        return miso

    wire.back = back


def open_driver(wire: Wire, **options: Any) -> Driver:
    """A driver with its axes configured: 1 us high, 1 us low."""
    driver = Driver(wire, **options)
    configure(driver)
    return driver


def configure(driver: Driver) -> None:
    """Pins of all axes."""
    for axis in range(driver.c.axes):
        config = {"step_high_ns": 1000, "step_low_ns": 1000, "dir_setup_ns": 500, "dir_hold_ns": 500}
        driver.call("configure_axis", axis, ffi().new("struct passo_axis_config *", config))
        driver.call("enable", axis, True)


def struct(name: str, **fields: Any) -> Any:
    """A new C struct."""
    return ffi().new(f"struct passo_{name} *", fields)


def by_speed(steps: Sequence[int], speed: int = 100_000, acceleration: int = 20_000_000) -> Any:
    """A quick move."""
    return struct(
        "move_by_speed", steps=list(steps), speed=speed * Q32, acceleration=acceleration * Q32, profile=0
    )


def poll(driver: Driver) -> None:
    """One poll; it is at most one frame."""
    before = driver.engine.frames
    driver.poll()
    assert driver.engine.frames - before <= 1


def finish(driver: Driver, seconds: float = 2) -> None:
    """Poll until all has ended, as a main loop does."""
    wire = driver.engine
    end = wire.clock + int(seconds * wire.clock_hz)
    while driver.is_moving:
        assert wire.clock < end, "it does not end"
        poll(driver)
        if idle := driver.idle_microseconds:
            wire.run(min(idle, 300) * (wire.clock_hz // 1_000_000))


def error_of(driver: Driver, call: str, *arguments: Any) -> str:
    """Name of the error of a call: OK, if none."""
    try:
        driver.call(call, *arguments)
    except DriverError as error:
        return error.name
    return "OK"


def path(count: int, clocks: int = 72) -> tuple[list, list]:
    """Short lines: 2 steps of axis 0 and one back of axis 1 each, with 8 ramps."""
    lines = [
        struct("line", substeps=20, steps=[2, 1], directions=2, last=n == count - 1)[0] for n in range(count)
    ]
    velocity = (1 << 48) // clocks
    ticks = count * 20 * clocks // 128
    cruise = [ticks // 7] * 6 + [ticks - 6 * (ticks // 7)]
    ramps = [struct("ramp", velocity_end=velocity)[0]]
    for n, length in enumerate(cruise):
        step = min(2**48 - 1, round(2**48 / length))
        ramps.append(struct("ramp", velocity_end=velocity, ticks=length, progress_step=step, last=n == 6)[0])
    return lines, ramps
