# SPDX-License-Identifier: MIT
"""Rule: the page is usable at 360 px, in light and dark, and axe-core finds nothing that keeps anybody out."""

from __future__ import annotations

import pytest
from axe_core_python.selenium import Axe  # type: ignore[import-untyped]
from page_browser import Browser, Monitor

SIZES = ((1280, 860), (768, 1024), (360, 740))


@pytest.mark.parametrize("width", [320, 360, 414, 768, 1000, 1280, 1920])
def test_no_width_scrolls_sideways(page: Browser, width: int) -> None:
    page.size(width, 800)
    wide = page.js("return [document.documentElement.scrollWidth, innerWidth]")
    assert wide[0] <= wide[1] == width
    cut = page.js(
        "return [...document.querySelectorAll('header *, .orders *, .side *')].filter((node) => {"
        "const box = node.getBoundingClientRect(); return box.width && (box.right > innerWidth + 1 || box.left < -1)})"
        ".map((node) => node.id || node.className || node.tagName)"
    )
    assert cut == []


def test_stop_is_in_sight_on_a_phone_wherever_one_scrolls(page: Browser) -> None:
    page.size(360, 740)
    for part in (0.0, 0.5, 1.0):
        page.js(f"scrollTo(0, {part} * document.documentElement.scrollHeight)")
        box = page.js(
            "const b = document.getElementById('stop').getBoundingClientRect(); return [b.top, b.bottom, innerHeight]"
        )
        assert 0 <= box[0] < box[1] <= box[2], (part, box)


def test_targets_are_large_enough_for_a_finger(page: Browser) -> None:
    page.size(360, 740)
    small = page.js(
        "return [...document.querySelectorAll('button, select, input, [role=radio]')]"
        ".map((node) => [node.id || node.textContent, node.getBoundingClientRect()])"
        ".filter(([, box]) => box.width && (box.width < 24 || box.height < 24)).map(([name]) => name)"
    )
    assert small == []
    eyes = page.js("return [...argusMonitor.stage.eyes.values()]")
    near = min(((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2) ** 0.5 for k, a in enumerate(eyes) for b in eyes[:k])
    assert near >= 20


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
@pytest.mark.parametrize("size", SIZES, ids=lambda size: str(size[0]))
def test_axe_finds_nothing(page: Browser, monitor: Monitor, size: tuple[int, int], dark: bool) -> None:
    page.open(monitor.url, dark)
    page.size(*size)
    found = Axe().run(page.driver)
    told = [
        f"{rule['id']}: {rule['help']}: {node['target']} {node.get('failureSummary', '')}"
        for rule in found["violations"]
        for node in rule["nodes"]
    ]
    assert told == []
    assert len(found["passes"]) > 15


def test_axe_would_find_something(page: Browser) -> None:
    page.js(
        "const stop = document.getElementById('stop'); stop.textContent = ''; stop.removeAttribute('title');"
    )
    assert "button-name" in [rule["id"] for rule in Axe().run(page.driver)["violations"]]


def test_the_theme_can_be_chosen(page: Browser) -> None:
    seen = []
    for _ in range(3):
        page.click("theme")
        seen.append((page.text("theme"), page.js("return getComputedStyle(document.body).backgroundColor")))
    assert [name for name, _ in seen] == ["Theme: light", "Theme: dark", "Theme: auto"]
    assert seen[0][1] != seen[1][1]
    assert seen[2][1] == seen[0][1], "the system wishes for light"
