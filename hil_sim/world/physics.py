# SPDX-License-Identifier: MIT
"""What real sonars and wheels do beyond the plain model: all of it off by default (docs/worlds.md has the sources)."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from typing import Any, Final

from hil_sim.arguments import offer
from hil_sim.document import Item
from hil_sim.errors import SimError


@dataclass(frozen=True)
class Physics:
    """Departures from the plain model; 0 is off.

    Sonars: dropout: share of the pings that hear nothing. gain_db: each sonar's gain is off by up to this, either way.
    double_bounce: share of the pings at a smooth surface that hear what the surface mirrors, at the whole way.
    range_scale: each sonar's ranges are off by up to this part, either way. sound: the same for all sonars together.
    range_step_mm: ranges come in such steps. blind_mm: an echo from nearer is missed; heard is its repetition or
    nothing.
    cross_array: share of the pings that hear the ping of another array of the same moment, when that comes sooner.
    as_recorded: by how much noise, silence and short echoes are as in recordings (tables/recorded.toml); 1 is wholly.

    Wheels: odometry_scale: part by which distances are off. odometry_drift_deg_m: turn that odometry does not see, for
    each metre. slip: share of the way on which the wheels slip.
    """

    dropout: float = 0.0
    gain_db: float = 0.0
    double_bounce: float = 0.0
    range_scale: float = 0.0
    sound: float = 0.0
    range_step_mm: float = 0.0
    blind_mm: float = 0.0
    cross_array: float = 0.0
    as_recorded: float = 0.0
    odometry_scale: float = 0.0
    odometry_drift_deg_m: float = 0.0
    slip: float = 0.0

    @property
    def on_sonars(self) -> bool:
        """Whether anything about sonars is on."""
        return any(getattr(self, name) for name in LIMITS if name not in _WHEELS)

    @property
    def text(self) -> str:
        """As `parse_physics` reads it; empty for the plain model."""
        for name, values in SETS.items():
            if self == values:
                return name
        return ",".join(f"{name}={getattr(self, name)!r}" for name in LIMITS if getattr(self, name))


LIMITS: Final = {
    "dropout": (0.0, 1.0),
    "gain_db": (0.0, 30.0),
    "double_bounce": (0.0, 1.0),
    "range_scale": (0.0, 0.5),
    "sound": (0.0, 0.2),
    "range_step_mm": (0.0, 1000.0),
    "blind_mm": (0.0, 2000.0),
    "cross_array": (0.0, 1.0),
    "as_recorded": (0.0, 1.0),
    "odometry_scale": (0.0, 0.5),
    "odometry_drift_deg_m": (0.0, 45.0),
    "slip": (0.0, 1.0),
}
"""Smallest and largest value of each."""
_WHEELS: Final = ("odometry_scale", "odometry_drift_deg_m", "slip")
PLAIN: Final = Physics()
SETS: Final = {
    "plain": PLAIN,
    "rough-day": Physics(
        dropout=0.01,
        gain_db=4.0,
        double_bounce=0.08,
        range_scale=0.01,
        sound=0.01,
        range_step_mm=10.0,
        odometry_scale=0.01,
        odometry_drift_deg_m=0.5,
    ),
    "recorded": Physics(as_recorded=1.0),
    "coarse-steps": Physics(as_recorded=1.0, range_step_mm=3.43),
}
"""Sets with a name."""


def parse_physics(text: str) -> Physics:
    """Read a named set, NAME=VALUE, or several with commas between them, later ones over earlier ones.

    >>> parse_physics("rough-day,dropout=0.05").dropout
    0.05
    """
    values: dict[str, Any] = {}
    for part in text.split(","):
        name, equals, value = part.strip().partition("=")
        if not equals and name in SETS:
            values |= dataclasses.asdict(SETS[name])
        elif equals and name in LIMITS:
            values[name] = _number(name, value)
        else:
            known = [f"{one}=" for one in LIMITS]
            raise SimError(f"no physics '{part}'{offer(name + equals, [*SETS, *known])}")
    return Physics(**values)


def read_physics(item: Item) -> Physics:
    """Read `physics` of a file: text as for the option, or a mapping of names to values."""
    if isinstance(item.value, dict):
        keys = item.mapping(tuple(LIMITS))
        return Physics(**{name: value.number(*LIMITS[name]) for name, value in keys.items()})
    return item.convert(parse_physics)


def _number(name: str, text: str) -> float:
    low, high = LIMITS[name]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise SimError(f"physics: {name} must be a number from {low:g} to {high:g}, not '{text}'")
    return value
