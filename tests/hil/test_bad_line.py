# SPDX-License-Identifier: MIT
"""Rule (S8): whatever the line carries, argusd ends with the documented code and a line on what to do."""

from __future__ import annotations

import json
import os
import pty
import random
import re
import threading
import tty
from collections.abc import Iterator
from contextlib import contextmanager

from harness import PATIENCE_S, Bench, run_argusd
from worlds import hall

ALL_SONARS = list(range(16))


@contextmanager
def noisy_port(seed: int) -> Iterator[str]:
    """A port on which somebody sends random bytes."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    os.set_blocking(master, False)
    stop = threading.Event()
    noise = random.Random(seed)

    def shout() -> None:
        while not stop.wait(0.02):
            try:
                os.write(master, noise.randbytes(40))
                os.read(master, 4096)
            except OSError:
                continue

    thread = threading.Thread(target=shout, daemon=True)
    thread.start()
    try:
        yield os.ttyname(slave)
    finally:
        stop.set()
        thread.join(PATIENCE_S)
        os.close(slave)
        os.close(master)


def test_check_on_a_healthy_robot_lists_what_is_there(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    link = f"serial:{bench.port}@9600"
    told = run_argusd("--link", link, "--check", "--json")
    assert told.returncode == 0, told.stderr
    report = json.loads(told.stdout)
    assert report["sonars"] == ALL_SONARS
    assert (report["baud"], report["subclass"], report["bad_checksums"]) == (9600, "p3dx-sh", 0)
    plain = run_argusd("--link", link, "--check")
    assert plain.returncode == 0, plain.stderr
    seen = re.search(r"16 of 16 seen:([ \d]+)", plain.stdout)
    assert seen is not None, plain.stdout
    assert [int(n) for n in seen[1].split()] == ALL_SONARS


def test_check_on_a_robot_with_a_silent_sonar_names_it(bench: Bench) -> None:
    bench.sim(bench.world(**hall()), "silent:6")
    told = run_argusd("--link", f"serial:{bench.port}@9600", "--check", "--json")
    assert told.returncode == 0, told.stderr
    assert json.loads(told.stdout)["sonars"] == [k for k in ALL_SONARS if k != 6]


def test_garbage_on_the_line_is_exit_4() -> None:
    with noisy_port(seed=11) as port:
        told = run_argusd("--link", f"serial:{port}@9600", "--check", "--wait", "3")
    assert told.returncode == 4
    (line,) = told.stderr.splitlines()
    assert "no robot answered" in line
    assert "garbage" in line or "bad checksums" in line, line
    assert "--auto-baud" in line or "noisy" in line, line


def test_wrong_rate_is_exit_4_and_names_the_way_out(bench: Bench) -> None:
    bench.sim(bench.world(**hall()), extra=["--baud", "38400"])
    told = run_argusd("--link", f"serial:{bench.port}@9600", "--check", "--wait", "3")
    assert told.returncode == 4
    assert "--auto-baud" in told.stderr


def test_auto_baud_finds_the_rate(bench: Bench) -> None:
    bench.sim(bench.world(**hall()), extra=["--baud", "38400"])
    told = run_argusd("--link", f"serial:{bench.port}", "--auto-baud", "--check", "--json")
    assert told.returncode == 0, told.stderr
    assert "38400" in told.stderr
    assert json.loads(told.stdout)["baud"] == 38400


def test_auto_baud_on_garbage_is_exit_4() -> None:
    with noisy_port(seed=12) as port:
        told = run_argusd("--link", f"serial:{port}", "--auto-baud", "--check")
    assert told.returncode == 4
    assert "bytes were heard" in told.stderr
