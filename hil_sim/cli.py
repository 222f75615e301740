# SPDX-License-Identifier: MIT
"""The `argus-sim` command: one emulated P3-DX on a pseudo-terminal, a TCP port, a real UART or a CAN bus."""

from __future__ import annotations

import argparse
import dataclasses
import functools
import logging
import math
import os
import re
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from hil_sim.arcos import BAUD
from hil_sim.body import BodyModel
from hil_sim.can_spec import CanSpec, parse_spec
from hil_sim.errors import SimError
from hil_sim.faults import Fault, FaultSet, fault_help, parse_fault
from hil_sim.link_faults import LinkFaults
from hil_sim.links import LATE_MS, Fleet, Link, Loop, PtyLink, SerialLink, TcpLink
from hil_sim.mobilesim import NAME as MOBILESIM_NAME
from hil_sim.mobilesim import MobileSimServer
from hil_sim.moving import moving_solids
from hil_sim.record import MAX_BYTES, Recorder
from hil_sim.robot import Log, Robot
from hil_sim.scenario import SEED_MAX, Scenario, load_scenario
from hil_sim.server import SIP_CYCLE_MS, ArcosServer
from hil_sim.sonar import SonarRing
from hil_sim.truth import TruthRecord
from hil_sim.world import Pose, World, load_world, world_names

DEFAULT_TCP_HOST = "127.0.0.1"
DEFAULT_NAME = "P3DX_0001"
ROBOTS_MAX = 64

_EXAMPLES = """\
examples:
  argus-sim                                   one robot in the default world; prints the device to open
  argus-sim --link-name /tmp/robot            the same behind a stable name
  argus-sim --world lab --fault off:3@12s --truth truth.jsonl
  argus-sim --record drive.rec                what passes on the link, for argus-log
  argus-sim --tcp 8101                        as the vendor's emulator listens
  argus-sim --serial /dev/ttyUSB0@9600        on a real UART
  argus-sim --can can0                        on a CAN bus, each ARCOS packet an ISO-TP message (docs/can.md)
  argus-sim --robots 3 --tcp 8101             three robots, on ports 8101 to 8103
  argus-sim --tcp 8101 --quirks mobilesim     with the answers of the vendor's emulator
  argus-sim bench diagnosis --help            how well faults are diagnosed, over many missions without a link

The first line on standard output is the device path, HOST:PORT, or what argusd takes after can:, alone; with
--robots one line for each. All else goes to standard error.
A pseudo-terminal takes 10 bit times a byte at the robot's rate and is garbled at any other.

exit codes: 0 ended by a signal or --duration, 1 link cannot be opened or was lost, 2 wrong argument or file
"""


class _Parser(argparse.ArgumentParser):
    """Reports a wrong argument in one line."""

    def error(self, message: str) -> NoReturn:
        """Print the line and leave with code 2."""
        self.exit(2, f"{self.prog}: {message}; see {self.prog} --help\n")


def _start(text: str) -> Pose:
    parts = text.split(",")
    try:
        if len(parts) != 3:
            raise ValueError
        x, y, heading = (float(part) for part in parts)
        if not all(map(math.isfinite, (x, y, heading))):
            raise ValueError
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not X,Y,DEG, for example 1000,500,90") from None
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


