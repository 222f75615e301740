# SPDX-License-Identifier: MIT
"""Rule: `physics = recorded` is as the fitted table says, from the seed alone, and still in a still world."""

from __future__ import annotations

import dataclasses
from collections import defaultdict
from typing import Any

import numpy as np
import pytest

from hil_sim.bench.journey import parse_row
from hil_sim.bench.journey_course import ROUGH_DRIFT_DEG_M
from hil_sim.sil import Mission, run
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM, SonarParams
from hil_sim.sonar.recorded import Recorded
from hil_sim.sonar.ring import SonarRing
from hil_sim.sonar.rough import Roughness
from hil_sim.tables import load
from hil_sim.world.files import load_world
from hil_sim.world.model import Pose
from hil_sim.world.physics import SETS, Physics, parse_physics

SEEDS = range(6)
TABLE: dict[str, Any] = load("recorded")
HERE = Pose(0.0, 0.0, 0.0)


def at_rest(physics: Physics, seed: int, seconds: float = 6.0) -> list[list[int]]:
    """Return what each sonar reads while the robot stands at the start of `lab`."""
    world = load_world("lab")
    rough = Roughness(physics, 16, np.random.default_rng([seed, 3]))
    ring = SonarRing(world, SonarParams(), None, np.random.default_rng([seed, 2]), rough=rough)
    found: dict[int, list[int]] = defaultdict(list)
    for now in range(0, int(seconds * 1000), 10):
        for reading in ring.advance(now, lambda _: world.start):
            found[reading.number].append(reading.range_mm)
    return list(found.values())


def test_at_rest_it_is_as_quiet_and_repeats_as_often_as_the_recordings() -> None:
    rows = [np.array(row) for seed in SEEDS for row in at_rest(SETS["recorded"], seed)]
    heard = [row for row in rows if row.max() < NO_ECHO_MM]
    assert len(heard) > 30
    spread = float(np.median([row.std() for row in heard]))
    repeats = float(np.concatenate([np.diff(row) == 0 for row in heard]).mean())
    assert abs(spread - TABLE["rest"]["spread_mm"]) < 0.25, f"{spread} mm, seeds {SEEDS}"
    assert abs(repeats - TABLE["rest"]["repeats"]) < 0.12, f"{repeats}, seeds {SEEDS}"


def test_silence_and_short_echoes_stay_while_the_world_is_still() -> None:
    for seed in SEEDS:
        for row in at_rest(SETS["recorded"], seed):
            values = np.array(row)
            assert (values == NO_ECHO_MM).all() or not (values == NO_ECHO_MM).any(), f"seed {seed}: {row}"
            assert np.ptp(values) < 20, f"seed {seed}: {row}"


def test_coarse_steps_are_steps_and_end_at_the_floor() -> None:
    step_mm = SETS["coarse-steps"].range_step_mm
    assert step_mm == pytest.approx(TABLE["rest"]["step_mm"], abs=0.1)
    grid = {round(k * step_mm) for k in range(2000)} | {MIN_MM, NO_ECHO_MM}
    assert {value for row in at_rest(SETS["coarse-steps"], 1) for value in row} <= grid
    rough = Roughness(SETS["coarse-steps"], 16, np.random.default_rng(1))
    assert rough.stepped(MIN_MM) >= MIN_MM


def shares(strength: float = 1.0, seeds: range = range(40)) -> tuple[np.ndarray[Any, Any], float]:
    """Return how often each sonar misses an echo from 2 m, over many places, and how often it hears one too near."""
    missed, near = [], []
    for seed in seeds:
        recorded = Recorded(strength, 8, np.random.default_rng(seed))
        rng = np.random.default_rng(seed)
        places = [Pose(float(x), float(y), float(deg)) for x, y, deg in rng.uniform(-9000, 9000, (150, 3))]
        for number in range(8):
            heard = [recorded.heard(number, place, place, 2000.0) for place in places]
            missed.append(sum(value == NO_ECHO_MM for value in heard) / len(heard))
            near.append(sum(value < 2000 for value in heard) / len(heard))
    return np.array(missed), float(np.mean(near))


def test_sonars_differ_in_what_they_miss_as_the_recorded_ones_do() -> None:
    missed, near = shares()
    model = TABLE["silence"]["model"]
    whole = model + (1 - model) * missed  # together with what the plain model misses
    assert np.quantile(whole, 0.9) / np.quantile(whole, 0.1) > 3, "seeds 0 to 39"
    assert whole.mean() == pytest.approx(np.mean(TABLE["silence"]["by_sonar"]), abs=0.05)
    assert near == pytest.approx(TABLE["near"]["share"], abs=0.004)


def test_nothing_is_missed_that_is_near_and_nothing_at_all_at_strength_0() -> None:
    recorded = Recorded(1.0, 16, np.random.default_rng(3))
    recorded._near = 0.0
    for number in range(16):
        for x in range(-5000, 5000, 70):
            place = Pose(float(x), 0.0, 10.0)
            assert recorded.heard(number, place, place, TABLE["silence"]["heard_mm"] - 1.0) < NO_ECHO_MM
            assert recorded.heard(number, place, place, float(NO_ECHO_MM)) == NO_ECHO_MM
    missed, near = shares(1e-9, range(3))
    assert missed.max() == near == 0


def test_an_echo_is_late_by_whole_half_waves_and_as_often_as_drawn() -> None:
    recorded = Recorded(1.0, 8, np.random.default_rng(5))
    step_mm = TABLE["rest"]["step_mm"]
    for number, share in enumerate([0.0, 0.25, 0.8, *recorded.late[3:]]):
        recorded.late[number] = share
        late = np.random.default_rng(number).random(4000)
        waves = np.array(
            [(recorded.measured(number, 1000.0, 9.0, 0.0, one) - 1000) / step_mm for one in late]
        )
        assert waves == pytest.approx(np.round(waves), abs=1e-6)
        assert (waves > 0).mean() == pytest.approx(share, abs=0.03)
        assert waves.max() <= 3


def test_a_mission_is_the_same_again_and_other_physics_are_as_before() -> None:
    mission = Mission("office", ((3000, 0),), physics="recorded", limit_s=15.0)
    once = run(mission).digest
    assert run(mission).digest == once
    assert run(dataclasses.replace(mission, seed=2)).digest != once
    # A stream of its own: what else is rough is drawn as without it.
    plain, both = (
        Roughness(parse_physics(text), 16, np.random.default_rng(4))
        for text in ("rough-day", "rough-day,as_recorded=1")
    )
    assert (plain.gain_db, plain.scale) == (both.gain_db, both.scale)
    assert [plain.draw() for _ in range(50)] == [both.draw() for _ in range(50)]
    assert (plain.recorded is None, both.recorded is None) == (True, False)


def test_journeys_have_rows_of_them_and_only_a_rough_day_drifts_more() -> None:
    for name, physics in (("recorded", "recorded"), ("steps", "coarse-steps"), ("rough", "rough-day")):
        row = parse_row(f"rooms+{name}+people")
        assert row.physics == physics
        assert (row.drift_deg_m == ROUGH_DRIFT_DEG_M) == (name == "rough")
