# SPDX-License-Identifier: MIT
"""Builds the vendor's programs outside of the checkout, runs them against ours, and prints what came of it."""

from __future__ import annotations

import contextlib
import itertools
import json
import os
import pty
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any, Final

ROOT: Final = Path(__file__).resolve().parents[2]
SIM: Final = ROOT / ".venv/bin/argus-sim"
ARGUSD: Final = ROOT / "build/release/argusd"
EXAMPLES: Final = ("wander", "demo", "gotoActionExample")
LIMIT_S: Final = 45.0
ESCAPE: Final = b"\x1b"
ARROW_UP: Final = b"\x1b[A"
DROVE_MM: Final = 300.0
SETTLE_S: Final = 4.0
"""Until argusd has met the robot."""
MAP: Final = "AMROffice.map"
GOAL: Final = "800,0"


@dataclass(frozen=True)
class Peer:
    """One run: who against whom, whether it did what it must, and what was seen."""

    client: str
    server: str
    passed: bool
    seen: str


def cache(name: str, source: Path) -> Path:
    """Return a copy of the sources to build in: theirs stay as they are, and nothing of them is in our tree."""
    home = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folder = home / "argus" / "peers" / name
    if not folder.exists():
        ignored = shutil.ignore_patterns("*.o", "*.a", "*.so", ".git")
        shutil.copytree(source, folder, symlinks=True, ignore=ignored, ignore_dangling_symlinks=True)
    return folder


def make(folder: Path, *words: str) -> None:
    """Run make; its output goes where ours goes."""
    subprocess.run(["make", "-j2", *words], cwd=folder, check=True)


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


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return int(server.getsockname()[1])


@contextlib.contextmanager
def started(words: Sequence[str | Path], **options: Any) -> Iterator[subprocess.Popen[bytes]]:
    """Start a program; it ends with the block."""
    child = subprocess.Popen([str(word) for word in words], start_new_session=True, **options)
    try:
        yield child
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child.pid, signal.SIGTERM)
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(10)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child.pid, signal.SIGKILL)
        child.wait()


def wait_port(port: int, limit_s: float = 30.0) -> bool:
    """Wait until somebody listens; whoever looks is turned away by nobody's session."""
    until = time.monotonic() + limit_s
    hexed = f":{port:04X} "
    while time.monotonic() < until:
        rows = Path("/proc/net/tcp").read_text().splitlines()[1:]
        if any(hexed in row and row.split()[3] == "0A" for row in rows):
            return True
        time.sleep(0.1)
    return False


def keys_of(name: str) -> list[tuple[float, bytes]]:
    """What is pressed, after how many seconds: demo is driven by hand, the others drive by themselves."""
    return [(4.0 + 0.2 * k, ARROW_UP) for k in range(40)] if name == "demo" else []


def run_client(
    words: Sequence[str], environment: Mapping[str, str], keys: Sequence[tuple[float, bytes]]
) -> None:
    """Run a client on a terminal for LIMIT_S with these keys, then escape."""
    master, slave = pty.openpty()
    with (
        os.fdopen(master, "wb", buffering=0) as terminal,
        started(words, stdin=slave, stdout=slave, stderr=slave, env=dict(environment)) as child,
    ):
        os.close(slave)
        os.set_blocking(master, False)
        start = time.monotonic()
        for after_s, key in [*keys, (LIMIT_S, ESCAPE)]:
            drain_until(master, start + after_s, child)
            with contextlib.suppress(OSError):
                terminal.write(key)
        with contextlib.suppress(subprocess.TimeoutExpired):
            child.wait(5)


def drain_until(terminal: int, end: float, child: subprocess.Popen[bytes]) -> None:
    """Let a program go on that writes to the terminal."""
    while time.monotonic() < end and child.poll() is None:
        with contextlib.suppress(OSError):
            if select.select([terminal], [], [], 0.05)[0]:
                sys.stdout.write(os.read(terminal, 4096).decode("latin-1"))


