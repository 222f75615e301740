# SPDX-License-Identifier: MIT
"""Drives short missions with the fault manager of ARGUS_CORE and prints, as JSON, which safety rules it breaks."""

from __future__ import annotations

import json
import sys
from typing import Any, Final

from watched import watch

from hil_sim.sil import Mission

_AROUND: Final = ((1700.0, 0.0), (1700.0, 1550.0))
MISSIONS: Final[dict[str, dict[str, Any]]] = {
    "plain": {},
    "off": {"faults": ("off:3@travelled>600",)},
    "silent": {"faults": ("silent:3@travelled>600",)},
    "never-heard": {"faults": ("silent:3",)},
    "two-silent": {"faults": ("silent:3@travelled>300", "silent:4@travelled>300")},
    "four-silent": {"faults": tuple(f"silent:{n}@travelled>300" for n in (2, 3, 4, 5))},
    "ring-silent": {"faults": tuple(f"silent:{n}@travelled>300" for n in range(16))},
    "bumper": {"faults": ("bumper:3@4s",)},
    "cut": {"faults": ("link-cut@4s-6.5s",), "limit_s": 20.0},
    "box-ahead": {"world": "box-ahead", "course": ((3000.0, 0.0),)},
    "paper-box": {"world": "box-ahead", "course": ((3000.0, 0.0),), "config": {"profile": "paper"}},
    "sweeps": {"faults": ("off:3@travelled>300", "off:4@travelled>300"), "config": {"profile": "paper"}},
    "stuck-near": {"faults": ("stuck:3@travelled>400:value=240",)},
    "posts": {"world": "posts", "course": ((2500.0, 0.0), (0.0, 0.0))},
}
"""What each mission differs in from a drive round a corner of the demo world."""


def mission_of(name: str, seed: int) -> Mission:
    """Return the mission of a name."""
    given: dict[str, Any] = {"world": "demo", "course": _AROUND, "limit_s": 60.0} | MISSIONS[name]
    return Mission(seed=seed, **given)


def main() -> None:
    """Run the missions that are named, or all, with the seed of the first argument."""
    seed, names = int(sys.argv[1]), sys.argv[2:] or list(MISSIONS)
    found: dict[str, list[tuple[int, str]]] = {}
    for name in names:
        _, violations = watch(mission_of(name, seed))
        found[name] = [(one.rule, str(one)) for one in violations]
    print(json.dumps(found))


if __name__ == "__main__":
    main()
