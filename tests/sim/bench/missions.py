# SPDX-License-Identifier: MIT
"""Made-up outcomes and records for the tests of the bench."""

from __future__ import annotations

import dataclasses
import os
import signal
from collections.abc import Mapping, Sequence
from typing import Any

from hil_sim.bench.judge import Track
from hil_sim.sil import Collision, FaultTruth, Mission, Outcome

Changes = Mapping[int, Sequence[tuple[float, str, str]]]


def fault(kind: str = "wrong", sonar: int = 3, onset: float = 10.0, **more: Any) -> FaultTruth:
    """Return a fault that shows from its onset on."""
    plain: dict[str, Any] = {"first_visible_s": onset, "first_visible_driven_mm": 1000.0}
    return FaultTruth(kind, sonar, f"{kind}:{sonar}@{onset:g}s", onset, 1000.0, **(plain | more))


def outcome(
    *truth: FaultTruth, health: Changes | None = None, t_s: float = 400.0, hits: Sequence[Collision] = ()
) -> Outcome:
    """Return an outcome with these changes of health, each sonar HEALTHY from 1 s on."""
    changes = [[(1.0, "HEALTHY", ""), *(health or {}).get(sonar, ())] for sonar in range(16)]
    return Outcome(
        mission=Mission("demo", ((1700, 0),)),
        reached=True,
        t_s=t_s,
        goal_mm=0.0,
        driven_mm=40_000.0,
        driving_s=t_s,
        collisions=list(hits),
        events=[],
        health=changes,
        truth=list(truth),
        final=[one[-1][1:] for one in changes],
        record=b"",
        stops=4,
        verifications=3,
        verifying_s=12.0,
        digest="0",
    )


def track(*visible: tuple[int, float], stand: tuple[float, float] = (0.0, 0.0), t_s: float = 400.0) -> Track:
    """Return a track of a robot that drives 100 mm in each second, save while it stands; 20 visible readings.

    visible: sonar and time of the first of its visible readings, a second apart.
    """
    seconds = [float(second) for second in range(int(t_s) + 1)]
    driving_s = [second - min(max(second - stand[0], 0.0), stand[1] - stand[0]) for second in seconds]
    shown = {sonar: [first + k for k in range(20)] for sonar, first in visible}
    return Track(seconds, [100 * driving for driving in driving_s], driving_s, shown)


def record(name: str = "argus/tune/office/1/off", **more: Any) -> dict[str, Any]:
    """Return the record of a fault-free mission of one hour."""
    profile, split, world, seed, variant = name.split("/")
    plain: dict[str, Any] = {
        "id": name,
        "profile": profile,
        "split": split,
        "world": world,
        "place": "room",
        "seed": int(seed),
        "variant": variant,
        "sonar": {},
        "error": None,
        "t_s": 3600.0,
        "driving_s": 3600.0,
        "driven_mm": 100_000.0,
        "reached": True,
        "goal_mm": 10.0,
        "faults": [],
        "false_disables": [],
        "false_names": [],
        "collisions": [],
        "struck": 0,
        "attributable": False,
        "undetected": False,
        "stops": 6,
        "verifications": 5,
        "verifying_s": 40.0,
        "digest": "0",
        "wall_s": 0.1,
    }
    return plain | more


def judged(kind: str = "off", **more: Any) -> dict[str, Any]:
    """Return the record of a fault that was found and named after a second."""
    return {
        "kind": kind,
        "sonar": 3,
        "text": f"{kind}:3@10s",
        "onset_s": 10.0,
        "end_s": None,
        "visible_s": 10.0,
        "visible_n": 9,
        "visible_in_time": 9,
        "visible_at": [round(0.32 * k, 3) for k in range(9)],
        "readings_in_time": 93 if kind in ("silent", "stuck", "wrong", "intermittent") else 31,
        "contradicted_in_time": 9,
        "apart": None,
        "found": True,
        "doubted_s": 1.0,
        "named": kind,
        "named_right": True,
        "named_end": kind,
        "named_end_right": True,
        "latency_s": 1.0,
        "latency_mm": 200.0,
        "latency_readings": 3,
        "rehabilitated_s": None,
        "rehabilitation": None,
    } | more


def later(truth: FaultTruth, **more: Any) -> FaultTruth:
    """Return the fault with other fields."""
    return dataclasses.replace(truth, **more)


DEADLY = "argus/tune/lab/2/garbage"


def deadly(name: str) -> dict[str, Any]:
    """Run no mission; one of them kills its process each time."""
    if name == DEADLY:
        os.kill(os.getpid(), signal.SIGKILL)
    return record(name)
