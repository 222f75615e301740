# SPDX-License-Identifier: MIT
"""Rule: an image drives the emulated robot to its goal, and a board that fails on the way leaves it standing."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from machine import PATIENCE_S, ROOT, UNDEFINED, running

from hil_sim.demo.runner import Lines

MOVING_MM_S = 20.0


class Robot:
    """The emulated robot, and the truth about it."""

    def __init__(self, device: str, truth: Path) -> None:
        self.device = device
        self._truth = truth.open("rb")
        self._lines = Lines(self._truth.fileno())
        self.speed_mm_s = 0.0

    def look(self) -> None:
        """Read what has become known since."""
        for line in self._lines.read():
            record: dict[str, Any] = json.loads(line)
            if record.get("type") == "state":
                self.speed_mm_s = abs(record["v_mm_s"])

    def wait_until(self, moving: bool) -> None:
        """Wait until it moves, or stands."""
        until = time.monotonic() + PATIENCE_S
        while (self.speed_mm_s > MOVING_MM_S) is not moving:
            assert time.monotonic() < until, f"{self.speed_mm_s} mm/s for {PATIENCE_S} s"
            time.sleep(0.05)
            self.look()


@contextmanager
def robot(folder: Path) -> Iterator[Robot]:
    """Run an emulated robot on a pty."""
    truth = folder / "truth.jsonl"
    command: list[str | Path] = [
        Path(sys.executable).with_name("argus-sim"),
        "--baud",
        "9600",
        "--world",
        "open-office",
    ]
    with subprocess.Popen([*command, "--truth", truth], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            yield Robot(process.stdout.readline().strip(), truth)
        finally:
            process.terminate()


def test_a_short_course_is_driven_to_its_end(tmp_path: Path) -> None:
    course = tmp_path / "course.csv"
    course.write_text("# x_mm,y_mm\n400,0\n", encoding="utf-8")
    with robot(tmp_path) as emulated:
        command: list[str | Path] = [ROOT / "tools/qemu-board", "--link", f"serial:{emulated.device}@9600"]
        done = subprocess.run(
            [*command, "--active", "--course", course],
            capture_output=True,
            text=True,
            check=False,
            timeout=600,
        )
    events = [json.loads(line)["event"] for line in done.stdout.splitlines()]
    assert done.returncode == 0, done.stderr
    assert "GOAL_REACHED" in events
    assert events.index("GOAL_REACHED") < events.index("SESSION_CLOSED")


def test_a_fault_on_the_way_leaves_the_robot_standing_and_is_told(tmp_path: Path) -> None:
    with robot(tmp_path) as emulated, running("mps2-an386", tmp_path, device=emulated.device) as board:
        board.wait_for("SESSION_OPEN")
        assert board.order("course 1500,0") == "taken"
        assert board.order("active") == "taken"
        emulated.wait_until(moving=True)
        board.patch(UNDEFINED)
        assert board.wait_for("START")["reset"] == "fault"
        # Silent since: the robot's own watchdog stops it, and the board, passive as it starts, lets it stand.
        board.wait_for("SESSION_OPEN")
        emulated.look()
        emulated.wait_until(moving=False)
        assert board.wait_for("STATUS")["active"] is False
