# SPDX-License-Identifier: MIT
"""The arguments of `argus-sim`."""

from __future__ import annotations

import argparse
import math
import re
import sys
from typing import Any, Final, NoReturn

from hil_sim.arcos import BAUD
from hil_sim.arguments import Parser
from hil_sim.errors import SimError
from hil_sim.links.can_spec import CanSpec, parse_spec
from hil_sim.record.recording import MAX_BYTES
from hil_sim.scenario.scenario import SEED_MAX, Scenario, scenario_names, sonar_value
from hil_sim.server.quirks import QUIRKS
from hil_sim.server.server import SIP_CYCLE_MS
from hil_sim.tables import robots
from hil_sim.tables.ring import ring_file
from hil_sim.tables.robot import DEFAULT_ROBOT, robot_table
from hil_sim.version import add_version
from hil_sim.world.files import world_names
from hil_sim.world.model import Pose
from hil_sim.world.physics import LIMITS, SETS, Physics, parse_physics

DEFAULT_TCP_HOST = "127.0.0.1"
ROBOTS_MAX = 64
_MINUS: Final = re.compile(r"-[0-9.]")
_EXAMPLES = """\
examples:
  argus-sim                                   one robot in the default world; prints the device to open
  argus-sim --link-name /tmp/robot            the same behind a stable name
  argus-sim --world lab --fault off:3@12s --truth truth.jsonl
  argus-sim --record drive.rec                what passes on the link, for argus-log
  argus-sim --tcp 8101                        as the vendor's emulator listens
  argus-sim --serial /dev/ttyUSB0@9600        on a real UART
  argus-sim --can can0                        on a CAN bus, each ARCOS packet an ISO-TP message (docs/can.md)
  argus-sim --robot amigo-sh --world office   an AmigoBot with its eight sonars
  argus-sim --physics rough-day               sonars and wheels as on a bad day (docs/worlds.md)
  argus-sim --orders                          sonars broken and mended as it runs, by lines such as 'break off:3'
  argus-sim --monitor --world lab             robot, argusd and a live page, in one command
  argus-sim --robots 3 --tcp 8101             three robots, on ports 8101 to 8103
  argus-sim --tcp 8101 --quirks mobilesim     with the answers of the vendor's emulator
  argus-sim --tcp 8101 --quirks mobilesim --laser     ... and its laser, for ARIA's programs (docs/emulator.md)
  argus-sim bench diagnosis --help            how well faults are diagnosed, over many missions without a link
  argus-sim bench journey --help              whether the robot gets there, and what the diagnosis costs
  argus-sim experiment --help                 the experiments of the paper, and the study that it lacks

The first line on standard output is the device path, HOST:PORT, or what argusd takes after can:, alone; with
--robots one line for each. All else goes to standard error, but for the answers to --orders.
A pseudo-terminal takes 10 bit times a byte at the robot's rate and is garbled at any other.

exit codes: 0 ended by a signal or --duration, 1 link cannot be opened or was lost, 2 wrong argument or file
"""


_NAMES: Final = {"scenario": scenario_names, "world": world_names}


