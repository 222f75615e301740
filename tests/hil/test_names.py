# SPDX-License-Identifier: MIT
"""Rule: a second argusd takes no name on disk of a living one: it names that one and ends; a dead one's it takes."""

from __future__ import annotations

import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from harness import ARGUSD

PATIENCE_S = 180.0
NAMES = {
    "--control": ("unix:{0}/c", "c.lock", 2),
    "--state": ("{0}/s", "s.lock", 2),
    "--guard": ("pty:{0}/g", "g.lock", 3),
}


@pytest.fixture
def silent() -> Iterator[str]:
    """A link at whose end nobody ever answers."""
    with socket.create_server(("127.0.0.1", 0), backlog=16) as server:
        yield f"tcp:127.0.0.1:{server.getsockname()[1]}"


def start(stack: ExitStack, link: str, *more: str) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [str(ARGUSD), "--link", link, "--wait", "forever", *more],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    stack.callback(process.wait)
    stack.callback(process.kill)
    return process


def is_locked_by(path: Path, pid: int) -> bool:
    """Whether a process has the lock on a file: that it is there says nothing, since it is made before."""
    if not path.exists():
        return False
    ending = f":{path.stat().st_ino}"
    locks = (line.split() for line in Path("/proc/locks").read_text(encoding="ascii").splitlines())
    return any("FLOCK" in words and str(pid) in words and words[-3].endswith(ending) for words in locks)


def await_claim(path: Path, pid: int) -> None:
    until_s = time.monotonic() + PATIENCE_S
    while not is_locked_by(path, pid):
        assert time.monotonic() < until_s, f"{path.name} is not locked by {pid}"
        time.sleep(0.02)


@pytest.mark.parametrize("option", NAMES)
def test_a_second_argusd_takes_no_name_of_a_living_one(option: str, silent: str, tmp_path: Path) -> None:
    place, lock, code = NAMES[option]
    given = (option, place.format(tmp_path))
    with ExitStack() as stack:
        first = start(stack, silent, *given)
        await_claim(tmp_path / lock, first.pid)
        second = start(stack, silent, *given)
        _, said = second.communicate(timeout=PATIENCE_S)
        assert second.returncode == code, said
        assert f"process {first.pid} has it" in said, said
        first.kill()
        first.wait()
        third = start(stack, silent, *given)
        time.sleep(1.0)
        assert third.poll() is None, third.communicate()[1]
        third.terminate()
        third.wait(PATIENCE_S)
        assert not (tmp_path / lock).exists()
