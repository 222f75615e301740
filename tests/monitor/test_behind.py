# SPDX-License-Identifier: MIT
"""Rule: the page works behind a proxy, under https and in a folder; it shows within 2 s that nothing comes any more,
whoever is silent, and comes back by itself; ages are by the server's clock, whatever the browser's says."""

from __future__ import annotations

import os
import signal
import statistics
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from page_browser import Browser, Monitor
from proxy import Proxy

SILENT_MS = 2000
BUSY_MS = 4000
"""What a busy host may take besides: the browser shares its cores with the robot."""
LATENCY_MS = 1000
PATH = "/robots/one/"


class Behind:
    """A page behind a proxy, and the processes that may fall silent."""

    def __init__(self, folder: Path) -> None:
        self.proxy = Proxy(folder, PATH)
        words = ["--sim", "--world", "hall", "--port", "0", "--allow-origin", self.proxy.origin]
        self.monitor = Monitor(words, folder)
        self.proxy.backend = self.monitor.port
        self.url = f"{self.proxy.origin}{PATH}#{self.monitor.url.split('#')[1]}"

    @property
    def argusd(self) -> int:
        """The process of the argusd that the monitor started."""
        children = Path(
            f"/proc/{self.monitor.process.pid}/task/{self.monitor.process.pid}/children"
        ).read_text()
        (found,) = (
            pid for pid in children.split() if Path(f"/proc/{pid}/comm").read_text().strip() == "argusd"
        )
        return int(found)

    def close(self) -> None:
        self.monitor.end()
        self.proxy.close()


@pytest.fixture(scope="module")
def behind(_able: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Behind]:
    made = Behind(tmp_path_factory.mktemp("behind"))
    yield made
    made.close()


@pytest.fixture(scope="module")
def visitor(_able: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A browser that takes the proxy's certificate."""
    made = Browser(tmp_path_factory.mktemp("visitor"), "--ignore-certificate-errors")
    yield made
    made.close()


def test_under_https_and_in_a_folder(behind: Behind, visitor: Browser) -> None:
    visitor.open(behind.url)
    visitor.complaints()
    assert visitor.driver.current_url == f"{behind.proxy.origin}{PATH}"
    assert visitor.js("return isSecureContext && location.protocol") == "https:"
    assert all(path.startswith(PATH) for path in behind.proxy.seen if path != "/favicon.ico"), (
        behind.proxy.seen
    )
    visitor.wait("readings come", lambda: visitor.known("readings.sip"))
    visitor.wait("it may be driven", lambda: visitor.known("state.mode") == "IDLE")
    visitor.click("control")
    visitor.wait("it is in control", lambda: visitor.text("control") == "In control")
    assert visitor.complaints() == []


def test_another_name_gets_nothing(behind: Behind, visitor: Browser) -> None:
    # The name is this machine's own, but nobody allowed the origin that it makes with https.
    visitor.driver.get(f"https://127.0.0.1:{behind.proxy.port}{PATH}")
    found = visitor.driver.execute_async_script(
        "const done = arguments[arguments.length - 1];"
        "const socket = new WebSocket(new URL('live', document.baseURI.replace('https', 'wss')));"
        "socket.onopen = () => done('open'); socket.onerror = () => done('refused');"
    )
    assert found == "refused"
    assert visitor.text("link") != "live"


def freeze(pid: int) -> Callable[[bool], None]:
    return lambda on: os.kill(pid, signal.SIGSTOP if on else signal.SIGCONT)


SILENCES: dict[str, tuple[Callable[[Behind], Callable[[bool], None]], str]] = {
    "the connection carries nothing": (
        lambda one: lambda on: one.proxy.carry(not on),
        "argus-monitor is away",
    ),
    "argus-monitor hangs": (lambda one: freeze(one.monitor.process.pid), "argus-monitor is away"),
    "argusd hangs": (lambda one: freeze(one.argusd), "argusd reports nothing"),
}


@pytest.mark.parametrize("who", sorted(SILENCES))
def test_silence_is_seen_in_time_and_the_page_comes_back(behind: Behind, visitor: Browser, who: str) -> None:
    make, words = SILENCES[who]
    visitor.open(behind.url)
    visitor.wait("readings come", lambda: visitor.known("readings.sip"))
    silence = make(behind)
    # The page itself notes when it is told for the last time, and when it shows that.
    visitor.js(
        "window.heard = performance.now(); const put = argusMonitor.stage.drawn; window.seen = null;"
        "new MutationObserver(() => { window.seen ??= performance.now(); })"
        ".observe(document.body, { attributes: true, attributeFilter: ['class'] });"
    )
    silence(True)
    begin = time.monotonic()
    try:
        visitor.wait("it is greyed", lambda: visitor.js("return document.body.classList.contains('stale')"))
        took_ms = visitor.js("return window.seen - window.heard")
        print(f"{who}: shown after {took_ms:.0f} ms ({time.monotonic() - begin:.1f} s)")
        assert took_ms < SILENT_MS + BUSY_MS
        visitor.wait("it says why", lambda: words in visitor.text("link"))
        assert visitor.text("failure") == "Not connected"
        assert visitor.text("stage-text") == "Nothing comes any more: this is of earlier."
        grey = "return getComputedStyle(document.getElementById(arguments[0])).filter"
        for name in ("stage", "sonars", "sonars-count", "chosen-text", "plan", "figures"):
            assert visitor.js(grey, name) == "grayscale(1)", name
    finally:
        silence(False)
    visitor.wait("it is back", lambda: visitor.text("link") == "live")
    visitor.wait("it is not grey", lambda: not visitor.js("return document.body.classList.contains('stale')"))


def test_a_connection_that_breaks_is_made_again(behind: Behind, visitor: Browser) -> None:
    visitor.open(behind.url)
    lives = behind.proxy.seen.count(f"{PATH}live")
    behind.proxy.cut()
    visitor.wait("another is made", lambda: behind.proxy.seen.count(f"{PATH}live") > lives)
    visitor.wait("it is back", lambda: visitor.text("link") == "live")


@pytest.mark.parametrize("off_s", [3600, -3600, 86_400 * 400], ids=["ahead", "behind", "a year ahead"])
def test_a_browser_whose_clock_is_off_tells_ages_right(behind: Behind, visitor: Browser, off_s: int) -> None:
    script = (
        f"{{ const Real = Date, off = {off_s * 1000};"
        "globalThis.Date = class extends Real {"
        "constructor(...given) { super(...(given.length ? given : [Real.now() + off])); }"
        "static now() { return Real.now() + off; } }; }"
    )
    command: dict[str, Any] = visitor.driver.execute_cdp_cmd(
        "Page.addScriptToEvaluateOnNewDocument", {"source": script}
    )
    try:
        visitor.open(behind.url)
        assert abs(visitor.js("return Date.now()") / 1000 - time.time() - off_s) < 60
        visitor.wait(
            "readings are timed", lambda: len(visitor.js("return argusMonitor.latencies") or ()) > 20
        )
        latencies: list[float] = visitor.js("return argusMonitor.latencies")
        assert -50 < statistics.median(latencies) < LATENCY_MS
        shown = visitor.js("return document.getElementById('figures').textContent")
        assert "SIP to screen" in shown
    finally:
        visitor.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", command)
