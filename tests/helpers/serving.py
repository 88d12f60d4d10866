# SPDX-License-Identifier: MIT
"""A simulated core at a socket, served by a thread of the test."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from passo.serve import Server


@contextmanager
def serving(engine: Any, path: Path, **options: bool) -> Iterator[Server]:
    """The server, until the end of the block."""
    ended = threading.Event()
    with Server(engine, path, **options) as server:
        thread = threading.Thread(target=server.serve, args=(ended.is_set,))
        thread.start()
        try:
            yield server
        finally:
            ended.set()
            thread.join()
