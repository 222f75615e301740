# SPDX-License-Identifier: MIT
"""A real Chromium without a screen, and argus-monitor as a process, for the tests of the page."""

from __future__ import annotations

import os
import selectors
import shutil
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final, TypeVar

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

ROOT: Final = Path(__file__).resolve().parents[2]
BIN: Final = ROOT / ".venv/bin"
PROGRAMS: Final = ("chromium", "chromedriver")
FLAGS: Final = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
# A guard against what hangs, not a rule: a busy host needs long for a browser.
PATIENCE_S: Final = 90.0
T = TypeVar("T")


def missing() -> str:
    """Name what of the browser is not installed."""
    return ", ".join(name for name in PROGRAMS if shutil.which(name) is None)


def wait_for(what: str, probe: Callable[[], T], within_s: float = PATIENCE_S) -> T:
    """Poll until PROBE is true and return its value."""
    until = time.monotonic() + within_s
    while not (value := probe()):
        if time.monotonic() > until:
            raise AssertionError(f"not within {within_s:g} s: {what}")
        time.sleep(0.05)
    return value


class Monitor:
    """A running argus-monitor; `url` is what it printed."""

    def __init__(self, arguments: Sequence[str], folder: Path, *, program: str = "argus-monitor") -> None:
        self.folder = folder
        self.log = folder / f"{program}.log"
        self.command = [str(BIN / program), *arguments]
        with self.log.open("ab") as errors:
            self.process = subprocess.Popen(
                self.command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=errors,
                cwd=folder,
                env={**os.environ, "TMPDIR": str(folder), "PYTHONPATH": f"{ROOT}:{ROOT / 'tools'}"},
            )
        self.url = self._first_line()

    def _first_line(self) -> str:
        assert self.process.stdout is not None
        with selectors.DefaultSelector() as ready:
            ready.register(self.process.stdout, selectors.EVENT_READ)
            if not ready.select(PATIENCE_S):
                self.end()
                raise AssertionError(f"it printed no address: {self.log.read_text()}")
        line = self.process.stdout.readline().decode().strip()
        assert line.startswith("http://127.0.0.1:"), f"'{line}': {self.log.read_text()}"
        return line

    @property
    def port(self) -> int:
        """The port of the page."""
        return int(self.url.split(":")[2].split("/")[0])

    @property
    def control(self) -> Path:
        """The control socket of the argusd that it started."""
        (found,) = self.folder.glob("argus-monitor-*/control")
        return found

    def end(self) -> int:
        """End it as Ctrl-C does; return its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise


class Browser:
    """One Chromium with the page in it."""

    def __init__(self, profile: Path, *flags: str) -> None:
        options = webdriver.ChromeOptions()
        for flag in (*FLAGS, *flags, f"--user-data-dir={profile}"):
            options.add_argument(flag)
        options.binary_location = str(shutil.which("chromium"))
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options, Service(shutil.which("chromedriver")))
        self.size(1280, 860)

    def open(self, url: str, dark: bool = False) -> None:
        """Open the page and wait until it shows a robot."""
        self.dark(dark)
        self.driver.get("about:blank")
        self.driver.get(url)
        self.wait("the robot is live", lambda: self.text("link") == "live")

    def size(self, width: int, height: int) -> None:
        """Give the page a size, however small."""
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)

    def dark(self, dark: bool) -> None:
        """Let the system wish for dark or light."""
        wish = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [wish]})

    def js(self, script: str, *arguments: Any) -> Any:
        """Run a script in the page."""
        return self.driver.execute_script(script, *arguments)

    def known(self, path: str) -> Any:
        """What the page knows, such as `state.mode`."""
        return self.js(f"return window.argusMonitor?.known?.{path.replace('.', '?.')} ?? null")

    def text(self, name: str) -> str:
        """The text of the element with an id."""
        return str(self.js(f"return document.getElementById('{name}')?.textContent.trim() ?? ''"))

    def row(self, sonar: int) -> str:
        """What the list says of a sonar."""
        return str(self.js(f"return document.querySelector('[data-k=\"{sonar}\"] .what')?.textContent ?? ''"))

    def wait(self, what: str, probe: Callable[[], T], within_s: float = PATIENCE_S) -> T:
        """Wait; tell what the page showed when it was in vain."""
        try:
            return wait_for(what, probe, within_s)
        except AssertionError as error:
            shown = self.driver.find_element(By.TAG_NAME, "body").text
            raise AssertionError(f"{error}\nthe page showed:\n{shown}") from None

    def click(self, name: str) -> None:
        """Click the element with an id as a mouse does."""
        self.driver.find_element(By.ID, name).click()

    def when(self, condition: str, action: str) -> bool:
        """Do something in the page as soon as something is so there: nearer in time than a driver can be."""
        self.driver.set_script_timeout(PATIENCE_S)
        script = (
            "const done = arguments[arguments.length - 1];"
            f"const look = () => {{ if ({condition}) {{ {action}; done(true); }} else setTimeout(look, 10); }};"
            "look();"
        )
        return bool(self.driver.execute_async_script(script))

    def point(self, x: float, y: float) -> None:
        """Click a place of the page with the mouse."""
        action = ActionBuilder(self.driver)
        action.pointer_action.move_to_location(round(x), round(y)).click()  # type: ignore[no-untyped-call]
        action.perform()

    def point_sonar(self, sonar: int) -> None:
        """Click a sonar on the picture."""
        at = self.js(
            "const { eyes, box: stage } = argusMonitor.stage, at = eyes.get(arguments[0]);"
            "const box = stage.getBoundingClientRect();"
            "return at && [box.x + box.width / 2 + at[0], box.y + box.height / 2 + at[1]]",
            sonar,
        )
        self.point(*at)

    def keys(self, *keys: str) -> None:
        """Press keys where the focus is."""
        for key in keys:
            self.driver.switch_to.active_element.send_keys(key)

    def focus_stage(self) -> None:
        """Put the focus on the picture."""
        self.js("document.getElementById('stage').focus()")

    def complaints(self) -> list[str]:
        """What the console has complained of since the last call."""
        said = self.driver.get_log("browser")  # type: ignore[no-untyped-call]
        return [entry["message"] for entry in said if entry["level"] == "SEVERE"]

    def close(self) -> None:
        """End the browser."""
        self.driver.quit()


__all__ = ["BIN", "ROOT", "Browser", "By", "Keys", "Monitor", "missing", "wait_for"]
