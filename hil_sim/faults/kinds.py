# SPDX-License-Identifier: MIT
"""The kinds of faults as values: of sonars, of the bumper and of the link."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:  # argusctl reads the words: it need not wait for numpy
    from hil_sim.world.model import Pose

SONAR_KINDS: Final = {
    "off": "reads 5000 in each of its slots",
    "silent": "its slots yield no reading",
    "stuck": "repeats the reading at onset, or value=MM (0 to 65535)",
    "wrong": "scale=FACTOR, then offset=MM; or angle=DEG: the range seen along its axis + angle; low=, high=",
    "garbage": "uniform from low=100 to high=5000",
    "slow": "reports the echo of n=COUNT firings ago (default 5)",
    "intermittent": "each reading is value=5000 with probability p=P (default 0.5); beyond=MM: farther echoes only",
}
KIND_NAME: Final = dict(enumerate(SONAR_KINDS, 1))
"""Their names by the numbers that events and recordings have; 0 stands for none."""
WHEEL_KINDS: Final = {
    "wheel": "left or right turns PART of what it is told, 0.5 to 1, e.g. wheel:left:0.95; its encoder sees it",
}
LINK_KINDS: Final = {
    "link-drop": "loses packets with probability p=P (default 1)",
    "link-corrupt": "damages packets with probability p=P (default 1)",
    "link-delay": "holds every packet for ms=MS",
    "link-cut": "lets nothing through",
}
DIRECTIONS: Final = ("both", "to_client", "to_robot")


@dataclass(frozen=True)
class When:
    """One bound in time or place: `variable` is t (ms), x, y or travelled (mm); `sign` +1 above, -1 below."""

    variable: str
    sign: int
    value: float

    def met(self, now_ms: float, pose: Pose, travelled_mm: float) -> bool:
        """The bound is passed."""
        here = {"t": now_ms, "x": pose.x_mm, "y": pose.y_mm, "travelled": travelled_mm}[self.variable]
        return here >= self.value if self.variable == "t" else (here - self.value) * self.sign > 0


@dataclass(frozen=True)
class Ramp:
    """How long a fault grows: `variable` is t (`length` in ms) or travelled (mm)."""

    variable: str
    length: float

    def grown(self, since: float, here: float) -> float:
        """Return the part of the fault that is there, 0 to 1."""
        return min(1.0, max(0.0, (here - since) / self.length))


@dataclass(frozen=True)
class Fault:
    """Anything that can be injected; `text` is what it was written as."""

    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class SonarFault(Fault):
    """A fault of sonars, on from `start` to `end`; None: from the beginning, for good.

    value: what is read. low, high: readings are clipped to these; None: to those of a healthy sonar.
    """

    kind: str
    sonars: tuple[int, ...]
    start: When | None = None
    end: When | None = None
    value: int | None = None
    scale: float = 1.0
    offset: float = 0.0
    angle: float | None = None
    n: int = 5
    p: float = 0.5
    beyond: int | None = None
    ramp: Ramp | None = None
    low: int | None = None
    high: int | None = None


@dataclass(frozen=True)
class BumperHit(Fault):
    """A press of front bumper segment 1 (leftmost) to 5."""

    segment: int
    start_ms: float
    end_ms: float


@dataclass(frozen=True)
class WheelFault(Fault):
    """A wheel that turns less than it should: `part` of it, from `start` to `end`; None: all the time."""

    side: str
    part: float
    start: When | None = None
    end: When | None = None


@dataclass(frozen=True)
class LinkFault(Fault):
    """A disturbance of the link; `kind` is drop, corrupt, delay or cut; `end_ms` None: for good."""

    kind: str
    start_ms: float = 0.0
    end_ms: float | None = None
    probability: float = 1.0
    delay_ms: float = 0.0
    direction: str = "both"


@dataclass(frozen=True)
class FaultChange:
    """A fault of one sonar, or a bumper hit, that began (`on`) or ended."""

    t_ms: float
    kind: str
    on: bool
    text: str
    sonar: int | None = None
    segment: int | None = None

    def as_record(self) -> dict[str, Any]:
        """Return the change as fields of the truth record."""
        fields: dict[str, Any] = {"kind": self.kind, "on": self.on, "text": self.text}
        if self.sonar is not None:
            fields["sonar"] = self.sonar
        if self.segment is not None:
            fields["segment"] = self.segment
        return fields
