# SPDX-License-Identifier: MIT
"""Rule: smooth walls and 1 % crosstalk make the rules of the paper misfire as documented; nothing is hit."""

from __future__ import annotations

import json

import pytest
from harness import PATIENCE_S, ROOT, Argusd, Bench, Sim
from rules import OFF

pytestmark = pytest.mark.monitored

RECORD = ROOT / "build/hil/paper-in-smooth.json"
COURSE = "1700,0\n1700,1900\n"
ENOUGH_S = 60.0


def record(sim: Sim, argusd: Argusd, ended: str) -> dict[str, object]:
    """What became of the drive, for whoever compares rule sets."""
    disabled = argusd.named("SONAR_DISABLED")
    return {
        "world": "smooth",
        "seed": 1,
        "crosstalk": 0.01,
        "profile": "paper",
        "ended": ended,
        "robot_s": sim.t_s,
        "state": disabled[-1]["state"] if disabled else "IsNormal",
        "falsely_disabled": [
            {"name": e["name"], "kind": e["value"], "robot_s": round(sim.robot_time(argusd.unix(e)), 1)}
            for e in disabled
        ],
        "rest": {key: sim.now[key] for key in ("x_mm", "y_mm", "heading_deg")},
        "collisions": len(sim.of("collision")),
    }


def test_paper_disables_healthy_sonars_and_stands(bench: Bench) -> None:
    sim = bench.sim("smooth", crosstalk=0.01)
    course = bench.path / "course.csv"
    course.write_text(COURSE)
    argusd = bench.argusd("--course", str(course))
    argusd.wait("SESSION_OPEN")
    ended = argusd.wait("MISSION_FAILED", "GOAL_REACHED", timeout_s=ENOUGH_S + PATIENCE_S)
    sim.wait_rest()
    result = record(sim, argusd, ended["event"])
    RECORD.parent.mkdir(parents=True, exist_ok=True)
    RECORD.write_text(json.dumps(result, indent=2) + "\n")
    assert result["collisions"] == 0
    assert result["ended"] == "MISSION_FAILED"
    kinds = [e["value"] for e in argusd.named("SONAR_DISABLED")]
    assert kinds.count(OFF) >= 3, "healthy sonars are disabled for want of an echo"
    assert argusd.wait_exit() == 1
