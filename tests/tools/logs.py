# SPDX-License-Identifier: MIT
"""What the tests of `argus-log` share: the recorded captures, made-up sessions, and a way to run the command."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import forks
from argus_tools.formats import MODULES
from argus_tools.log.cli import COMMANDS

from hil_sim.arcos import COMMAND, Command, Sip, frame

ROOT = Path(__file__).resolve().parents[2]
CAPTURES = ROOT / "tests" / "data" / "captures"
ARGUS_LOG = "argus_tools.log.cli:main"


def preload(arguments: Sequence[str | Path]) -> list[str]:
    """Return what argus-log imports late for these arguments; what draws is large, so only where it is to be had."""
    late = [f"argus_tools.log.{name}" for name in COMMANDS if name != "plot" or name in arguments]
    return [*late, *(f"argus_tools.formats.{name}" for name in MODULES)]


def run(*arguments: str | Path, stdin: bytes | None = None) -> subprocess.CompletedProcess[bytes]:
    """Run argus-log; any traceback fails the test."""
    env = {**os.environ, "COLUMNS": "120"}
    done = forks.run(ARGUS_LOG, *arguments, given=stdin, env=env, preload=preload(arguments))
    assert b"Traceback" not in done.stderr, done.stderr.decode()
    return done


def start(*arguments: str | Path) -> forks.Forked:
    """Start argus-log with a pipe at each of its three descriptors."""
    pipe = subprocess.PIPE
    return forks.start(
        ARGUS_LOG, *arguments, stdin=pipe, stdout=pipe, stderr=pipe, preload=preload(arguments)
    )


def decode(*arguments: str | Path, stdin: bytes | None = None) -> list[dict[str, Any]]:
    """Run `argus-log decode --json`; return its objects."""
    done = run("decode", "--json", *arguments, stdin=stdin)
    assert done.returncode == 0, done.stderr.decode()
    return [json.loads(line) for line in done.stdout.splitlines()]


def capture_bytes(path: Path, direction: str) -> bytes:
    """Return the bytes of one direction of a capture, read without the code under test."""
    records = map(json.loads, path.read_text().splitlines())
    return b"".join(bytes.fromhex(r["hex"]) for r in records if r["dir"] == direction)


def sip(**values: Any) -> bytes:
    """Return a SIP as it goes over the wire."""
    return frame(Sip(**values).data)


def command(name: str, value: int | None = None) -> bytes:
    """Return a command as it goes over the wire; SYNC0 to SYNC2 are 0 to 2."""
    number = {"SYNC0": 0, "SYNC1": 1, "SYNC2": 2}.get(name, COMMAND.get(name, 0))
    made = Command.none(number) if value is None else Command.integer(number, value)
    return frame(made.data)


def jsonl(records: Iterable[tuple[float | None, str, bytes]]) -> bytes:
    """Return (t, dir, bytes) as JSON lines."""
    return b"".join(
        json.dumps({"t": t, "dir": direction, "hex": data.hex()}).encode() + b"\n"
        for t, direction, data in records
    )
