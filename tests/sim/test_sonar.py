# SPDX-License-Identifier: MIT
"""Rule: a transducer reads the nearest echo in its cone that is loud enough, with the noise and crosstalk asked for,
clipped to 100..5000; and fires when its array's clock and order say so, the same for the same seed."""

from __future__ import annotations

import math
import random
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from hil_sim.faults.execute import FaultSet
from hil_sim.faults.grammar import parse_fault
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import Reading, SonarParams
from hil_sim.sonar.ring import SonarRing
from hil_sim.tables import load
from hil_sim.world.model import Pose, World

TABLE = load("robots/p3dx-sh")["sonar"]
LOW: int = TABLE["min_mm"]
NONE: int = TABLE["no_echo_mm"]
CYCLE: int = TABLE["cycle_ms"]
HALF_CONE = TABLE["cone_deg"] / 2
MOUNTS = {p["number"]: p for p in TABLE["pose"]}
FAR = 60_000.0
RADIUS = load("robots/p3dx-sh")["body"]["tolerance_centre_mm"]
SOUND_MM_MS = 343.0
QUIET = SonarParams(noise_mm=0, noise_part=0, crosstalk=0)
HOME = Pose(0, 0, 0)


def world_of(*segments: tuple[float, float, float, float], roughness: float = 1.0) -> World:
    rows = np.array(segments, dtype=float).reshape(-1, 4)
    return World("t", rows, np.full(len(rows), roughness))


def tilted(distance: float, tilt_deg: float, roughness: float = 1.0) -> World:
    """A wall without ends whose foot from the origin lies at `distance`, `tilt_deg` to the left of ahead."""
    c, s = math.cos(math.radians(tilt_deg)), math.sin(math.radians(tilt_deg))
    x, y = distance * c, distance * s
    return world_of((x + FAR * s, y - FAR * c, x - FAR * s, y + FAR * c), roughness=roughness)


def ahead(world: World, heading_deg: float = 0.0, params: SonarParams = QUIET) -> int:
    return EchoModel(world, params).range_mm(0, 0, heading_deg)


# ---- echoes -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("roughness", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("distance", [100, 101, 245, 999.4, 1000, 2500, 4999])
def test_a_wall_square_on_reads_its_distance(distance: float, roughness: float) -> None:
    assert ahead(tilted(distance, 0, roughness)) == round(distance)


def test_readings_are_clipped_to_100_and_5000() -> None:
    assert ahead(tilted(40, 0)) == LOW
    assert ahead(tilted(5200, 0)) == NONE
    assert ahead(world_of()) == NONE
    assert ahead(tilted(1000, 180)) == NONE


@pytest.mark.parametrize("distance", [245, 1000, 2000])
@pytest.mark.parametrize("tilt", [-40, -25, -15, -14, -5, 0, 1, 7.3, 15, 20, 33, 50])
def test_a_rough_wall_reads_its_nearest_point_in_the_cone(tilt: float, distance: float) -> None:
    expected = distance / math.cos(math.radians(max(0.0, abs(tilt) - HALF_CONE)))
    # The rays of the fan stand 1.5 degrees apart: the nearest is within 0.75 of the foot.
    assert ahead(tilted(distance, tilt)) == pytest.approx(expected, abs=1 + distance * 1e-4)


# At 1 m and the default parameters: largest angle between axis and normal at which a wall is heard. docs/worlds.md.
LIMIT_DEG = {0.0: 20.75, 0.25: 22.75, 0.5: 27.5, 0.8: 52.25, 1.0: 86.5}


# Wall's distance from sonar 3, which is square-on, to what sonar 2 reads more.
NEIGHBOUR_MM = {245: 10, 500: 11, 1000: 13, 2000: 16, 4000: 24}


@pytest.mark.parametrize("roughness", LIMIT_DEG)
def test_a_smooth_wall_mirrors_sound_away_beyond_its_angle_and_a_rough_one_does_not(roughness: float) -> None:
    limit = LIMIT_DEG[roughness]
    for side in (1, -1):
        assert ahead(tilted(1000, side * limit, roughness)) < NONE
        for beyond in (0.5, 1, 2, 3):
            assert ahead(tilted(1000, side * (limit + beyond), roughness)) == NONE
    for tilt in np.arange(limit + 0.5, 60, 2.5):
        assert ahead(tilted(1000, tilt, roughness)) == NONE
        assert ahead(tilted(1000, tilt, 1.0)) < NONE


