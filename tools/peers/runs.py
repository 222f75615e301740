# SPDX-License-Identifier: MIT
"""Builds the vendor's programs outside of the checkout, runs them against ours, and prints what came of it."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import IO, Any, Final

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from devtool.base import leave_at_sigterm

from peers import ros
from peers.base import (
    ARGUSD,
    FAILURES,
    SIM,
    Peer,
    cache,
    free_port,
    make,
    run_client,
    started,
    tried,
    truth_of,
    wait_port,
)
from peers.guard import DROVE_MM, Client, Place, at_robot, by_command, by_guard

EXAMPLES: Final = ("wander", "demo", "gotoActionExample")
NEEDS: Final = {
    "MOBILESIM_SOURCE": ("ARIA_SOURCE",),
    "ROSARIA_SOURCE": ("ARIA_SOURCE", ros.ROOT_VARIABLE),
    "P2OS_SOURCE": (ros.ROOT_VARIABLE,),
    "PLAYER_SOURCE": (ros.ROOT_VARIABLE,),
}
"""What each is built with, and in."""
LIMIT_S: Final = 45.0
ARROW_UP: Final = b"\x1b[A"
MAP: Final = "AMROffice.map"
GOAL: Final = "800,0"


def build_aria(source: Path) -> Path:
    """Build the library and the examples; return the folder."""
    folder = cache("aria", source)
    make(folder, "lib/libAria.so", "lib/libAria.a")
    make(folder, *(f"examples/{name}" for name in EXAMPLES))
    return folder


def build_mobilesim(source: Path, aria: Path) -> Path:
    """Build the emulator without a screen, with the ARIA built before; return the folder."""
    folder = cache("mobilesim", source)
    loader = folder / "MapLoader.cc"
    text = loader.read_text(encoding="latin-1")
    # AriaCoda returns by value what ARIA returned by pointer.
    loader.write_text(text.replace("getMapObjects()->", "getMapObjects()."), encoding="latin-1")
    include = aria / "include"
    make(folder, f"ARIA={aria}", f"ARIA_CFLAGS=-I{include} -I{include / 'Aria'}", "MobileSim")
    return folder


def keys_of(name: str) -> list[tuple[float, bytes]]:
    """What is pressed, after how many seconds: demo is driven by hand, the others drive by themselves."""
    return [(4.0 + 0.2 * k, ARROW_UP) for k in range(40)] if name == "demo" else []


def aria_against_sim(aria: Path, name: str, folder: Path) -> Peer:
    """One of the vendor's examples drives our robot."""
    port = free_port()
    truth = folder / f"{name}.jsonl"
    environment = {**os.environ, "LD_LIBRARY_PATH": str(aria / "lib"), "ARIA": str(aria)}
    words = [str(aria / "examples" / name), "-remoteHost", "127.0.0.1", "-remoteRobotTcpPort", str(port)]
    with started([SIM, "--tcp", str(port), "--world", "hall", "--truth", truth], stdout=subprocess.DEVNULL):
        wait_port(port)
        run_client(words, environment, keys_of(name), LIMIT_S)
    seen = truth_of(truth)
    passed = seen["sessions"] > 0 and seen["way_mm"] > DROVE_MM
    text = f"{seen['sessions']} session, {seen['way_mm']:.0f} mm in {LIMIT_S:.0f} s, {seen['collisions']} collisions"
    return Peer(name, "argus-sim", passed, text)


def wander_of(aria: Path) -> Client:
    """The vendor's wander, as it is."""

    def words(place: Place) -> list[str | Path]:
        return [aria / "examples/wander", "-remoteHost", "127.0.0.1", "-remoteRobotTcpPort", str(place.port)]

    return Client("wander", by_command(words, LD_LIBRARY_PATH=str(aria / "lib"), ARIA=str(aria)))


def argusd_against_mobilesim(mobilesim: Path, folder: Path) -> Peer:
    """argusd drives the vendor's robot to a goal."""
    port = free_port()
    words: list[str | Path] = [
        mobilesim / "MobileSim",
        "--noninteractive",
        "-m",
        mobilesim / MAP,
        "-r",
        "p3dx",
        "-p",
        str(port),
        "--no-crash-debug",
    ]
    log = (folder / "mobilesim.log").open("wb")
    with log, screen() as display:
        environment = {**os.environ, "DISPLAY": display, "MOBILESIM": str(mobilesim)}
        return drive_there(words, log, environment, port, folder)


@contextlib.contextmanager
def screen() -> Iterator[str]:
    """A screen in memory, since the emulator does not start without one; its name."""
    reader, writer = os.pipe()
    with started(["Xvfb", "-displayfd", str(writer), "-screen", "0", "640x480x24"], pass_fds=[writer]):
        os.close(writer)
        with os.fdopen(reader) as name:
            yield f":{name.readline().strip()}"