class _Parser(Parser):
    """Knows a place that begins with a minus, and the names that an option without one wants."""

    def error(self, message: str) -> NoReturn:
        """Print the line, with the names that may stand there, and leave with code 2."""
        for option, names in _NAMES.items():
            if message.startswith(f"argument --{option}: expected one argument"):
                message += f": {', '.join(names())}, or a file"
        super().error(message)

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Take a place that begins with a minus for what it is, no option."""
        words = list(sys.argv[1:] if args is None else args)
        for k in range(len(words) - 1, 0, -1):
            if words[k - 1] == "--start" and _MINUS.match(words[k]):
                words[k - 1 : k + 1] = [f"--start={words[k]}"]
        return super().parse_known_args(words, namespace)


def _start(text: str) -> Pose:
    parts = text.split(",")
    try:
        if len(parts) not in (2, 3):
            raise ValueError
        x, y, heading = (float(part) for part in (*parts, "0")[:3])
        if not all(map(math.isfinite, (x, y, heading))):
            raise ValueError
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"'{text}' is not X,Y or X,Y,DEG, for example 1000,-500,90"
        ) from None
    return Pose(x, y, heading)


def _tcp(text: str) -> tuple[str, int]:
    host, _, port = text.rpartition(":")
    if not port.isdigit() or not 0 <= int(port) <= 65535:
        raise argparse.ArgumentTypeError(f"'{text}' is not [HOST:]PORT with a port of 0 to 65535")
    return host.strip("[]") or DEFAULT_TCP_HOST, int(port)


def _serial(text: str) -> tuple[str, int]:
    match = re.fullmatch(r"(.+)@(\d+)", text)
    if not match or int(match[2]) not in BAUD.values():
        rates = ", ".join(str(rate) for rate in BAUD.values())
        raise argparse.ArgumentTypeError(f"'{text}' is not DEV@BAUD with a rate of {rates}")
    return match[1], int(match[2])


def _can(text: str) -> CanSpec:
    try:
        return parse_spec(text)
    except SimError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _baud(text: str) -> int:
    if not text.isdigit() or int(text) not in BAUD.values():
        raise argparse.ArgumentTypeError(
            f"'{text}' is none of {', '.join(str(rate) for rate in BAUD.values())}"
        )
    return int(text)


def _probability(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a probability from 0 to 1")
    return value


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 < value < 1e9:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of seconds above 0")
    return value


def _label(text: str) -> str:
    if not text or len(text) > 20 or not text.isascii() or not text.isprintable():
        raise argparse.ArgumentTypeError(f"'{text}' is not 1 to 20 ASCII characters")
    return text


def _seed(text: str) -> int:
    if not text.isdigit() or int(text) > SEED_MAX:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 0 to {SEED_MAX}")
    return int(text)


def _robots(text: str) -> int:
    if not text.isdigit() or not 1 <= int(text) <= ROBOTS_MAX:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of robots from 1 to {ROBOTS_MAX}")
    return int(text)


def _sip_cycle(text: str) -> int:
    if not text.isdigit() or not 20 <= int(text) <= 250 or int(text) % 10:
        raise argparse.ArgumentTypeError(f"'{text}' is not 20 to 250 ms in steps of 10")
    return int(text)


def _ring(text: str) -> str:
    try:
        robot_table(ring_file(text))
    except SimError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    return text


def _physics(text: str) -> Physics:
    try:
        return parse_physics(text)
    except SimError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _sonar(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        return sonar_value(name, value)
    except SimError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def _megabytes(text: str) -> int:
    try:
        megabytes = int(text)
    except ValueError:
        megabytes = 0
    if not 1 <= megabytes <= 100_000:
        raise argparse.ArgumentTypeError(f"{text}: give megabytes, 1 to 100000")
    return megabytes * 1_000_000


def parser() -> argparse.ArgumentParser:
    """Return the argument parser of `argus-sim`."""
    result = _Parser(
        prog="argus-sim",
        description="Emulate a Pioneer robot: ARCOS server, drive, odometry, sonars, bumpers, faults.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    place = result.add_argument_group("world and robot")
    place.add_argument(
        "--world", metavar="NAME|FILE", help=f"a world of ours or a .map file (default {Scenario.world})"
    )
    place.add_argument(
        "--scenario",
        metavar="NAME|FILE",
        help=f"world, start, faults and more: one of ours ({', '.join(scenario_names())}) or a YAML file",
    )
    place.add_argument("--seed", type=_seed, metavar="N", help="seed of everything random (default 1)")
    place.add_argument(
        "--start", type=_start, metavar="X,Y[,DEG]", help="start pose, mm and degrees (default 0)"
    )
    place.add_argument(
        "--bumpers", type=int, choices=(0, 5), help="front bumper segments (default: as the robot has)"
    )
    place.add_argument(
        "--rear-bumpers", type=int, choices=(0, 5), help="rear bumper segments (default: as the robot has)"
    )
    place.add_argument(
        "--robot", choices=robots(), metavar="NAME", help=f"{', '.join(robots())} (default {DEFAULT_ROBOT})"
    )
    place.add_argument(
        "--ring", dest="robot", type=_ring, metavar="FILE.toml", help="a ring and body of your own instead"
    )
    place.add_argument("--name", type=_label, help="the robot's name (default: as its table says)")
    place.add_argument(
        "--subclass",
        type=_label,
        help="the subclass it announces (default: the robot's); one of --robot is that robot unless --robot is given",
    )
    place.add_argument(
        "--robots", type=_robots, default=1, metavar="N", help="serve N robots, each in a world of its own"
    )
    place.add_argument(
        "--quirks",
        choices=tuple(QUIRKS),
        default="robot",
        help="whose habits: the robot's (default) or the vendor emulator's",
    )
    place.add_argument(
        "--sip-cycle", type=_sip_cycle, default=SIP_CYCLE_MS, metavar="MS", help="between SIPs (default 100)"
    )
    place.add_argument(
        "--physics",
        type=_physics,
        metavar="SET|NAME=VALUE,...",
        help=f"{', '.join(SETS)}, or values of {', '.join(LIMITS)} (docs/worlds.md)",
    )
    place.add_argument(
        "--sonar",
        type=_sonar,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="a parameter of the sonar model, as in a scenario (docs/worlds.md); repeatable",
    )
    place.add_argument(
        "--laser", action="store_true", help="a laser that clients may ask for, as the vendor's emulator has"
    )
    place.add_argument("--aux-loopback", action="store_true", help="a loop-back plug on each AUX port")
    faults = result.add_argument_group("faults")
    faults.add_argument("--fault", action="append", default=[], metavar="SPEC", help="e.g. off:3@12s")
    faults.add_argument(
        "--crosstalk", type=_probability, metavar="P", help="probability of a crosstalk reading"
    )
    links = result.add_argument_group("link (default: a pseudo-terminal)").add_mutually_exclusive_group()
    links.add_argument(
        "--tcp", type=_tcp, metavar="[HOST:]PORT", help=f"listen on TCP (host {DEFAULT_TCP_HOST})"
    )
    links.add_argument("--serial", type=_serial, metavar="DEV@BAUD", help="serve on a real UART")
    links.add_argument(
        "--can",
        type=_can,
        metavar="IFACE[,KEY=N...]",
        help="serve on a CAN bus, see docs/can.md",
    )
    pty = result.add_argument_group("pseudo-terminal")
    pty.add_argument("--link-name", metavar="PATH", help="symlink to the device, removed at the end")
    pty.add_argument("--baud", type=_baud, metavar="N", help="the robot's rate (default 9600)")
    rest = result.add_argument_group("other")
    rest.add_argument("--truth", metavar="FILE", help="write what really happens as JSON lines")
    rest.add_argument("--record", metavar="FILE", help="append all bytes of the link with their times")
    rest.add_argument(
        "--record-max",
        type=_megabytes,
        metavar="MB",
        default=MAX_BYTES,
        help="size at which FILE becomes FILE.1 and so on to FILE.4 (default 64)",
    )
    rest.add_argument("--duration", type=_seconds, metavar="S", help="end after S seconds")
    rest.add_argument(
        "--monitor",
        action="store_true",
        help="start argusd and a page in the browser as well: argus-monitor --sim (docs/monitor.md)",
    )
    rest.add_argument(
        "--orders",
        action="store_true",
        help="obey lines on standard input ('break off:3', 'mend 3', 'mend all', 'watch') until it ends",
    )
    rest.add_argument("--list-worlds", action="store_true", help="list our worlds and leave")
    rest.add_argument("--list-faults", action="store_true", help="list the fault kinds and leave")
    rest.add_argument(
        "-v", "--verbose", action="count", default=0, help="say more on standard error; -vv: every command"
    )
    add_version(rest)
    result.elsewhere = ("bench", "experiment")
    return result
