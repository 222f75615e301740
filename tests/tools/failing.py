# SPDX-License-Identifier: MIT
"""The made-up drive of docs/logs.md: 30 s through a round room, in which sonar 3 dies and sonar 5 reads ever longer."""

from __future__ import annotations

import math
import random

from hil_sim.arcos import Sip, frame
from hil_sim.tables import load

SIPS = 300
DEAD_FROM, LONG_FROM = 150, 200
ROOM_MM = 2800
_POSES = load("robots/p3dx-sh")["sonar"]["pose"]


def _range(pose: dict[str, int], x_mm: float, rng: random.Random) -> int:
    """Distance along the sonar's axis to the wall of the round room."""
    turn = math.radians(pose["heading_deg"])
    x, y = x_mm + pose["x_mm"], pose["y_mm"]
    along = x * math.cos(turn) + y * math.sin(turn)
    return round(math.sqrt(along**2 + ROOM_MM**2 - x**2 - y**2) - along + rng.gauss(0, 4))


def drive() -> bytes:
    """Return what a terminal program would have saved of the robot's side."""
    rng = random.Random(4)
    out = bytearray()
    for n in range(SIPS):
        x_mm = n * 2.5
        readings = []
        for pose in _POSES:
            if n % 4 != pose["number"] % 4:
                continue
            mm = _range(pose, x_mm, rng)
            if pose["number"] == 3 and n >= DEAD_FROM:
                mm = 5000
            if pose["number"] == 5 and n >= LONG_FROM:
                mm += min(1200, (n - LONG_FROM) * 30)
            readings.append((pose["number"], mm))
        packet = frame(
            Sip(
                type=0x33, x=round(x_mm), left_vel=25, right_vel=25, battery=126, flags=7, battery_x10=126,
                sonars=tuple(readings),
            ).data
        )  # fmt: skip
        if n == 180:
            packet = packet[:20] + bytes((packet[20] ^ 0x10,)) + packet[21:]
        out += packet
    return bytes(out)
