# SPDX-License-Identifier: MIT
"""A headless browser, driven through a pair of pipes in the DevTools protocol."""

import base64
import json
import os
import shutil
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Self

PROGRAM = "chromium-headless-shell"
KEYS = {"Enter": (13, "\r"), "Escape": (27, ""), "ArrowLeft": (37, ""), "ArrowRight": (39, "")}  # code, text


@dataclass
class Tasks:
    """Seconds of the processor: each task of the main thread of a page, and all of all its threads."""

    main: list[float] = field(default_factory=list)
    seconds: float = 0


class Browser:
    """One page of a browser; `errors` are what its console said of failures."""

    def __init__(self, folder: Path, width: int = 1400, height: int = 1000, dark: bool = False):
        program = shutil.which(PROGRAM)
        assert program, "there is no browser: run 'tools/setup.sh browser'"
        (command_in, self._out), (self._in, command_out) = os.pipe(), os.pipe()
        options = (
            *("--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--remote-debugging-pipe"),
            *(f"--user-data-dir={folder}", f"--window-size={width},{height}", "about:blank"),
        )
        # The browser reads from 3 and writes to 4.
        self._process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{command_in} 4>&{command_out}', "bash", program, *options],
            pass_fds=(command_in, command_out),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(command_in)
        os.close(command_out)
        self._number, self._waiting = 0, b""
        self.errors: list[str] = []
        self._events: list[Any] | None = None  # of a trace; the last one is None
        target = self._call("Target.createTarget", url="about:blank", session=None)["targetId"]
        self._session = None
        self._session = self._call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self._call(f"{domain}.enable")
        if dark:
            dark_colors = {"name": "prefers-color-scheme", "value": "dark"}
            self._call("Emulation.setEmulatedMedia", features=[dark_colors])

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()
        os.close(self._in)
        os.close(self._out)

    def open(self, url: str, ready: str = "true", seconds: float = 60) -> None:
        """Open a page and wait until an expression holds in it."""
        self._call("Page.navigate", url=url)
        self.wait(ready, seconds)

    def wait(self, expression: str, seconds: float = 60) -> None:
        """Wait until an expression holds."""
        end = time.monotonic() + seconds
        while not self.value(f"document.readyState === 'complete' && !!({expression})"):
            assert time.monotonic() < end, f"{expression} does not become true: {self.errors}"
            time.sleep(0.05)

    def value(self, expression: str) -> Any:
        """The value of an expression of JavaScript, as JSON has it; a promise is awaited."""
        answer = self._call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def _box(self, selector: str) -> list[float]:
        """Left, top, width and height of an element, which is scrolled into view."""
        box: list[float] = self.value(
            f"(() => {{ const e = document.querySelector({json.dumps(selector)});"
            "e.scrollIntoView({block: 'center'}); const b = e.getBoundingClientRect();"
            "return [b.left, b.top, b.width, b.height]; })()"
        )
        return box

    def drag(self, selector: str, begin: float, end: float) -> None:
        """Drag the mouse over an element, between two parts of its width."""
        left, top, width, height = self._box(selector)
        for kind, part in (
            ("mouseMoved", begin),
            ("mousePressed", begin),
            ("mouseMoved", end),
            ("mouseReleased", end),
        ):
            self._call(
                "Input.dispatchMouseEvent",
                type=kind, x=left + part * width, y=top + height / 2, clickCount=1,
                button="none" if kind == "mouseMoved" and part == begin else "left", buttons=1,
            )  # fmt: skip

    def press(self, key: str, ctrl: bool = False) -> None:
        """Press and release a key of KEYS, or a character, where the focus is, as a person does."""
        code, text = KEYS.get(key, (ord(key[0]), key))
        for kind in ("keyDown", "keyUp"):
            self._call(
                "Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, text=text,
                modifiers=2 if ctrl else 0,
            )  # fmt: skip

    def touch(self, selector: str, *moments: list[float]) -> None:
        """Touch an element with fingers; where they are at each moment, as parts of its width."""
        left, top, width, height = self._box(selector)
        for number, fingers in enumerate(moments):
            points = [
                {"x": left + part * width, "y": top + height / 2, "id": finger}
                for finger, part in enumerate(fingers)
            ]
            kind = "touchMove" if number else "touchStart"
            self._call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
        self._call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    @contextmanager
    def tasks(self) -> Iterator[Tasks]:
        """What tasks the page has; complete at the end."""
        found = Tasks()
        self._events = []
        self._call(
            "Tracing.start", traceConfig={"includedCategories": ["disabled-by-default-devtools.timeline"]}
        )
        yield found
        self._call("Tracing.end")
        while self._events[-1:] != [None]:
            self._note(self._read())
        events, self._events = [event for event in self._events if event], None
        main = {
            (event["pid"], event["tid"])
            for event in events
            if event["name"] == "thread_name" and event["args"]["name"] == "CrRendererMain"
        }
        for event in events:
            if event["name"] == "RunTask" and event["pid"] in {pid for pid, _ in main}:
                seconds = event.get("tdur", 0) / 1e6
                found.seconds += seconds
                if (event["pid"], event["tid"]) in main:
                    found.main.append(seconds)

    def picture(self, path: Path) -> None:
        """Write what is visible to a PNG."""
        path.write_bytes(base64.b64decode(self._call("Page.captureScreenshot", format="png")["data"]))

    def _call(self, method: str, session: str | None = "", **params: Any) -> dict[str, Any]:
        self._number += 1
        message = {"id": self._number, "method": method, "params": params}
        if session == "" and self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._read()
            if answer.get("id") == self._number:
                assert "error" not in answer, answer
                return answer["result"]
            self._note(answer)

    def _note(self, event: dict[str, Any]) -> None:
        params = event.get("params", {})
        if self._events is not None and event.get("method") == "Tracing.dataCollected":
            self._events += params["value"]
        elif self._events is not None and event.get("method") == "Tracing.tracingComplete":
            self._events.append(None)
        elif event.get("method") == "Runtime.exceptionThrown":
            details = params["exceptionDetails"]
            self.errors.append(details.get("exception", {}).get("description", details["text"]))
        elif event.get("method") == "Log.entryAdded" and params["entry"]["level"] == "error":
            self.errors.append(params["entry"]["text"])

    def _read(self) -> dict[str, Any]:
        while b"\0" not in self._waiting:
            more = os.read(self._in, 1 << 16)
            assert more, "the browser has ended"
            self._waiting += more
        message, self._waiting = self._waiting.split(b"\0", 1)
        return json.loads(message)
