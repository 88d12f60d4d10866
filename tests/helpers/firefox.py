# SPDX-License-Identifier: MIT
"""Firefox without a window, driven by its Marionette protocol: JSON on a socket."""

import json
import shutil
import socket
import subprocess
import time
from pathlib import Path
from typing import Any, Self

PROGRAM = "firefox-esr"
KEYS = {"Enter": "\ue007", "Escape": "\ue00c", "ArrowLeft": "\ue012", "ArrowRight": "\ue014"}
START = 60  # seconds
PREFERENCES = {"marionette.port": 0, "browser.shell.checkDefaultBrowser": False, "app.update.enabled": False}
ANSWER = (
    "const done = arguments[arguments.length - 1];"
    "(async () => eval(arguments[0]))().then(value => done({value}), error => done({error: `${error}`}))"
)


class Firefox:
    """One page, as tests/helpers/browser.py has it in Chromium."""

    def __init__(self, folder: Path):
        program = shutil.which(PROGRAM)
        assert program, "there is no Firefox: run 'tools/setup.sh browser'"
        folder.mkdir(parents=True, exist_ok=True)
        lines = [f"user_pref({json.dumps(key)}, {json.dumps(value)});" for key, value in PREFERENCES.items()]
        (folder / "user.js").write_text("\n".join(lines))
        self._process = subprocess.Popen(
            [program, "--headless", "--marionette", "--no-remote", "--profile", folder],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        self._number, self._waiting = 0, b""
        port, end = folder / "MarionetteActivePort", time.monotonic() + START
        while not (port.exists() and port.read_text()):
            assert time.monotonic() < end, "Firefox does not start"
            time.sleep(0.1)
        self._socket = socket.create_connection(("127.0.0.1", int(port.read_text())))
        self._read()  # its greeting
        self._call("WebDriver:NewSession", capabilities={})

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()
        self._process.kill()
        self._process.wait()

    def open(self, url: str, ready: str = "true", seconds: float = 60) -> None:
        """Open a page and wait until an expression holds in it."""
        self._call("WebDriver:Navigate", url=url)
        self.wait(ready, seconds)

    def wait(self, expression: str, seconds: float = 60) -> None:
        """Wait until an expression holds."""
        end = time.monotonic() + seconds
        while not self.value(f"!!({expression})"):
            assert time.monotonic() < end, f"{expression} does not become true"
            time.sleep(0.05)

    def value(self, expression: str) -> Any:
        """The value of an expression of JavaScript, as JSON has it; a promise is awaited."""
        script = f"window.eval({json.dumps(expression)})"
        answer = self._call("WebDriver:ExecuteAsyncScript", script=ANSWER, args=[script], sandbox=None)
        assert "error" not in answer["value"], answer["value"]
        return answer["value"].get("value")

    def press(self, key: str, ctrl: bool = False) -> None:
        """Press and release a key of KEYS, or a character, where the focus is, as a person does."""
        own = KEYS.get(key, key)
        keys = ["\ue009", own] if ctrl else [own]
        actions = [{"type": "keyDown", "value": own} for own in keys]
        actions += [{"type": "keyUp", "value": own} for own in reversed(keys)]
        self._call("WebDriver:PerformActions", actions=[{"type": "key", "id": "keys", "actions": actions}])

    def _call(self, method: str, **params: Any) -> Any:
        self._number += 1
        data = json.dumps([0, self._number, method, params]).encode()
        self._socket.sendall(f"{len(data)}:".encode() + data)
        _, _, error, result = self._read()
        assert error is None, error
        return result

    def _read(self) -> Any:
        while b":" not in self._waiting:
            self._more()
        length, self._waiting = self._waiting.split(b":", 1)
        while len(self._waiting) < int(length):
            self._more()
        data, self._waiting = self._waiting[: int(length)], self._waiting[int(length) :]
        return json.loads(data)

    def _more(self) -> None:
        more = self._socket.recv(1 << 16)
        assert more, "Firefox has ended"
        self._waiting += more
