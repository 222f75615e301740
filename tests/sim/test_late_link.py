# SPDX-License-Identifier: MIT
"""Rule: a link that becomes late makes the robot slow, then stand; it drives into nothing and reaches no false goal."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Final

import pytest
from dead_front import FRONT, Case

from hil_sim.bench.journey_worlds import place_of
from hil_sim.sil import Mission, Outcome, run

WORLDS: Final = ("doors-1", "corridors-1", "bends-1", "dead-ends-1", "map-office", "map-floor")
SHAPES: Final = ("both", "to_client", "to_robot", "ramp", "jitter", "pulses")
DELAYS_MS: Final = (100, 200, 400, 600, 900, 1300, 2000)
LIMIT_S: Final = 30.0
FALSE_MM: Final = 150.0
STALE: Final = tuple(range(40601, 40631))
"""Seeds of a course on which late SIPs used to end in false goals."""


def _delay(start_s: float, end_s: float | None, ms: float, way: str) -> str:
    end = "" if end_s is None else f"-{end_s:.2f}s"
    return f"link-delay@{start_s:.2f}s{end}:ms={ms:.0f}:dir={way}"


def _windows(rng: random.Random, at_s: float, ms: float, shape: str) -> tuple[str, ...]:
    """Delays of random size one after the other, or delays of one size with pauses between them."""
    faults: list[str] = []
    while at_s < LIMIT_S:
        lasts_s = rng.uniform(0.2, 1.5)
        way = "both" if shape == "jitter" else rng.choice(("both", "to_client", "to_robot"))
        faults.append(_delay(at_s, at_s + lasts_s, rng.uniform(0, ms) if shape == "jitter" else ms, way))
        at_s += lasts_s + (0 if shape == "jitter" else rng.uniform(0.5, 4))
    return tuple(faults)


def _faults(shape: str, ms: float, rng: random.Random) -> tuple[str, ...]:
    at_s = rng.uniform(2.5, 12)
    if shape == "ramp":
        return tuple(_delay(at_s + 0.3 * k, None, ms / 10, "both") for k in range(10))
    if shape in ("jitter", "pulses"):
        return _windows(rng, at_s, ms, shape)
    return (_delay(at_s, None, ms, shape),)


def _drive(seed: int, shape: str, ms: float) -> Outcome:
    place = place_of(WORLDS[seed % len(WORLDS)], (4302, seed // len(WORLDS)))
    faults = _faults(shape, ms, random.Random(f"late {seed} {shape} {ms}")) if ms else ()
    x_mm, y_mm, heading_deg = place.begins[:3]
    start = (x_mm, y_mm, heading_deg)
    return run(Mission(place.path, place.course, start, faults=faults, seed=43000 + seed, limit_s=LIMIT_S))


def _wrong(outcome: Outcome) -> str:
    """What must not be: something hit, or a goal that is told and not true."""
    told = any(event.name == "GOAL_REACHED" for event in outcome.events)
    hit = [c for c in outcome.collisions if not c.struck]
    if hit:
        return f"hit something at {hit[0].t_s:.1f} s"
    return (
        f"{outcome.goal_mm:.0f} mm off the goal that it tells" if told and outcome.goal_mm > FALSE_MM else ""
    )


def _names(outcome: Outcome) -> set[str]:
    return {event.name for event in outcome.events}


@pytest.mark.parametrize(
    ("shape", "ms"), [("both", 400), ("to_robot", 900), ("to_client", 2000), ("jitter", 1300)]
)
def test_nothing_is_hit_when_the_link_becomes_late(shape: str, ms: int) -> None:
    seed = SHAPES.index(shape)
    outcome = _drive(seed, shape, ms)
    assert not _wrong(outcome), f"seed {seed}, {shape}, {ms} ms: {_wrong(outcome)}"
    assert "LINK_SLOW" in _names(outcome)


def test_a_link_without_delay_is_never_slow() -> None:
    for seed in range(3):
        names = _names(_drive(seed, "both", 0))
        assert not names & {"LINK_SLOW", "LINK_PROMPT"}, f"seed {seed}"


def test_a_delay_that_ends_is_reported_and_the_robot_arrives() -> None:
    faults = (_delay(3, 5, 900, "both"),)
    outcome = run(
        Mission("demo", ((900, 0), (1500, 300)), faults=faults, seed=7, limit_s=60, stop_at_goal=False)
    )
    assert {"LINK_SLOW", "LINK_PROMPT"} <= _names(outcome)
    assert outcome.reached
    assert not _wrong(outcome)


def test_late_readings_end_in_no_false_goal() -> None:
    for seed in STALE[:3]:
        assert not _wrong(_stale(seed, 3500)), f"seed {seed}"


def _stale(seed: int, ms: int) -> Outcome:
    faults = (_delay(2.5, None, ms, "to_client"),)
    return run(Mission("demo", ((900, 0), (1500, 300)), faults=faults, seed=seed, limit_s=60))


@pytest.mark.parametrize("robot", ["p3dx-sh", "p3at-sh"])
@pytest.mark.parametrize("box_x_mm", [3500.0, 4500.0])
def test_what_was_heard_before_a_gap_shows_no_living_array_behind_it(
    robot: str, box_x_mm: float, tmp_path: Path
) -> None:
    """The front dies in a bare hall while the robot stands for the link: nothing tells of it but the silence."""
    file = tmp_path / "hall.yaml"
    file.write_text(Case(walls="none", box_x_mm=box_x_mm).world(), encoding="utf-8")
    faults = (*(f"off:{k}@4s" for k in FRONT), _delay(3, None, 300, "both"))
    outcome = run(Mission(str(file), ((14_000, 0),), faults=faults, robot=robot, seed=3, limit_s=60))
    assert "LINK_SLOW" in _names(outcome)
    assert not _wrong(outcome), _wrong(outcome)


def test_a_mission_whose_link_is_never_in_time_fails_with_the_reason() -> None:
    """32 readings in each SIP take 160 ms at 9600 baud, and there is one each 100 ms."""
    mission = Mission(
        "office", ((2000, 0),), robot="peoplebot-sh", quirks="mobilesim", baud=9600, limit_s=120
    )
    outcome = run(mission)
    names = [event.name for event in outcome.events]
    assert names[-2:] == ["LINK_SLOW", "MISSION_FAILED"]
    assert outcome.driven_mm == 0


@pytest.mark.wide
@pytest.mark.parametrize("shape", SHAPES)
def test_nothing_is_hit_in_many_runs(shape: str) -> None:
    wrong = []
    for seed in range(40):
        ms = DELAYS_MS[seed % len(DELAYS_MS)]
        if _wrong(_drive(seed, shape, 0)):
            continue  # the way itself, link or no link
        if why := _wrong(_drive(seed, shape, ms)):
            wrong.append(f"seed {seed}, {shape}, {ms} ms: {why}")
    assert not wrong, wrong


@pytest.mark.wide
@pytest.mark.parametrize("ms", [2500, 3500])
def test_late_readings_end_in_no_false_goal_in_many_runs(ms: int) -> None:
    wrong = [f"seed {seed}: {why}" for seed in STALE if (why := _wrong(_stale(seed, ms)))]
    assert not wrong, wrong