def loss_db(roughness: float, tilt: float, off: float, distance: float) -> float:
    """The loss of a ray `off` degrees from the axis at a wall tilted by `tilt`, from docs/worlds.md."""
    incidence = tilt - off
    way = distance / math.cos(math.radians(incidence))
    beam, mirror = 20 * (off / HALF_CONE) ** 2, 0.24 * (1 - roughness) ** 2 * incidence**2
    return float(beam) + mirror - 20 * math.log10(math.cos(math.radians(incidence))) + 2 * way / 1000


@pytest.mark.parametrize("seed", range(200))
def test_a_lone_wall_agrees_with_the_documented_losses(seed: int) -> None:
    rng = random.Random(seed)
    roughness, tilt, distance = rng.random(), rng.uniform(-70, 70), rng.uniform(200, 4500)
    rays = [off for k in range(-10, 11) if abs(tilt - (off := HALF_CONE * k / 10)) < 89]

    def nearest(margin: float) -> float:
        ranges = [
            distance / math.cos(math.radians(tilt - off))
            for off in rays
            if loss_db(roughness, tilt, off, distance) <= margin
        ]
        return min(NONE, round(min(ranges))) if ranges else NONE

    model = ahead(tilted(distance, tilt, roughness))
    assert nearest(30 + 1e-6) - 1 <= model <= nearest(30 - 1e-6) + 1, f"seed {seed}"


def test_specular_loss_can_be_switched_off() -> None:
    plain = SonarParams(specular=False)
    assert ahead(tilted(1000, 40, 0.0), params=plain) == ahead(tilted(1000, 40, 1.0))


@pytest.mark.parametrize("distance", [500, 1000, 2000])
def test_an_inner_corner_of_smooth_walls_sends_sound_back(distance: int) -> None:
    arms = 3000
    one, other = (distance, 0, distance - arms, arms), (distance, 0, distance - arms, -arms)
    both = world_of(one, other, roughness=0.0)
    for heading in (-10, 0, 10):
        # Each wall alone stands at 35 to 55 degrees, far beyond what it sends back.
        assert ahead(both, heading) == distance
        # Without the corner between them neither is heard.
        past = world_of((distance + arms, -arms, distance - arms, arms), roughness=0.0)
        assert ahead(past, heading) == NONE


def test_a_corner_returns_sound_to_who_looks_into_it_only() -> None:
    # An outer corner is as loud as an edge: 18 dB less than a wall. Against 25 dB it is heard, against 15 not.
    outer = world_of((1000, 0, 2000, 900), (1000, 0, 2000, -900), roughness=0.0)
    inner = world_of((1000, 0, 100, 900), (1000, 0, 100, -900), roughness=0.0)
    for margin, heard in ((25.0, True), (15.0, False)):
        params = SonarParams(margin_db=margin)
        assert ahead(outer, params=params) == (1000 if heard else NONE)
        assert ahead(inner, params=params) == 1000


def test_an_edge_fades_towards_the_rim_of_the_cone() -> None:
    edge = world_of((1000, 0, 2000, 900), roughness=0.0)
    # 18 for the edge, 2 for the air, 20 (angle/15)^2 for the beam: 30 at 10.6 degrees.
    for side in (1, -1):
        assert ahead(edge, side * 10.4) == 1000
        assert ahead(edge, side * 10.9) == NONE


def test_nothing_thin_falls_between_the_rays() -> None:
    post = world_of((4000, -1, 4000, 1))
    assert all(ahead(post, heading) == 4000 for heading in np.arange(-6, 6, 0.1))


def test_a_wall_that_goes_straight_on_has_no_corner_in_it() -> None:
    c, s = math.cos(math.radians(40)), math.sin(math.radians(40))
    whole = tilted(1000, 40, 0.0)
    # The joint lies where the wall is too far from square-on to be heard; a corner there would be.
    x, y = 1000 * c + 500 * s, 1000 * s - 500 * c
    split = world_of(
        (x + FAR * s, y - FAR * c, x, y),
        (x, y, x - FAR * s, y + FAR * c),
        roughness=0.0,
    )
    for heading in range(-60, 100, 5):
        assert ahead(split, heading) == ahead(whole, heading)


