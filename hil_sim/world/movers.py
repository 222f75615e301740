# SPDX-License-Identifier: MIT
"""People who walk and doors that swing, as a file describes them (docs/worlds.md)."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any, Final, TypeAlias

from hil_sim.document import Item

Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Person:
    """Someone who walks along a line and back.

    path: corners of the way, mm. speed: mm/s. radius: mm. pause: seconds of standing at each end. loop: False walks
    once and stays. delay: seconds before the first step. yields: waits for a robot that is in the way, and after
    `patience` seconds (0: never) turns round. roughness: as of a wall.
    """

    path: tuple[Point, ...]
    speed: float = 800.0
    radius: float = 200.0
    pause: float = 2.0
    loop: bool = True
    delay: float = 0.0
    yields: bool = True
    patience: float = 10.0
    roughness: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "path", tuple((float(x), float(y)) for x, y in self.path))


@dataclass(frozen=True)
class Door:
    """A leaf that swings on its hinge, closed at first, and waits while the robot is in its way.

    closed, open: directions in which the leaf lies then, degrees. period: seconds from one opening to the next;
    swing: seconds that opening takes, and closing; it rests the same time open as closed. delay: seconds before the
    first opening. yields: False swings into the robot. roughness: as of a wall.
    """

    hinge: Point
    width: float = 900.0
    closed: float = 0.0
    open: float = 90.0
    period: float = 20.0
    swing: float = 2.0
    delay: float = 0.0
    yields: bool = True
    roughness: float = 1.0

    def __post_init__(self) -> None:
        x, y = self.hinge
        object.__setattr__(self, "hinge", (float(x), float(y)))


Mover: TypeAlias = Person | Door

_NUMBERS: Final[dict[type[Any], dict[str, tuple[float, float]]]] = {
    Person: {
        "speed": (1, 3000),
        "radius": (50, 1000),
        "pause": (0, 1e6),
        "delay": (0, 1e6),
        "patience": (0, 1e6),
        "roughness": (0, 1),
    },
    Door: {
        "width": (50, 5000),
        "closed": (-360, 360),
        "open": (-360, 360),
        "period": (1, 1e6),
        "swing": (0.1, 1e5),
        "delay": (0, 1e6),
        "roughness": (0, 1),
    },
}
_FLAGS: Final = ("loop", "yields")


def _values(item: Item, kind: type[Any]) -> tuple[dict[str, Item], dict[str, Any]]:
    keys = item.mapping(tuple(f.name for f in dataclasses.fields(kind)))
    values: dict[str, Any] = {}
    for name, value in keys.items():
        if name in _NUMBERS[kind]:
            values[name] = value.number(*_NUMBERS[kind][name])
        elif name in _FLAGS:
            values[name] = value.flag()
    return keys, values


def read_people(item: Item) -> tuple[Person, ...]:
    """Read the list `people` of a file."""
    people = []
    for entry in item.items():
        keys, values = _values(entry, Person)
        if "path" not in keys:
            entry.fail("'path' is missing; add it")
        path = tuple((x, y) for x, y in (point.numbers(2) for point in keys["path"].items()))
        if len(path) < 2 or len(set(path)) == 1:
            keys["path"].fail("a path needs two points or more, not all in one place; a post stands still")
        people.append(Person(path, **values))
    return tuple(people)


def read_doors(item: Item) -> tuple[Door, ...]:
    """Read the list `doors` of a file."""
    doors = []
    for entry in item.items():
        keys, values = _values(entry, Door)
        if "hinge" not in keys:
            entry.fail("'hinge' is missing; add it")
        x, y = keys["hinge"].numbers(2)
        door = Door((x, y), **values)
        if not 0 < abs(door.open - door.closed) <= 180:
            entry.fail("open must differ from closed, by 180 degrees at most; correct one")
        if 2 * door.swing > door.period:
            entry.fail("two swings take longer than the period; shorten swing or lengthen period")
        doors.append(door)
    return tuple(doors)


def plain(mover: Mover) -> dict[str, Any]:
    """Return a mover as a mapping for YAML or JSON; values that are the default are left out."""
    values = {
        f.name: getattr(mover, f.name)
        for f in dataclasses.fields(mover)
        if getattr(mover, f.name) != f.default
    }
    if isinstance(mover, Person):
        return values | {"path": [list(point) for point in mover.path]}
    return values | {"hinge": list(mover.hinge)}
