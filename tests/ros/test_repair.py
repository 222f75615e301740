# SPDX-License-Identifier: MIT
"""Rule: a trusted reading is told after REP 117; of one that is not, nothing is told that nobody measured."""

from __future__ import annotations

import doctest
import math
from types import SimpleNamespace
from typing import Any

import pytest
from argus_ros import argus_node, messages
from argus_ros.argus_node import ArgusNode
from argus_ros.make_messages import PACKAGES
from argus_ros.repair import Dead, NoEcho, Policy, Trust, Verdict, bearings, neighbours
from argus_ros.ring import Ring
from argus_tools.rings.intake import Limits
from rclpy.parameter import Parameter

from hil_sim.tables import robots
from hil_sim.tables.robot import robot_table

SONAR = Limits(0.1, 5.0)


def test_the_examples_in_the_sources_are_true() -> None:
    result = doctest.testmod(messages)
    assert result.attempted > 0
    assert result.failed == 0


@pytest.mark.parametrize(
    ("range_m", "rep117", "greatest"),
    [
        (1.5, 1.5, 1.5),
        (0.1, 0.1, 0.1),
        (4.999, 4.999, 4.999),
        (5.0, math.inf, 5.0),
        (math.inf, math.inf, 5.0),
        (0.05, -math.inf, -math.inf),
        (-math.inf, -math.inf, -math.inf),
    ],
)
def test_a_trusted_reading(range_m: float, rep117: float, greatest: float) -> None:
    assert Policy().good(range_m, SONAR) == rep117
    assert Policy(no_echo=NoEcho.MAX).good(range_m, SONAR) == greatest
    assert math.isnan(Policy().good(math.nan, SONAR))


def test_one_that_is_not_trusted() -> None:
    assert Policy(Dead.WITHHOLD).bad([1.0], SONAR) is None
    invalid = Policy(Dead.INVALID).bad([1.0], SONAR)
    assert invalid is not None
    assert math.isnan(invalid)
    assert Policy(Dead.COVER).bad([], SONAR) is None
    assert Policy(Dead.COVER).bad([5.0, 1.2], SONAR) == 1.2
    assert Policy(Dead.COVER).bad([5.0, 5.0], SONAR) == math.inf


def test_trust() -> None:
    doubted, named, healthy = Verdict("SUSPECT"), Verdict("SUSPECT", "off"), Verdict("HEALTHY")
    assert [v.trusted(Trust.NAMED) for v in (doubted, named, healthy)] == [True, False, True]
    assert [v.trusted(Trust.HEALTHY) for v in (doubted, named, healthy)] == [False, False, True]


@pytest.mark.parametrize("name", robots())
def test_neighbours_look_nearly_the_same_way(name: str) -> None:
    places = bearings(robot_table(name))
    for number in places:
        beside = neighbours(number, places)
        assert number not in beside
        assert len(beside) <= 2
        for other in beside:
            away = abs((places[other] - places[number] + 180) % 360 - 180)
            assert 0 < away <= 45


def test_a_ring_of_which_a_part_is_mapped_is_not_called_failed() -> None:
    # The fault manager counts the sonars that this ring has not got as silent.
    verdicts = [Verdict("HEALTHY")] * 3 + [Verdict("ABSENT")] * 13
    status = messages.ring_status("x", "", verdicts, "p3dx-sh", {})
    assert (status.level, status.message) == (b"\x00", "3 of 3 sonars to be trusted")
    verdicts[1] = Verdict("DISABLED", "off")
    status = messages.ring_status("x", "", verdicts, "p3dx-sh", {})
    assert (status.level, status.message) == (b"\x01", "2 of 3 sonars to be trusted")


FIELDS = {line.split()[1] for line in PACKAGES["p2os_msgs"][0]["SonarArray"]}


class FakeArray(SimpleNamespace):
    """In the place of p2os2's own message, which PyPI has not: it takes the same fields and no other."""

    def __init__(self, **fields: Any) -> None:
        assert fields.keys() == FIELDS
        super().__init__(**fields)


def test_the_aggregate_of_p2os2_has_nan_for_who_is_withheld(monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[Any] = []
    monkeypatch.setattr(argus_node, "SonarArray", FakeArray)
    node = ArgusNode()
    publisher = node.create_publisher

    def create(kind: Any, topic: str, *options: Any, **more: Any) -> Any:
        if kind is FakeArray:
            assert topic == "sonar"
            return SimpleNamespace(publish=said.append)
        return publisher(kind, topic, *options, **more)

    monkeypatch.setattr(node, "create_publisher", create)
    node.set_parameters([Parameter("control", value="unix:/nonexistent")])
    node.start()
    node._ring = argus_node._Ring(robot_table())
    node._ring.verdicts = [Verdict("HEALTHY")] * 3 + [Verdict("DISABLED", "off")] + [Verdict("HEALTHY")] * 12
    node._take_readings({"t": 1.0, "sip": 1, "mm": [1000] * 15 + [5000], "age_ms": [0] * 16})
    node.destroy_node()
    (array,) = said
    assert array.ranges_count == 16
    assert list(array.ranges[:3]) == [1.0] * 3
    assert math.isnan(array.ranges[3])
    assert array.ranges[15] == math.inf


def test_a_ring_begun_anew_takes_no_reading_of_the_time_before(monkeypatch: pytest.MonkeyPatch) -> None:
    ring, limits = Ring(robot_table()), Limits(0.1, 5.0)
    made: list[dict[int, int]] = []
    told = ring._sip

    def noted() -> bytes:
        made.append(dict(ring._fresh))
        return told()

    monkeypatch.setattr(ring, "_sip", noted)
    for k in range(30):  # sonar 5 was heard behind the last packet of the first run
        ring.note(4, 1.0, limits)
        ring.advance(1000 + k * 0.1)
    ring.advance(1002.95)
    ring.note(5, 0.2, limits)
    ring.advance(1002.97)
    made.clear()
    for k in range(5):
        ring.note(4, 1.0, limits)
        ring.advance(10 + k * 0.1)
    assert ring.restarts == 1
    assert made
    assert {k for fresh in made for k in fresh} == {4}, made