def test_what_is_in_front_hides_what_is_behind() -> None:
    plate = (1000, -400, 1000, 400)
    assert ahead(world_of(plate, (500, -300, 500, 300))) == 500
    # Behind the plate: a corner, which the rays to corners must not see through it.
    assert ahead(world_of(plate, (1500, 0, 1400, 100), (1500, 0, 1400, -100), roughness=0.0)) == 1000
    # Behind a mirror that is not heard itself: still hidden.
    c = FAR * math.cos(math.radians(45))
    mirror = (1000 - c, -c, 1000 + c, c)
    corner = ((2500, 0, 1900, 600), (2500, 0, 1900, -600))
    assert ahead(world_of(*corner, roughness=0.0)) == 2500
    assert ahead(world_of(mirror, *corner, roughness=0.0)) == NONE


def test_neighbours_on_a_flat_face_differ_less_than_without_a_cone() -> None:
    # docs/worlds.md: sonar 3 is square-on; its neighbour, 20 degrees further round, still sees the face at 5.
    for distance, difference in NEIGHBOUR_MM.items():
        ring = SonarRing(world_of((RADIUS + distance, -FAR, RADIUS + distance, FAR)), QUIET)
        readings = [ring.true_range(number, Pose(0, 0, -10)) for number in range(8)]
        tolerance = round((readings[3] + RADIUS) * (1 / math.cos(math.radians(20)) - 1))
        assert readings[2] - readings[3] == difference
        assert difference < tolerance / 2


@pytest.mark.parametrize("name", ["air_db_m", "mirror_db_deg2", "edge_db", "corner_db", "tip_db"])
def test_a_loss_of_zero_is_silent_arithmetic(name: str) -> None:
    params = SonarParams(**{name: 0.0})  # type: ignore[arg-type]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for heading in range(0, 360, 15):
            assert LOW <= ahead(world_of((900, -50, 900, 50), (900, 50, 800, 90)), heading, params) <= NONE
            assert LOW <= ahead(tilted(800, 30), heading, params) <= NONE


@pytest.mark.parametrize("seed", range(3))
def test_no_place_and_heading_gives_a_range_outside_100_to_5000_or_a_warning(seed: int) -> None:
    rng = random.Random(seed)
    world = world_of(*((rng.uniform(-3e3, 3e3),) * 2 + (rng.uniform(-3e3, 3e3), 77.0) for _ in range(12)))
    model = EchoModel(world, QUIET)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(300):
            x, y = rng.uniform(-9e3, 9e3), rng.choice([77.0, rng.uniform(-9e3, 9e3)])
            value = model.range_mm(x, y, rng.choice([0.0, 90.0, rng.uniform(-720, 720)]))
            assert LOW <= value <= NONE, f"seed {seed}"


@pytest.mark.parametrize("number", MOUNTS)
def test_each_sonar_looks_from_its_place_along_its_heading(number: int) -> None:
    mount, gap = MOUNTS[number], 700
    for heading, x, y in ((0.0, 0.0, 0.0), (37.0, 1200.0, -800.0)):
        way = math.radians(mount["heading_deg"] + heading)
        c, s = math.cos(math.radians(heading)), math.sin(math.radians(heading))
        px = x + mount["x_mm"] * c - mount["y_mm"] * s + gap * math.cos(way)
        py = y + mount["x_mm"] * s + mount["y_mm"] * c + gap * math.sin(way)
        # A plate square-on to this sonar, just wider than its cone there.
        dx, dy = -300 * math.sin(way), 300 * math.cos(way)
        ring = SonarRing(world_of((px - dx, py - dy, px + dx, py + dy)), QUIET)
        assert ring.true_range(number, Pose(x, y, heading)) == pytest.approx(gap, abs=1)


# ---- noise and crosstalk ----------------------------------------------------------------------------------------


def pings(world: World, params: SonarParams, seed: int, ms: float) -> list[Reading]:
    ring = SonarRing(world, params, rng=np.random.default_rng(seed))
    return run(ring, 0.0, ms)


def run(
    ring: SonarRing, begin: float, end: float, pose_at: Callable[[float], Pose] = lambda _: HOME
) -> list[Reading]:
    """Advance in steps of 10 ms, both ends included."""
    readings = []
    for k in range(round((end - begin) / 10) + 1):
        readings += ring.advance(begin + 10 * k, pose_at)
    return readings


