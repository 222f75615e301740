# SPDX-License-Identifier: MIT
"""Rule: each bar is judged by the row it is of, on its bound, and only where that row was run."""

from __future__ import annotations

from typing import Any

from bench.journeys import journey, with_ideal
from bench.missions import judged

from hil_sim.bench.journey_bars import bars, found_of_one
from hil_sim.bench.journey_figures import summarise


def verdicts(records: list[dict[str, Any]]) -> dict[str, str]:
    return {bar.name: bar.verdict for bar in bars(summarise(records))}


def many(row: str, count: int, **more: Any) -> list[dict[str, Any]]:
    return [
        one for seed in range(1, count + 1) for one in with_ideal(f"argus/judge/{row}/lab/{seed}", **more)
    ]


def test_nothing_run_nothing_judged() -> None:
    assert bars(summarise([])) == []
    assert bars(summarise([journey("paper/judge/rooms/lab/1")])) == []


def test_goals_pass_by_their_bound() -> None:
    name = "rooms: goals truly reached"
    assert verdicts(many("rooms", 100))[name] == "pass"
    assert verdicts(many("rooms", 30))[name] == "open"
    lost = many("rooms", 28) + [journey(f"argus/judge/rooms/lab/{k}", truly=False) for k in (29, 30)]
    assert verdicts(lost)[name] == "fail"


def test_speeds_are_judged_against_the_ideal() -> None:
    assert verdicts(many("rooms", 9, t_s=160.0))["rooms: speed over the ideal"] == "pass"
    assert verdicts(many("rooms", 9, t_s=170.0))["rooms: speed over the ideal"] == "fail"
    assert verdicts(many("rooms+rough", 9, t_s=170.0))["rooms+rough: speed over the ideal"] == "pass"
    mixed = many("rooms", 6, t_s=150.0) + with_ideal("argus/judge/rooms/lab/9", t_s=240.0)
    assert verdicts(mixed)["rooms: speed over the ideal"] == "open"


def test_looking_and_names_are_of_the_clock() -> None:
    said = verdicts(many("rooms", 12, looking_s=9.0))
    assert said["rooms: looking in a clock hour"] == "pass"
    assert said["rooms: false names in a clock hour"] == "pass"
    named = [{"t_s": 1.0, "sonar": 2, "kind": "off"}]
    said = verdicts(many("rooms", 12, looking_s=11.0, false_names=named))
    assert said["rooms: looking in a clock hour"] == "fail"
    assert said["rooms: false names in a clock hour"] == "fail"


def test_a_collision_by_a_fault_fails_whatever_the_row() -> None:
    name = "all rows: attributable collisions"
    assert verdicts(many("rooms", 3))[name] == "open"
    hit = journey("argus/judge/rooms+one/lab/1", attributable=True, collisions=[[1.0, 0.0, 0.0]])
    assert verdicts([*many("rooms", 3), hit])[name] == "fail"


def test_near_a_wall_counts_on_a_healthy_robot_only() -> None:
    name = "healthy rows: closest to a wall in free driving (in rooms)"
    assert verdicts(many("rooms", 2, closest_mm=49.0))[name] == "fail"
    fine = many("rooms", 2)
    assert verdicts([*fine, journey("argus/judge/rooms+one/lab/1", closest_mm=9.0)])[name] == "pass"


def test_a_goal_behind_walls_must_be_called_one() -> None:
    name = "closed: says that there is no way"
    given_up = [
        journey(f"argus/judge/closed/closed-1/{k}", word="failed", truly=False) for k in range(1, 101)
    ]
    assert verdicts(given_up)[name] == "pass"
    assert verdicts([one | {"word": "running"} for one in given_up])[name] == "fail"


def test_what_is_found_is_judged_where_one_fails_alone() -> None:
    some = [
        journey("argus/judge/rooms+one/lab/1", faults=[judged("off"), judged("slow", found=False)]),
        journey("argus/judge/rooms+front/lab/1", faults=[judged("off", found=False, latency_s=None)] * 8),
    ]
    (row,) = [bar for bar in bars(summarise(some)) if bar.name == "rows of one fault: found in time"]
    assert (row.value, row.cases, row.verdict) == (0.5, 2, "fail")
    kinds = found_of_one(summarise(some))
    assert (kinds["slow"]["in_time"]["hits"], kinds["slow"]["ever"]["hits"]) == (0, 1)
    assert set(kinds) == {"all", "off", "slow"}


def test_an_obstacle_set_is_judged_by_the_word_of_the_robot() -> None:
    off = [journey(f"argus/judge/doors/doors-1/{k}", truly=False, goal_mm=300.0) for k in range(1, 101)]
    assert verdicts(off)["doors: goals reached by its word"] == "pass"
    lost = [one | {"word": "running"} for one in off]
    assert verdicts(lost)["doors: goals reached by its word"] == "fail"


def test_somebody_met_ahead_fails_a_row_with_people() -> None:
    name = "rows with people: somebody met ahead"
    for met, verdict in ((0, "pass"), (1, "fail")):
        assert verdicts(many("rooms+people", 4, met_ahead=met, walked_into=3))[name] == verdict
    assert name not in verdicts(many("rooms", 4))
