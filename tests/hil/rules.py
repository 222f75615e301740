# SPDX-License-Identifier: MIT
"""Rules that several HIL tests check: the diagnosis, the goal, and what S3 allows after a silence."""

from __future__ import annotations

import math
from typing import Final

from harness import SIP_S, Argusd, Record, Sim, Tap, is_at_rest, is_translating, way_mm

OFF: Final = 1
SILENT: Final = 2
WRONG: Final = 4
REACHED_MM: Final = 150.0
CRUISE_MM_S: Final = 190.0
BRAKES_WITHIN_S: Final = 2.0
STANDS_WITHIN_S: Final = 2.7
STANDS_WITHIN_MM: Final = 467.0
ODOMETRY_MM: Final = 20.0
JITTER_S: Final = 0.05
"""Between two clocks of one host."""


def name(sonar: int) -> str:
    """A sonar's name in an event."""
    return f"sonar/front/{sonar:02}"


def cruise(sim: Sim, x_mm: float = 300.0) -> Record:
    """Wait until it drives at full speed."""
    return sim.wait("it drives", lambda s: s["v_mm_s"] > CRUISE_MM_S and s["x_mm"] > x_mm)


def injected_s(sim: Sim) -> float:
    """Robot time at which the first fault began."""
    return float(next(r["t_s"] for r in sim.of("fault") if r["active"]))


def assert_only(argusd: Argusd, *expected: tuple[int, int]) -> None:
    """Diagnosis equals injection: sonars and kinds, and no other was ever disabled."""
    disabled = [(e["name"], e["value"]) for e in argusd.named("SONAR_DISABLED")]
    assert sorted(disabled) == sorted((name(sonar), kind) for sonar, kind in expected)


def assert_after_injection(sim: Sim, argusd: Argusd, event: Record) -> None:
    """The diagnosis did not come before the fault."""
    assert sim.robot_time(argusd.unix(event)) > injected_s(sim) - JITTER_S


def assert_reached(sim: Sim, x_mm: float, y_mm: float = 0.0) -> None:
    """The true centre is near the goal, at rest, and nothing was hit."""
    end = sim.wait_rest()
    off_mm = math.hypot(end["x_mm"] - x_mm, end["y_mm"] - y_mm)
    assert off_mm <= REACHED_MM, f"stands {off_mm:.0f} mm from the goal"
    sim.assert_no_collision()


def assert_stops_in_time(sim: Sim, silent_s: float) -> Record:
    """S3 on the robot's own clock, from when it heard nothing more; return the state in which it stands."""
    sim.wait("time for the bound", lambda s: s["t_s"] > silent_s + STANDS_WITHIN_S + 2 * SIP_S)
    states = sim.of("state")
    before = max((s for s in states if s["t_s"] <= silent_s), key=lambda s: float(s["t_s"]))
    after = [s for s in states if s["t_s"] > silent_s]
    brakes = next((s for s in after if s["v_mm_s"] < before["v_mm_s"] - 10), None)
    rest = next((s for s in after if is_at_rest(s)), None)
    assert brakes is not None, "it never brakes"
    assert rest is not None, "it never stands"
    # A state is written each 100 ms, so that both may be seen that much late; and the emulator measures the host.
    seen_s = SIP_S + JITTER_S + max((r["late_ms"] for r in sim.of("late", silent_s - 1)), default=0.0) / 1000
    brakes_s, stands_s, stands_mm = brakes["t_s"] - silent_s, rest["t_s"] - silent_s, way_mm(before, rest)
    assert brakes_s <= BRAKES_WITHIN_S + seen_s, f"brakes {brakes_s:.2f} s later"
    assert stands_s <= STANDS_WITHIN_S + seen_s, f"stands {stands_s:.2f} s later"
    assert stands_mm <= STANDS_WITHIN_MM + ODOMETRY_MM, f"stands {stands_mm:.0f} mm farther"
    return rest


def assert_still_between(sim: Sim, from_s: float, to_s: float) -> None:
    """No translation between two robot times."""
    moves = [s for s in sim.of("state", from_s) if is_translating(s) and s["t_s"] < to_s]
    assert not moves, f"moves before the health check: {moves[0]}"


def assert_no_move_sent(tap: Tap, from_unix_s: float, to_unix_s: float) -> None:
    """No packet asks for a translation between two wall clock times."""
    sent = [
        h for h in tap.commands(from_unix_s)
        if h.unix_s < to_unix_s and (h.name == "MOVE" or (h.name in ("VEL", "VEL2") and h.value != 0))
    ]  # fmt: skip
    assert not sent, f"{sent[0].name} {sent[0].value} before the health check"
