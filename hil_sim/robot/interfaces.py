# SPDX-License-Identifier: MIT
"""What the robot asks of its surroundings: body, moving solids, sonar ring and faults."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

from hil_sim.faults.kinds import FaultChange
from hil_sim.world.model import Pose


class Contact(Protocol):
    """Where the body meets a solid."""

    @property
    def front_segments(self) -> int:
        """Bit mask as in the SIP: bits 1 to 5, leftmost to rightmost front segment."""

    @property
    def rear_segments(self) -> int:
        """Bit mask as in the SIP for the rear."""


class Body(Protocol):
    """What the robot asks of the physics of its body."""

    def contact(self, pose: Pose, now_ms: float) -> Contact | None:
        """Return the contact at a pose, None when free."""

    def clearance_mm(self, pose: Pose) -> float:
        """Return the distance from the body to the nearest solid."""


class Moving(Protocol):
    """What the robot asks of solids that move by themselves."""

    def step(self, robot: Pose) -> None:
        """Let a sub-step pass; the robot's true pose is given for those that wait for it."""

    @property
    def fastest_mm_s(self) -> float:
        """No point of any of them is faster."""


class SonarReading(Protocol):
    """One reading as the ring gives it."""

    @property
    def t_ms(self) -> float:
        """When it was completed."""

    @property
    def number(self) -> int:
        """Number of the sonar, as in the SIP."""

    @property
    def range_mm(self) -> int:
        """What is reported."""

    @property
    def true_mm(self) -> int:
        """What a faultless sonar would have reported."""

    @property
    def fault(self) -> str | None:
        """The fault kind that made it, if any."""


class Ring(Protocol):
    """What the robot asks of its sonar arrays."""

    enabled: list[bool]
    cycle_ms: int

    def set_polling(self, numbers: Sequence[int]) -> None:
        """Take a POLLING string: one-based transducer numbers."""

    def reset(self) -> None:
        """Return to the default firing order."""

    def advance(self, now_ms: float, pose_at: Callable[[float], Pose]) -> Sequence[SonarReading]:
        """Fire what is due up to now; return the readings completed."""

    def fire_all(self, now_ms: float, pose: Pose) -> Sequence[SonarReading]:
        """Return a reading of every sonar of the enabled arrays, without noise."""


class Faults(Protocol):
    """What the robot asks of the injected faults."""

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> Sequence[FaultChange]:
        """Switch faults on and off; return the changes."""

    def wheels(self) -> tuple[float, float]:
        """Return the part that the left and the right wheel turn of what they should."""

    def bumper(self, now_ms: float) -> int:
        """Return the front bumper bits that a fault presses."""
