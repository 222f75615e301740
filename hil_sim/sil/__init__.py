# SPDX-License-Identifier: MIT
"""Software in the loop: the C fault manager and the emulated robot in one process, under virtual time.

Nothing sleeps and no thread runs. The robot is the one that `argus-sim` serves, the fault manager the one that
argusd runs. Between them the bytes take the time that a serial line would need. The same mission gives the same
run, to the byte.

>>> mission = Mission("demo", ((1700, 0),), faults=("off:3@2s",), limit_s=3.0)
>>> Mission.from_json(mission.to_json()) == mission
True
"""

from hil_sim.sil.line import Packet
from hil_sim.sil.mission import Frozen, Mission
from hil_sim.sil.outcome import Collision, Event, FaultTruth, Outcome
from hil_sim.sil.run import REACHED_MM, SONARS, Sil, Trace, run
from hil_sim.sil.sightings import READING, ROW, Seen, Sighting, Sightings

__all__ = [
    "REACHED_MM",
    "READING",
    "ROW",
    "SONARS",
    "Collision",
    "Event",
    "FaultTruth",
    "Frozen",
    "Mission",
    "Outcome",
    "Packet",
    "Seen",
    "Sighting",
    "Sightings",
    "Sil",
    "Trace",
    "run",
]