def truth_of(path: Path) -> dict[str, Any]:
    """What truly happened."""
    records = [json.loads(line) for line in path.read_text().splitlines() if line.endswith("}")]
    states = [r for r in records if r["type"] == "state"]
    way = sum(
        ((a["x_mm"] - b["x_mm"]) ** 2 + (a["y_mm"] - b["y_mm"]) ** 2) ** 0.5
        for a, b in itertools.pairwise(states)
    )
    return {
        "sessions": sum(r["type"] == "session" and r["state"] == "open" for r in records),
        "way_mm": way,
        "collisions": sum(r["type"] == "collision" for r in records),
    }


def aria_against_sim(aria: Path, name: str, folder: Path) -> Peer:
    """One of the vendor's examples drives our robot."""
    port = free_port()
    truth = folder / f"{name}.jsonl"
    environment = {**os.environ, "LD_LIBRARY_PATH": str(aria / "lib"), "ARIA": str(aria)}
    words = [str(aria / "examples" / name), "-remoteHost", "127.0.0.1", "-remoteRobotTcpPort", str(port)]
    with started([SIM, "--tcp", str(port), "--world", "hall", "--truth", truth], stdout=subprocess.DEVNULL):
        wait_port(port)
        run_client(words, environment, keys_of(name))
    seen = truth_of(truth)
    passed = seen["sessions"] > 0 and seen["way_mm"] > DROVE_MM
    text = f"{seen['sessions']} session, {seen['way_mm']:.0f} mm in {LIMIT_S:.0f} s, {seen['collisions']} collisions"
    return Peer(name, "argus-sim", passed, text)


def aria_behind_guard(aria: Path, folder: Path) -> Peer:
    """The vendor's wander drives a robot whose sonar 3 is dead, by a guard port of argusd: it must meet nothing."""
    robot, guard = free_port(), free_port()
    truth = folder / "guarded.jsonl"
    said = folder / "guarded.events"
    environment = {**os.environ, "LD_LIBRARY_PATH": str(aria / "lib"), "ARIA": str(aria)}
    client = [str(aria / "examples/wander"), "-remoteHost", "127.0.0.1", "-remoteRobotTcpPort", str(guard)]
    sim: list[str | Path] = [
        SIM,
        "--tcp",
        str(robot),
        "--world",
        "office",
        "--fault",
        "silent:3",
        "--truth",
        truth,
    ]
    argusd = [str(ARGUSD), "--link", f"tcp:127.0.0.1:{robot}", "--wait", "60", "--json"]
    argusd += ["--guard", f"tcp:127.0.0.1:{guard}", "--guard-readings", "cover"]
    with started(sim, stdout=subprocess.DEVNULL), said.open("wb") as events:
        wait_port(robot)
        with started(argusd, stdout=events, stdin=subprocess.DEVNULL):
            wait_port(guard)
            time.sleep(SETTLE_S)
            run_client(client, environment, [])
    seen = truth_of(truth)
    held = sum(b'"GUARD_' in line for line in said.read_bytes().splitlines())
    passed = seen["sessions"] > 0 and seen["way_mm"] > DROVE_MM and seen["collisions"] == 0
    drove = f"{seen['way_mm']:.0f} mm in {LIMIT_S:.0f} s, {seen['collisions']} collisions"
    text = f"sonar 3 dead: {drove}, {held} guard events"
    return Peer("wander", "argusd --guard", passed, text)


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


def run_peers(given: Mapping[str, Path], folder: Path) -> list[Peer]:
    """Build and run what is given."""
    if "ARIA_SOURCE" not in given:
        print("MobileSim is built with ARIA: give ARIA_SOURCE= as well")
        return []
    aria = build_aria(given["ARIA_SOURCE"])
    peers = [aria_against_sim(aria, example, folder) for example in EXAMPLES]
    peers.append(aria_behind_guard(aria, folder))
    if "MOBILESIM_SOURCE" in given:
        peers.append(argusd_against_mobilesim(build_mobilesim(given["MOBILESIM_SOURCE"], aria), folder))
    return peers


def main(words: Sequence[str]) -> int:
    """Build and run what is given as NAME=FOLDER; 1 when something is not as it must be."""
    given = {name: Path(folder) for name, _, folder in (word.partition("=") for word in words)}
    with tempfile.TemporaryDirectory() as name:
        peers = run_peers(given, Path(name))
    for peer in peers:
        print(f"{'ok' if peer.passed else 'FAILED':6} {peer.client} against {peer.server}: {peer.seen}")
    return 0 if peers and all(peer.passed for peer in peers) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
