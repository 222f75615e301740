# SPDX-License-Identifier: MIT
"""Rule: whatever is behind the link, and however it lies: never a motion of a robot that is not known, never a goal
that is none, and every stop has its reason among the events."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import pytest
from mutants import MutatedSil, run_mutant

WORLD = """about: Bare rough hall.
start: [0, 0, 0]
walls:
  - {points: [[-1500, -2000], [4500, -2000], [4500, 2000], [-1500, 2000]], closed: true}
"""
FEW, MANY, SHARDS = 20, 1100, 10
NEAR_S: Final = 1.5
REST_S: Final = 25.0
"""The robot waits no longer than this without one more event that tells why."""
WHY: Final = frozenset((
    "LINK_LOST", "LINK_STALLED", "LINK_RESUMED", "SESSION_NO_ANSWER", "SESSION_OPEN", "SESSION_CLOSED", "ROBOT_UNSAFE",
    "SUBCLASS_UNKNOWN", "OTHER_ROBOT", "MOTORS_OFF", "MOTORS_ON", "BUMPER", "STALL", "POSE_LEAP", "HEADING_LEAP",
    "SLIP", "ODOMETRY_LOST", "SONAR_DEAD", "SONAR_SILENT", "SONAR_SUSPECT", "SONAR_VERIFYING", "SONAR_DISABLED",
    "SONAR_NAMED", "OBJECT", "OBJECT_CHECKED", "AVOIDING", "NO_WAY", "SWEEP", "STEP", "BACKING", "TURN_BLOCKED",
    "WAITING", "WAYPOINT", "GOAL_REACHED", "MISSION_FAILED", "TURN_FAILED", "LOOK", "PASSIVE",
))  # fmt: skip
LASTING: Final = frozenset(
    ["OTHER_ROBOT", "SUBCLASS_UNKNOWN", "ROBOT_UNSAFE", "MISSION_FAILED", "GOAL_REACHED", "ODOMETRY_LOST"]
)


def unexplained(sil: MutatedSil) -> list[str]:
    """Stops with no other event near, and a rest at the end that nothing tells of."""
    events = [e for e in sil.events if e.name in WHY]
    found = [
        f"STOPPED at {stop.t_s:.1f} s"
        for stop in sil.events
        if stop.name == "STOPPED" and not any(abs(e.t_s - stop.t_s) <= NEAR_S for e in events)
    ]
    if not {e.name for e in events} & LASTING and events[-1].t_s < sil.now_ms / 1000 - REST_S:
        found.append(f"nothing since {events[-1]}")
    return found


def check(world: str, seed: int) -> MutatedSil:
    sil = run_mutant(world, seed)
    text = f"seed {seed}: {'; '.join(sil.said)}"
    for server in sil.strangers:
        assert not server.asked, f"{text}: {server.name!r} {server.subclass!r} was told {server.asked[:5]}"
    assert not sil.false_goals, f"{text}: {sil.false_goals}"
    assert not sil.robot.hits, f"{text}: {sil.robot.hits[0]}"
    assert not unexplained(sil), f"{text}: {unexplained(sil)}"
    return sil


@pytest.fixture
def world(tmp_path: Path) -> str:
    path = tmp_path / "hall.yaml"
    path.write_text(WORLD)
    return str(path)


def test_some_mutated_links(world: str) -> None:
    done = [check(world, seed) for seed in range(FEW)]
    # The test would show nothing if nobody drove, no robot was swapped, or nobody got there.
    assert sum(bool(sil.strangers) for sil in done) >= FEW / 10
    assert sum(sil.robot.chassis.travelled_mm > 1000 for sil in done) >= FEW / 2
    assert sum(any(e.name == "GOAL_REACHED" for e in sil.events) for sil in done) >= FEW / 4


@pytest.mark.wide
@pytest.mark.parametrize("shard", range(SHARDS))
def test_many_mutated_links(world: str, shard: int) -> None:
    for seed in range(FEW + shard, MANY, SHARDS):
        check(world, seed)
