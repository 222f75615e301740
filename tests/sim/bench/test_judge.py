# SPDX-License-Identifier: MIT
"""Rule: each word that decides pass or fail (found, latency, named, set apart, false disable, repaired, attributable)
means what docs/diagnosis.md says, to the edge."""

from __future__ import annotations

from typing import Any

import pytest
from bench.missions import Changes, fault, outcome, track

from hil_sim.bench.judge import (
    BOUND_S,
    Track,
    false_disables,
    false_names,
    judge,
    judge_fault,
)
from hil_sim.sil import Collision, FaultTruth, Mission, Sightings, run
from hil_sim.sonar.params import NO_ECHO_MM


def judged(truth: FaultTruth, *changes: tuple[float, str, str], **more: Any) -> dict[str, Any]:
    own = more.pop("track", None) or track((truth.sonar, truth.onset_s))
    return judge_fault(truth, outcome(truth, health={truth.sonar: changes}, **more), own)


# ---- found and latency ------------------------------------------------------------------------------------------


def test_the_bounds_are_the_p99_bounds() -> None:
    quick, slower = ("off", "garbage", "slow"), ("silent", "stuck", "wrong", "intermittent")
    assert dict.fromkeys(quick, 10.0) | dict.fromkeys(slower, 30.0) == BOUND_S


@pytest.mark.parametrize("kind", BOUND_S)
def test_found_is_within_the_bound_of_its_kind_from_the_first_visible_reading(kind: str) -> None:
    truth = fault(kind, first_visible_s=14.0)
    just = judged(truth, (14.0 + BOUND_S[kind], "DISABLED", kind))
    late = judged(truth, (14.0 + BOUND_S[kind] + 0.1, "DISABLED", kind))
    assert just["found"]
    assert just["latency_s"] == BOUND_S[kind]
    assert not late["found"]
    assert late["latency_s"] == pytest.approx(BOUND_S[kind] + 0.1)


def test_found_before_it_showed_has_no_negative_latency() -> None:
    assert judged(fault(first_visible_s=14.0), (12.0, "DISABLED", "wrong"))["latency_s"] == 0


def test_latency_is_told_in_metres_and_in_readings_as_well() -> None:
    record = judged(fault(), (15.0, "DISABLED", "wrong"), track=track((3, 10.0), stand=(12.0, 14.0)))
    assert record["latency_mm"] == pytest.approx(300)
    assert record["latency_readings"] == 5  # at 11, 12, 13, 14, 15; the one at onset itself is before it


@pytest.mark.parametrize(
    ("health", "kind", "found"),
    [
        ("DISABLED", "wrong", True),
        ("DISABLED", "garbage", True),
        ("DISABLED", "", True),
        ("SUSPECT", "wrong", True),
        ("STALE", "wrong", True),
        ("SUSPECT", "garbage", False),
        ("SUSPECT", "", False),
        ("HEALTHY", "wrong", False),
        ("UNKNOWN", "wrong", False),
    ],
)
def test_found_is_disabled_or_named_rightly(health: str, kind: str, found: bool) -> None:
    assert judged(fault(), (12.0, health, kind))["found"] is found


def test_what_was_said_before_or_after_the_fault_does_not_count() -> None:
    truth = fault(end_s=100.0)
    assert not judged(truth, (9.9, "SUSPECT", "wrong"))["found"]
    assert not judged(truth, (100.1, "DISABLED", "wrong"))["found"]
    assert judged(truth, (9.9, "SUSPECT", "wrong"), (11.0, "DISABLED", "wrong"))["latency_s"] == 1


def test_another_sonar_that_is_disabled_does_not_find_it() -> None:
    truth = fault(sonar=3)
    made = outcome(truth, health={4: [(12.0, "DISABLED", "wrong")]})
    assert not judge_fault(truth, made, track((3, 10.0)))["found"]


# ---- the name ---------------------------------------------------------------------------------------------------


def test_the_name_is_that_of_the_moment_it_was_found_and_the_last_one_is_kept_beside_it() -> None:
    record = judged(fault("slow"), (12.0, "DISABLED", "wrong"), (20.0, "DISABLED", "slow"))
    assert (record["named"], record["named_right"]) == ("wrong", False)
    assert (record["named_end"], record["named_end_right"]) == ("slow", True)


def test_a_named_suspect_has_a_name_at_its_end() -> None:
    record = judged(fault("slow"), (12.0, "SUSPECT", "slow"), (15.0, "SUSPECT", ""), (40.0, "HEALTHY", ""))
    assert record["named_end"] == "slow"


def test_a_name_after_the_fault_is_not_its_name_at_its_end() -> None:
    record = judged(fault("slow", end_s=100.0), (12.0, "DISABLED", "slow"), (101.0, "DISABLED", "wrong"))
    assert record["named_end"] == "slow"


