# SPDX-License-Identifier: MIT
"""More than sonar: a wheel that turns less than it should, named with its size and countered."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import yaml

from hil_sim.sil import Mission, Sighting, Sil

PARTS: Final = (0.99, 0.95, 0.9)
SIDES: Final = ("left", "right")
WAY_MM: Final = 5000
HALL: Final[Mapping[str, object]] = {
    "about": "A hall, wide enough for who drifts aside.",
    "start": [0, 0, 0],
    "roughness": 1.0,
    "walls": [{"points": [[-1500, -4800], [7500, -4800], [7500, 4800], [-1500, 4800]], "closed": True}],
}
_ALONE_MM_S: Final = 200
_LIMIT_S: Final = 90.0


@dataclass(frozen=True)
class Row:
    """One wheel: how far off the straight line 5 m end, and how far the way strays from it.

    alone: one MOVE of 5 m, nobody steers. steered: a course of 5 m without diagnosis: the heading is corrected where it
    is off by 2 degrees. named: thousandths that the fault manager says, and countered: what is left of it then. All by
    the encoders, which see the wheel: the odometry's own error is left out.
    """

    side: str
    part: float
    alone_mm: float
    steered_mm: float
    countered_mm: float
    countered_end_mm: float
    named: int | None
    named_at_mm: float | None

    @property
    def true_pm(self) -> float:
        """Thousandths that the wheel falls short: positive the left one."""
        return (1 if self.side == "left" else -1) * (1 - self.part) * 1000


def run(seed: int = 1) -> list[Row]:
    """Drive 5 m with each wheel short by 1, 5 and 10 %."""
    with tempfile.TemporaryDirectory(prefix="argus-wheel-") as folder:
        path = Path(folder) / "hall.yaml"
        path.write_text(yaml.safe_dump(dict(HALL)), encoding="utf-8")
        return [_row(str(path), side, part, seed) for side in SIDES for part in PARTS]


def _row(world: str, side: str, part: float, seed: int) -> Row:
    fault = f"wheel:{side}:{part:g}"
    steered, _, _ = drive(world, (fault,), seed, diagnosis="off")
    countered, end, sil = drive(world, (fault,), seed)
    named = next((event for event in sil.events if event.name == "WHEEL_SHORT"), None)
    return Row(
        side,
        part,
        alone_mm(world, (fault,), seed),
        steered,
        countered,
        end,
        None if named is None else named.value,
        None if named is None else sil.named_at_mm,
    )


class Drive(Sil):
    """A drive of which is noted how far it strayed, by the encoders."""

    strayed_mm = 0.0
    named_at_mm: float | None = None

    def note(self, _sil: Sil, _sighting: Sighting) -> None:
        """Take a SIP."""
        chassis = self.robot.chassis
        self.strayed_mm = max(self.strayed_mm, abs(chassis.odo_y))
        if self.named_at_mm is None and any(event.name == "WHEEL_SHORT" for event in self.events):
            self.named_at_mm = chassis.odo_x


def drive(
    world: str, faults: tuple[str, ...], seed: int, *, diagnosis: str = "on", profile: str = "argus"
) -> tuple[float, float, Drive]:
    """Drive a course of 5 m straight ahead; return how far the way strays, and how far off the line it ends."""
    config = {"profile": profile, "diagnosis": diagnosis}
    course = ((float(WAY_MM), 0.0),)
    mission = Mission(world, course, faults=faults, seed=seed, config=config, limit_s=_LIMIT_S)
    sil = Drive(mission)
    sil.trace = sil.note
    sil.run()
    return sil.strayed_mm, abs(sil.robot.chassis.odo_y), sil


def alone_mm(world: str, faults: tuple[str, ...], seed: int) -> float:
    """Return how far off the straight line one MOVE of 5 m ends with nobody to steer."""
    sil = Sil(Mission(world, (), faults=faults, seed=seed, config={"active": "off"}, limit_s=_LIMIT_S))
    sil.run_until(2.0)
    robot = sil.robot
    robot.enable(True)
    robot.drive.set_speed(_ALONE_MM_S)
    robot.drive.move(WAY_MM)
    while robot.drive.has_set_point and not sil.over:
        sil.run_until(sil.now_ms / 1000 + 0.5)
    return abs(robot.chassis.odo_y)


def table(rows: list[Row]) -> str:
    """Return the rows in Markdown."""
    lines = [
        "| wheel | falls short by | one MOVE: off by | steered: strays | named as | after | countered: strays "
        "| ends off by |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        named = (
            "-"
            if row.named is None
            else f"{abs(row.named) / 10:.1f} % {'left' if row.named > 0 else 'right'}"
        )
        after = "-" if row.named_at_mm is None else f"{row.named_at_mm / 1000:.2f} m"
        lines.append(
            f"| {row.side} | {100 * (1 - row.part):.0f} % | {row.alone_mm:.0f} mm | {row.steered_mm:.0f} mm | "
            f"{named} | {after} | {row.countered_mm:.0f} mm | {row.countered_end_mm:.0f} mm |"
        )
    return "\n".join(lines) + "\n"
