# SPDX-License-Identifier: MIT
"""What came of a mission."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from hil_sim.sil.mission import Mission


class Event(NamedTuple):
    """One thing that the fault manager said: `name` as in its catalogue, `state` the failure state then."""

    t_s: float
    name: str
    sonar: int | None
    value: int
    state: str


class Collision(NamedTuple):
    """The body met a solid at this place; `struck`: the robot stood, the solid came to it."""

    t_s: float
    x: float
    y: float
    struck: bool


@dataclass
class FaultTruth:
    """One fault of one sonar as it was injected; `driven` is the true way driven until then.

    first_visible_s: the first reading that it changed by more than max(100 mm, 5 %), or took away. None while
    there was none: then the fault could not be seen.
    """

    kind: str
    sonar: int
    text: str
    onset_s: float
    onset_driven_mm: float
    end_s: float | None = None
    first_visible_s: float | None = None
    first_visible_driven_mm: float | None = None


@dataclass
class Outcome:
    """What came of a mission.

    t_s: robot time at the end. goal_mm: true distance from the goal then. driving_s: time in motion. health:
    for each sonar every change of time, health and kind, looked at with each SIP. final: health and kind at the
    end. verifying_s: time spent on verification by turning. digest: of all bytes both ways and their times.
    """

    mission: Mission
    reached: bool
    t_s: float
    goal_mm: float
    driven_mm: float
    driving_s: float
    collisions: list[Collision]
    events: list[Event]
    health: list[list[tuple[float, str, str]]]
    truth: list[FaultTruth]
    final: list[tuple[str, str]]
    record: bytes
    stops: int
    verifications: int
    verifying_s: float
    digest: str
