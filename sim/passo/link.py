# SPDX-License-Identifier: MIT
"""The host's end of the SPI link: sequence numbers, replies and retries."""

from collections.abc import Callable, Sequence

from passo import frame
from passo.engine import Engine, PairEngine
from passo.registers import Verdict

# The gap after a frame is the time the core needs to execute it.
GAP = 64
TRIES = 4


class LinkError(Exception):
    """The link failed for good."""


class RefusedError(LinkError):
    """The core refused a frame; `verdict` says why."""

    def __init__(self, verdict: Verdict, what: str):
        self.verdict = verdict
        super().__init__(f"{what} was refused: {verdict.name}: {verdict.description}")


class Link:
    """Frames that are executed exactly once, or an exception."""

    def __init__(self, engine: Engine | PairEngine, tries: int = TRIES):
        self.engine = engine
        self.tries = tries
        self.retries = 0
        self.status = 0
        self._sequence = 0
        # A write with the sequence number that was accepted last would pass for a duplicate.
        self.read(0, 1)
        self._sequence = (self.status >> 16) + 1 & 0xFF

    def write(self, address: int, *words: int) -> None:
        """Write consecutive registers."""
        mosi = frame.write_frame(self._next(), address, words)
        self._send(mosi, frame.write_verdict, f"write to 0x{address:03X}")

    def push(self, address: int, words: Sequence[int]) -> None:
        """Write all words to one register."""
        mosi = frame.push_frame(self._next(), address, words)
        self._send(mosi, frame.write_verdict, f"push to 0x{address:03X}")

    def read(self, address: int, length: int) -> list[int]:
        """Read consecutive registers."""
        mosi = frame.read_frame(self._next(), address, length)
        miso = self._send(mosi, frame.read_verdict, f"read of 0x{address:03X}")
        return miso[frame.DATA : frame.DATA + length]

    def _next(self) -> int:
        sequence = self._sequence
        self._sequence = sequence + 1 & 0xFF
        return sequence

    def _send(
        self, mosi: list[int], judge: Callable[[Sequence[int], Sequence[int]], Verdict], what: str
    ) -> list[int]:
        """Send until the reply is clear. The sequence number keeps a frame from being executed twice."""
        problem = ""
        for attempt in range(self.tries):
            self.retries += attempt > 0
            miso = self.engine.transfer(mosi, GAP)
            try:
                verdict = judge(mosi, miso)
            except frame.FrameError as error:
                problem = str(error)
                continue
            self.status = miso[0]
            if verdict in (Verdict.OK, Verdict.DUPLICATE):
                return miso
            if verdict != Verdict.BAD_CRC:
                raise RefusedError(verdict, what)
            problem = verdict.description
        raise LinkError(f"{what} failed {self.tries} times: {problem}")