def _fault(text: str) -> Fault:
    try:
        return parse_fault(text)
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
        description="Emulate a Pioneer P3-DX: ARCOS server, drive, odometry, sonars, bumpers, faults.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    place = result.add_argument_group("world and robot")
    place.add_argument(
        "--world", metavar="NAME|FILE", help=f"a world of ours or a .map file (default {Scenario.world})"
    )
    place.add_argument("--scenario", metavar="FILE", help="world, start, faults and more from a YAML file")
    place.add_argument("--seed", type=_seed, metavar="N", help="seed of everything random (default 1)")
    place.add_argument("--start", type=_start, metavar="X,Y,DEG", help="start pose, mm and degrees")
    place.add_argument(
        "--bumpers", type=int, choices=(0, 5), help="front bumper segments (default 5; 0: bare robot)"
    )
    place.add_argument(
        "--rear-bumpers", type=int, choices=(0, 5), default=0, help="rear bumper segments (default 0)"
    )
    place.add_argument("--name", type=_label, help=f"the robot's name (default {DEFAULT_NAME})")
    place.add_argument(
        "--subclass", type=_label, default="p3dx-sh", help="the subclass it announces (default %(default)s)"
    )
    place.add_argument(
        "--robots", type=_robots, default=1, metavar="N", help="serve N robots, each in a world of its own"
    )
    place.add_argument(
        "--quirks",
        choices=("p3dx", "mobilesim"),
        default="p3dx",
        help="whose habits: the robot's (default) or the vendor emulator's",
    )
    place.add_argument(
        "--sip-cycle", type=_sip_cycle, default=SIP_CYCLE_MS, metavar="MS", help="between SIPs (default 100)"
    )
    place.add_argument("--aux-loopback", action="store_true", help="a loop-back plug on each AUX port")
    faults = result.add_argument_group("faults")
    faults.add_argument(
        "--fault", type=_fault, action="append", default=[], metavar="SPEC", help="e.g. off:3@12s"
    )
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
    rest.add_argument("--list-worlds", action="store_true", help="list our worlds and leave")
    rest.add_argument("--list-faults", action="store_true", help="list the fault kinds and leave")
    rest.add_argument(
        "-v", "--verbose", action="count", default=0, help="say more on standard error; -vv: every command"
    )
    return result


def _scenario(arguments: argparse.Namespace) -> Scenario:
    """The scenario file with the command line laid over it."""
    scenario = load_scenario(arguments.scenario) if arguments.scenario else Scenario()
    changes: dict[str, Any] = {
        name: value
        for name, value in (
            ("world", arguments.world),
            ("seed", arguments.seed),
            ("start", arguments.start),
            ("bumpers", arguments.bumpers),
        )
        if value is not None
    }
    if arguments.crosstalk is not None:
        changes["sonar"] = dataclasses.replace(scenario.sonar, crosstalk=arguments.crosstalk)
    if arguments.fault:
        changes["faults"] = (*scenario.faults, *arguments.fault)
    return dataclasses.replace(scenario, **changes)


def _link(arguments: argparse.Namespace, index: int, seed: int) -> tuple[Link, int]:
    """The link asked for, of the robot with this index, and the rate at which the robot starts."""
    if arguments.tcp:
        if arguments.link_name or arguments.baud:
            raise SimError("--link-name and --baud are for a pseudo-terminal; leave them out with --tcp")
        host, port = arguments.tcp
        if port + index > 65535:
            raise SimError(f"--tcp {port}: no port left for robot {index + 1}; begin lower")
        return TcpLink(host, port + index if port else 0, deaf=_is_mobilesim(arguments)), BAUD["B9600"]
    if arguments.serial:
        if arguments.link_name or arguments.baud:
            raise SimError(
                "--link-name and --baud are for a pseudo-terminal; give the rate as --serial DEV@BAUD"
            )
        if arguments.robots > 1:
            raise SimError(f"--robots {arguments.robots}: one UART serves one robot; use --tcp or ptys")
        return SerialLink(*arguments.serial), arguments.serial[1]
    if arguments.can:
        if arguments.link_name or arguments.baud:
            raise SimError("--link-name and --baud are for a pseudo-terminal; leave them out with --can")
        from hil_sim.links_can import CanLink

        return CanLink(arguments.can.of_robot(index)), BAUD["B9600"]
    baud = arguments.baud or BAUD["B9600"]
    name = str(_numbered(Path(arguments.link_name), index)) if arguments.link_name else None
    return PtyLink(baud, name, seed), baud


