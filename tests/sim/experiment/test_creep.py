# SPDX-License-Identifier: MIT
"""Rule: with no sonar left the robot stops and says so; it creeps on bumpers only with leave, and never faster."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil_sim.experiment.safety import Safety, watch
from hil_sim.sil import Mission, Outcome, Sil

ALL = "+".join(map(str, range(16)))
CREEP_MM_S = 60
OPEN = """about: A bare rough room.
start: [0, 0, 0]
roughness: 1.0
walls: [{points: [[-2500, -3000], [4500, -3000], [4500, 3000], [-2500, 3000]], closed: true}]
"""
LOW = OPEN + "posts: [{centre: [1600, 0], diameter: 200}]\n"


@pytest.fixture
def room(tmp_path: Path) -> str:
    path = tmp_path / "room.yaml"
    path.write_text(OPEN, encoding="utf-8")
    return str(path)


@pytest.fixture
def blocked(tmp_path: Path) -> str:
    path = tmp_path / "blocked.yaml"
    path.write_text(LOW, encoding="utf-8")
    return str(path)


class Speeds:
    """The greatest speed since the robot first crept, asked at every tick, after the rules of safety."""

    def __init__(self, sil: Sil) -> None:
        self.safety, self._sil = Safety(sil), sil
        self.most_mm_s = 0.0
        self.crept = False
        sil.robot.watch = self._tick

    def _tick(self, news: object) -> None:
        self.safety.tick(news)  # type: ignore[arg-type]
        self.crept = self.crept or self._sil.mode == "CREEPING"
        if self.crept:
            self.most_mm_s = max(self.most_mm_s, abs(self._sil.robot.drive.v))


def drive(world: str, fault: str, goal: float, **config: int) -> tuple[Sil, Outcome, Speeds]:
    sil = Sil(
        Mission(world, ((goal, 0.0),), faults=(fault,), config=config, seed=3, limit_s=150, stop_at_goal=True)
    )
    speeds = Speeds(sil)
    return sil, sil.run(), speeds


def names(sil: Sil) -> list[str]:
    return [event.name for event in sil.events]


@pytest.mark.parametrize("kind", ["silent", "off"])
def test_all_sixteen_lost_on_the_way_stop_it_for_good(room: str, kind: str) -> None:
    sil, outcome, _ = drive(room, f"{kind}:{ALL}@5s", 3500)
    assert sil.state_of_mission == "failed"
    assert not outcome.collisions
    assert names(sil).count("MISSION_FAILED") == 1
    assert "CREEPING" not in names(sil)
    failed = next(event for event in sil.events if event.name == "MISSION_FAILED")
    assert failed.t_s < 20
    assert abs(sil.robot.drive.v) < 1
    assert sil.robot.chassis.x < 3000


@pytest.mark.parametrize("kind", ["silent", "off"])
def test_with_leave_it_creeps_to_a_near_goal(room: str, kind: str) -> None:
    sil, outcome, speeds = drive(room, f"{kind}:{ALL}@5s", 3500, creep_mm_s=CREEP_MM_S)
    assert outcome.reached
    assert not outcome.collisions
    assert "CREEPING" in names(sil)
    assert CREEP_MM_S / 2 < speeds.most_mm_s <= CREEP_MM_S + 1
    assert not any(speeds.safety.counts.values()), speeds.safety.breaches


def test_it_stops_and_backs_off_at_a_bumper(blocked: str) -> None:
    """The post is met soon after the sonars are lost, and the goal lies behind it."""
    sil, outcome, speeds = drive(blocked, f"silent:{ALL}@2.2s", 3000, creep_mm_s=CREEP_MM_S)
    said = names(sil)
    assert outcome.collisions
    assert "BUMPER" in said
    assert said.index("CREEPING") < said.index("BUMPER") < said.index("BACKING")
    touched, backed = (next(e.t_s for e in sil.events if e.name == name) for name in ("BUMPER", "BACKING"))
    assert backed - touched < 5
    assert speeds.most_mm_s <= CREEP_MM_S + 1
    assert outcome.reached, said


def test_faster_than_allowed_is_found_out(room: str) -> None:
    sil = Sil(
        Mission(room, ((3500.0, 0.0),), faults=(f"silent:{ALL}@5s",), config={"creep_mm_s": 40}, limit_s=60)
    )
    safety = watch(sil)
    while sil.mode != "CREEPING" or abs(sil.robot.drive.v) < 20:
        sil.step()
        assert not sil.over
    assert safety.counts["S5"] == 0
    sil.robot.drive.v = 120.0
    sil.run_until(sil.now_ms / 1000 + 0.05)
    assert safety.counts["S5"] > 0


# ---- never heard


@pytest.mark.parametrize(("creep", "most"), [(0, 100), (CREEP_MM_S, CREEP_MM_S)])
def test_a_ring_that_was_never_heard_is_driven_slowly(creep: int, most: int) -> None:
    """All 16 off from the start look like an open hall: at the speed of a step at most, whatever the way is like."""
    sil = Sil(
        Mission(
            "lab", ((1700.0, 0.0), (1700.0, 1550.0)), faults=(f"off:{ALL}",), config={"creep_mm_s": creep}
        )
    )
    fastest = 0.0
    while not sil.over and sil.now_ms < 60_000:
        sil.step()
        fastest = max(fastest, abs(sil.robot.drive.v))
    assert names(sil).count("NO_ECHO") == 1
    assert 0 < fastest <= most + 1
    assert sum(name == "BUMPER" for name in names(sil)) <= 1 or creep


def test_in_a_hall_it_hurries_as_soon_as_one_has_heard(room: str) -> None:
    sil, outcome, _ = drive(room, f"off:{ALL}@0s-6s", 3500)
    assert outcome.reached
    assert outcome.t_s < 30
    assert names(sil).count("NO_ECHO") == 1


def test_a_front_that_was_never_heard_does_not_lead(room: str) -> None:
    sil, outcome, _ = drive(room, "off:front", 3000)
    first = next(event for event in sil.events if event.name == "REVERSED")
    assert first.value == 1
    assert first.t_s < 3
    assert outcome.reached
    assert not outcome.collisions
