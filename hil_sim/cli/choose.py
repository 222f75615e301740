# SPDX-License-Identifier: MIT
"""What the arguments ask for: the scenario, and the link and the name of each robot."""

from __future__ import annotations

import argparse
import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from hil_sim.arcos import BAUD
from hil_sim.errors import SimError, missing_package
from hil_sim.faults.grammar import parse_fault
from hil_sim.links.base import Link
from hil_sim.links.pty import PtyLink
from hil_sim.links.tcp import TcpLink
from hil_sim.links.uart import SerialLink
from hil_sim.scenario.scenario import Scenario, load_scenario
from hil_sim.server.mobilesim import NAME as MOBILESIM_NAME
from hil_sim.tables import robots
from hil_sim.tables.robot import robot_table


def scenario_of(arguments: argparse.Namespace) -> Scenario:
    """The scenario file with the command line laid over it."""
    scenario = load_scenario(arguments.scenario) if arguments.scenario else Scenario()
    changes: dict[str, Any] = {
        name: value
        for name, value in (
            ("world", arguments.world),
            ("seed", arguments.seed),
            ("start", arguments.start),
            ("bumpers", arguments.bumpers),
            ("robot", arguments.robot),
            ("physics", arguments.physics),
        )
        if value is not None
    }
    # Who says that it is an AmigoBot has its body, too.
    if arguments.robot is None and arguments.subclass in robots():
        changes["robot"] = arguments.subclass
    sonar = dict(arguments.sonar)
    if arguments.crosstalk is not None:
        sonar["crosstalk"] = arguments.crosstalk
    changes["sonar"] = dataclasses.replace(scenario.sonar, **sonar)
    scenario = dataclasses.replace(scenario, **changes)
    # Those of the file again, since another robot may not have the sonars that they name.
    table = robot_table(scenario.robot)
    texts = [*(fault.text for fault in scenario.faults), *arguments.fault]
    return dataclasses.replace(scenario, faults=tuple(parse_fault(text, table) for text in texts))


def link_of(arguments: argparse.Namespace, index: int, seed: int) -> tuple[Link, int]:
    """The link asked for, of the robot with this index, and the rate at which the robot starts."""
    for option in ("tcp", "serial", "can"):
        if getattr(arguments, option):
            return _LINKS[option](arguments, index)
    baud = arguments.baud or BAUD["B9600"]
    name = str(numbered(Path(arguments.link_name), index)) if arguments.link_name else None
    return PtyLink(baud, name, seed), baud


def _refuse_pty_options(arguments: argparse.Namespace, instead: str) -> None:
    if arguments.link_name or arguments.baud:
        raise SimError(f"--link-name and --baud are for a pseudo-terminal; {instead}")


def _tcp(arguments: argparse.Namespace, index: int) -> tuple[Link, int]:
    _refuse_pty_options(arguments, "leave them out with --tcp")
    host, port = arguments.tcp
    if port + index > 65535:
        raise SimError(f"--tcp {port}: no port left for robot {index + 1}; begin lower")
    return TcpLink(host, port + index if port else 0, deaf=is_mobilesim(arguments)), BAUD["B9600"]


def _serial(arguments: argparse.Namespace, index: int) -> tuple[Link, int]:
    _refuse_pty_options(arguments, "give the rate as --serial DEV@BAUD")
    if index or arguments.robots > 1:
        raise SimError(f"--robots {arguments.robots}: one UART serves one robot; use --tcp or ptys")
    return SerialLink(*arguments.serial), arguments.serial[1]


def _can(arguments: argparse.Namespace, index: int) -> tuple[Link, int]:
    _refuse_pty_options(arguments, "leave them out with --can")
    try:
        from hil_sim.links.can import CanLink
    except ModuleNotFoundError as error:
        raise SimError(f"--can: {missing_package(error)}") from error
    return CanLink(arguments.can.of_robot(index)), BAUD["B9600"]


_LINKS: Final[dict[str, Callable[[argparse.Namespace, int], tuple[Link, int]]]] = {
    "tcp": _tcp,
    "serial": _serial,
    "can": _can,
}


def is_mobilesim(arguments: argparse.Namespace) -> bool:
    """Whether the habits asked for are those of the vendor's emulator."""
    return bool(arguments.quirks == "mobilesim")


def numbered(path: Path, index: int) -> Path:
    """The file of the robot with this index: PATH, PATH-2, PATH-3, before the suffix."""
    return path.with_name(f"{path.stem}-{index + 1}{path.suffix}") if index else path


def robot_name(arguments: argparse.Namespace, robot: str, index: int) -> str:
    """The name of the robot with this index; a number at its end counts up."""
    default = MOBILESIM_NAME if is_mobilesim(arguments) else robot_table(robot).name
    name: str = arguments.name or default
    if not index:
        return name
    stem = name.rstrip("0123456789")
    digits = name[len(stem) :]
    number = f"{int(digits) + index:0{len(digits)}d}" if digits else f"_{index + 1}"
    return stem[: 20 - len(number)] + number
