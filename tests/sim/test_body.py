# SPDX-License-Identifier: MIT
"""Rule: the body meets a solid exactly when a brute-force look at its rectangle says so, and presses the bumper
segments, counted left to right, that the solid is in front of."""

from __future__ import annotations

import cmath
import math
import random

import numpy as np
import pytest

from hil_sim import native
from hil_sim.tables import load
from hil_sim.world import body
from hil_sim.world.body import BodyModel
from hil_sim.world.model import Pose, World

BODY = load("robots/p3dx-sh")["body"]
FRONT, REAR, HALF = float(BODY["front_mm"]), float(BODY["rear_mm"]), BODY["width_mm"] / 2
COUNT = BODY["front_bumpers"]
BUMPER_DEPTH = 60.0
FARTHEST = 3000.0
GRAIN = 1.0


def world_of(*segments: tuple[float, float, float, float]) -> World:
    return World("t", np.array(segments, dtype=float).reshape(-1, 4), np.ones(len(segments)))


def grains(world: World, pose: Pose) -> list[complex]:
    """Points of all solids, GRAIN apart or nearer, in the body's frame: real ahead, imaginary left."""
    back = cmath.exp(-1j * math.radians(pose.heading_deg))
    points = []
    for x1, y1, x2, y2 in world.segments.tolist():
        a, b = complex(x1, y1), complex(x2, y2)
        count = max(1, math.ceil(abs(b - a) / GRAIN))
        points += [(a + (b - a) * k / count - complex(pose.x_mm, pose.y_mm)) * back for k in range(count + 1)]
    return points


def depth(point: complex) -> float:
    """How far outside the rectangle a point is; negative: how deep inside."""
    ahead = max(point.real - FRONT, -REAR - point.real)
    aside = abs(point.imag) - HALF
    return math.hypot(max(ahead, 0.0), max(aside, 0.0)) if max(ahead, aside) > 0 else max(ahead, aside)


def random_world(rng: random.Random) -> World:
    segments = []
    for _ in range(rng.randrange(1, 6)):
        x, y, way, length = (
            rng.uniform(-900, 900),
            rng.uniform(-900, 900),
            rng.uniform(0, 7),
            rng.uniform(5, 900),
        )
        segments.append((x, y, x + length * math.cos(way), y + length * math.sin(way)))
    return world_of(*segments)


@pytest.mark.parametrize("seed", range(60))
def test_contact_and_clearance_agree_with_brute_force(seed: int) -> None:
    rng = random.Random(seed)
    world = random_world(rng)
    pose = Pose(rng.uniform(-500, 500), rng.uniform(-500, 500), rng.uniform(-720, 720))
    nearest = min(depth(point) for point in grains(world, pose))
    clearance = BodyModel(world).clearance_mm(pose)
    contact = BodyModel(world).contact(pose, 0.0)
    assert clearance == pytest.approx(max(0.0, min(nearest, FARTHEST)), abs=GRAIN / 2 + 1e-6), f"seed {seed}"
    if abs(nearest) > GRAIN:
        assert (contact is not None) == (nearest < 0), f"seed {seed}"
    assert (contact is not None) == (clearance == 0), f"seed {seed}"


def test_the_random_poses_hit_and_miss() -> None:
    outcomes = set()
    for seed in range(60):
        rng = random.Random(seed)
        world = random_world(rng)
        pose = Pose(rng.uniform(-500, 500), rng.uniform(-500, 500), rng.uniform(-720, 720))
        outcomes.add(BodyModel(world).contact(pose, 0.0) is None)
    assert outcomes == {True, False}


@pytest.mark.parametrize("seed", range(20))
def test_what_a_model_remembers_changes_no_answer(seed: int) -> None:
    rng = random.Random(1000 + seed)
    world = random_world(rng)
    model = BodyModel(world)
    x, y, heading = rng.uniform(-2500, 2500), rng.uniform(-2500, 2500), rng.uniform(-180, 180)
    for step in range(300):
        heading += rng.uniform(-8, 8)
        way = math.atan2(-y, -x) + rng.uniform(-1.5, 1.5)
        x, y = x + 40 * math.cos(way), y + 40 * math.sin(way)
        pose = Pose(x, y, heading)
        fresh = BodyModel(world)
        assert model.contact(pose, 0.0) == fresh.contact(pose, 0.0), f"seed {1000 + seed}, step {step}"
        if step % 7 == 0:
            assert model.clearance_mm(pose) == pytest.approx(fresh.clearance_mm(pose)), f"seed {1000 + seed}"


def expected_bits(points: list[complex], side: float, length: float) -> int:
    """Segments 1 to 5, left to right, in front of which solid lies: by place in the row, not by formula."""
    edges = [HALF - k * 2 * HALF / COUNT for k in range(COUNT + 1)]
    bits = 0
    for point in points:
        if depth(point) <= 0 and side * point.real >= length - BUMPER_DEPTH:
            for k in range(COUNT):
                if edges[k + 1] <= point.imag <= edges[k]:
                    bits |= 1 << (k + 1)
    return bits


