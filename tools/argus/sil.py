# SPDX-License-Identifier: MIT
"""A mission of the fault manager on the emulated robot, hundreds of times faster than real time; see docs/sil.md.

>>> Mission("demo", ((1700, 0),), faults=("off:3@2s",)).seed
1
"""

from hil_sim.errors import SimError
from hil_sim.sil import (
    Collision,
    Event,
    FaultTruth,
    Frozen,
    Mission,
    Outcome,
    Packet,
    Sighting,
    Sil,
    Trace,
    run,
)
from hil_sim.world.movers import Door, Person

__all__ = [
    "Collision",
    "Door",
    "Event",
    "FaultTruth",
    "Frozen",
    "Mission",
    "Outcome",
    "Packet",
    "Person",
    "Sighting",
    "Sil",
    "SimError",
    "Trace",
    "run",
]