ROOM = world_of(
    (2000, -2000, 2000, 2000),
    (2000, 2000, -2000, 2000),
    (-2000, 2000, -2000, -2000),
    (-2000, -2000, 2000, -2000),
)


@pytest.mark.parametrize(("fixed", "part"), [(5.0, 0.002), (20.0, 0.0), (0.0, 0.01)])
def test_noise_has_the_spread_asked_for_about_the_true_range(fixed: float, part: float) -> None:
    seed = 11
    readings = pings(ROOM, SonarParams(noise_mm=fixed, noise_part=part, crosstalk=0), seed, 100_000)
    scaled = np.array([(r.range_mm - r.true_mm) / (fixed + part * r.true_mm) for r in readings])
    n = len(scaled)
    assert n > 4900
    assert abs(scaled.mean()) < 5 / math.sqrt(n), f"seed {seed}"
    # 5 sigma of the estimate; rounding to mm adds 1/12 mm^2.
    assert scaled.std() == pytest.approx(1, abs=5 / math.sqrt(2 * n) + 0.005), f"seed {seed}"
    assert 0.6 < (abs(scaled) < 1).mean() < 0.76


def test_noise_is_clipped_and_spares_no_echo() -> None:
    near = world_of((200, -99, 200, 99))
    readings = pings(near, SonarParams(noise_mm=300, crosstalk=0), 3, 20_000)
    assert min(r.range_mm for r in readings) == LOW
    assert all(r.range_mm == NONE for r in readings if r.true_mm == NONE)
    assert any(r.true_mm == NONE for r in readings)


@pytest.mark.parametrize("rate", [0.01, 0.1])
def test_crosstalk_comes_at_its_rate_and_reads_too_short(rate: float) -> None:
    seed = 12
    readings = pings(ROOM, SonarParams(noise_mm=0, noise_part=0, crosstalk=rate), seed, 200_000)
    n = len(readings)
    hit = [r for r in readings if r.range_mm != r.true_mm]
    # A draw within half a millimetre of the truth goes unseen: once in thousands.
    assert abs(len(hit) - n * rate) <= 5 * math.sqrt(n * rate * (1 - rate)) + 1, (
        f"seed {seed}: {len(hit)} of {n}"
    )
    assert all(LOW <= r.range_mm < r.true_mm for r in hit)
    depth = [(r.range_mm - LOW) / (r.true_mm - LOW) for r in hit]
    assert np.mean(depth) == pytest.approx(0.5, abs=5 * math.sqrt(1 / 12 / len(hit))), f"seed {seed}"
    # Of 1000 the largest lies beyond 0.98 but once in 10^8 times.
    assert max(depth) > 0.98 or len(hit) < 900, f"seed {seed}"
    assert len(hit) > 900 or rate < 0.1


def test_no_crosstalk_means_none() -> None:
    assert all(r.range_mm == r.true_mm for r in pings(ROOM, QUIET, 1, 50_000))


# ---- schedule ---------------------------------------------------------------------------------------------------


