# SPDX-License-Identifier: MIT
"""Rule: a port without a Pioneer judges its ring: one that leaps is named, no healthy one (examples/hcsr04)."""

from __future__ import annotations

import math
import random
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from machine import ROOT, connected

IMAGE = ROOT / "build/stm32f405/hcsr04.elf"
MOUNTS = (
    (0, 140, 90), (90, 107, 50), (134, 41, 17), (134, -41, -17),
    (90, -107, -50), (0, -140, -90), (-121, -70, -150), (-121, 70, 150),
)  # fmt: skip
NO_ECHO_MM, US_PER_MM = 4000.0, 2000 / 343
WALL_MM, SEED, DRIVE_S = 900.0, 4711, 60


class Card:
    """The firing card of a robot in a corridor, in lockstep with the board: a line of figures, then its answers."""

    def __init__(self, folder: Path) -> None:
        ends = [folder / name for name in ("console.sock", "card.sock")]
        words = ["qemu-system-arm", "-M", "netduinoplus2", "-display", "none", "-monitor", "none"]
        for end in ends:
            words += ["-serial", f"unix:{end},server=on,wait=on"]
        self.process = subprocess.Popen([*words, "-kernel", str(IMAGE)], stdin=subprocess.DEVNULL)
        self.console = connected(ends[0])
        self.card = connected(ends[1])
        self._said = self.console.makefile("r", encoding="ascii")
        assert self._said.readline() == "ring 0\n"

    def close(self) -> None:
        """Cut the power."""
        self.process.kill()
        self.process.wait()
        self._said.close()
        self.console.close()
        self.card.close()

    def asked(self, figures: list[int]) -> list[str]:
        """Return the events that come of a line."""
        self.card.sendall((" ".join(map(str, figures)) + "\n").encode())
        lines: list[str] = []
        while not (line := self._said.readline()).startswith("done"):
            assert line, "the board is gone"
            lines.append(line.rstrip("\n"))
        assert line == f"done {figures[0]}\n"
        return lines


@pytest.fixture
def card(tmp_path: Path) -> Iterator[Card]:
    made = Card(tmp_path)
    try:
        yield made
    finally:
        made.close()


def range_mm(x_mm: float, y_mm: float, bearing: float) -> float:
    """To the walls of a corridor, 23 m by 1.8 m, along one ray."""
    ranges = [NO_ECHO_MM]
    if abs(math.sin(bearing)) > 1e-6:
        ranges.append((math.copysign(WALL_MM, math.sin(bearing)) - y_mm) / math.sin(bearing))
    if abs(math.cos(bearing)) > 1e-6:
        ranges.append(((20000.0 if math.cos(bearing) > 0 else -3000.0) - x_mm) / math.cos(bearing))
    return min(ranges)


def drive(card: Card, broken: int | None, seconds: int = DRIVE_S) -> list[str]:
    """A zigzag: 6 s ahead, 2 s of turning, so that sonars look where others looked; return what was said."""
    dice = random.Random(SEED)
    x, y, heading, said = 0.0, 300.0, math.radians(-16.5), []
    for tick in range(1, seconds * 10 + 1):
        turns, way = tick % 80 >= 60, 1 if tick // 80 % 2 == 0 else -1
        turn, speed = (way * 16.5, 0) if turns else (0.0, 200)
        heading += math.radians(turn) / 10
        x += speed / 10 * math.cos(heading)
        y += speed / 10 * math.sin(heading)
        echoes = []
        for number, (ahead, left, bearing) in enumerate(MOUNTS):
            at = (x + ahead * math.cos(heading) - left * math.sin(heading),
                  y + ahead * math.sin(heading) + left * math.cos(heading))  # fmt: skip
            axis = heading + math.radians(bearing)
            nearest = min(range_mm(*at, axis + math.radians(beside)) for beside in range(-15, 16, 3))
            if nearest < NO_ECHO_MM - 10:
                nearest += dice.uniform(-8, 8)
            echoes.append(round((dice.uniform(300, 3800) if number == broken else nearest) * US_PER_MM) or 1)
        pose = [round(x), round(y), round(math.degrees(heading) * 100), speed, round(turn * 100)]
        said += card.asked([tick * 100, *pose, *echoes])
    return said


@pytest.mark.parametrize("broken", [None, 2])
def test_the_ring_is_judged_on_the_board(card: Card, broken: int | None) -> None:
    said = drive(card, broken)
    assert any(line.startswith("SESSION_OPEN") for line in said)
    named = {line.split()[1] for line in said if line.startswith(("SONAR_NAMED", "SONAR_DISABLED"))}
    assert named == (set() if broken is None else {str(broken)}), f"seed {SEED}: {said[-20:]}"


def test_a_line_that_is_none_is_passed_over(card: Card) -> None:
    card.card.sendall(b"\n1 2 3\nx\n" + b"9" * 500 + b"\n" + b"7 " * 60 + b"\n")
    assert any(line.startswith("SESSION_OPEN") for line in drive(card, None, 2))
