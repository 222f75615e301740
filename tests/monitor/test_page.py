# SPDX-License-Identifier: MIT
"""Rule: what happens to the robot is on the page, and what is done on the page happens to the robot."""

from __future__ import annotations

import http.server
import math
import re
import statistics
import threading
from collections.abc import Sequence
from pathlib import Path

import pytest
from page_browser import Browser, By, Keys, Monitor, wait_for

ARRIVED_MM = 80.0
"""A goal counts as reached within 60 mm; a robot that brakes rolls a little."""
LATENCY_MS = 150.0
"""From the SIP to the screen, in the median: a test host is busy. tests/bench/monitor.py asks it of each one."""


def test_the_page_shows_the_robot_and_its_console_is_silent(page: Browser) -> None:
    assert page.driver.title == "Argus monitor"
    assert page.text("failure") not in ("", "Not connected")
    page.wait("all sonars are in use", lambda: page.text("sonars-count") == "16 of 16 in use")
    assert len(page.driver.find_elements(By.CSS_SELECTOR, ".sonar-row")) == 16
    assert page.js("return argusMonitor.stage.eyes.size") == 16
    page.wait("echoes are drawn", lambda: page.js("return argusMonitor.stage.echoes.length") > 3)
    assert len(page.driver.find_elements(By.CSS_SELECTOR, "#robot .beam")) == 16
    figures = page.text("figures")
    assert "Battery12." in figures
    page.wait("SIPs are counted", lambda: page.known("state.sips") > 20)
    assert page.complaints() == []


def test_every_control_has_a_tooltip(page: Browser) -> None:
    page.wait("the list is there", lambda: page.driver.find_elements(By.CSS_SELECTOR, ".sonar-row"))
    controls = page.js(
        "return [...document.querySelectorAll('button, input, select')].map((e) => [e.outerHTML, e.title])"
    )
    assert len(controls) > 35
    assert [html for html, title in controls if not title] == []


def test_values_of_events_have_units_or_names(page: Browser) -> None:
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    page.focus_stage()
    page.keys(Keys.ARROW_LEFT)
    page.wait(
        "an angle is shown in degrees", lambda: re.search(r"stopped -?\d+\.\d\d deg", page.text("events"))
    )
    page.wait("an order by its name", lambda: "operatoroperator TURN" in page.text("events"))


# Labels by the picture's own boxes, so that also a later change of font or place is seen.
OVERLAPS = """
const boxes = [...document.querySelectorAll('#robot .reading, #robot .deg, .headline p, .zoom button')]
  .map((e) => [e.textContent, e.getBoundingClientRect()]);
const stage = document.getElementById('stage').getBoundingClientRect();
const found = [];
boxes.forEach(([one, a], i) => {
  if (a.left < stage.left || a.right > stage.right) found.push([one, 'outside']);
  for (const [other, b] of boxes.slice(i + 1)) {
    const apart = a.right <= b.left + 2 || b.right <= a.left + 2 || a.bottom <= b.top + 4 || b.bottom <= a.top + 4;
    if (!apart && /^[+−]?[0-9.]+°?$/.test(one) && !/Sonar/.test(other)) found.push([one, other]);
  }
});
return [boxes.length, found];
"""


@pytest.mark.parametrize("dark", [True, False], ids=["dark", "light"])
def test_no_range_lies_on_another_on_a_phone(page: Browser, dark: bool) -> None:
    page.size(360, 740)
    page.dark(dark)
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    page.focus_stage()
    seen = 0
    for _ in range(6):  # other bearings, other ranges, other neighbours
        shown, found = page.js(OVERLAPS)
        assert found == []
        seen = max(seen, shown)
        heading = page.known("state.heading_cdeg")
        page.keys(Keys.ARROW_LEFT)
        page.wait("it turns", lambda: page.known("state.heading_cdeg") != heading)  # noqa: B023
        page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    assert seen > 8, "there are ranges on the picture"
    assert page.js("return document.documentElement.scrollWidth - innerWidth") <= 0


def test_the_token_leaves_the_address_and_survives_a_reload(page: Browser, monitor: Monitor) -> None:
    assert page.driver.current_url == monitor.url.split("#")[0]
    page.driver.refresh()
    page.wait("live again", lambda: page.text("link") == "live")


def distance_to(page: Browser, goal: Sequence[float]) -> float:
    """How far the robot is from a point, mm."""
    here = page.known("state")
    return math.dist((here["x_mm"], here["y_mm"]), goal)


