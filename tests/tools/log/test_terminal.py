# SPDX-License-Identifier: MIT
"""Rule: a long file shows its progress on a terminal and nowhere else, and nothing of it stays behind."""

from __future__ import annotations

import os
import pty
import re
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from logs import ROOT, jsonl, sip

pytestmark = pytest.mark.soak

LONG_BYTES = 9 << 20  # a bar is shown from 8 on
_ESCAPES = re.compile(rb"\x1b\[[0-9;?]*[A-Za-z]")


@pytest.fixture(scope="module")
def long_log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("long") / "long.bin"
    block = b"".join(sip(x=n, sonars=((n % 16, 700),)) for n in range(1000))
    path.write_bytes(block * (LONG_BYTES // len(block) + 1))
    return path


def run_on_terminal(arguments: list[str], stdout: int | None, **variables: str) -> tuple[int, bytes]:
    """Run argus-log with a terminal as standard error; return the exit code and what appeared on it."""
    ours, theirs = pty.openpty()
    environment = {k: v for k, v in os.environ.items() if k not in ("NO_COLOR", "TERM", "COLUMNS")}
    environment |= {"PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}", "TERM": "xterm", **variables}
    command = [sys.executable, "-m", "argus_tools.log.cli", *arguments]
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=theirs if stdout is None else stdout,
        stderr=theirs,
        env=environment,
    )
    os.close(theirs)
    seen = bytearray()

    def listen() -> None:
        while True:
            try:
                data = os.read(ours, 65536)
            except OSError:
                return
            if not data:
                return
            seen.extend(data)

    listener = threading.Thread(target=listen)
    listener.start()
    code = process.wait(600)
    listener.join()
    os.close(ours)
    return code, bytes(seen)


def discard(action: Callable[[int], tuple[int, bytes]]) -> tuple[int, bytes]:
    with open(os.devnull, "wb") as nothing:  # noqa: PTH123
        return action(nothing.fileno())


@pytest.mark.parametrize("variables", [{}, {"NO_COLOR": "1"}], ids=["colour", "no colour"])
def test_a_bar_while_a_long_file_is_read(variables: dict[str, str], long_log: Path) -> None:
    code, seen = discard(lambda out: run_on_terminal(["decode", "--json", str(long_log)], out, **variables))
    assert code == 0
    assert b"long.bin" in seen
    assert re.search(rb"\d+(\.\d)?/9(\.\d)? MB", _ESCAPES.sub(b"", seen)), seen[-400:]
    # The cursor is shown again and the line is empty at the end.
    assert seen.rindex(b"\x1b[?25h") > seen.rindex(b"\x1b[?25l")
    assert seen.rindex(b"\x1b[2K") > seen.rindex(b"MB")
    if variables:
        assert not re.search(rb"\x1b\[[0-9;]*3[0-9;]*m", seen)


def test_none_on_a_terminal_that_cannot_take_lines_back(long_log: Path) -> None:
    code, seen = discard(lambda out: run_on_terminal(["decode", "--json", str(long_log)], out, TERM="dumb"))
    assert (code, seen) == (0, b"")


def test_none_for_a_short_file(tmp_path: Path) -> None:
    path = tmp_path / "short.jsonl"
    path.write_bytes(jsonl([(0.0, "r2c", sip())]))
    assert discard(lambda out: run_on_terminal(["decode", "--json", str(path)], out)) == (0, b"")


def test_none_between_packets_on_the_same_terminal(tmp_path: Path, long_log: Path) -> None:
    code, seen = run_on_terminal(["decode", str(long_log), "--type", "CONFIGPAC"], None)
    assert (code, seen) == (0, b"")


def test_none_in_a_file(long_log: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}"}
    command = [sys.executable, "-m", "argus_tools.log.cli", "stats", str(long_log)]
    done = subprocess.run(command, capture_output=True, env=environment, timeout=600, check=False)
    assert (done.returncode, done.stderr) == (0, b"")
