# SPDX-License-Identifier: MIT
"""Two C models with the same pin waveforms: one goes clock by clock, one with passo_core_advance() and
passo_core_shift()."""

import random
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any

from cffi import FFI
from passo.build import Parameters
from passo.compiler import declarations, library, sources
from passo.pins import INPUTS
from passo.toolchain import paths

HERE = Path(__file__).parent
MODEL = ("pins", "shift", "core_encoder", "core_outputs", "core_trackers", "model", "core")
HEADERS = [
    *(paths.protocol / f"passo_{name}.h" for name in ("registers", "words", "shapes", "command")),
    *(paths.core / f"passo_{name}.h" for name in MODEL),
    HERE / "core_player.h",
]
FOLDERS = (paths.core, paths.protocol)
EVENTS = 1 << 16
Segment = tuple[int, dict[str, int]]  # clocks with these levels of the input pins
HALF_PERIOD = 2  # clocks that SCLK stays at each level


@cache
def load() -> tuple[FFI, Any]:
    """All types of the model, and the player."""
    ffi = FFI()
    ffi.cdef(declarations(HEADERS))
    files = [HERE / "core_player.c", *sources(*FOLDERS)]
    player = library("player", (HERE, *FOLDERS), files, "-O2", "-fno-semantic-interposition")
    return ffi, ffi.dlopen(str(player))


class Player:
    """One model."""

    def __init__(self, parameters: Parameters, advance: bool):
        ffi, c = load()
        self.ffi, self.c = ffi, c
        self.core = ffi.new("struct passo_core *")
        assert c.passo_core_reset(self.core, ffi.new("struct passo_parameters *", asdict(parameters)))
        self.log = ffi.new("struct passo_pin_event[]", EVENTS)
        self.player = ffi.new(
            "struct player *",
            {"core": self.core, "advance": advance, "events": self.log, "capacity": EVENTS},
        )

    def play(self, segments: Sequence[Segment]) -> list[int]:
        """Play segments; return MISO at the end of each."""
        c_segments = self.ffi.new(
            "struct player_segment[]", [{"clocks": clocks, "inputs": inputs} for clocks, inputs in segments]
        )
        assert self.c.player_play(self.player, c_segments, len(segments)), (
            "an output changed in a quiet clock"
        )
        return [segment.spi_miso for segment in c_segments]

    def exchange(self, inputs: Any, shift: Any, clocks: int) -> None:
        """Go on with an exchange, by jumps."""
        assert self.c.player_exchange(self.player, inputs, shift, clocks), "an output changed in a jump"

    def events(self) -> bytes:
        """The pin events since the last call."""
        count, self.player.count = self.player.count, 0
        return bytes(self.ffi.buffer(self.log, count * self.ffi.sizeof("struct passo_pin_event")))

    def state(self) -> bytes:
        """The whole `struct passo_core`."""
        return bytes(self.ffi.buffer(self.core))


