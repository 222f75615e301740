# SPDX-License-Identifier: MIT
"""Rule: whatever happens to a board, it starts again, says why, and is silent until the robot stands."""

from __future__ import annotations

import contextlib
import itertools
import os
import pty
import re
import select
import socket
import subprocess
import sys
import threading
import time
import tty
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from machine import ROOT, TO_ITSELF, UNDEFINED, Machine, digest_of, noise, running

QUIET_S = 2.5
"""How long a board is silent after any start (hal/board/loop.c), by its own clock."""


@pytest.fixture
def board(tmp_path: Path) -> Iterator[Machine]:
    with running("mps2-an386", tmp_path) as machine:
        yield machine


def assert_silent_at_first(machine: Machine) -> None:
    """The robot hears nothing until the board says that its link is up, which it does not do too early."""
    heard = len(machine.heard)
    line = machine.wait_for("LINK_UP")
    assert line["t"] >= QUIET_S
    assert len(machine.heard) - heard <= 6  # SYNC0 may come with the line


def test_it_says_what_it_is_and_runs_with(board: Machine, tmp_path: Path) -> None:
    start = board.wait_for("START")
    header = (ROOT / "firmware/include/argus/argus.h").read_text(encoding="utf-8")
    version = re.search(r'#define ARGUS_VERSION "([^"]+)"', header)
    assert version is not None
    assert start["board"] == "mps2-an386"
    assert start["version"] == version[1]
    assert start["config"] == digest_of("", tmp_path)
    assert (start["settings"], start["reset"]) == ("built", "power")
    assert_silent_at_first(board)
    status = board.wait_for("STATUS")
    assert status["active"] is False  # a robot may be at the end of the line
    assert status["stack_left"] > 200


def test_the_other_board_starts_too(tmp_path: Path) -> None:
    with running("stm32f405", tmp_path) as machine:
        assert machine.wait_for("START")["board"] == "stm32f405"
        assert_silent_at_first(machine)


def test_settings_outlive_a_restart_and_a_power_cut(board: Machine, tmp_path: Path) -> None:
    board.wait_for("START")
    assert board.order("set step_mm 120") == "from the next start, if it is saved"
    assert board.order("set policy fewest") == "from the next start, if it is saved"
    assert board.order("set speed_mm_s 7500") == "out of its range"
    assert board.order("save") == "ok"
    board.console.sendall(b"restart\n")
    wanted = digest_of("step_mm = 120\npolicy = fewest\n", tmp_path)
    start = board.wait_for("START")
    assert (start["settings"], start["reset"], start["config"]) == ("stored", "order", wanted)
    store = board.save_store()
    board.close()
    with running(
        "mps2-an386", tmp_path, "-device", f"loader,file={store},addr=0x1ffffc,force-raw=on"
    ) as again:
        start = again.wait_for("START")
        assert (start["settings"], start["reset"], start["config"]) == ("stored", "power", wanted)


def test_unsafe_settings_are_not_saved(board: Machine) -> None:
    board.wait_for("START")
    board.order("set speed_mm_s 750")
    assert board.order("save").startswith("S5:")


def test_a_fault_is_told_after_the_restart_with_its_place(board: Machine) -> None:
    board.wait_for("LINK_UP")
    address = board.patch(UNDEFINED)
    start = board.wait_for("START")
    assert start["reset"] == "fault"
    assert int(start["pc"], 16) == address
    assert start["cause"] != "00000000"
    assert_silent_at_first(board)


def test_a_program_that_hangs_is_bitten_by_the_watchdog(board: Machine) -> None:
    board.wait_for("LINK_UP")
    address = board.patch(TO_ITSELF)
    start = board.wait_for("START")
    assert start["reset"] == "watchdog"
    assert int(start["pc"], 16) == address
    assert_silent_at_first(board)


def test_a_flooded_second_uart_holds_nothing_up(board: Machine) -> None:
    board.wait_for("LINK_UP")
    begun, sent = time.monotonic(), 0
    statuses: list[dict[str, Any]] = []
    while len(statuses) < 4 and time.monotonic() - begun < 60:
        board.console.sendall(noise(256) + b"\n")
        sent += 1
        statuses += [line for line in board.lines(0.01) if line["event"] == "STATUS"]
    times = [status["t"] for status in statuses]
    assert len(times) == 4
    assert max(later - earlier for earlier, later in itertools.pairwise(times)) < 3.0
    assert sent > 10
    assert statuses[-1]["active"] is False
    assert board.heard.count(b"\xfa\xfb\x03\x00") >= 2  # the robot is still called meanwhile


def test_noise_on_the_robots_line_is_skipped(board: Machine) -> None:
    board.wait_for("LINK_UP")
    before = board.wait_for("STATUS")["t"]
    assert board.robot is not None
    board.robot.sendall(noise(4000))
    status = board.wait_for("STATUS")
    while status["skipped_bytes"] < 1000 and status["t"] < before + 30:
        status = board.wait_for("STATUS")
    assert status["skipped_bytes"] >= 1000
    assert status["mode"] == "OFFLINE"


def test_the_stack_of_the_images_is_large_enough() -> None:
    for name in ("mps2-an386", "stm32f405"):
        done = subprocess.run(
            ["python3", "tools/size_image.py", f"build/{name}"],
            cwd=ROOT,
            check=False,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stdout + done.stderr


@contextlib.contextmanager
def as_serial_line(end: socket.socket) -> Iterator[str]:
    """Give the other side of a board's UART a device, as an adapter has one."""
    inside, outside = pty.openpty()
    tty.setraw(outside)
    done = threading.Event()

    def carry() -> None:
        while not done.is_set():
            ready, _, _ = select.select([inside, end.fileno()], [], [], 0.05)
            if inside in ready:
                end.sendall(os.read(inside, 4096))
            if end.fileno() in ready:
                os.write(inside, end.recv(4096))

    thread = threading.Thread(target=carry)
    thread.start()
    try:
        yield os.ttyname(outside)
    finally:
        done.set()
        thread.join()
        os.close(inside)
        os.close(outside)


def flash_check(device: str, *options: str) -> subprocess.Popen[str]:
    """Start argus-flash-check."""
    command = [sys.executable, "-m", "argus_tools.flash_check", device, "--wait", "60", *options]
    return subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def test_the_check_of_what_was_flashed(board: Machine, tmp_path: Path) -> None:
    board.wait_for("START")
    with as_serial_line(board.console) as device:
        with flash_check(device, "--board", "mps2-an386", "--config", digest_of("", tmp_path)) as good:
            said, _ = good.communicate()
        assert good.returncode == 0, said
        assert "reset     order" in said
        with flash_check(device, "--board", "stm32f405", "--config", "00000000") as other:
            said, _ = other.communicate()
        assert (other.returncode, said.count("FAIL")) == (1, 2), said
        with flash_check(device, "--listen") as listening:
            while listening.poll() is None:  # a restart before it listens is not seen
                board.patch(UNDEFINED)
                with contextlib.suppress(subprocess.TimeoutExpired):
                    listening.wait(10)
            assert listening.stdout is not None
            said = listening.stdout.read()
        assert listening.returncode == 1, said
        assert "FAIL reset     fault, pc " in said
