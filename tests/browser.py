"""A browser without a window, for tests of exported pages: Chromium, driven through two pipes."""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, Self

__all__ = ["CHROMIUM", "Browser"]

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
"""Where the browser is, if there is one."""
_FLAGS = (
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-extensions",
    "--no-proxy-server", "--host-resolver-rules=MAP * ~NOTFOUND", "--remote-debugging-pipe",
)  # fmt: skip
_PATIENCE_S = 60.0
_CROWDED = """(() => {
  const shown = [...document.querySelectorAll("button, select, label, legend, dt, dd, h1, h2, h3, th, td, p")]
    .filter(one => one.offsetParent).map(one => [one, one.getBoundingClientRect()]);
  const cut = shown.filter(([one]) => one.clientWidth && one.scrollWidth > one.clientWidth + 1);
  const upon = shown.filter(([one, a]) => shown.some(([two, b]) =>
    !one.contains(two) && !two.contains(one) && a.left < b.right - 1 && b.left < a.right - 1
    && a.top < b.bottom - 1 && b.top < a.bottom - 1));
  return [...cut, ...upon].map(([one]) => one.outerHTML);
})()"""
"""The texts of a page that are cut, or lie upon others."""
_CODES = {"Tab": 9, "Enter": 13, " ": 32, "End": 35, "ArrowUp": 38, "ArrowDown": 40}
"""Keys that act only by their codes."""


class Browser:
    """One page of a browser of its own, in a ``with`` block.

    Attributes
    ----------
    requests : list of str
        Every address that was loaded or tried.
    complaints : list of str
        Everything that pages wrote to the console, and every uncaught error.
    """

    def __init__(self) -> None:
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self._number = 0
        self._session = ""
        self._waiting = b""

    def __enter__(self) -> Self:
        import fcntl  # which Windows has not

        assert CHROMIUM is not None
        self._folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        read_by_it, self._write = os.pipe()
        self._read, written_by_it = os.pipe()
        command = [CHROMIUM, *_FLAGS, f"--user-data-dir={self._folder.name}", "about:blank"]
        # The browser reads from 3 and writes to 4; neither may be a pipe's number here.
        ends = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (read_by_it, written_by_it)]
        script = f'exec 3<&{ends[0]} 4>&{ends[1]}; exec "$@"'
        self._program = subprocess.Popen(
            ["bash", "-c", script, "browser", *command],
            pass_fds=ends, stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
        )  # fmt: skip
        for end in (read_by_it, written_by_it, *ends):
            os.close(end)
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(target for target in targets if target["type"] == "page")
        attached = self.call("Target.attachToTarget", targetId=page["targetId"], flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Network", "Log"):
            self.call(f"{domain}.enable")
        return self

    def __exit__(self, *error: object) -> None:
        self._program.kill()
        self._program.wait()
        os.close(self._write)
        os.close(self._read)
        self._folder.cleanup()

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method of the browser, and return its result."""
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while (answer := self._next()).get("id") != self._number:
            self._note(answer)
        assert "error" not in answer, (method, answer)
        result: dict[str, Any] = answer["result"]
        return result

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._waiting:
            more = os.read(self._read, 1 << 20)
            assert more, "the browser is gone"
            self._waiting += more
        message, self._waiting = self._waiting.split(b"\0", 1)
        read: dict[str, Any] = json.loads(message)
        return read

    def _note(self, event: dict[str, Any]) -> None:
        found = event.get("params", {})
        match event.get("method"):
            case "Network.requestWillBeSent":
                self.requests.append(found["request"]["url"])
            case "Runtime.exceptionThrown":
                details = found["exceptionDetails"]
                self.complaints.append(details.get("exception", {}).get("description", details["text"]))
            case "Runtime.consoleAPICalled":
                self.complaints.append(str(found["args"]))
            case "Log.entryAdded":
                self.complaints.append(found["entry"]["text"])

    def open(
        self, path: Path, *, width: int = 1280, height: int = 720, dark: bool = True, still: bool = False
    ) -> None:
        """Load a file into a window of so many pixels, and wait until its player is there.

        ``still`` is for the user's wish that nothing moves by itself.
        """
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width, height=height, deviceScaleFactor=1 if width > 500 else 2, mobile=width < 500,
        )  # fmt: skip
        wishes = {
            "prefers-color-scheme": "dark" if dark else "light",
            "prefers-reduced-motion": "reduce" if still else "no-preference",
        }
        features = [{"name": name, "value": value} for name, value in wishes.items()]
        self.call("Emulation.setEmulatedMedia", features=features)
        self.call("Page.navigate", url=path.as_uri())
        self.until("document.readyState === 'complete' && 'player' in window")

    def value(self, expression: str) -> Any:
        """Return what an expression of JavaScript is."""
        found = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def until(self, expression: str) -> None:
        """Wait until an expression is true: a busy machine is late, not wrong."""
        self._wait(lambda: bool(self.value(expression)), expression)

    def _wait(self, seen: Callable[[], bool], what: str) -> None:
        deadline = time.monotonic() + _PATIENCE_S
        while not seen():
            assert time.monotonic() < deadline, (what, self.complaints)
            time.sleep(0.05)

    def key(self, key: str, *, shift: bool = False) -> None:
        """Press a key and let it go."""
        for kind in ("keyDown", "keyUp"):
            letter = "\r" if key == "Enter" else key
            more: dict[str, Any] = {"text": letter} if kind == "keyDown" and len(letter) == 1 else {}
            if key in _CODES:
                more |= {"windowsVirtualKeyCode": _CODES[key], "code": key.replace(" ", "Space")}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, modifiers=8 if shift else 0, **more)

    def tab_to(self, expression: str) -> None:
        """Press Tab until an expression is true of ``it``, the element that has the focus."""
        for _ in range(200):
            self.key("Tab")
            if self.value(f"(it => {expression})(document.activeElement)"):
                return
        raise AssertionError(f"the focus never comes to {expression}")

    def click(self, x: float, y: float) -> None:
        """Press the left mouse button at a place of the page [px], and let it go."""
        for kind in ("mousePressed", "mouseReleased"):
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def crowded(self) -> list[str]:
        """Return what of the page's texts is cut or lies upon others, as HTML."""
        found: list[str] = self.value(_CROWDED)
        return found

    def picture(self, *, whole: bool = False) -> bytes:
        """Return what is seen, or the whole page, as PNG."""
        taken = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        return base64.b64decode(taken["data"])
