# SPDX-License-Identifier: MIT
"""Old clients on a robot whose sonar 3 is dead, at the robot itself and by a guard port of argusd, in one office."""

from __future__ import annotations

import contextlib
import os
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from peers.base import ARGUSD, SIM, Peer, free_port, run_client, started, truth_of, wait_port
from peers.wire import Wire, lost, to_port, to_terminal

WORLD: Final = ("--world", "office")
FAULT: Final = ("--fault", "off:3")
"""The sonar hears nothing: its reading is that of a free way."""
DROVE_MM: Final = 300.0
SETTLE_S: Final = 4.0
"""Until argusd has met the robot."""
LINK_S: Final = 30.0


@dataclass(frozen=True)
class Place:
    """Where a client finds the robot, and how long it is to drive."""

    port: int
    path: str
    seconds: float
    folder: Path


@dataclass(frozen=True)
class Client:
    """A program that drives; `run` starts it at a place and returns when it has driven for so long."""

    name: str
    run: Callable[[Place], None]
    terminal: bool = False
    """It wants a serial line, not a port."""


def by_command(words: Callable[[Place], list[str | Path]], **environment: str) -> Callable[[Place], None]:
    """A client that is one program; it gets a terminal, and escape at its end."""

    def run(place: Place) -> None:
        run_client(words(place), {**os.environ, **environment}, [], place.seconds)

    return run


@contextmanager
def robot(folder: Path, terminal: bool) -> Iterator[Wire]:
    """An emulated robot with its sonar dead, behind a wire."""
    truth = folder / "truth.jsonl"
    port, line = free_port(), folder / "robot"
    at = ["--link-name", str(line)] if terminal else ["--tcp", str(port)]
    with started([SIM, *at, *WORLD, *FAULT, "--truth", truth], stdout=subprocess.DEVNULL):
        if terminal:
            wait_path(line)
        else:
            wait_port(port)
        wire = Wire(lambda: to_terminal(line) if terminal else to_port(port), terminal)
        try:
            yield wire
        finally:
            wire.close()


def wait_path(path: Path) -> None:
    """Wait until a file is there."""
    until = time.monotonic() + LINK_S
    while not path.exists() and time.monotonic() < until:
        time.sleep(0.1)


@contextmanager
def guarded(folder: Path, robot_port: int, terminal: bool) -> Iterator[Wire]:
    """An argusd with a guard port, behind a wire; what it says is in guard.jsonl."""
    port, line = free_port(), folder / "guard"
    guard = f"pty:{line}" if terminal else f"tcp:127.0.0.1:{port}"
    words = [str(ARGUSD), "--link", f"tcp:127.0.0.1:{robot_port}", "--wait", "60", "--json"]
    words += ["--guard", guard, "--guard-readings", "cover"]
    with (
        (folder / "guard.jsonl").open("wb") as events,
        started(words, stdout=events, stdin=subprocess.DEVNULL),
    ):
        if terminal:
            wait_path(line)
        else:
            wait_port(port)
        time.sleep(SETTLE_S)
        wire = Wire(lambda: to_terminal(line) if terminal else to_port(port), terminal)
        try:
            yield wire
        finally:
            wire.close()


def at_robot(client: Client, seconds: float, folder: Path) -> Peer:
    """The client alone: for what the guard is there."""
    folder.mkdir()
    with robot(folder, client.terminal) as wire:
        client.run(Place(wire.port, wire.path, seconds, folder))
    seen = truth_of(folder / "truth.jsonl")
    text = f"{seen['way_mm'] / 1000:.1f} m in {seconds:.0f} s, {seen['collisions']} collisions"
    return Peer(client.name, "argus-sim, sonar 3 dead", seen["way_mm"] > DROVE_MM, text)


def by_guard(client: Client, seconds: float, folder: Path) -> Peer:
    """The client by a guard port: it must drive, meet nothing, and miss no packet."""
    folder.mkdir()
    with ExitStack() as stack:
        link = stack.enter_context(robot(folder, terminal=False))
        port = stack.enter_context(guarded(folder, link.port, client.terminal))
        with contextlib.suppress(subprocess.TimeoutExpired):
            client.run(Place(port.port, port.path, seconds, folder))
    seen = truth_of(folder / "truth.jsonl")
    said = (folder / "guard.jsonl").read_text()
    missed = lost(link.sip_s, port.sip_s)
    held, slowed = said.count('"GUARD_HELD"'), said.count('"GUARD_SLOWED"')
    passed = seen["way_mm"] > DROVE_MM and seen["collisions"] == 0 and missed == port.damaged == 0
    text = (
        f"{seen['way_mm'] / 1000:.1f} m in {seconds:.0f} s, {seen['collisions']} collisions, "
        f"held {held}, slowed {slowed} times; {len(port.sip_s)} SIPs, {missed} lost"
    )
    return Peer(client.name, "argusd --guard, sonar 3 dead", passed, text)
