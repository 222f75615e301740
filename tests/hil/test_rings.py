# SPDX-License-Identifier: MIT
"""Rule: argusd drives a robot with a ring of the user's, finds its dead sonar, and moves none of another ring."""

from __future__ import annotations

from pathlib import Path

import pytest
from harness import Bench, is_at_rest, run_argusd
from rules import OFF, assert_only, assert_reached
from worlds import hall

from hil_sim.tables.robot import robot_table
from hil_sim.tables.write import toml_of

ROOT = Path(__file__).resolve().parents[2]
RINGS = ROOT / "docs/samples/rings"
DEAD = 2
COURSE = "1000,0\n1000,900\n0,900\n0,0\n"
ARGUS = {"profile": "argus"}


def ring_of(bench: Bench, name: str) -> str:
    """A sample, with all that it inherits, as argusd reads it."""
    path = bench.path / f"{name}.toml"
    path.write_text(toml_of(robot_table(str(RINGS / f"{name}.toml"))))
    return str(path)


@pytest.mark.long
@pytest.mark.parametrize("name", ["amigobot", "roundbot"])
def test_a_ring_of_another_make_is_driven_with_a_dead_sonar(bench: Bench, name: str) -> None:
    ring = ring_of(bench, name)
    sim = bench.sim(bench.world(**hall()), f"off:{DEAD}@0s", extra=("--ring", ring))
    course = bench.path / "course.csv"
    course.write_text(COURSE)
    argusd = bench.argusd("--ring", ring, "--course", str(course), config=ARGUS)
    argusd.wait("GOAL_REACHED")
    health = argusd.status["health"]
    assert argusd.wait_exit() == 0
    assert_reached(sim, 0)
    assert_only(argusd, (DEAD, OFF))
    assert [k for k, word in enumerate(health[:8]) if word != "HEALTHY"] == [DEAD]
    assert set(health[8:]) == {"ABSENT"}


@pytest.mark.parametrize(("robot", "ring"), [("p3dx-sh", "roundbot"), ("amigo-sh", "scitos-g5")])
def test_a_robot_that_the_ring_is_not_of_is_never_moved(bench: Bench, robot: str, ring: str) -> None:
    # A P3-DX lists sonars 8 to 15, which the round one has not got; an AmigoBot has not got 24.
    sim = bench.sim(bench.world(**hall()), extra=("--robot", robot))
    argusd = bench.argusd("--ring", ring_of(bench, ring), "--goal", "900,0", config=ARGUS)
    event = argusd.wait("SONARS_BEYOND")
    assert event["value"] == 8
    assert argusd.wait_exit() == 1
    assert argusd.status["barred"] == "sonars"
    assert all(is_at_rest(state) for state in sim.of("state"))


def test_settings_are_judged_by_the_ring(bench: Bench) -> None:
    # At 250 mm/s a P3-DX meets what it sees at 250 mm before it stands, a small round robot does not.
    config = bench.path / "fast.conf"
    config.write_text("speed_mm_s = 240\nobject_range_mm = 250\n")
    link = ("--link", f"serial:{bench.port}@9600", "--config", str(config))
    told = run_argusd(*link, "--check")
    assert (told.returncode, "(S5)" in told.stderr) == (2, True)
    ring = ring_of(bench, "roundbot")
    bench.sim(bench.world(**hall()), extra=("--ring", ring))
    told = run_argusd(*link, "--ring", ring, "--check")
    assert told.returncode == 0, told.stderr
    config.write_text("speed_mm_s = 400\nobject_range_mm = 250\n")
    told = run_argusd(*link, "--ring", ring, "--check")
    assert told.returncode == 2
    assert told.stderr.startswith(f"argusd: {ring}: S5: "), told.stderr
    config.write_text("speed_mm_s = 5000\n")
    told = run_argusd(*link, "--ring", ring, "--check")
    assert (told.returncode, "out of range" in told.stderr) == (2, True)
