# SPDX-License-Identifier: MIT
"""What the runs of peers share: where they are built, how they are started, and what truly happened."""

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
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[2]
SIM: Final = ROOT / ".venv/bin/argus-sim"
ARGUSD: Final = ROOT / "build/release/argusd"
ESCAPE: Final = b"\x1b"


FAILURES: Final = (OSError, subprocess.SubprocessError, ValueError, LookupError)
"""What a program of others that fails to build or to run comes back as."""


@dataclass(frozen=True)
class Peer:
    """One run: which programs met, whether it did what it must, and what was seen."""

    client: str
    server: str
    passed: bool
    seen: str


def tried(client: str, server: str, run: Callable[[], Peer]) -> Peer:
    """Return what a run gives; one that fails has not passed, and is no reason to leave out the others."""
    try:
        return run()
    except FAILURES as error:
        return Peer(client, server, False, f"{type(error).__name__}: {error}")


def home() -> Path:
    """The folder in which peers are built."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "argus" / "peers"


def copied(source: Path, target: Path, *ignored: str) -> Path:
    """Copy a folder, unless that was done before: what stands under the name is whole, whatever ends us."""
    if not target.exists():
        target.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=target.parent, prefix=f".{target.name}-") as folder:
            part = Path(folder) / target.name
            patterns = shutil.ignore_patterns(*ignored)
            shutil.copytree(source, part, symlinks=True, ignore=patterns, ignore_dangling_symlinks=True)
            part.rename(target)
    return target


def cache(name: str, source: Path, folder: Path | None = None) -> Path:
    """Return a copy of the sources to build in: theirs stay as they are, and nothing of them is in our tree."""
    return copied(source, (folder or home()) / name, "*.o", "*.a", "*.so", ".git")


def make(folder: Path, *words: str) -> None:
    """Run make; its output goes where ours goes."""
    subprocess.run(["make", "-j2", *words], cwd=folder, check=True)


def free_port() -> int:
    """Return a port that no program listens on."""
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
    """Wait until a program listens; the look disturbs no session."""
    until = time.monotonic() + limit_s
    hexed = f":{port:04X} "
    while time.monotonic() < until:
        rows = Path("/proc/net/tcp").read_text().splitlines()[1:]
        if any(hexed in row and row.split()[3] == "0A" for row in rows):
            return True
        time.sleep(0.1)
    return False


def run_client(
    words: Sequence[str | Path],
    environment: Mapping[str, str],
    keys: Sequence[tuple[float, bytes]],
    seconds: float,
) -> None:
    """Run a client on a terminal for so long with these keys, each after so many seconds, then escape."""
    master, slave = pty.openpty()
    with (
        os.fdopen(master, "wb", buffering=0) as terminal,
        started(words, stdin=slave, stdout=slave, stderr=slave, env=dict(environment)) as child,
    ):
        os.close(slave)
        os.set_blocking(master, False)
        start = time.monotonic()
        for after_s, key in [*keys, (seconds, ESCAPE)]:
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
