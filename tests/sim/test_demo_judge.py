# SPDX-License-Identifier: MIT
"""Rule: the judge passes a drive on which everything holds, and for each thing that may go wrong fails exactly
the rules that say so; times of both programs end up on one clock."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from demo_drive import (
    CLOCK_S,
    FAULTS,
    OPEN_S,
    TASK,
    WAYPOINTS,
    Record,
    made_up,
    named,
    read_late,
    robot_s,
    verdict_on,
)

from hil_sim.core.library import kind_name
from hil_sim.demo.judge import Injected, Task, Verdict, clock_offset_s, energy_j, judge, sonar_of
from hil_sim.errors import SimError
from hil_sim.faults.kinds import KIND_NAME
from hil_sim.tables import load

Records = list[Record]
Doctor = Callable[[Records, Records], None]


def rows(truth: Records, kind: str) -> Records:
    """The truth records of one type; change them at will."""
    return [one for one in truth if one["type"] == kind]


def failing(verdict: Verdict) -> set[str]:
    return {rule.name for rule in verdict.rules if not rule.holds}


def event(events: Records, at_s: float, name: str, about: str, value: int) -> None:
    """Slip an event in where its time belongs."""
    place = next((k for k, one in enumerate(events) if robot_s(one) >= at_s), len(events))
    events.insert(place, {"t": at_s + CLOCK_S, "event": name, "level": 2, "name": about, "value": value})


def onset_s(truth: Records, sonar: int) -> float:
    return float(next(one["t_s"] for one in rows(truth, "fault") if sonar in one["sonars"]))


def disable_healthy(_: Records, events: Records) -> None:
    event(events, 20.0, "SONAR_DISABLED", "sonar/front/04", 4)


def disable_healthy_for_a_while(_: Records, events: Records) -> None:
    event(events, 20.0, "SONAR_DISABLED", "sonar/front/04", 4)
    event(events, 25.0, "SONAR_HEALTHY", "sonar/front/04", 1800)


def disable_rear(_: Records, events: Records) -> None:
    event(events, 20.0, "SONAR_DISABLED", "sonar/rear/12", 1)


def name_wrong_kind(_: Records, events: Records) -> None:
    named(events, "SONAR_DISABLED")[0]["value"] = 4


def name_unknown_kind(_: Records, events: Records) -> None:
    named(events, "SONAR_DISABLED")[1]["value"] = 99


def diagnose_early(truth: Records, events: Records) -> None:
    early = next(one for one in named(events, "SONAR_DISABLED") if sonar_of(one) == 6)
    events.remove(early)
    event(events, onset_s(truth, 6) - 0.05, "SONAR_DISABLED", "sonar/front/06", 4)


def miss_a_fault(_: Records, events: Records) -> None:
    events.remove(named(events, "SONAR_DISABLED")[1])


def take_it_back(_: Records, events: Records) -> None:
    event(events, 50.0, "SONAR_HEALTHY", "sonar/front/03", 1800)


def never_inject(truth: Records, _: Records) -> None:
    truth[:] = [one for one in truth if not (one["type"] == "fault" and 6 in one["sonars"])]


def inject_another_kind(truth: Records, _: Records) -> None:
    rows(truth, "fault")[1]["kind"] = "stuck"


def collide(truth: Records, _: Records) -> None:
    truth.insert(900, {"type": "collision", "t_s": 30.0, "x_mm": 900.0, "y_mm": 0.0, "segment": 2})


def end_off_goal(truth: Records, by_mm: float) -> None:
    """Shift the whole path, so that only its end, measured against the goal, differs."""
    for state in rows(truth, "state"):
        state["x_mm"] += by_mm


def end_elsewhere(truth: Records, _: Records) -> None:
    end_off_goal(truth, 151.0)


def end_rolling(truth: Records, _: Records) -> None:
    rows(truth, "state")[-1]["v_mm_s"] = 20.0


def end_turning(truth: Records, _: Records) -> None:
    rows(truth, "state")[-2]["w_deg_s"] = -5.0


def never_say_goal(_: Records, events: Records) -> None:
    events.remove(named(events, "GOAL_REACHED")[0])


def give_up(_: Records, events: Records) -> None:
    named(events, "GOAL_REACHED")[0]["event"] = "MISSION_FAILED"


def give_up_and_arrive(_: Records, events: Records) -> None:
    event(events, 40.0, "MISSION_FAILED", "task", 900)


def take_too_long(truth: Records, events: Records) -> None:
    """Let robot and argusd stand at the goal until the limit is over."""
    said = named(events, "GOAL_REACHED")[0]
    last = rows(truth, "state")[-1]
    late_s = OPEN_S + TASK.limit_s + 0.1
    truth.append({**last, "t_s": late_s + 1.0})
    said["t"] = late_s + CLOCK_S


def break_invariant(_: Records, events: Records) -> None:
    event(events, 33.0, "INVARIANT", "manager", 4)


def lose_events(_: Records, events: Records) -> None:
    event(events, 33.0, "EVENTS_LOST", "events", 17)


GOAL, REST, SAID, TIME = "goal reached", "at rest", "argusd knows it arrived", "in time"
HIT, INJECTED, EQUALS = "nothing hit", "faults came in time", "diagnosis equals injection"
AFTER, HEALTHY, WHOLE = "each after its injection", "no healthy sonar disabled", "argusd is consistent"

DOCTORED: list[tuple[Doctor, set[str]]] = [
    (disable_healthy, {EQUALS, HEALTHY}),
    (disable_healthy_for_a_while, {HEALTHY}),
    (disable_rear, {EQUALS, HEALTHY}),
    (name_wrong_kind, {EQUALS}),
    (name_unknown_kind, {EQUALS}),
    (diagnose_early, {AFTER, HEALTHY}),
    (miss_a_fault, {EQUALS}),
    (take_it_back, {EQUALS}),
    (never_inject, {INJECTED, AFTER, HEALTHY}),
    (inject_another_kind, {INJECTED, AFTER, HEALTHY}),
    (collide, {HIT}),
    (end_elsewhere, {GOAL}),
    (end_rolling, {REST}),
    (end_turning, {REST}),
    (never_say_goal, {SAID, TIME}),
    (give_up, {SAID, TIME}),
    (give_up_and_arrive, {SAID}),
    (take_too_long, {TIME}),
    (break_invariant, {WHOLE}),
    (lose_events, {WHOLE}),
]


def test_a_good_drive_passes() -> None:
    verdict = verdict_on(*made_up())
    assert failing(verdict) == set()
    assert verdict.passed
    assert verdict.false_disables == ()


@pytest.mark.parametrize(("doctor", "rules"), DOCTORED, ids=[one.__name__ for one, _ in DOCTORED])
def test_a_doctored_drive_fails_just_these_rules(doctor: Doctor, rules: set[str]) -> None:
    truth, events = made_up()
    doctor(truth, events)
    verdict = verdict_on(truth, events)
    assert failing(verdict) == rules
    assert not verdict.passed


def test_every_rule_is_broken_by_some_doctored_drive() -> None:
    assert {name for _, rules in DOCTORED for name in rules} == {
        rule.name for rule in verdict_on(*made_up()).rules
    }


@pytest.mark.parametrize(
    ("off_mm", "holds"), [(149.0, True), (150.5, False), (-149.0, True), (-151.0, False)]
)
def test_the_goal_is_a_circle_of_150_mm(off_mm: float, holds: bool) -> None:
    truth, events = made_up()
    end_off_goal(truth, off_mm)
    assert (GOAL not in failing(verdict_on(truth, events))) is holds


@pytest.mark.parametrize(("late_s", "holds"), [(-0.1, True), (0.1, False)])
def test_the_time_limit_is_robot_time_from_the_opened_session(late_s: float, holds: bool) -> None:
    truth, events = made_up()
    taken = robot_s(named(events, "GOAL_REACHED")[0]) - OPEN_S
    verdict = judge(truth, events, Task(WAYPOINTS[-1], FAULTS, limit_s=taken - late_s))
    assert (TIME not in failing(verdict)) is holds


@pytest.mark.parametrize(("left_mm", "holds"), [(1499.0, False), (1501.0, True)])
def test_a_fault_needs_way_before_it(left_mm: float, holds: bool) -> None:
    truth, events = made_up()
    states = rows(truth, "state")
    way = 0.0
    for before, after in zip(reversed(states[:-1]), reversed(states[1:]), strict=True):
        way += math.hypot(after["x_mm"] - before["x_mm"], after["y_mm"] - before["y_mm"])
        if way >= left_mm:
            break
    # Shrink the world so that the state found lies exactly this far before the end.
    scale = left_mm / way
    for state in states:
        state["x_mm"] *= scale
        state["y_mm"] *= scale
    rows(truth, "fault")[1]["t_s"] = before["t_s"]
    found = next(one for one in named(events, "SONAR_DISABLED") if sonar_of(one) == 6)
    found["t"] = before["t_s"] + 0.5 + CLOCK_S
    goal = (WAYPOINTS[-1][0] * scale, WAYPOINTS[-1][1] * scale)
    verdict = judge(truth, events, Task(goal, FAULTS))
    assert failing(verdict) == (set() if holds else {INJECTED})
    assert verdict.findings[1].way_left_mm == pytest.approx(left_mm)


def test_latency_counts_from_the_first_false_reading_not_from_the_onset() -> None:
    truth, events = made_up()
    start = onset_s(truth, 6)
    pings = [one for one in rows(truth, "sonar") if one["sonar"] == 6 and one["t_s"] >= start]
    for ping in pings[:3]:
        ping["range_mm"] = ping["true_mm"] - 100
    finding = verdict_on(truth, events).findings[1]
    assert finding.diagnosed is not None
    assert finding.first_off_s == pings[3]["t_s"]
    assert finding.latency_s == pytest.approx(finding.diagnosed.t_s - pings[3]["t_s"])


def test_far_readings_may_be_off_by_five_percent() -> None:
    truth, events = made_up()
    start = onset_s(truth, 6)
    pings = [one for one in rows(truth, "sonar") if one["sonar"] == 6 and one["t_s"] >= start]
    for ping, off in zip(pings, (190, 200, 201), strict=False):
        ping["true_mm"], ping["range_mm"] = 4000, 4000 - off
    assert verdict_on(truth, events).findings[1].first_off_s == pings[2]["t_s"]


def test_a_drive_without_faults_wants_none_found() -> None:
    truth, events = made_up()
    events = [one for one in events if one["event"] != "SONAR_DISABLED"]
    verdict = judge(truth, events, Task(WAYPOINTS[-1], ()))
    assert failing(verdict) <= {INJECTED}
    assert EQUALS in failing(judge(truth, events, Task(WAYPOINTS[-1], (Injected("off", 1),))))


def test_the_journey_in_figures() -> None:
    truth, events = made_up()
    journey = verdict_on(truth, events).journey
    assert journey is not None
    assert journey.way_mm == pytest.approx(3250, abs=5)
    assert journey.start_s == OPEN_S
    assert journey.time_s == pytest.approx(robot_s(named(events, "GOAL_REACHED")[0]) - OPEN_S)
    assert journey.sweeps == len(named(events, "SWEEP"))
    assert journey.stop_commands == 2
    assert [plan.rotations_deg for plan in journey.plans] == [(-20,), (-20,)]
    assert journey.turned_deg == pytest.approx(90 + 40 * journey.sweeps, abs=1)
    least = min(state["clearance_mm"] for state in rows(truth, "state"))
    assert journey.closest_mm == pytest.approx(least)


def test_energy_scales_the_idle_power_alone() -> None:
    power = load("energy")["power"]
    account = {"idle_s": 0.0, "sonar_s": 0.0, "wheel_m": 0.0, "accel_j": 0.0}
    start = {"energy_j": account}
    end = {"energy_j": {"idle_s": 10.0, "sonar_s": 10.0, "wheel_m": 2.0, "accel_j": 3.0}}
    once, twice = energy_j(start, end), energy_j(start, end, 2.0)
    assert twice - once == pytest.approx(10.0 * power["idle_w"])
    rest = 10.0 * power["sonar_w"] + 2.0 * power["wheel_j_per_m"] + 3.0
    assert once == pytest.approx(10.0 * power["idle_w"] + rest)


# ---- clocks --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(5))
def test_wall_times_join_the_clocks_whatever_the_delays(seed: int) -> None:
    truth, events = made_up()
    read_late(truth, events, seed)
    assert clock_offset_s(truth, events) == pytest.approx(-CLOCK_S, abs=1e-6), f"seed {seed}"


def test_wall_times_win_over_the_sessions_opening() -> None:
    truth, events = made_up()
    read_late(truth, events, 1)
    named(events, "SESSION_OPEN")[0]["t"] += 0.15
    assert clock_offset_s(truth, events) == pytest.approx(-CLOCK_S, abs=1e-6)


def test_without_wall_times_the_opened_session_joins_them() -> None:
    truth, events = made_up()
    named(events, "SESSION_OPEN")[0]["t"] += 0.15
    assert clock_offset_s(truth, events) == pytest.approx(-CLOCK_S - 0.15)


def test_wall_times_in_one_stream_only_do_not_count() -> None:
    truth, events = made_up()
    read_late(truth, events, 1)
    for one in events:
        del one["wall_s"]
    assert clock_offset_s(truth, events) == pytest.approx(-CLOCK_S)


def test_the_verdict_is_the_same_with_and_without_wall_times() -> None:
    truth, events = made_up()
    plain = verdict_on(truth, events)
    read_late(truth, events, 2)
    walled = verdict_on(truth, events)
    assert walled.passed
    assert [one.latency_s for one in walled.findings] == pytest.approx(
        [one.latency_s for one in plain.findings]
    )


def with_calendar(truth: Records, events: Records) -> None:
    """The calendar times that both programs write: one clock record, and a status rounded to ms."""
    truth.insert(1, {"type": "clock", "t_s": 0.002, "unix_s": 1.7e9 + 0.002})
    for number, status in enumerate(named(events, "STATUS")):
        status["unix"] = round(1.7e9 + robot_s(status) + number % 3 * 0.004, 3)


def test_calendar_times_join_the_clocks_where_no_reader_noted_any() -> None:
    truth, events = made_up()
    with_calendar(truth, events)
    named(events, "SESSION_OPEN")[0]["t"] += 0.25
    assert clock_offset_s(truth, events) == pytest.approx(-CLOCK_S, abs=0.002)
    assert verdict_on(truth, events).passed


def test_a_readers_notes_win_over_calendar_times() -> None:
    truth, events = made_up()
    with_calendar(truth, events)
    truth[1]["unix_s"] += 3600.0
    read_late(truth, events, 3)
    assert clock_offset_s(truth, events) == pytest.approx(-CLOCK_S, abs=1e-6)


def test_clocks_that_cannot_be_joined_are_an_error_in_one_line() -> None:
    truth, events = made_up()
    with pytest.raises(SimError, match="cannot be joined") as raised:
        clock_offset_s(truth, [one for one in events if one["event"] != "SESSION_OPEN"])
    assert "\n" not in str(raised.value)


def test_nothing_recorded_is_an_error_in_one_line() -> None:
    with pytest.raises(SimError, match="nothing to judge"):
        judge([], [], TASK)


@pytest.mark.parametrize(("kind", "holds"), [(4, True), (3, False)])
def test_the_last_kind_of_a_sonar_counts(kind: int, holds: bool) -> None:
    truth, events = made_up()
    found = next(one for one in named(events, "SONAR_DISABLED") if sonar_of(one) == 6)
    found["value"] = 7 - kind
    event(events, robot_s(found) + 2.0, "SONAR_KIND", "sonar/front/06", kind)
    event(events, robot_s(found) + 2.0, "SONAR_KIND", "sonar/front/04", 4)  # of one that is not DISABLED
    verdict = verdict_on(truth, events)
    assert failing(verdict) == (set() if holds else {EQUALS})
    assert verdict.findings[1].diagnosed_kind == ("wrong" if holds else "stuck")
    assert verdict.findings[1].diagnosed is not None
    assert verdict.findings[1].diagnosed.t_s == pytest.approx(robot_s(found))


def test_the_kinds_are_called_as_the_fault_manager_calls_them() -> None:
    assert {number: kind_name(number) for number in KIND_NAME} == dict(KIND_NAME)
    assert kind_name(max(KIND_NAME) + 1) == "?"
