# SPDX-License-Identifier: MIT
"""A sender that others wrote, grbl-streamer, at a pseudo-terminal."""

import logging
import threading
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

from grbl_streamer import GrblStreamer

PATIENCE = 30  # seconds


class Sender:
    """The sender and the answers it has received."""

    def __init__(self, link: Path, patience: float = PATIENCE) -> None:
        self.patience = patience
        logging.getLogger("GrblStreamer").setLevel(logging.CRITICAL)
        self.events: Counter[str] = Counter()
        self.last: dict[str, tuple[Any, ...]] = {}
        self.grbl = GrblStreamer(self._told)
        self._one_thread_streams()
        self.grbl.cnect(str(link), 115200)

    def _one_thread_streams(self) -> None:
        """Lock what `job_run` and the thread of the reader both call: without, a line may be sent twice."""
        stream, lock = self.grbl._stream, threading.Lock()

        def locked() -> None:
            with lock:
                stream()

        self.grbl._stream = locked

    def _told(self, event: str, *data: Any) -> None:
        self.events[event] += 1
        self.last[event] = data

    def wait(self, event: str) -> tuple[Any, ...]:
        """Wait for an event; return what came with it."""
        self.until(lambda: self.events[event])
        return self.last[event]

    def start(self, lines: list[str], incremental: bool = False) -> None:
        """Run a job."""
        self.events.clear()
        self.grbl.job_new()
        self.grbl.incremental_streaming = incremental
        self.grbl.write("\n".join(lines))
        self.grbl.job_run()

    def boot(self) -> None:
        """Wait until the reset of the connection is over, and all that the sender asks after it is answered.

        An answer that comes later would count as that of a line of the job.
        """
        self.wait("on_boot")
        self.grbl.poll_interval = 0.05
        self.grbl.poll_start()
        self.wait("on_standstill")  # after some reports: at the first one it asks for modes again
        # one of these events comes with the greeting, and one with each answer
        self.until(lambda: self.events["on_rx_buffer_percent"] == 1 + self.events["on_write"])

    def finish(self) -> None:
        """Wait for the end of the job and of its motion."""
        self.wait("on_job_completed")
        self.wait_for_state("Idle")

    def until(self, condition: Callable[[], object]) -> None:
        """Wait for a condition."""
        end = time.monotonic() + self.patience
        while not condition():
            assert time.monotonic() < end, (self.grbl.cmode, self.events, self.last)
            time.sleep(0.01)

    def wait_for_state(self, state: str) -> None:
        """Wait for a report with this state, and for its position: the sender stores one after the other.

        Twice, since a message of an alarm tells the state alone.
        """
        for _ in range(2):
            self.last.pop("on_stateupdate", None)
            self.until(lambda: self._reported() == state)

    def _reported(self) -> str | None:
        self.grbl.poll_start()  # to see the next report even if it is the same
        return self.last.get("on_stateupdate", (None,))[0]