def _is_mobilesim(arguments: argparse.Namespace) -> bool:
    return bool(arguments.quirks == "mobilesim")


def _numbered(path: Path, index: int) -> Path:
    """The file of the robot with this index: PATH, PATH-2, PATH-3, before the suffix."""
    return path.with_name(f"{path.stem}-{index + 1}{path.suffix}") if index else path


def _robot_name(arguments: argparse.Namespace, index: int) -> str:
    """The name of the robot with this index; a number at its end counts up."""
    default = MOBILESIM_NAME if _is_mobilesim(arguments) else DEFAULT_NAME
    name: str = arguments.name or default
    if not index:
        return name
    stem = name.rstrip("0123456789")
    digits = name[len(stem) :]
    number = f"{int(digits) + index:0{len(digits)}d}" if digits else f"_{index + 1}"
    return stem[: 20 - len(number)] + number


@contextmanager
def _on_signal(number: int, act: Callable[[], object]) -> Iterator[None]:
    """Act when that signal comes."""
    handler = signal.signal(number, lambda _number, _frame: act())
    try:
        yield
    finally:
        signal.signal(number, handler)


@contextmanager
def _signals() -> Iterator[list[int]]:
    """Collect SIGINT and SIGTERM; the wake-up pipe ends a sleep that one falls into."""
    caught: list[int] = []
    with ExitStack() as stack:
        for number in (signal.SIGINT, signal.SIGTERM):
            stack.enter_context(_on_signal(number, functools.partial(caught.append, number)))
        yield caught


def _say(text: str) -> None:
    print(f"argus-sim: {text}", file=sys.stderr, flush=True)


def build_robot(
    scenario: Scenario, world: World, start: Pose, log: Log | None, rear_bumpers: int = 0
) -> Robot:
    """Return a robot at `start` in `world` with all that the scenario gives it."""
    moving = moving_solids((*world.movers, *scenario.movers))
    body = BodyModel(world, moving)
    if body.contact(start, 0.0) is not None:
        place = f"{start.x_mm:g},{start.y_mm:g},{start.heading_deg:g}"
        raise SimError(f"start {place}: a solid of world {world.name} is there; choose another with --start")
    # Streams of their own, so that one more draw in one place changes nothing elsewhere.
    faults = FaultSet(scenario.faults, np.random.default_rng([scenario.seed, 1]))
    ring = SonarRing(world, scenario.sonar, faults, np.random.default_rng([scenario.seed, 2]), moving=moving)
    return Robot(
        body,
        ring,
        start,
        faults=faults if scenario.faults else None,
        bumpers=scenario.bumpers,
        rear_bumpers=rear_bumpers,
        seed=scenario.seed,
        moving=moving,
        log=log,
    )


def _meta(scenario: Scenario, world: World, start: Pose) -> dict[str, Any]:
    """What the truth record begins with: all that is needed to make the run again."""
    return {
        "world": world.name,
        "world_file": scenario.world,
        "seed": scenario.seed,
        "start": [start.x_mm, start.y_mm, start.heading_deg],
        "course": [list(point) for point in scenario.course],
        "goal": list(scenario.goal) if scenario.goal else None,
        "faults": [str(fault) for fault in scenario.faults],
        "bumpers": scenario.bumpers,
        "scenario": scenario.text(),
    }


