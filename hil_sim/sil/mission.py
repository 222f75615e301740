# SPDX-License-Identifier: MIT
"""Everything that one run depends on."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from hil_sim.tables.robot import DEFAULT_ROBOT
from hil_sim.world.movers import Door, Mover, Person, plain

V = TypeVar("V")


class Frozen(Mapping[str, V], Generic[V]):
    """A mapping that can be a key and that no one changes; equal to any with the same content."""

    __slots__ = ("_values",)

    def __init__(self, values: Mapping[str, V] | None = None) -> None:
        self._values = dict(sorted((values or {}).items()))

    def __getitem__(self, key: str) -> V:
        return self._values[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        return repr(self._values)

    def __reduce__(self) -> tuple[Any, ...]:
        return Frozen, (self._values,)


@dataclass(frozen=True)
class Mission:
    """Everything that one run depends on.

    world: a name or a file, as for `argus-sim --world`. course: world axes, mm; the last point is the goal.
    start: x, y in mm and heading in degrees; None takes the world's. faults: texts of the grammar of faults.
    config: settings of the fault manager by name; `baud` is that of the mission unless it is given.
    sonar: parameters of the sonar model by name. movers: people and doors besides the world's own.
    limit_s: robot time at which the run is given up.
    record: the persistent record of an earlier mission. stop_at_goal: False goes on to the limit.
    robot, physics, quirks: as for the options of argus-sim; no physics is as the world says.
    """

    world: str
    course: tuple[tuple[float, float], ...]
    start: tuple[float, float, float] | None = None
    faults: tuple[str, ...] = ()
    seed: int = 1
    config: Mapping[str, int | str] = field(default_factory=Frozen)
    sonar: Mapping[str, float] = field(default_factory=Frozen)
    movers: tuple[Mover, ...] = ()
    limit_s: float = 300.0
    record: bytes | None = None
    baud: int = 9600
    stop_at_goal: bool = True
    robot: str = DEFAULT_ROBOT
    physics: str = ""
    quirks: str = "robot"

    def __post_init__(self) -> None:
        fix = object.__setattr__
        fix(self, "course", tuple((float(x), float(y)) for x, y in self.course))
        fix(self, "faults", tuple(self.faults))
        fix(self, "movers", tuple(self.movers))
        fix(self, "config", Frozen(self.config))
        fix(self, "sonar", Frozen(self.sonar))

    def to_json(self) -> str:
        """Return the mission as one line of JSON."""
        values = {f.name: getattr(self, f.name) for f in dataclasses.fields(self)}
        values["config"], values["sonar"] = dict(self.config), dict(self.sonar)
        values["record"] = None if self.record is None else self.record.hex()
        values["movers"] = [plain(mover) for mover in self.movers]
        return json.dumps(values, separators=(",", ":"))

    @classmethod
    def from_json(cls, text: str) -> Mission:
        """Return the mission that `to_json` wrote."""
        values = json.loads(text)
        values["course"] = tuple((x, y) for x, y in values["course"])
        values["start"] = None if values["start"] is None else tuple(values["start"])
        values["record"] = None if values["record"] is None else bytes.fromhex(values["record"])
        values["movers"] = tuple(_mover(fields) for fields in values["movers"])
        return cls(**values)


def _mover(fields: dict[str, Any]) -> Mover:
    return Person(**fields) if "path" in fields else Door(**fields)