class PlayerPair:
    """An engine for passo.link that compares both models at random moments."""

    def __init__(self, parameters: Parameters, rng: random.Random):
        self.ffi, self.c = load()
        self.parameters = parameters
        self.rng = rng
        self.each = Player(parameters, advance=False)
        self.jump = Player(parameters, advance=True)
        self.events = 0
        self.compared = 0
        self.core_type = self.ffi.typeof("struct passo_core")
        self._inputs = {pin.name: pin.idle for pin in INPUTS}

    @property
    def clock(self) -> int:
        """Clocks since reset."""
        return self.each.player.clock

    @property
    def skipped(self) -> int:
        """Clocks that were jumped over."""
        return self.jump.player.skipped

    def transfer(self, mosi: Sequence[int], gap: int = 16) -> list[int]:
        """One chip select, SPI mode 0."""
        selected = self._inputs | {"spi_cs_n": 0}
        self._play([(4, selected)])
        reply = self._exchange(mosi, selected)
        self._play([(4, selected | {"spi_mosi": mosi[-1] & 1}), (gap, self._inputs)])
        return reply

    def _exchange(self, mosi: Sequence[int], selected: dict[str, int]) -> list[int]:
        """Words clock by clock, and as bits that are jumped over; compared at random clocks."""
        levels: list[Segment] = []  # one per clock
        for word in mosi:
            for bit in range(31, -1, -1):
                low = selected | {"spi_mosi": word >> bit & 1}
                levels += [(1, low)] * HALF_PERIOD + [(1, low | {"spi_sclk": 1})] * HALF_PERIOD
        sent, received = self.ffi.new("uint32_t[]", list(mosi)), self.ffi.new("uint32_t[]", len(mosi))
        fields = {"mosi": sent, "miso": received, "bits": 32 * len(mosi), "half_period": HALF_PERIOD}
        shift = self.ffi.new("struct passo_shift *", fields)
        inputs = self.ffi.new("struct passo_inputs *", selected)
        miso: list[int] = []
        while len(miso) < len(levels):
            begin = len(miso)
            clocks = min(self.rng.choice([1, 3, 20, 100, 1000]), len(levels) - begin)
            miso += self.each.play(levels[begin : begin + clocks])
            self.jump.exchange(inputs, shift, clocks)
            if self._differ():
                fields = list(differing(self.core_type, self.each.core[0], self.jump.core[0]))
                assert not fields, f"clocks {begin} to {shift.clock} of a frame: {'; '.join(fields[:12])}"
        sampled = miso[HALF_PERIOD - 1 :: 2 * HALF_PERIOD]
        words = [int("".join(map(str, sampled[i : i + 32])), 2) for i in range(0, len(sampled), 32)]
        assert list(received) == words
        return words

    def run(self, clocks: int) -> int:
        """Nothing at the pins for so long."""
        self._play([(clocks, self._inputs)])
        return clocks

    def set(self, pin: str, levels: int) -> None:
        """Set the levels of an input pin."""
        self._inputs = self._inputs | {pin: levels}

    def sync(self, level: bool) -> None:
        """Set the sync input."""
        self.set("sync", int(level))

    def _play(self, segments: list[Segment]) -> list[int]:
        """Play segments, cut at random places to compare there; return MISO at the end of each."""
        miso: list[int] = []
        batch: list[Segment] = []
        for segment in segments:
            clocks, inputs = segment
            if self.rng.random() < (0.02 if clocks < 100 else 0.9):
                first = self.rng.randint(0, clocks)
                self._both([*batch, (first, inputs)])
                miso += [m for m in self._last_miso[: len(batch)]]
                batch = [(clocks - first, inputs)]
            else:
                batch.append(segment)
        self._both(batch)
        return miso + self._last_miso

    def _both(self, segments: list[Segment]) -> None:
        before = self.each.state()
        clock = self.clock
        self._last_miso = self.each.play(segments)
        miso = self.jump.play(segments)
        if self._differ() or miso != self._last_miso:
            self._find_difference(before, clock, segments)

    def _differ(self) -> bool:
        """Compare the events since the last call, and the states."""
        events = self.each.events()
        self.events += len(events) // self.ffi.sizeof("struct passo_pin_event")
        self.compared += 1
        return self.jump.events() != events or self.each.state() != self.jump.state()

    def _find_difference(self, before: bytes, clock: int, segments: list[Segment]) -> None:
        """Play once more, each jump by itself, up to the first after which the models are not the same."""
        for player in (self.each, self.jump):
            self.ffi.buffer(player.core)[:] = before
        for clocks, levels in segments:
            inputs = self.ffi.new("struct passo_inputs *", levels)
            left = clocks
            while left:
                jump = self.c.passo_core_advance(self.jump.core, inputs, left)
                if not jump:
                    self.c.passo_core_clock(self.jump.core, inputs)
                for _ in range(jump or 1):
                    self.c.passo_core_clock(self.each.core, inputs)
                clock, left = clock + (jump or 1), left - (jump or 1)
                if self.each.state() != self.jump.state():
                    fields = list(differing(self.core_type, self.each.core[0], self.jump.core[0]))
                    # what lies between members does not count
                    assert not fields, f"clock {clock}, after a jump of {jump}: {'; '.join(fields[:12])}"


def differing(kind: Any, a: Any, b: Any, name: str = "core") -> Iterator[str]:
    """The members in which two structs differ."""
    if kind.kind == "struct":
        for member, field in kind.fields:
            yield from differing(field.type, getattr(a, member), getattr(b, member), f"{name}.{member}")
    elif kind.kind == "array":
        for i in range(kind.length):
            yield from differing(kind.item, a[i], b[i], f"{name}[{i}]")
    elif a != b:
        yield f"{name} is {a}, with advance {b}"
