# SPDX-License-Identifier: MIT
"""Synchronous code in a cocotb test: it runs in a thread and waits for coroutines."""

import queue
import threading
from asyncio import CancelledError
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

Result = TypeVar("Result")


class Thread:
    """Runs plain code, which can wait for coroutines of the test."""

    def __init__(self) -> None:
        self._requests: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._answers: queue.SimpleQueue[tuple[Any, BaseException | None]] = queue.SimpleQueue()

    def wait(self, coroutine: Coroutine[Any, Any, Result]) -> Result:
        """In the plain code: wait for a coroutine."""
        self._requests.put(coroutine)
        result, error = self._answers.get()
        if error is not None:
            raise error
        return result

    async def run(self, body: Callable[[], None]) -> None:
        """In the test: run the plain code; the simulator runs only while it waits."""

        def main() -> None:
            try:
                body()
                self._requests.put(None)
            except BaseException as error:  # whatever it is, the test has to fail
                self._requests.put(error)

        threading.Thread(target=main, daemon=True).start()
        while (request := self._requests.get()) is not None:
            if isinstance(request, BaseException):
                raise request
            try:
                self._answers.put((await request, None))
            except CancelledError as error:  # the test is over
                self._answers.put((None, error))
                raise
            except Exception as error:
                self._answers.put((None, error))