def drive_there(
    words: Sequence[str | Path], log: IO[bytes], environment: Mapping[str, str], port: int, folder: Path
) -> Peer:
    """Start the emulator and drive its robot."""
    options: dict[str, Any] = {"stdout": log, "stderr": subprocess.STDOUT, "stdin": subprocess.DEVNULL}
    with started(words, cwd=folder, env=dict(environment), **options):
        if not wait_port(port):
            return Peer(
                "argusd",
                "MobileSim",
                False,
                "nobody listens: " + (folder / "mobilesim.log").read_text()[-200:],
            )
        course = [str(ARGUSD), "--link", f"tcp:127.0.0.1:{port}", "--active", "--goal", GOAL, "--json"]
        done = subprocess.run(course, capture_output=True, check=False, timeout=300, stdin=subprocess.DEVNULL)
    return drive_of(done)


def drive_of(done: subprocess.CompletedProcess[bytes]) -> Peer:
    """What argusd said of its drive."""
    events = [json.loads(line) for line in done.stdout.splitlines()]
    out = [e["name"] for e in events if e["event"] == "SONAR_DISABLED"]
    reached = any(e["event"] == "GOAL_REACHED" for e in events)
    sips = max((e["sips"] for e in events if e["event"] == "STATUS"), default=0)
    text = f"goal {GOAL} {'reached' if reached else 'not reached'}, {sips} SIPs, sonars out: {', '.join(out) or 'none'}"
    return Peer("argusd", "MobileSim", reached and done.returncode == 0, text)


def complete(given: Mapping[str, Path]) -> dict[str, Path]:
    """Return of the sources those that all they are built with is there for; say of the others what lacks."""
    there = {*given, *(name for name in (ros.ROOT_VARIABLE,) if os.environ.get(name))}
    found = {}
    for name, folder in given.items():
        lacking = [need for need in NEEDS.get(name, ()) if need not in there]
        if lacking:
            print(f"skipped {name}: give {' and '.join(f'{need}=' for need in lacking)} as well")
        else:
            found[name] = folder
    return found


def run_peers(given: Mapping[str, Path], folder: Path, seconds: float) -> Iterator[Peer]:
    """Build and run what is given and has what it needs."""
    aria = None
    if "ARIA_SOURCE" in given:
        try:
            aria = build_aria(given["ARIA_SOURCE"])
        except FAILURES as error:
            yield Peer("AriaCoda", "its compiler", False, str(error))
            given = {name: source for name, source in given.items() if name != "ARIA_SOURCE"}
    given = complete(given)
    if aria is not None:
        for example in EXAMPLES:
            yield tried(example, "argus-sim", partial(aria_against_sim, aria, example, folder))
        yield from by_wire("wander", lambda: wander_of(aria), seconds, folder)
    if given.keys() & set(ros.SOURCES):
        try:
            makers = ros.clients(given, ros.debian(), aria)
        except FAILURES as error:
            makers = {}
            yield Peer("clients of ROS 1", f"{ros.ROOT_VARIABLE}=", False, str(error))
        for name, made in makers.items():
            yield from by_wire(name, made, seconds, folder)
    if "MOBILESIM_SOURCE" in given and aria is not None:
        source = given["MOBILESIM_SOURCE"]
        yield tried(
            "argusd",
            "MobileSim",
            lambda: argusd_against_mobilesim(build_mobilesim(source, aria), folder),
        )


def by_wire(name: str, made: Callable[[], Client], seconds: float, folder: Path) -> Iterator[Peer]:
    """Build a client; run it at the robot and by a guard port."""
    try:
        client = made()
    except FAILURES as error:
        yield Peer(name, "its compiler", False, str(error))
        return
    yield tried(name, "argus-sim, sonar 3 dead", partial(at_robot, client, seconds, folder / f"{name}-robot"))
    yield tried(
        name, "argusd --guard, sonar 3 dead", partial(by_guard, client, seconds, folder / f"{name}-guard")
    )


def line_of(peer: Peer) -> str:
    """A run in one line."""
    return f"{'ok' if peer.passed else 'FAILED':6} {peer.client} against {peer.server}: {peer.seen}"


def main(words: Sequence[str]) -> int:
    """Build and run what is given as NAME=FOLDER; 1 when something is not as it must be."""
    leave_at_sigterm()
    given = {name: Path(folder) for name, _, folder in (word.partition("=") for word in words)}
    seconds = float(os.environ.get("PEER_SECONDS", LIMIT_S))
    peers = []
    with tempfile.TemporaryDirectory() as name:
        for peer in run_peers(given, Path(name), seconds):
            peers.append(peer)
            print(line_of(peer), flush=True)
    print("", *map(line_of, peers), sep="\n")  # once more, below what the clients have written
    return 0 if all(peer.passed for peer in peers) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