@pytest.mark.parametrize(
    ("kind", "readings", "right"),
    [
        ("stuck", {NO_ECHO_MM}, True),
        ("stuck", {1500}, False),
        ("stuck", set(), False),
        ("wrong", {NO_ECHO_MM}, False),
    ],
)
def test_stuck_at_no_echo_may_be_called_off(kind: str, readings: set[int], right: bool) -> None:
    own = track((3, 10.0))
    own.stuck_mm[3] = readings
    assert judged(fault(kind), (12.0, "DISABLED", "off"), track=own)["named_right"] is right
    assert judged(fault(kind), (12.0, "SUSPECT", "off"), track=own)["found"] is right


# ---- what could be seen -----------------------------------------------------------------------------------------


def test_the_times_of_the_first_visible_readings_are_noted() -> None:
    assert judged(fault(end_s=14.5))["visible_at"] == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert judged(fault(end_s=200.0))["visible_at"] == [float(k) for k in range(16)]
    assert judged(fault("silent", end_s=11.0))["visible_at"] == [0.0, 0.32, 0.64, 0.96]
    assert judged(fault(first_visible_s=None), track=track())["visible_at"] == []


# ---- set apart --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("readings", "apart"), [(2, "not shown"), (3, None)])
def test_too_few_visible_readings_set_a_fault_apart(readings: int, apart: str | None) -> None:
    own = track((3, 10.5))
    del own.visible_s[3][readings:]
    assert judged(fault(), track=own)["apart"] == apart


def test_a_fault_that_never_shows_is_set_apart_even_when_disabled() -> None:
    truth = fault(first_visible_s=None)
    assert judged(truth, track=track())["apart"] == "not shown"
    assert judged(truth, (12.0, "DISABLED", "wrong"), track=track())["apart"] == "not shown"


def test_a_fault_found_at_its_first_readings_is_not_set_apart_for_firing_no_more() -> None:
    own = track((3, 10.5))
    del own.visible_s[3][1:]
    assert judged(fault(), (12.0, "DISABLED", "wrong"), track=own)["apart"] is None


def test_a_fault_without_time_to_be_found_is_set_apart() -> None:
    assert judged(fault(), t_s=39.0)["apart"] == "ended early"
    assert judged(fault(), t_s=41.0)["apart"] is None
    assert judged(fault(end_s=39.0))["apart"] == "ended early"
    assert judged(fault(end_s=41.0))["apart"] is None


def test_a_sonar_disabled_before_its_fault_is_set_apart() -> None:
    assert judged(fault(), (5.0, "DISABLED", "off"))["apart"] == "disabled before"
    assert judged(fault(), (5.0, "DISABLED", "off"), (8.0, "HEALTHY", ""))["apart"] is None


def test_slots_of_a_silent_sonar_count_as_readings() -> None:
    assert judged(fault("silent"), track=track())["apart"] is None
    assert judged(fault("silent"), track=track())["visible_n"] > 1000


def test_a_wrong_name_is_a_doubt_and_no_find() -> None:
    own = judged(fault("slow"), (12.0, "SUSPECT", ""), (13.0, "SUSPECT", "wrong"), (25.0, "SUSPECT", "slow"))
    assert (own["doubted_s"], own["latency_s"], own["found"]) == (3.0, 15.0, False)
    assert judged(fault("slow"), (12.0, "SUSPECT", "slow"))["doubted_s"] == 2.0
    assert judged(fault("slow"), (12.0, "DISABLED", ""))["doubted_s"] == 2.0
    assert judged(fault("slow"), (9.0, "SUSPECT", "wrong"), (12.0, "SUSPECT", ""))["doubted_s"] is None
    assert judged(fault("slow", end_s=30.0), (31.0, "SUSPECT", "slow"))["doubted_s"] is None


def test_readings_in_time_are_those_within_the_bound_and_the_fault() -> None:
    own = track((3, 10.5))  # one a second, twenty of them
    assert judged(fault("off", first_visible_s=10.5), track=own)["visible_in_time"] == 11
    assert judged(fault("wrong", first_visible_s=10.5), track=own)["visible_in_time"] == 20
    assert judged(fault("wrong", first_visible_s=10.5, end_s=13.0), track=own)["visible_in_time"] == 3
    assert judged(fault("off", first_visible_s=None), track=track())["visible_in_time"] == 0
    assert judged(fault("silent", first_visible_s=10.5), track=track())["visible_in_time"] == 94


# ---- false disables and false names -----------------------------------------------------------------------------


def count(health: Changes, *truth: FaultTruth) -> tuple[int, int]:
    made = outcome(*truth, health=health)
    return len(false_disables(made)), len(false_names(made))