def _loop(
    arguments: argparse.Namespace, scenario: Scenario, world: World, index: int, stack: ExitStack
) -> Loop:
    """One robot on its link, ready for a client."""
    start = scenario.start or world.start
    log: Log | None = None
    if arguments.truth:
        truth = _numbered(Path(arguments.truth), index)
        log = stack.enter_context(TruthRecord(truth, _meta(scenario, world, start)))
    robot = build_robot(scenario, world, start, log, arguments.rear_bumpers)
    link, baud = _link(arguments, index, scenario.seed)
    kind = MobileSimServer if _is_mobilesim(arguments) else ArcosServer
    server = kind(
        robot,
        name=_robot_name(arguments, index),
        subclass=arguments.subclass,
        flash_baud=baud,
        sip_cycle_ms=arguments.sip_cycle,
        aux_loopback=arguments.aux_loopback,
        log=log,
    )
    faults = LinkFaults(scenario.link_faults, scenario.seed, log) if scenario.link_faults else None
    stack.callback(link.close)
    link.open()
    recorder = None
    if arguments.record:
        record = _numbered(Path(arguments.record), index)
        recorder = Recorder(record, f"argus-sim {link.address}", _say, arguments.record_max)
        stack.callback(recorder.close)
    return Loop(server, link, faults, recorder=recorder)


def _serve(arguments: argparse.Namespace, scenario: Scenario, stack: ExitStack) -> None:
    logging.basicConfig(format="argus-sim: %(message)s", stream=sys.stderr)
    if arguments.verbose > 1:
        logging.getLogger("argus.sim").setLevel(logging.DEBUG)
    world = load_world(scenario.world)
    caught = stack.enter_context(_signals())
    loops = [
        _loop(
            arguments,
            dataclasses.replace(scenario, seed=(scenario.seed + k) % (SEED_MAX + 1)),
            world,
            k,
            stack,
        )
        for k in range(arguments.robots)
    ]
    for loop in loops:
        print(loop.link.address, flush=True)
    if arguments.verbose:
        faults_text = ", ".join(map(str, scenario.faults)) or "none"
        _say(f"world {world.name}, seed {scenario.seed}, faults: {faults_text}")
    for loop in loops:
        if loop.server.log is not None:
            loop.server.log("clock", {"t_s": loop.now_ms() / 1000, "unix_s": time.time()})

    def resumed() -> None:
        for loop in loops:
            loop.resumed()

    stack.enter_context(_on_signal(signal.SIGCONT, resumed))
    runner = loops[0] if len(loops) == 1 else Fleet(loops)
    runner.run(lambda: bool(caught), arguments.duration and arguments.duration * 1000)
    if arguments.verbose:
        for loop in loops:
            _report(loop.server, loop.link)
    if warning := _lateness(loops):
        _say(warning)


def _lateness(loops: Sequence[Loop]) -> str:
    """What to say of a host that did not keep up; empty of one that did."""
    turns = sum(loop.late_turns for loop in loops)
    if not turns:
        return ""
    worst_ms = max(loop.late_max_ms for loop in loops)
    return (
        f"the host was late: {turns} {'turn' if turns == 1 else 'turns'} by more than {LATE_MS:.0f} ms, "
        f"at most {worst_ms:.0f} ms; timing in this run means nothing exact"
    )


def _report(server: ArcosServer, link: Link) -> None:
    robot, heard = server.robot, server.unframer.counters
    _say(f"{robot.now_ms / 1000:.1f} s, {server.sips} SIPs, {robot.collisions} collisions")
    junk = f"{heard.bad_checksum} bad checksums, {heard.junk_bytes} junk bytes"
    _say(f"heard {heard.packets} packets, {junk}")
    if summary := link.summary():
        _say(summary)


def main(argv: Sequence[str] | None = None) -> int:
    """Run `argus-sim`; return its exit code."""
    words = list(sys.argv[1:] if argv is None else argv)
    if words[:1] == ["bench"]:
        from hil_sim.bench.cli import main as bench

        return bench(words[1:])
    arguments = parser().parse_args(words)
    try:
        if arguments.list_worlds:
            print("\n".join(world_names()))
        elif arguments.list_faults:
            print(fault_help())
        else:
            with ExitStack() as stack:
                _serve(arguments, _scenario(arguments), stack)
    except SimError as error:
        _say(str(error))
        return error.exit_code
    except BrokenPipeError:
        # Nobody reads our output; the interpreter would complain once more while it closes it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return 0


if __name__ == "__main__":
    sys.exit(main())
