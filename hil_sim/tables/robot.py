# SPDX-License-Identifier: MIT
"""A robot as its table says, typed: body, motion, odometry, sonars."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, Final

from hil_sim.arguments import offer
from hil_sim.core.library import Ring, ring_fault
from hil_sim.errors import SimError
from hil_sim.tables import load, robots
from hil_sim.tables.ring import Lines, is_ring, place_of, read_ring, ring_of

DEFAULT_ROBOT: Final = "p3dx-sh"


@dataclass(frozen=True)
class BodyShape:
    """The body as a rectangle round the centre of rotation, mm; bumpers: segments at each end, 0 for none."""

    front_mm: float
    rear_mm: float
    half_mm: float
    swing_mm: float
    front_bumpers: int
    rear_bumpers: int

    @property
    def reach_mm(self) -> float:
        """From the centre of rotation to the furthest corner."""
        return math.hypot(max(self.front_mm, self.rear_mm), self.half_mm)

    @property
    def corners(self) -> tuple[tuple[float, float], ...]:
        """The corners of the rectangle: front left and right, rear right and left."""
        front, rear, half = self.front_mm, self.rear_mm, self.half_mm
        return (front, half), (front, -half), (-rear, -half), (-rear, half)


@dataclass(frozen=True)
class Mount:
    """Where a sonar stands on the robot, where it looks, the index of its array, and what it guards."""

    x_mm: float
    y_mm: float
    heading_deg: float
    array: int
    role: str


@dataclass(frozen=True)
class RobotTable:
    """One robot; the files in hil_sim/tables/robots have the source of each figure.

    motion, odometry: figures by their names in the file. orders, places: sonars of each array in their default
    firing order, and where they are.
    front, rear: sonars of the arrays of that place, or of a ring those that look that way. forward: the paper's
    forward-facing six or what stands for them. ring: of one out of a file of the user's, what the fault manager is
    given; one that it knows has none.
    """

    robot_class: str
    subclass: str
    name: str
    serial: str
    body: BodyShape
    motion: dict[str, int]
    odometry: dict[str, int]
    cycle_ms: int
    mounts: tuple[Mount, ...]
    orders: tuple[tuple[int, ...], ...]
    places: tuple[str, ...]
    front: tuple[int, ...]
    rear: tuple[int, ...]
    forward: tuple[int, ...]
    min_mm: int
    no_echo_mm: int
    cone_deg: int
    ring: Ring | None = None
    sectors: tuple[int, ...] = ()
    """Those of the sonars that are sectors of a laser's scan,"""
    sector_deg: int = 0
    """... so wide each."""

    @property
    def sonars(self) -> int:
        """How many sonars it has, numbered from 0."""
        return len(self.mounts)

    @property
    def without_laser(self) -> RobotTable:
        """The same without the sectors, which make arrays of their own."""
        if not self.sectors:
            return self
        mounts = self.mounts[: self.sonars - len(self.sectors)]
        arrays = len({mount.array for mount in mounts})
        orders, places = self.orders[:arrays], self.places[:arrays]
        return replace(self, mounts=mounts, orders=orders, places=places, sectors=(), sector_deg=0)

    @property
    def refresh_ms(self) -> int:
        """Time between two firings of one sonar by default."""
        return self.cycle_ms * max(len(order) for order in self.orders)


@cache
def robot_table(name: str = DEFAULT_ROBOT) -> RobotTable:
    """Return the table of a robot by its subclass, or of FILE.toml; SimError for one that there is not.

    A robot out of a file is known by its subclass, too, from then on.

    >>> robot_table("p3dx-sh").sonars
    16
    """
    if is_ring(name):
        return _own(Path(name))
    if name in _OWN:
        return _OWN[name]
    if name not in robots():
        raise SimError(f"no robot '{name}'{offer(name, robots(), 'a file FILE.toml')}")
    return _built(load(f"robots/{name}"))


_OWN: Final[dict[str, RobotTable]] = {}


def own_ring(subclass: str) -> Ring | None:
    """Return the ring of a robot that was read out of a file; None of any other."""
    table = _OWN.get(subclass)
    return table.ring if table else None


def _own(path: Path) -> RobotTable:
    table, lines = read_ring(path)
    ring = ring_of(table)
    _check(ring, lines)
    robot = replace(_built(table), ring=ring)
    if ring.name in robots():
        raise SimError(
            f"{lines.where('identity', 'subclass')}: {ring.name} is a robot that is known; give another name"
        )
    _OWN[ring.name] = robot
    robot_table.cache_clear()
    return robot


def _check(ring: Ring, lines: Lines) -> None:
    """Let the fault manager itself judge a ring."""
    if fault := ring_fault(ring):
        what = f"{fault.key}: " if fault.key else f"sonar {fault.sonar}: " if fault.sonar is not None else ""
        raise SimError(f"{place_of(fault.key, fault.sonar, lines)}: {what}{fault.meaning}")


def _built(table: dict[str, Any]) -> RobotTable:
    identity, body, sonar = table["identity"], table["body"], table["sonar"]
    laser = table.get("laser", {})
    mounts = tuple(
        Mount(float(p["x_mm"]), float(p["y_mm"]), float(p["heading_deg"]), p["array"], p["role"])
        for p in sonar["pose"]
    )
    front = tuple(n for n, mount in enumerate(mounts) if _is_front(mount, sonar["array"][mount.array]))
    return RobotTable(
        robot_class=identity["class"],
        subclass=identity["subclass"],
        name=identity["name"],
        serial=identity["serial"],
        body=BodyShape(
            float(body["front_mm"]),
            float(body["rear_mm"]),
            body["width_mm"] / 2,
            float(body["swing_radius_mm"]),
            body["front_bumpers"],
            body["rear_bumpers"],
        ),
        motion=table["motion"],
        odometry=table["odometry"],
        cycle_ms=sonar["cycle_ms"],
        mounts=mounts,
        orders=tuple(tuple(array["order"]) for array in sonar["array"]),
        places=tuple(str(array["place"]) for array in sonar["array"]),
        front=front,
        rear=tuple(n for n in range(len(mounts)) if n not in front),
        forward=tuple(sonar["forward"]),
        min_mm=sonar["min_mm"],
        no_echo_mm=sonar["no_echo_mm"],
        cone_deg=sonar["cone_deg"],
        sectors=tuple(range(len(mounts) - laser["sectors"], len(mounts))) if laser else (),
        sector_deg=laser["field_deg"] // laser["sectors"] if laser else 0,
    )


def _is_front(mount: Mount, array: dict[str, Any]) -> bool:
    place = str(array["place"])
    return mount.role != "astern" if place == "ring" else place.endswith("front")
