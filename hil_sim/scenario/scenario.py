# SPDX-License-Identifier: MIT
"""Scenario files: world, seed, start, course or goal, sonar behaviour and everything that goes wrong in a run."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import yaml

from hil_sim.arguments import offer
from hil_sim.document import Item, read_document
from hil_sim.errors import SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import Fault, LinkFault
from hil_sim.sonar.params import SonarParams
from hil_sim.tables.robot import DEFAULT_ROBOT, RobotTable, robot_table
from hil_sim.world.model import Pose
from hil_sim.world.movers import Door, Mover, Person, read_doors, read_people
from hil_sim.world.movers import plain as movers_plain
from hil_sim.world.physics import Physics, read_physics

SCENARIO_DIR: Final = Path(__file__).resolve().parents[1] / "scenarios"
SEED_MAX: Final = 2**63 - 1
BUMPERS: Final = (0, 5)


@dataclass(frozen=True)
class Scenario:
    """One run of the emulator.

    robot: its subclass, one of those with a table. start: None takes the world's. course: waypoints in world axes, mm;
    the goal is the last. physics: None is as the world says. bumpers: front segments; None is as the robot has.

    faults: sonar faults, bumper hits and link faults, in the order written. people, doors: besides the world's own.
    """

    world: str = "lab"
    seed: int = 1
    start: Pose | None = None
    course: tuple[tuple[float, float], ...] = ()
    goal: tuple[float, float] | None = None
    sonar: SonarParams = field(default_factory=SonarParams)
    faults: tuple[Fault, ...] = ()
    bumpers: int | None = None
    robot: str = DEFAULT_ROBOT
    physics: Physics | None = None
    about: str = ""
    people: tuple[Person, ...] = ()
    doors: tuple[Door, ...] = ()

    @property
    def movers(self) -> tuple[Mover, ...]:
        """All that moves besides the robot and what the world has."""
        return (*self.people, *self.doors)

    @property
    def link_faults(self) -> tuple[LinkFault, ...]:
        """The faults of the link among the faults."""
        return tuple(fault for fault in self.faults if isinstance(fault, LinkFault))

    def save(self, path: str | Path) -> None:
        """Write the scenario so that `load_scenario` gives it back."""
        try:
            Path(path).write_text(self.text(), encoding="utf-8")
        except OSError as error:
            raise SimError(
                f"{path}: cannot write the scenario ({error.strerror}); name another file"
            ) from error

    def text(self) -> str:
        """Return the scenario as YAML; values that are the default are left out, world and seed never."""
        changed = _changed(self)
        plain = {name: self._plain(name) for name in _ORDER if name in changed or name in _ALWAYS}
        return yaml.safe_dump(plain, sort_keys=False, default_flow_style=None, width=100)

    def _plain(self, name: str) -> Any:
        """A value as YAML has it."""
        value = getattr(self, name)
        if name == "sonar":
            return _changed(value)
        if name == "physics":
            return value.text
        if name == "faults":
            return [fault.text for fault in value]
        if name in ("people", "doors"):
            return [movers_plain(mover) for mover in value]
        if name == "course":
            return [list(point) for point in value]
        return list(value) if isinstance(value, tuple) else value


def _changed(values: Any) -> dict[str, Any]:
    """The fields of a dataclass that are not as by default."""
    found = {}
    for f in dataclasses.fields(values):
        default = f.default_factory() if f.default_factory is not dataclasses.MISSING else f.default
        if getattr(values, f.name) != default:
            found[f.name] = getattr(values, f.name)
    return found


_ALWAYS: Final = ("world", "seed")
_ORDER: Final = (
    "about", "world", "robot", "seed", "start", "course", "goal", "physics", "sonar", "faults", "bumpers",
    "people", "doors",
)  # fmt: skip
_KEYS: Final = tuple(f.name for f in dataclasses.fields(Scenario))
_SONAR_LIMITS: Final = {
    "noise_mm": (0, 1000),
    "noise_part": (0, 1),
    "crosstalk": (0, 1),
    "cone_deg": (1, 90),
    "edge_db": (0, 100),
    "margin_db": (1, 100),
    "air_db_m": (0, 50),
    "mirror_db_deg2": (0, 10),
    "corner_db": (0, 100),
    "tip_db": (0, 100),
    "side_lobe_db": (0, 100),
    "side_lobe_deg": (2, 170),
}


def load_scenario(path: str | Path) -> Scenario:
    """Load a scenario file; raises SimError with file and line for whatever is unknown or out of range.

    A name without a suffix is one of the scenarios that come with the emulator. A world is looked for beside the
    scenario file first.
    """
    file = _file_of(path)
    top = read_document(file)
    keys = top.mapping(_KEYS)
    if "course" in keys and "goal" in keys:
        keys["goal"].fail("give a course or a goal, not both; a course ends at its last point")
    values: dict[str, Any] = {}
    robot = keys["robot"].convert(robot_table) if "robot" in keys else robot_table()
    for name, item in keys.items():
        values[name] = _faults(item, robot) if name == "faults" else _READERS[name](item)
    if "world" in values:
        beside = file.parent / values["world"]
        if beside.suffix in (".yaml", ".yml", ".map") and _exists(beside):
            values["world"] = str(beside)
    return Scenario(**values)


def _file_of(path: str | Path) -> Path:
    """A file, or one of our scenarios by its name."""
    file = Path(path)
    if file.suffix != "" or _exists(file):
        return file
    if str(path) not in scenario_names():
        name = str(path)[:60]
        raise SimError(f"no scenario {name!r}{offer(name, scenario_names(), 'a file ending in .yaml')}")
    return SCENARIO_DIR / f"{path}.yaml"


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def scenario_names() -> list[str]:
    """Names of the scenarios that come with the emulator."""
    return sorted(path.stem for path in SCENARIO_DIR.glob("*.yaml"))


def _pose(item: Item) -> Pose:
    x, y, heading = item.numbers(3)
    return Pose(x, y, heading)


def _point(item: Item) -> tuple[float, float]:
    x, y = item.numbers(2)
    return x, y


def _course(item: Item) -> tuple[tuple[float, float], ...]:
    points = tuple(_point(point) for point in item.items())
    if not points:
        item.fail("a course needs one point or more; or leave it out")
    return points


def _sonar(item: Item) -> SonarParams:
    keys = item.mapping((*_SONAR_LIMITS, "specular"))
    values: dict[str, Any] = {
        name: value.flag() if name == "specular" else value.number(*_SONAR_LIMITS[name])
        for name, value in keys.items()
    }
    return SonarParams(**values)


def _faults(item: Item, robot: RobotTable) -> tuple[Fault, ...]:
    return tuple(fault.convert(lambda text: parse_fault(text, robot)) for fault in item.items())


def _bumpers(item: Item) -> int:
    if item.value not in BUMPERS or isinstance(item.value, bool):
        item.fail(f"bumpers is {' or '.join(str(n) for n in BUMPERS)}, not '{item.value}'")
    return int(item.value)


_READERS: Final = {
    "world": Item.text,
    "about": Item.text,
    "seed": lambda item: item.integer(0, SEED_MAX),
    "start": _pose,
    "course": _course,
    "goal": _point,
    "sonar": _sonar,
    "robot": Item.text,
    "physics": read_physics,
    "bumpers": _bumpers,
    "people": read_people,
    "doors": read_doors,
}


def sonar_value(name: str, text: str) -> tuple[str, float]:
    """Return a parameter of the sonar model with its value; SimError when there is none or it is out of range."""
    if name not in _SONAR_LIMITS:
        raise SimError(f"sonar: '{name}' is no parameter of the model; there are {', '.join(_SONAR_LIMITS)}")
    low, high = _SONAR_LIMITS[name]
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not low <= value <= high:
        raise SimError(f"sonar: {name} must be a number from {low:g} to {high:g}, not '{text}'")
    return name, value
