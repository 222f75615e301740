# SPDX-License-Identifier: MIT
"""Rule: the picture of any drive, good or bad, is one PNG of a size for a README, with every word inside it."""

from __future__ import annotations

import dataclasses
import struct
from pathlib import Path
from typing import NamedTuple

import pytest
from demo_drive import CLOCK_S, Record, drawing, made_up, named
from matplotlib.backend_bases import RendererBase
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from hil_sim.demo import picture, scene
from hil_sim.demo.judge import of_type, sonar_of
from hil_sim.demo.scene import Drive
from hil_sim.world.files import load_world

LEAST_WIDE_PX, MOST_BYTES = 1200, 400_000


def find_late(events: list[Record]) -> None:
    """Sonar 6 is found 5 s later than it was."""
    late = next(one for one in named(events, "SONAR_DISABLED") if sonar_of(one) == 6)
    late["t"] += 5.0
    events.sort(key=lambda one: float(one["t"]))


def everything_wrong() -> tuple[list[Record], list[Record]]:
    """A drive with a miss, a false verdict, a collision, no goal."""
    truth, events = made_up()
    events.remove(named(events, "SONAR_DISABLED")[1])
    events.remove(named(events, "GOAL_REACHED")[0])
    events.append({"t": 25.0 + CLOCK_S, "event": "SONAR_DISABLED", "name": "sonar/front/02", "value": 4})
    truth.append({"type": "collision", "t_s": 40.0, "x_mm": 1600.0, "y_mm": 100.0})
    return truth, events


def size_px(path: Path) -> tuple[int, int]:
    head = path.read_bytes()[:24]
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    width, height = struct.unpack(">II", head[16:])
    return width, height


class Drawn(NamedTuple):
    """A picture, and every text that was really drawn, with the box it takes in pixels."""

    path: Path
    boxes: dict[str, Bbox]


def drawn(drive: Drive, path: Path) -> Drawn:
    """Draw, and note the texts."""
    boxes: dict[str, Bbox] = {}
    draw = Text.draw

    def noted(self: Text, renderer: RendererBase) -> None:
        patch = self.get_bbox_patch()
        draw(self, renderer)
        if self.get_visible() and self.get_text().strip():
            box = patch.get_window_extent(renderer) if patch else self.get_window_extent(renderer)
            boxes[self.get_text()] = Bbox.union([box, boxes.get(self.get_text(), box)])

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(Text, "draw", noted)
        picture.draw(drive, path)
    return Drawn(path, boxes)


@pytest.fixture(scope="module")
def good(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """The picture of a good drive; drawing takes a second, so those that only look share it."""
    return drawn(drawing(*made_up()), tmp_path_factory.mktemp("good") / "demo.png")


@pytest.fixture(scope="module")
def bad(tmp_path_factory: pytest.TempPathFactory) -> Drawn:
    """The picture of a drive in which everything is wrong."""
    return drawn(drawing(*everything_wrong()), tmp_path_factory.mktemp("bad") / "demo.png")


def test_one_png_of_a_good_size(good: Drawn) -> None:
    assert size_px(good.path)[0] >= LEAST_WIDE_PX
    assert good.path.stat().st_size < MOST_BYTES
    assert list(good.path.parent.iterdir()) == [good.path]


def test_the_same_drive_gives_the_same_bytes_a_late_finding_others(good: Drawn, tmp_path: Path) -> None:
    truth, events = made_up()
    picture.draw(drawing(truth, events), tmp_path / "again.png")
    find_late(events)
    picture.draw(drawing(truth, events), tmp_path / "late.png")
    assert (tmp_path / "again.png").read_bytes() == good.path.read_bytes()
    assert (tmp_path / "late.png").read_bytes() != good.path.read_bytes()


@pytest.mark.parametrize("which", ["good", "bad"])
def test_every_word_lies_inside_the_picture(which: str, request: pytest.FixtureRequest) -> None:
    found: Drawn = request.getfixturevalue(which)
    width, height = size_px(found.path)
    outside = {
        text: box.extents
        for text, box in found.boxes.items()
        if box.x0 < 0 or box.y0 < 0 or box.x1 > width or box.y1 > height
    }
    assert len(found.boxes) > 30
    assert outside == {}


def test_long_lines_stay_inside_too(tmp_path: Path) -> None:
    """The longest title that the options allow, and a verdict in which every rule failed."""
    drive = drawing(*made_up())
    title = "Argus, one drive: sonar 3 wrong, then sonar 6 wrong"
    title += "   (world smooth, seed 9223372036854775807, policy fewest)"
    rules = tuple(dataclasses.replace(rule, holds=False) for rule in drive.verdict.rules)
    verdict = dataclasses.replace(drive.verdict, rules=rules)
    long = dataclasses.replace(drive, title=title, verdict=verdict)
    boxes = drawn(long, tmp_path / "demo.png").boxes
    headline = next(text for text in boxes if text.startswith("Failed: "))
    assert headline.count(",") == len(rules) - 1
    for text in (title, headline):
        assert boxes[text].x1 <= size_px(tmp_path / "demo.png")[0], text


def test_the_words_say_what_happened(good: Drawn, bad: Drawn) -> None:
    words = "\n".join(good.boxes)
    for wanted in (
        "A made-up drive",
        "Passed:",
        "Sonar 3 goes dead",
        "Sonar 6 goes wrong",
        "Start",
        "Goal",
        "1 m",
    ):
        assert wanted in words, wanted
    words = "\n".join(bad.boxes)
    for wanted in ("Failed:", "never proved", "Sonar 2 is healthy, yet", "Collision at"):
        assert wanted in words, wanted


@pytest.mark.parametrize("kept", [1, 2, 40])
def test_a_drive_that_broke_off_at_once_is_drawn_too(kept: int, tmp_path: Path) -> None:
    truth, events = made_up()
    states = of_type(truth, "state")[:kept]
    last_s = states[-1]["t_s"]
    truth = [one for one in truth if one.get("t_s", 0.0) <= last_s or one["type"] == "session"]
    events = [one for one in events if one["t"] - CLOCK_S <= last_s or one["event"] == "SESSION_OPEN"]
    picture.draw(drawing(truth, events), tmp_path / "demo.png")
    assert size_px(tmp_path / "demo.png")[0] >= LEAST_WIDE_PX


def test_the_outlines_of_a_world_are_its_room_and_its_boxes() -> None:
    world = load_world("demo")
    outlines = list(scene.loops(world))
    assert sum(len(outline) for outline in outlines) == len(world.segments)
    assert len(outlines) == 2


def test_health_spans_have_no_gap_and_follow_the_events() -> None:
    drive = drawing(*made_up())
    spans = scene.health_spans(drive, 3)
    assert [word for _, _, word in spans] == ["unknown", "disabled"]
    assert spans[0][0] == drive.start_s
    assert spans[-1][1] == drive.end_s
    found = drive.verdict.findings[0].diagnosed
    assert found is not None
    assert spans[0][1] == spans[1][0] == pytest.approx(found.t_s)