def bits_near(points: list[complex], side: float, length: float) -> set[int]:
    """The expected bits, and those that a grain more or less would make of it."""
    shifts = [complex(dx, dy) for dx in (-GRAIN, 0, GRAIN) for dy in (-GRAIN, 0, GRAIN)]
    return {expected_bits([p + s for p in points], side, length) for s in shifts}


@pytest.mark.parametrize("seed", range(60))
def test_pressed_segments_agree_with_brute_force(seed: int) -> None:
    rng = random.Random(2000 + seed)
    # A short solid that comes a little into the body at its front or rear.
    side, length = rng.choice([(1.0, FRONT), (-1.0, REAR)])
    y, reach, width = rng.uniform(-HALF, HALF), rng.uniform(5, 90), rng.uniform(3, 300)
    segment = (side * (length - reach), y, side * (length + rng.uniform(-80, 100)), y + width)
    turn = rng.uniform(-180, 180)
    x0, y0 = rng.uniform(-3000, 3000), rng.uniform(-3000, 3000)
    at = complex(x0, y0)
    ends = [at + complex(*end) * cmath.exp(1j * math.radians(turn)) for end in (segment[:2], segment[2:])]
    world = world_of((ends[0].real, ends[0].imag, ends[1].real, ends[1].imag))
    pose = Pose(x0, y0, turn)
    contact = BodyModel(world).contact(pose, 0.0)
    assert contact is not None
    points = grains(world, pose)
    assert contact.front_segments in bits_near(points, 1.0, FRONT), f"seed {2000 + seed}"
    assert contact.rear_segments in bits_near(points, -1.0, REAR), f"seed {2000 + seed}"


@pytest.mark.parametrize("number", range(1, COUNT + 1))
def test_segments_count_from_the_left(number: int) -> None:
    y = HALF - (number - 0.5) * 2 * HALF / COUNT
    front = BodyModel(world_of((FRONT - 1, y - 2, FRONT - 1, y + 2))).contact(Pose(0, 0, 0), 0.0)
    assert front is not None
    assert (front.front, front.front_segments, front.rear_segments) == (True, 1 << number, 0)
    rear = BodyModel(world_of((1 - REAR, y - 2, 1 - REAR, y + 2))).contact(Pose(0, 0, 0), 0.0)
    assert rear is not None
    assert (rear.front, rear.front_segments, rear.rear_segments) == (False, 0, 1 << number)


def test_a_wall_across_presses_the_whole_bumper_and_one_along_the_side_none() -> None:
    across = BodyModel(world_of((FRONT - 1, -900, FRONT - 1, 900))).contact(Pose(0, 0, 0), 0.0)
    assert across is not None
    assert across.front_segments == 0b111110
    for x, front in ((100.0, True), (-200.0, False)):
        beside = BodyModel(world_of((x, HALF - 1, x, HALF + 90))).contact(Pose(0, 0, 0), 0.0)
        assert beside is not None
        assert (beside.front, beside.front_segments, beside.rear_segments) == (front, 0, 0)


def test_touching_counts_and_a_hair_less_does_not() -> None:
    wall = world_of((1000, -900, 1000, 900))
    assert BodyModel(wall).contact(Pose(1000 - FRONT, 0, 0), 0.0) is not None
    assert BodyModel(wall).contact(Pose(1000 - FRONT - 0.01, 0, 0), 0.0) is None
    assert BodyModel(wall).clearance_mm(Pose(700 - FRONT, 0, 0)) == pytest.approx(300)


def test_clearance_ends_at_three_metres_and_a_bare_world_is_free() -> None:
    assert BodyModel(world_of((5000, -9, 5000, 9))).clearance_mm(Pose(0, 0, 0)) == FARTHEST
    bare = BodyModel(world_of())
    assert bare.clearance_mm(Pose(0, 0, 0)) == FARTHEST
    assert bare.contact(Pose(0, 0, 0), 0.0) is None


def test_a_solid_wholly_inside_the_body_is_met() -> None:
    contact = BodyModel(world_of((-5, 3, 5, 3))).contact(Pose(0, 0, 77), 0.0)
    assert contact is not None
    assert (contact.front_segments, contact.rear_segments) == (0, 0)


@pytest.mark.parametrize("seed", range(20))
def test_clearance_in_c_is_that_of_python(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    assert native.library() is not None, "libargus_sim.so is not built: run tools/dev build release"
    rng = random.Random(f"clearance {seed}")
    world = random_world(rng)
    in_c = BodyModel(world)
    with monkeypatch.context() as patch:
        patch.setattr(body, "library", lambda: None)
        in_python = BodyModel(world)
    near = 0
    for _ in range(200):
        pose = Pose(rng.uniform(-1500, 1500), rng.uniform(-1500, 1500), rng.uniform(-180, 180))
        assert in_c.clearance_mm(pose) == in_python.clearance_mm(pose), f"seed {seed}: {pose}"
        near += 0 < in_c.clearance_mm(pose) < FARTHEST
    assert near > 20
