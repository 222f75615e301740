# SPDX-License-Identifier: MIT
"""Rule: each SIP that the fault manager takes is one row, as a trace sees it, whether C or Python writes it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hil_sim.core.library import mode_name
from hil_sim.robot import robot as robot_module
from hil_sim.robot.interfaces import SonarReading
from hil_sim.robot.robot import Robot
from hil_sim.sil import Mission, Sighting, Sightings, Sil
from hil_sim.sonar.params import Reading
from hil_sim.world.movers import Person

ROUND = ((2300.0, 1000.0), (-500.0, 500.0), (2300.0, -800.0), (0.0, 0.0))
MISSIONS = {
    "plain": Mission("office", ROUND, limit_s=80.0, stop_at_goal=False),
    "faults": Mission("office", ROUND, limit_s=40.0, faults=("off:3@5s", "wrong:4@9s-20s:scale=0.7")),
    "people": Mission("office", ROUND, limit_s=20.0, movers=(Person(((900.0, -900.0), (900.0, 900.0))),)),
    "a bad link": Mission("office", ROUND, limit_s=20.0, faults=("link-drop:p=0.1", "link-delay@5s:ms=300")),
    "mobilesim": Mission("office", ROUND, limit_s=20.0, quirks="mobilesim"),
}


class Watch:
    """Notes the same in Python, SIP by SIP."""

    def __init__(self) -> None:
        self.rows: list[tuple[Any, ...]] = []
        self.readings: list[SonarReading] = []

    def __call__(self, sil: Sil, sighting: Sighting) -> None:
        chassis, drive = sil.robot.chassis, sil.robot.drive
        place = chassis.x, chassis.y, chassis.th, chassis.travelled_mm
        self.rows.append((sighting.t_s, *sighting.pose, *place, drive.v, drive.w, sil.mode))
        self.readings += sighting.readings


def seen_of(sightings: Sightings) -> tuple[list[tuple[Any, ...]], list[SonarReading]]:
    """What was seen, in the form of Watch."""
    seen = sightings.seen
    names = ("t_ms", "x", "y", "heading", "true_x", "true_y", "th", "travelled_mm", "v", "w", "mode")
    rows = [
        (t_ms / 1000, *values, mode_name(mode))
        for t_ms, *values, mode in zip(*(seen.rows[name].tolist() for name in names), strict=True)
    ]
    _, listed = seen.listed()
    return rows, [Reading(t, n, mm, true_mm, seen.kinds[kind]) for t, n, mm, true_mm, kind in listed.tolist()]


def run(mission: Mission, *, pieces: bool = False) -> tuple[Watch, Sightings]:
    watch, sightings = Watch(), Sightings()
    sil = Sil(mission, trace=watch, sightings=sightings)
    while pieces and not sil.over:
        sil.run_until(sil.now_ms / 1000 + 0.37)
    sil.run()
    return watch, sightings


@pytest.mark.parametrize("pieces", [False, True])
@pytest.mark.parametrize("name", MISSIONS)
def test_columns_are_what_a_trace_sees(name: str, pieces: bool) -> None:
    watch, sightings = run(MISSIONS[name], pieces=pieces)
    rows, readings = seen_of(sightings)
    assert len(rows) > 100
    assert rows == watch.rows
    assert readings == watch.readings


@pytest.mark.parametrize("begun_s", [0.0, 5.0])
def test_a_trace_may_be_set_later(begun_s: float) -> None:
    """On one that has begun those come that are sent from then on."""
    sil, watch = Sil(MISSIONS["plain"]), Watch()
    sil.run_until(begun_s)
    sil.trace = watch
    sil.run_until(begun_s + 10.0)
    assert len(watch.rows) >= 90
    assert watch.rows[0][0] >= begun_s
    assert len({reading.number for reading in watch.readings}) == 16


@pytest.mark.parametrize("name", MISSIONS)
def test_c_and_python_write_the_same(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    in_c = Sightings()
    Sil(MISSIONS[name], sightings=in_c).run()
    monkeypatch.setattr(robot_module, "ticks_of", lambda _: None)
    in_python = Sightings()
    Sil(MISSIONS[name], sightings=in_python).run()
    assert seen_of(in_c) == seen_of(in_python)


def test_more_than_c_has_room_for_is_kept() -> None:
    """800 SIPs with some 5,000 readings, of which C holds 512 and 8,192 at once."""
    sightings = Sightings()
    Sil(MISSIONS["plain"], sightings=sightings).run()
    rows = sightings.seen.rows
    assert len(rows) > 700
    assert sightings.count < 512
    assert set(np.diff(rows["t_ms"]).tolist()) == {100.0}
    heard = np.bincount(sightings.seen.listed()[1]["number"], minlength=16)
    assert heard.min() > 200, "each sonar has a reading every 0.32 s"


# ---- what is on the line ----------------------------------------------------------------------------------------


@pytest.fixture
def robot() -> Robot:
    return Sil(Mission("office", ())).robot


def readings(*ranges: int) -> list[Reading]:
    return [Reading(float(k), k, mm, mm, None) for k, mm in enumerate(ranges)]


def test_sips_on_the_line_at_once_are_taken_one_by_one(robot: Robot) -> None:
    sightings = Sightings()
    for k in range(3):
        sightings.sent(bytes([k]), robot, readings(100 + k))
    assert [sightings.taken(bytes([k]), robot, 1) for k in range(3)] == [True] * 3
    assert sightings.seen.listed()[1]["range_mm"].tolist() == [100, 101, 102]


def test_equal_sips_are_as_many_as_there_are(robot: Robot) -> None:
    sightings = Sightings()
    for _ in range(2):
        sightings.sent(b"same", robot, readings(100))
    assert [sightings.taken(b"same", robot, 1) for _ in range(3)] == [True, True, False]


def test_one_that_is_lost_is_no_row(robot: Robot) -> None:
    sightings = Sightings()
    for k in range(3):
        sightings.sent(bytes([k]), robot, readings(100 + k, 200 + k))
    assert sightings.taken(b"\x02", robot, 1)
    assert not sightings.taken(b"\x00", robot, 1)
    assert not sightings.taken(b"other", robot, 1)
    assert sightings.seen.listed()[1]["range_mm"].tolist() == [102, 202]
    assert [reading.range_mm for reading in sightings.last.readings] == [102, 202]


def test_a_link_on_which_nothing_arrives_keeps_the_last_ones(robot: Robot) -> None:
    sightings = Sightings()
    for k in range(5000):
        sightings.sent(k.to_bytes(2), robot, readings(100, 200, 300))
    assert not sightings.taken((4935).to_bytes(2), robot, 1)
    assert sightings.taken((4936).to_bytes(2), robot, 1)
    assert sightings.taken((4999).to_bytes(2), robot, 1)
    assert sightings.last.readings == tuple(readings(100, 200, 300))


def test_without_keeping_only_the_last_is_there(robot: Robot) -> None:
    sightings = Sightings(keep=False)
    for k in range(1000):
        sightings.sent(k.to_bytes(2), robot, readings(k))
        assert sightings.taken(k.to_bytes(2), robot, 1)
        assert sightings.last.readings[0].range_mm == k
    assert len(sightings.seen.rows) < 512
