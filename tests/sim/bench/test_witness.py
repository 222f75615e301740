# SPDX-License-Identifier: MIT
"""Rule: a reading counts as contradicted when it is off and a sound one of another sonar, made from its place on its
bearing within 40 s, saw something else; nothing else counts."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hil_sim.bench import witness
from hil_sim.bench.witness import Pings
from hil_sim.sil import READING, Sighting
from hil_sim.sonar.params import NO_ECHO_MM, Reading
from hil_sim.world.model import Pose

FIRMWARE = Path(__file__).parents[3] / "firmware/awareness"
FAULTY, OTHER = 3, 4  # 20 degrees apart; sonar 4 looks where 3 looked once the robot has turned by 20
TRUE_MM = 2000


def sighting(
    t_s: float, *readings: Reading, heading: float = 0.0, x: float = 0.0, y: float = 0.0
) -> Sighting:
    return Sighting(t_s, Pose(x, y, heading), readings)


def pings(*sightings: Sighting) -> Pings:
    kinds: tuple[str | None, ...] = (None, "wrong", "stuck")
    places = [one.pose for one in sightings]
    listed = [
        (row, (r.t_ms, r.number, r.range_mm, r.true_mm, kinds.index(r.fault)))
        for row, one in enumerate(sightings)
        for r in one.readings
    ]
    return Pings(
        np.array([one.t_s for one in sightings]),
        np.array(places, dtype=np.float64).reshape(-1, 3),
        np.array([values for _, values in listed], READING),
        np.array([row for row, _ in listed], dtype=np.intp),
        kinds,
    )


def lie(t_s: float, value: int = 1000, fault: str | None = "wrong") -> Reading:
    return Reading(1000 * t_s, FAULTY, value, TRUE_MM, fault)


def sound(t_s: float, value: int = TRUE_MM, fault: str | None = None) -> Reading:
    return Reading(1000 * t_s, OTHER, value, TRUE_MM, fault)


def count(*sightings: Sighting, begin_s: float = 0.0, end_s: float = 30.0) -> int:
    return pings(sighting(0.0), *sightings).contradicted(FAULTY, begin_s, end_s)


def turned(t_s: float, *readings: Reading, **more: Any) -> Sighting:
    """A SIP of the robot turned so that OTHER looks where FAULTY looked at heading 0; the robot has stood since."""
    return sighting(t_s, *readings, **({"heading": 20.0} | more))


def between(value: int, other: int, **more: Any) -> int:
    """One reading of the faulty sonar, then, three seconds later, one of the other on its bearing."""
    return count(sighting(2.0, lie(2.0, value)), turned(4.9, **more), turned(5.0, sound(5.0, other), **more))


def test_another_value_from_the_same_place_contradicts() -> None:
    assert between(1000, 2000) == 1


@pytest.mark.parametrize(
    ("value", "other", "counts"),
    [
        (1000, 1005, 0),  # they agree, though it is off
        (1000, 1135, 1),  # 80 mm and 5 % of the nearer one, and 5 mm by which the transducers differ
        (1000, 1125, 0),
        (NO_ECHO_MM, 2000, 1),
        (NO_ECHO_MM, 4590, 1),
        (NO_ECHO_MM, 4610, 0),  # from so far the air decides
        (NO_ECHO_MM, NO_ECHO_MM, 0),
        (1000, NO_ECHO_MM, 1),
        (2050, 3000, 0),  # not off by more than noise
    ],
)
def test_what_contradicts(value: int, other: int, counts: int) -> None:
    assert between(value, other) == counts


@pytest.mark.parametrize(
    ("more", "counts"),
    [
        ({"heading": 20.0}, 1),
        ({"heading": 22.9}, 1),
        ({"heading": 23.1}, 0),
        ({"heading": 16.9}, 0),
        ({"heading": 380.0}, 1),
        ({"y": 100.0}, 0),
        ({"x": 190.0}, 1),
        ({"x": 230.0}, 0),
    ],
)
def test_only_one_place_and_bearing(more: dict[str, float], counts: int) -> None:
    assert between(1000, 2000, **more) == counts


def test_only_within_forty_seconds_in_either_order_and_in_time() -> None:
    def earlier(at: float) -> int:
        return count(
            turned(0.9),
            turned(1.0, sound(1.0)),
            sighting(at - 0.1),
            sighting(at, lie(at)),
            begin_s=2.0,
            end_s=50.0,
        )

    assert (earlier(40.9), earlier(41.1)) == (1, 0)
    later = [sighting(2.0, lie(2.0)), turned(8.9), turned(9.0, sound(9.0))]
    assert count(*later, end_s=9.0) == 1
    assert count(*later, end_s=8.95) == 0
    assert count(*later, begin_s=2.5) == 0


def test_each_reading_counts_once_and_only_sound_ones_contradict() -> None:
    many = [sighting(2.0 + k, lie(2.0 + k)) for k in range(3)]
    assert count(*many, turned(5.9), *(turned(6 + k / 10, sound(6 + k / 10)) for k in range(4))) == 3
    assert count(*many, turned(5.9), turned(6.0, sound(6.0, fault="stuck"))) == 0
    assert count(*[sighting(2.0, lie(2.0, fault=None))], turned(5.9), turned(6.0, sound(6.0))) == 0


def test_the_pose_is_that_of_the_reading_not_of_the_sip() -> None:
    """Half of a turn of 40 degrees is behind it when the reading is made."""
    half = [sighting(2.0, lie(2.0)), sighting(4.0), sighting(5.0, sound(4.5), heading=40.0)]
    assert count(*half) == 1
    assert count(*half[:2], sighting(5.0, sound(5.0), heading=40.0)) == 0


def test_readings_are_counted_right_or_not() -> None:
    seen = pings(
        sighting(0.0),
        *(sighting(k + 0.3, lie(k), sound(k)) for k in range(1, 6)),
        sighting(9, lie(9.0, 2000)),
    )
    assert seen.fired(FAULTY, 2.0, 4.0) == 3
    assert seen.fired(OTHER, 0.0, 30.0) == 5
    assert seen.fired(FAULTY, 0.0, 30.0) == 6
    assert pings().fired(FAULTY, 0.0, 30.0) == 0


def test_a_mission_without_a_sighting_has_none() -> None:
    assert pings().contradicted(FAULTY, 0.0, 10.0) == 0


@pytest.mark.parametrize(
    ("true_mm", "heard_mm", "visible"),
    [(1000, 1100, False), (1000, 1101, True), (4000, 4200, False), (4000, 3799, True), (5000, 100, True)],
)
def test_visible_is_off_by_more_than_100_mm_and_5_percent(true_mm: int, heard_mm: int, visible: bool) -> None:
    seen = pings(sighting(0.0, Reading(0.0, 3, heard_mm, true_mm, "wrong"), Reading(0.0, 4, 100, 5000, None)))
    assert seen.is_visible().tolist() == [visible, False]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("PINGS_AGE_MS", 1000 * witness.AGE_S),
        ("SAME_CDEG", 100 * witness.BEARING_DEG),
        ("SAME_LATERAL_MM", witness.ACROSS_MM),
        ("SAME_ALONG_MM", witness.ALONG_MM),
        ("NEAREST_MM", witness.NEAREST_MM),
        ("AGREE_MM", witness.AGREE_MM),
        ("AGREE_PERCENT", 100 * witness.AGREE_PART),
        ("FARTHEST_MM", witness.FARTHEST_MM),
    ],
)
def test_one_place_is_what_it_is_for_the_fault_manager(name: str, value: float) -> None:
    found = re.search(rf"^    X\({name}, (\d+),", (FIRMWARE / "numbers.h").read_text(), re.MULTILINE)
    assert found is not None, name
    assert int(found[1]) == value
