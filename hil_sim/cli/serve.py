# SPDX-License-Identifier: MIT
"""Serves the robots that were asked for until a signal or the end of the time."""

from __future__ import annotations

import argparse
import dataclasses
import functools
import signal
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

from hil_sim.cli.choose import link_of, numbered, robot_name
from hil_sim.errors import SimError
from hil_sim.faults.execute import FaultSet
from hil_sim.faults.link import LinkFaults
from hil_sim.links.base import Link
from hil_sim.links.loop import LATE_MS, Fleet, Loop
from hil_sim.links.orders import Orders
from hil_sim.record.recording import Recorder
from hil_sim.record.truth import Log, TruthRecord
from hil_sim.robot.robot import Robot
from hil_sim.scenario.build import build_robot, scanner_of
from hil_sim.scenario.scenario import SEED_MAX, Scenario
from hil_sim.server.quirks import server_kind
from hil_sim.server.server import ArcosServer
from hil_sim.world.files import load_world
from hil_sim.world.model import Pose, World


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


def say(text: str) -> None:
    """Print a line for people."""
    print(f"argus-sim: {text}", file=sys.stderr, flush=True)


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
        "robot": scenario.robot,
        "physics": (scenario.physics or world.physics).text,
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
        truth = numbered(Path(arguments.truth), index)
        log = stack.enter_context(TruthRecord(truth, _meta(scenario, world, start), say))
    robot = build_robot(scenario, world, start, log, arguments.rear_bumpers, arguments.orders)
    link, baud = link_of(arguments, index, scenario.seed)
    server = server_kind(arguments.quirks)(
        robot,
        name=robot_name(arguments, scenario.robot, index),
        subclass=arguments.subclass,
        flash_baud=baud,
        sip_cycle_ms=arguments.sip_cycle,
        aux_loopback=arguments.aux_loopback,
        log=log,
        scanner=scanner_of(scenario, world, robot) if arguments.laser else None,
    )
    faults = LinkFaults(scenario.link_faults, scenario.seed, log) if scenario.link_faults else None
    stack.callback(link.close)
    link.open()
    recorder = None
    if arguments.record:
        record = numbered(Path(arguments.record), index)
        recorder = Recorder(record, f"argus-sim {link.address}", say, arguments.record_max)
        stack.callback(recorder.close)
    orders = _orders(robot) if arguments.orders else None
    return Loop(server, link, faults, recorder=recorder, orders=orders)


def _orders(robot: Robot) -> Orders:
    assert isinstance(robot.faults, FaultSet)
    return Orders(robot, robot.faults, sys.stdin.fileno(), sys.stdout.fileno())


def serve(arguments: argparse.Namespace, scenario: Scenario) -> None:
    """Serve the robots of a scenario until a signal or the end of the time."""
    if arguments.orders and arguments.robots > 1:
        raise SimError(f"--robots {arguments.robots}: --orders are for one robot")
    with ExitStack() as stack:
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
        _announce(arguments, scenario, world, loops)

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
            say(warning)


def _announce(arguments: argparse.Namespace, scenario: Scenario, world: World, loops: Sequence[Loop]) -> None:
    """Say where the robots are to be reached, and note the time at which they are."""
    for loop in loops:
        print(loop.link.address, flush=True)
    if arguments.verbose:
        faults_text = ", ".join(map(str, scenario.faults)) or "none"
        say(f"world {world.name}, seed {scenario.seed}, faults: {faults_text}")
    for loop in loops:
        if loop.server.log is not None:
            loop.server.log("clock", {"t_s": loop.now_ms() / 1000, "unix_s": time.time()})


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
    say(f"{robot.now_ms / 1000:.1f} s, {server.sips} SIPs, {robot.chassis.collisions} collisions")
    junk = f"{heard.bad_checksum} bad checksums, {heard.junk_bytes} junk bytes"
    say(f"heard {heard.packets} packets, {junk}")
    if summary := link.summary():
        say(summary)
