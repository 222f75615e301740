# SPDX-License-Identifier: MIT
"""Rule: of a healthy robot in a plant that is not ours `argus-log faults` names no sonar, in at most 10 lines.

What is printed holds it. The diagnosis itself does not yet: the second test keeps the sonars that it falsely names or
leaves suspect, so that there may be fewer but never more.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from argus_tools.log.cli import main

FOREIGN = Path(__file__).resolve().parents[3] / "tests" / "data" / "foreign"
LINES_MAX = 10
# Of each capture: sonars with an event SONAR_NAMED, and sonars that are suspects at the end. All of them are healthy.
FALSE: dict[str, tuple[set[int], set[int]]] = {
    "argusd_aml_cone.rec.gz": ({0, 1, 2, 3, 4, 5, 7, 8, 11, 13, 15}, {5}),
    "argusd_office_cone.rec.gz": (
        {0, 1, 3, 9, 10, 12, 13, 14, 15},
        {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12},
    ),
    "wander_corridor_ray.jsonl.gz": (
        {0, 1, 2, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
        {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 15},
    ),
}


@pytest.mark.parametrize("name", sorted(FALSE))
def test_nothing_is_named_and_little_is_printed(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["faults", str(FOREIGN / name)]) == 0
    out = capsys.readouterr().out
    assert len(out.splitlines()) <= LINES_MAX
    assert not re.search(r"sonar/(front|rear)/\d\d|disabled", out), out


@pytest.mark.parametrize("name", sorted(FALSE))
def test_the_diagnosis_names_no_more_than_it_did(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["faults", "--json", str(FOREIGN / name)]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    named = {int(event["name"][-2:]) for event in events if event["event"] == "SONAR_NAMED"}
    suspects = {number for number, health in enumerate(events[-1]["health"]) if health == "SUSPECT"}
    assert [event for event in events if event["event"] == "SONAR_DISABLED"] == []
    assert (named - FALSE[name][0], suspects - FALSE[name][1]) == (set(), set())