def click_ahead(page: Browser, pixels: int) -> tuple[float, float]:
    """Click the floor ahead of the robot, which looks as it did at its start; return where that is, mm."""
    x, y, scale = page.js(
        "const b = argusMonitor.stage.box.getBoundingClientRect();"
        "return [b.x + b.width / 2, b.y + b.height / 2, argusMonitor.stage.scale]"
    )
    here = page.known("state")
    page.point(x, y - pixels)
    return here["x_mm"] + pixels / scale, here["y_mm"]


def test_a_click_on_the_floor_drives_there(page: Browser) -> None:
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    wanted = click_ahead(page, 140)
    page.wait("the order is told", lambda: page.text("say") == "On its way.")
    goal = page.js("return argusMonitor.stage.goal")
    assert math.dist(goal, wanted) < 2 / page.js("return argusMonitor.stage.scale"), "a pixel or two"
    assert page.text("control") == "In control"
    page.wait("it is there", lambda: page.text("say") == "The goal is reached.")
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    assert distance_to(page, goal) < ARRIVED_MM


def test_the_form_drives_there_stop_stops_on_the_way_and_go_on_goes_on(page: Browser) -> None:
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    goal = (0, 0) if distance_to(page, (0, 0)) > 700 else (1500, 0)
    for name, mm in zip(("x", "y"), goal, strict=True):
        page.driver.find_element(By.NAME, name).send_keys(
            str(mm / 1000) + (Keys.ENTER if name == "y" else "")
        )
    assert page.when(
        "argusMonitor.known.state.vel_left_mm_s > 100", "document.getElementById('stop').click()"
    )
    assert page.js("return argusMonitor.stage.goal") == list(goal)
    page.wait("it says that it is paused", lambda: page.text("mode").endswith(", paused"))
    page.wait(
        "it stands", lambda: page.known("state.vel_left_mm_s") == page.known("state.vel_right_mm_s") == 0
    )
    assert distance_to(page, goal) > ARRIVED_MM
    page.driver.find_element(By.CSS_SELECTOR, "[data-order=go]").click()
    page.wait("it is there", lambda: page.text("say") == "The goal is reached.")
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    assert distance_to(page, goal) < ARRIVED_MM


def test_the_keyboard_drives_chooses_breaks_and_stops(page: Browser) -> None:
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    page.focus_stage()
    chosen = page.known("chosen")
    page.keys("n", "n", "b")
    assert page.known("chosen") == (chosen + 1) % 16
    before = page.known("state.heading_cdeg")
    page.keys(Keys.ARROW_LEFT)
    page.wait(
        "it turns left", lambda: (page.known("state.heading_cdeg") - before) % 36000 in range(1500, 3000)
    )
    page.wait("and has turned", lambda: page.known("state.mode") == "IDLE")
    page.keys("p")
    page.wait("it is passive", lambda: page.text("active") == "Passive")
    page.keys("p")
    page.wait("it is active", lambda: page.text("active") == "Active")
    page.keys("f")
    page.wait("the chosen one is broken", lambda: str(page.known("chosen")) in page.known("broken"))
    page.keys("f")
    page.wait("and mended", lambda: page.known("broken") == {})
    stops = page.text("say")
    page.keys(Keys.SPACE)
    page.wait("Space stops", lambda: page.text("say") != stops and page.text("say").startswith("Stopped."))


def test_every_control_is_reached_by_tab_and_the_list_by_arrows(page: Browser) -> None:
    page.js("document.querySelector('.skip').focus()")
    reached = []
    for _ in range(60):
        page.keys(Keys.TAB)
        active = page.driver.switch_to.active_element
        name = (
            active.get_attribute("id")
            or active.get_attribute("data-order")
            or active.text
            or active.get_attribute("name")
        )
        reached.append(name)
        if name == "events":
            break
    wanted = {
        "control",
        "theme",
        "stage",
        "zoom-in",
        "stop",
        "turn",
        "step",
        "go",
        "recheck",
        "active",
        "fault",
        "break",
    }
    assert wanted <= set(reached), sorted(wanted - set(reached))
    row = page.driver.find_element(By.CSS_SELECTOR, ".sonar-row[tabindex='0']")
    row.send_keys(Keys.ARROW_DOWN)
    active = page.driver.switch_to.active_element
    assert active.get_attribute("role") == "radio"
    page.wait("the focus is on the chosen one", lambda: active.get_attribute("aria-checked") == "true")


def is_shown(page: Browser, selector: str) -> bool:
    """Whether the element can be seen, whole within the width of the page."""
    box = page.js(
        "const b = document.querySelector(arguments[0]).getBoundingClientRect(); return [b.left, b.right, b.height]",
        selector,
    )
    width: int = page.js("return document.documentElement.clientWidth")
    return bool(box[2] > 0 and box[0] >= 0 and box[1] <= width)