def test_each_entry_into_disabled_without_a_fault_is_a_false_disable() -> None:
    twice = [
        (5.0, "DISABLED", ""),
        (6.0, "DISABLED", "off"),
        (9.0, "PROBATION", ""),
        (12.0, "DISABLED", "off"),
    ]
    assert count({3: twice}) == (2, 0)
    assert count({3: twice}, fault(sonar=4)) == (2, 0)


@pytest.mark.parametrize(("at", "wrongly"), [(9.9, 1), (10.0, 0), (30.0, 0), (40.0, 0), (40.1, 1)])
def test_a_disable_is_false_outside_of_the_fault_and_10_s_after_it(at: float, wrongly: int) -> None:
    assert count({3: [(at, "DISABLED", "wrong")]}, fault(end_s=30.0)) == (wrongly, 0)


def test_each_name_of_a_suspect_without_a_fault_is_a_false_name() -> None:
    changes = [(5.0, "SUSPECT", ""), (6.0, "SUSPECT", "off"), (7.0, "SUSPECT", "stuck"), (9.0, "HEALTHY", "")]
    assert count({3: changes}) == (0, 2)
    assert count({3: changes}, fault(onset=4.0)) == (0, 0)


# ---- repaired sonars --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("back", "stand", "t_s", "said"),
    [
        (160.0, (0, 0), 400.0, "back"),
        (161.5, (0, 0), 400.0, "late"),
        (200.0, (100, 140), 400.0, "back"),  # only driving counts
        (None, (0, 0), 400.0, "never"),
        (None, (0, 0), 159.0, "ended early"),
        (None, (100, 380), 400.0, "ended early"),
    ],
)
def test_a_repaired_sonar_is_back_within_60_s_of_driving(
    back: float | None, stand: tuple[float, float], t_s: float, said: str
) -> None:
    changes = [(12.0, "DISABLED", "wrong"), *([(back, "HEALTHY", "")] if back else [])]
    own = track((3, 10.0), stand=stand, t_s=t_s)
    assert judged(fault(end_s=100.0), *changes, track=own, t_s=t_s)["rehabilitation"] == said


@pytest.mark.parametrize(
    "changes", [[], [(12.0, "SUSPECT", "wrong")], [(12.0, "DISABLED", "wrong"), (90.0, "HEALTHY", "")]]
)
def test_only_a_sonar_that_was_given_up_can_come_back(changes: list[tuple[float, str, str]]) -> None:
    assert judged(fault(end_s=100.0), *changes)["rehabilitation"] is None
    assert judged(fault(), (12.0, "DISABLED", "wrong"))["rehabilitation"] is None  # not repaired


# ---- collisions -------------------------------------------------------------------------------------------------

HIT = Collision(50.0, 0.0, 0.0, struck=False)
STRUCK = Collision(50.0, 0.0, 0.0, struck=True)


@pytest.mark.parametrize(
    ("hits", "twin_hits", "attributable"),
    [
        ([HIT], [], True),
        ([HIT], [HIT], False),
        ([HIT], [STRUCK], True),
        ([STRUCK], [], False),
        ([], [], False),
    ],
)
def test_a_collision_is_attributable_when_the_same_seed_without_the_fault_has_none(
    hits: list[Collision], twin_hits: list[Collision], attributable: bool
) -> None:
    record = judge(outcome(fault(), hits=hits), track((3, 10.0)), outcome(hits=twin_hits))
    assert record["attributable"] is attributable


def test_without_a_fault_no_collision_is_attributable() -> None:
    record = judge(outcome(hits=[HIT]), track(), outcome())
    assert not record["attributable"]
    assert record["collisions"] == [[50.0, 0.0, 0.0]]


@pytest.mark.parametrize(("found_at", "undetected"), [(20.0, False), (60.0, True)])
def test_undetected_is_a_fault_there_and_not_given_up_at_the_collision(
    found_at: float, undetected: bool
) -> None:
    made = outcome(fault(), health={3: [(found_at, "DISABLED", "wrong")]}, hits=[HIT])
    assert judge(made, track((3, 10.0)), outcome())["undetected"] is undetected


# ---- the track --------------------------------------------------------------------------------------------------


def test_the_track_sees_what_the_run_did() -> None:
    sightings = Sightings()
    mission = Mission(
        "demo",
        ((1700, 0), (1700, 1550)),
        faults=("stuck:3@2s:value=5000",),
        config={"active": "off"},
        limit_s=8,
    )
    done = run(mission, sightings=sightings)
    own = Track.of(sightings.seen)
    assert own.stuck_mm == {3: {NO_ECHO_MM}}
    assert len(own.visible_s[3]) >= 3
    assert own.visible_s[3][0] == pytest.approx(done.truth[0].first_visible_s, abs=0.1)
    assert own.driving_at(done.t_s) == pytest.approx(done.driving_s, abs=0.3)