def slots(readings: list[Reading], array: int) -> list[tuple[float, int]]:
    """When each transducer of an array fired: its echo's time less the time of flight."""
    rows = [(r.t_ms - 2 * r.range_mm / SOUND_MM_MS, r.number) for r in readings if r.number // 8 == array]
    return [(round(t, 6), number) for t, number in sorted(rows)]


def order(readings: list[Reading], array: int) -> list[int]:
    return [number for _, number in slots(readings, array)]


def test_one_transducer_of_each_array_fires_every_40_ms_in_order() -> None:
    readings = run(SonarRing(ROOM, QUIET), 0, 1000)
    for array in (0, 1):
        expected = [(k * CYCLE, 8 * array + k % 8) for k in range(24)]
        assert slots(readings, array)[:24] == expected
    assert [r.t_ms for r in readings] == sorted(r.t_ms for r in readings)


def test_an_echo_is_in_only_after_its_flight_and_no_echo_after_the_time_out() -> None:
    ring = SonarRing(world_of((1166, -9, 1166, 9)), QUIET)
    seen: dict[int, int] = {}
    for t in range(0, 400):
        for reading in ring.advance(t, lambda _: HOME):
            assert t - 1 < reading.t_ms <= t
            seen[reading.number] = t
    flight = 2 * 1000 / SOUND_MM_MS
    assert seen[3] == math.ceil(3 * CYCLE + flight)
    # 5000 mm take 29 ms; it fired at 0 and at 320.
    assert seen[0] == 320 + math.ceil(2 * NONE / SOUND_MM_MS)


def test_a_ping_sees_the_place_where_the_robot_was_when_it_fired() -> None:
    ring = SonarRing(world_of((3166, -FAR, 3166, FAR)), QUIET)
    readings = run(ring, 0, 330, lambda t: Pose(t, 0, 0))
    fired = {r.number: r.range_mm for r in readings}
    assert fired[3] == pytest.approx(3000 - 3 * CYCLE, abs=1)
    assert fired[4] == pytest.approx(3000 - 4 * CYCLE, abs=1)


@pytest.mark.parametrize(
    ("string", "front", "rear"),
    [
        ([1, 2, 3], [0, 1, 2], None),
        ([8, 8, 4], [7, 7, 3], None),
        ([16, 9], None, [15, 8]),
        ([1, 9, 1, 10, 5], [0, 0, 4], [8, 9]),
        ([5] * 20 + [6], [4] * 16, None),
        ([0, 3, 33, 200, 17], [2], None),
        ([17, 32], None, None),
    ],
)
def test_polling_sets_the_order_of_the_arrays_it_names(
    string: list[int], front: list[int] | None, rear: list[int] | None
) -> None:
    ring = SonarRing(ROOM, QUIET)
    run(ring, 0, 100)
    ring.set_polling(string)
    readings = run(ring, 110, 3000)
    for array, named in enumerate((front, rear)):
        expected = named or list(range(8 * array, 8 * array + 8))
        # What the old order fired last is in by then.
        fired = order([r for r in readings if r.t_ms > 200], array)[:40]
        doubled = expected * 60
        assert any(doubled[k : k + 40] == fired for k in range(len(expected))), (fired, expected)


def test_a_new_order_begins_at_its_beginning() -> None:
    ring = SonarRing(ROOM, QUIET)
    run(ring, 0, 110)
    ring.set_polling([8, 1, 5])
    # Slots at 120, 160, 200, ...; the sonar of slot 80 may still be on its way.
    fired = [number for t, number in slots(run(ring, 120, 500), 0) if t >= 120]
    assert fired[:6] == [7, 0, 4, 7, 0, 4]


def test_an_empty_polling_string_silences_all_until_the_next_and_forgets_no_order() -> None:
    ring = SonarRing(ROOM, QUIET)
    run(ring, 0, 100)
    ring.set_polling([3, 2])
    run(ring, 110, 300)
    ring.set_polling([])
    assert [r for r in run(ring, 310, 800) if r.t_ms > 345] == []
    ring.set_polling([12])
    readings = run(ring, 810, 1500)
    assert set(order(readings, 0)) == {1, 2}
    assert set(order(readings, 1)) == {11}
    ring.set_polling([])
    ring.set_polling([40])
    assert [r for r in run(ring, 1510, 2000) if r.t_ms > 1545] == [], "no number that counts is no number"


def test_reset_brings_back_the_order_and_the_cycle() -> None:
    ring = SonarRing(ROOM, QUIET)
    ring.set_polling([])
    ring.cycle_ms = 100
    ring.reset()
    assert slots(run(ring, 0, 400), 0)[:9] == [(k * CYCLE, k % 8) for k in range(9)]


@pytest.mark.parametrize("cycle", [20, 30, 70, 120])
def test_sonar_cycle_sets_the_pace_of_both_arrays(cycle: int) -> None:
    ring = SonarRing(ROOM, QUIET)
    ring.cycle_ms = cycle
    readings = run(ring, 0, 3000)
    for array in (0, 1):
        assert [number for _, number in slots(readings, array)][:20] == [8 * array + k % 8 for k in range(20)]
        assert abs(len(slots(readings, array)) - 3000 / cycle) <= 2


def test_an_echo_that_comes_after_the_next_firing_is_no_echo() -> None:
    wall = world_of((2166, -FAR, 2166, FAR))
    for cycle, expected in ((12, 2000), (11, NONE)):
        ring = SonarRing(wall, QUIET)
        ring.cycle_ms = cycle
        (value,) = {r.range_mm for r in run(ring, 0, 1000) if r.number == 3}
        assert value == expected, "2000 mm take 11.66 ms"


@pytest.mark.parametrize("array", [0, 1])
def test_each_array_has_its_switch(array: int) -> None:
    ring = SonarRing(ROOM, QUIET)
    run(ring, 0, 200)
    ring.enabled[array] = False
    readings = run(ring, 210, 1000)
    assert order(readings, array) == [], "not even what was on its way"
    other = order(readings, 1 - array)
    assert len(other) >= 19
    ring.enabled[array] = True
    begun = slots(run(ring, 1010, 1400), array)
    assert begun[0][0] == 1010, "the clock of an array begins when it is switched on"
    assert len(begun) >= 9


def test_a_long_pause_is_not_made_up_for() -> None:
    ring = SonarRing(ROOM, QUIET)
    run(ring, 0, 200)
    readings = run(ring, 60_000, 60_200)
    assert len(readings) <= 2 * 6
    assert min(r.t_ms for r in readings) > 60_000
    # A short one is: the ring was only not asked.
    ring = SonarRing(ROOM, QUIET)
    run(ring, 0, 200)
    assert len(ring.advance(1000, lambda _: HOME)) >= 2 * 19


def test_fire_all_gives_every_enabled_sonar_once_without_noise_and_leaves_the_schedule_alone() -> None:
    ring = SonarRing(ROOM, SonarParams(crosstalk=1.0), rng=np.random.default_rng(1))
    alike = SonarRing(ROOM, SonarParams(crosstalk=1.0), rng=np.random.default_rng(1))
    first, twin = run(ring, 0, 100), run(alike, 0, 100)
    readings = ring.fire_all(100.0, HOME)
    assert [r.number for r in readings] == list(range(16))
    assert all(r.range_mm == r.true_mm for r in readings)
    assert first + run(ring, 110, 500) == twin + run(alike, 110, 500)
    ring.enabled[0] = False
    assert [r.number for r in ring.fire_all(0.0, HOME)] == list(range(8, 16))


# ---- repeatability ----------------------------------------------------------------------------------------------


def test_the_same_seed_gives_the_same_readings_and_another_seed_others() -> None:
    params = SonarParams(crosstalk=0.1)
    assert pings(ROOM, params, 5, 5000) == pings(ROOM, params, 5, 5000)
    assert pings(ROOM, params, 5, 5000) != pings(ROOM, params, 6, 5000)


@pytest.mark.parametrize("text", ["off:3", "garbage:3", "intermittent:3:p=0.5", "slow:3", "wrong:3:angle=20"])
def test_a_fault_changes_no_other_sonars_readings(text: str) -> None:
    params = SonarParams(crosstalk=0.1)

    def others(faults: FaultSet | None) -> list[Reading]:
        ring = SonarRing(ROOM, params, faults, np.random.default_rng(9))
        return sorted((r for r in run(ring, 0, 5000) if r.number != 3), key=lambda r: (r.t_ms, r.number))

    assert others(FaultSet([parse_fault(text)])) == others(None), "seed 9"


def test_a_fault_is_named_in_the_reading_and_a_silent_slot_passes_unused() -> None:
    ring = SonarRing(ROOM, QUIET, FaultSet([parse_fault("off:3"), parse_fault("silent:4")]))
    readings = run(ring, 0, 700)
    assert {(r.range_mm, r.fault) for r in readings if r.number == 3} == {(NONE, "off")}
    assert all(r.true_mm < NONE for r in readings if r.number == 3)
    assert {r.fault for r in readings if r.number not in (3, 4)} == {None}
    fired = slots(readings, 0)
    assert [t for t, _ in fired[:12]] == [k * CYCLE for k in (0, 1, 2, 3, 5, 6, 7, 8, 9, 10, 11, 13)]


def test_an_emulator_made_without_an_rng_is_repeatable_too() -> None:
    params = SonarParams(crosstalk=0.1)
    assert run(SonarRing(ROOM, params), 0, 2000) == run(SonarRing(ROOM, params), 0, 2000)


def test_the_figures_in_the_document_are_those_tested_here() -> None:
    text = (Path(__file__).resolve().parents[2] / "docs" / "worlds.md").read_text(encoding="utf-8")
    for roughness, degrees in LIMIT_DEG.items():
        assert f"| {roughness:g} | {degrees:g} |" in text
    for distance, difference in NEIGHBOUR_MM.items():
        assert (
            f"| {distance} | {difference} | {round((distance + RADIUS) * (1 / math.cos(math.radians(20)) - 1))} |"
            in text
        )