@pytest.mark.parametrize("width", [320, 360, 700])
def test_on_a_narrow_page_the_form_and_the_keys_are_folded_out(page: Browser, width: int) -> None:
    page.size(width, 740)
    page.wait("no notice is in the way", lambda: not page.driver.find_elements(By.CSS_SELECTOR, "#say.shown"))
    assert not is_shown(page, ".hint")
    assert page.driver.find_element(By.ID, "more").get_attribute("aria-expanded") == "false"
    page.click("more")
    assert is_shown(page, ".hint")
    assert is_shown(page, "#goto")
    assert is_shown(page, "#goto button")
    assert page.driver.find_element(By.ID, "more").get_attribute("aria-expanded") == "true"
    assert page.js("return document.documentElement.scrollWidth") <= width
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    here = page.known("state")
    for name, mm in (("x", here["x_mm"] + 700), ("y", here["y_mm"])):
        page.driver.find_element(By.CSS_SELECTOR, f"#goto [name={name}]").send_keys(str(round(mm / 1000, 2)))
    page.driver.find_element(By.CSS_SELECTOR, "#goto button").click()
    page.wait("it is on its way", lambda: page.known("state.mode") == "DRIVING")
    page.click("stop")
    page.click("more")
    assert not is_shown(page, ".hint")


def test_on_a_wide_page_nothing_is_folded_away(page: Browser) -> None:
    assert not is_shown(page, "#more")
    assert is_shown(page, ".hint")
    assert is_shown(page, "#goto button")


def test_keys_do_nothing_in_fields_and_letters_nothing_outside_of_the_picture(page: Browser) -> None:
    page.wait("it stands", lambda: page.known("state.mode") == "IDLE")
    field = page.driver.find_element(By.NAME, "x")
    field.send_keys("1 p")
    assert field.get_attribute("value") == "1 p"
    page.js("document.activeElement.blur()")
    page.driver.find_element(By.TAG_NAME, "body").send_keys("p")
    page.js("return new Promise((done) => setTimeout(done, 600))")
    assert page.text("active") == "Active"


def test_one_of_two_pages_is_in_control(page: Browser, monitor: Monitor) -> None:
    page.click("control")
    page.wait("in control", lambda: page.text("control") == "In control")
    first = page.driver.current_window_handle
    page.driver.switch_to.new_window("tab")
    try:
        page.open(monitor.url)
        page.wait("there are two", lambda: page.text("viewers") == "2 viewers")
        page.wait("another has control", lambda: page.text("control") == "Take over")
        page.driver.find_element(By.CSS_SELECTOR, "[data-order=recheck]").click()
        page.wait("it is refused", lambda: "Somebody else is in control" in page.text("say"))
        page.click("control")
        page.wait("taken over", lambda: page.text("control") == "In control")
    finally:
        page.driver.close()
        page.driver.switch_to.window(first)
    page.wait("the first was told", lambda: page.text("say") == "Somebody else has taken control.")
    page.wait("nobody is in control", lambda: page.text("control") == "Take control")


def test_without_the_secret_the_page_asks_for_it(page: Browser, monitor: Monitor) -> None:
    first = page.driver.current_window_handle
    page.driver.switch_to.new_window("tab")
    try:
        page.driver.get(monitor.url.split("#")[0])
        page.wait("it asks", lambda: page.js("return document.getElementById('ask').open"))
        page.driver.find_element(By.ID, "token").send_keys("wrong-wrong-wrong-wrong" + Keys.ENTER)
        page.wait("it asks again", lambda: page.text("link") == "the secret was refused")
        page.wait("the dialog is back", lambda: page.js("return document.getElementById('ask').open"))
        page.js("document.getElementById('token').value = ''")
        page.driver.find_element(By.ID, "token").send_keys(monitor.url.split("#")[1] + Keys.ENTER)
        page.wait("live", lambda: page.text("link") == "live")
    finally:
        page.driver.close()
        page.driver.switch_to.window(first)


def test_the_page_comes_back_by_itself(page: Browser, monitor: Monitor, folder: Path) -> None:
    """A second server on the same argusd, ended and started again on its port, with the same secret."""
    secret = folder / "secret"
    secret.write_text("a-secret-that-stays-the-same\n")
    secret.chmod(0o600)
    arguments = ["--connect", f"unix:{monitor.control}", "--page-token", str(secret), "--port"]
    other = Monitor([*arguments, "0"], folder)
    try:
        assert "#" not in other.url
        page.driver.get("about:blank")
        page.open(f"{other.url}#{secret.read_text().strip()}")
        other.end()
        page.wait("it says so", lambda: page.text("link") == "argus-monitor is away")
        other = Monitor([*arguments, str(other.port)], folder)
        page.wait("it is back", lambda: page.text("link") == "live")
    finally:
        other.end()


