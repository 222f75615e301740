# SPDX-License-Identifier: MIT
"""Rule: every command of docs/monitor.md runs as it stands there and serves the page."""

from __future__ import annotations

import contextlib
import os
import re
import shlex
import subprocess
import sys
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest
from page_browser import BIN, ROOT, Monitor, wait_for

TEXT = (ROOT / "docs/monitor.md").read_text(encoding="utf-8")
BLOCKS = [
    [line.strip() for line in block.strip().splitlines()]
    for block in re.findall(r"(?:^    .+\n)+", TEXT, re.MULTILINE)
]
ALONE = [
    line
    for block in BLOCKS
    for line in block
    if " --tui" not in line and not any(" --control " in other for other in block)
]
"""What shows no page but a screen is run by tests/hil/test_control.py."""
TOGETHER = [block for block in BLOCKS if any(" --control " in line for line in block)]


@contextlib.contextmanager
def running(*command: str, folder: Path) -> Iterator[subprocess.Popen[str]]:
    child = subprocess.Popen(command, cwd=folder, stdout=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
    try:
        yield child
    finally:
        child.terminate()
        child.wait(60)


def serves(line: str, folder: Path) -> None:
    """Run a command that prints an address, get the page there, and end it in order."""
    program, *words = shlex.split(line)
    assert program in ("argus-monitor", "argus-sim")
    monitor = Monitor([*words, "--port", "0"], folder, program=program)
    try:
        with urllib.request.urlopen(monitor.url.split("#")[0]) as answer:
            assert b"<title>Argus monitor</title>" in answer.read()
    finally:
        code = monitor.end()
    assert code == 0, monitor.log.read_text()


def test_there_are_commands() -> None:
    assert len(ALONE) == 3
    assert [len(block) for block in TOGETHER] == [2, 3]


@pytest.mark.parametrize("line", ALONE)
def test_a_command_that_starts_all(line: str, tmp_path: Path) -> None:
    serves(line, tmp_path)


@pytest.mark.parametrize("block", TOGETHER, ids=["unix", "tcp"])
def test_commands_on_an_argusd(block: list[str], tmp_path: Path) -> None:
    """Where they stand in the text the robot is on port 8101 and the sockets in one place; here each has its own."""
    *before, argusd, monitor = block
    for line in before:
        subprocess.run(["sh", "-c", line], cwd=tmp_path, check=True)
    sim = [sys.executable, "-m", "hil_sim.cli", "--tcp", "0"]
    os.environ.setdefault("PYTHONPATH", f"{ROOT}:{ROOT / 'tools'}")
    with running(*sim, folder=tmp_path) as robot:
        assert robot.stdout is not None
        port = robot.stdout.readline().strip().rpartition(":")[2]
        place = str(tmp_path / "argus.sock")
        argusd = argusd.replace("tcp:localhost", f"tcp:localhost:{port}").replace("/tmp/argus.sock", place)
        program, *words = shlex.split(argusd)
        assert program == "argusd"
        with running(str(ROOT / "build/release/argusd"), *words, "--plain", folder=tmp_path) as daemon:
            if "unix:" in argusd:
                wait_for("the socket is there", Path(place).exists)
            serves(monitor.replace("/tmp/argus.sock", place), tmp_path)
            assert daemon.poll() is None, "argusd outlives the page"


def test_the_picture_is_there() -> None:
    (name,) = re.findall(r"!\[[^\]]+\]\((img/[\w.]+)\)", TEXT)
    assert (ROOT / "docs" / name).stat().st_size > 20_000
    assert BIN.exists()
