# SPDX-License-Identifier: MIT
"""Rule: text has a contrast of 4.5 and marks one of 3 (WCAG 2.2 AA), in light and dark; colours of health differ for
colour-blind people, too, and each health has a form of its own."""

from __future__ import annotations

import itertools
import re

import pytest
from argus_tools.monitor.server import page_files

Rgb = tuple[float, float, float]
HEALTH = ("good", "doubt", "bad", "trial", "quiet")
# How red-blind, green-blind and blue-blind people see linear RGB (Machado, Oliveira and Fernandes, 2009, severity 1).
BLINDNESS = {
    "protanopia": (
        (0.152286, 1.052583, -0.204868),
        (0.114503, 0.786281, 0.099216),
        (-0.003882, -0.048116, 1.051998),
    ),
    "deuteranopia": (
        (0.367322, 0.860646, -0.227968),
        (0.280085, 0.672501, 0.047413),
        (-0.011820, 0.042940, 0.968881),
    ),
    "tritanopia": (
        (1.255528, -0.076749, -0.178779),
        (-0.078411, 0.930809, 0.147602),
        (0.004733, 0.691367, 0.303900),
    ),
}
APART = 10.0
"""Of CIE 1976 colour difference: several times what two marks side by side need to be told apart."""


def palettes() -> dict[str, dict[str, str]]:
    css = page_files()["/monitor.css"][0].decode()
    blocks = re.findall(r"(\[data-theme=\"(\w+)\"\]) \{([^}]*)\}", css)
    return {name: dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6})", body)) for _, name, body in blocks}


def linear(text: str) -> Rgb:
    parts = [int(text[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    red, green, blue = (p / 12.92 if p <= 0.04045 else ((p + 0.055) / 1.055) ** 2.4 for p in parts)
    return red, green, blue


def luminance(colour: Rgb) -> float:
    return 0.2126 * colour[0] + 0.7152 * colour[1] + 0.0722 * colour[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(linear(one)), luminance(linear(other))))
    return (high + 0.05) / (low + 0.05)


def lab(colour: Rgb) -> Rgb:
    red, green, blue = (min(1.0, max(0.0, part)) for part in colour)
    x = (0.4124 * red + 0.3576 * green + 0.1805 * blue) / 0.9505
    y = 0.2126 * red + 0.7152 * green + 0.0722 * blue
    z = (0.0193 * red + 0.1192 * green + 0.9505 * blue) / 1.089
    fx, fy, fz = (v ** (1 / 3) if v > 0.008856 else 7.787 * v + 16 / 116 for v in (x, y, z))
    return 116 * fy - 16, 500 * (fx - fy), 200 * (fy - fz)


def apart(one: str, other: str, kind: str | None) -> float:
    def seen(text: str) -> Rgb:
        colour = linear(text)
        if kind is None:
            return lab(colour)
        rows = [sum(a * b for a, b in zip(row, colour, strict=True)) for row in BLINDNESS[kind]]
        return lab((rows[0], rows[1], rows[2]))

    return float(sum((a - b) ** 2 for a, b in zip(seen(one), seen(other), strict=True)) ** 0.5)


def test_measures_are_right() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21)
    assert apart("#ff0000", "#00a000", None) > 3 * apart("#c86400", "#8c8c00", "deuteranopia")


def test_both_themes_are_read_and_the_automatic_dark_is_the_dark_one() -> None:
    found = palettes()
    assert set(found) == {"light", "dark", "auto"}
    assert found["auto"] == found["dark"]
    assert set(found["light"]) == set(found["dark"])


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_contrast(theme: str) -> None:
    colours = palettes()[theme]
    for text in ("ink", "muted", *HEALTH, "accent"):
        for ground in ("bg", "card", "floor"):
            assert contrast(colours[text], colours[ground]) >= 4.5, (text, ground)
    assert contrast(colours["on-accent"], colours["accent"]) >= 4.5
    for mark in ("edge", "wall", "way", "echo", "doubted", "goal", "hull"):
        assert contrast(colours[mark], colours["floor"]) >= 3, mark


@pytest.mark.parametrize("theme", ["light", "dark"])
@pytest.mark.parametrize("kind", [None, *BLINDNESS])
def test_healthy_doubted_and_failed_are_told_apart(theme: str, kind: str | None) -> None:
    colours = palettes()[theme]
    for one, other in itertools.combinations(("good", "doubt", "bad"), 2):
        assert apart(colours[one], colours[other], kind) >= APART, (one, other)
    assert apart(colours["good"], colours["bad"], kind) >= 2 * APART


def test_each_health_has_a_form_and_a_word_of_its_own() -> None:
    words = page_files()["/words.js"][0].decode()
    looks = re.findall(r"(\w+): \{ word: \"([\w ]+)\", form: \"(\w+)\" \}", words)
    assert {name for name, _, _ in looks} == set(HEALTH)
    assert len({word for _, word, _ in looks}) == len({form for _, _, form in looks}) == len(HEALTH)
    stage = page_files()["/stage.js"][0].decode()
    assert all(f"    {form}: [[" in stage for _, _, form in looks)