def test_another_site_gets_nothing(page: Browser, monitor: Monitor, folder: Path) -> None:
    token = monitor.url.split("#")[1]
    (folder / "index.html").write_text(
        f"""<script>
        window.found = {{}};
        const socket = new WebSocket("ws://127.0.0.1:{monitor.port}/live");
        socket.onopen = () => {{ window.found.socket = "open"; socket.send('{{"token":"{token}"}}'); }};
        socket.onerror = () => window.found.socket ??= "refused";
        fetch("http://127.0.0.1:{monitor.port}/main.js").then(() => window.found.fetch = "read",
            () => window.found.fetch = "refused");
        </script>"""
    )

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_arguments: object) -> None:
            """Say nothing."""

    with http.server.ThreadingHTTPServer(
        ("127.0.0.1", 0), lambda *a: Quiet(*a, directory=str(folder))
    ) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        page.driver.get(f"http://127.0.0.1:{server.server_address[1]}/")
        found = wait_for(
            "both are answered",
            lambda: len(page.js("return window.found")) == 2 and page.js("return window.found"),
        )
        server.shutdown()
    assert found == {"socket": "refused", "fetch": "refused"}


def test_a_reading_is_on_the_screen_soon_after_its_sip(page: Browser) -> None:
    page.wait("readings have come", lambda: len(page.js("return argusMonitor.latencies") or ()) > 20)

    def median_ms() -> float:
        latest: list[float] = page.js("return argusMonitor.latencies.slice(-20)")
        return statistics.median(latest)

    # Of some second: in another one the host may have been busy.
    page.wait("a reading is shown soon", lambda: 0 < median_ms() < LATENCY_MS)


def test_a_sonar_broken_by_a_click_is_diagnosed_on_the_page_and_mended_by_another(page: Browser) -> None:
    page.js("document.getElementById('fault').value = 'silent'")
    page.point_sonar(3)
    page.wait("it is marked as broken", lambda: page.known("broken") == {"3": "silent"})
    page.wait("Argus finds it", lambda: page.known("state.kind")[3] == "silent")
    page.wait("it is out", lambda: page.known("state.health")[3] == "DISABLED")
    page.wait("the others stay in use", lambda: page.text("sonars-count") == "15 of 16 in use")
    page.wait("the list says so", lambda: page.row(3) == "↯ failed: silent")
    page.wait("the headline says so", lambda: "3 silent" in page.text("stage-text"))
    page.wait("so does the badge", lambda: page.text("failure") == "Minor failure")
    page.wait("it tells how long it took", lambda: page.text("say").startswith("Found after "))
    assert page.driver.find_elements(By.CSS_SELECTOR, "#robot .sonar.bad[data-sonar='3']")
    assert "sonar 3disabled" in page.text("events").replace(" ", "").replace("sonar3", "sonar 3")
    page.wait(
        "a plan covers for it", lambda: page.js("return document.querySelectorAll('#robot .turn').length") > 0
    )
    assert page.js("return document.querySelectorAll('#plan .turn').length") > 0
    assert page.js("return document.querySelectorAll('#robot .cover.turned').length") > 0
    page.point_sonar(3)
    page.wait("it is mended", lambda: page.known("broken") == {})
    page.driver.find_element(By.CSS_SELECTOR, "[data-sonar-order=retest]").click()
    page.wait("tested again it comes back", lambda: page.known("state.health")[3] in ("PROBATION", "HEALTHY"))
    # Standing still it may stay on probation for long: the manager wants to see it agree with the others.
    page.wait("and the list says so", lambda: page.row(3) in ("probation: silent", "healthy"))


def test_what_an_option_breaks_is_marked_from_the_start(chromium: Browser, folder: Path) -> None:
    words = ["--sim", "--world", "hall", "--port", "0", "--fault", "off:3", "--fault", "silent:6@20s"]
    monitor = Monitor(words, folder)
    try:
        chromium.open(monitor.url)
        chromium.wait("it is marked", lambda: chromium.row(3).startswith("↯ "))
        chromium.wait("so is one that its time breaks", lambda: chromium.row(6).startswith("↯ "))
        assert not chromium.row(4).startswith("↯")
        assert set(chromium.known("broken")) == {"3", "6"}
        bolts = "#robot .sonar[data-sonar='3'] .bolt"
        chromium.wait(
            "so it is on the picture", lambda: chromium.driver.find_elements(By.CSS_SELECTOR, bolts)
        )
    finally:
        monitor.end()
