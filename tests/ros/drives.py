# SPDX-License-Identifier: MIT
"""Drives of the emulated robot, as a driver of ROS would tell them: ranges, pose, and when."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from argus_tools.rings.motion import Motion

from hil_sim.arcos import PacketError, Sip, decode
from hil_sim.sil import Mission, Sil
from hil_sim.tables.robot import robot_table

TRACK_MM = robot_table().motion["track_mm"]
LEAST_M, GREATEST_M = 0.1, 5.0
HALF_WORD = 1 << 15


@dataclass(frozen=True)
class Told:
    """One packet of the robot: when, where it thinks that it is, and the sonars that fired (m)."""

    t_s: float
    motion: Motion
    ranges: tuple[tuple[int, float], ...]


def signed(word: int) -> int:
    return word - 2 * HALF_WORD if word >= HALF_WORD else word


def told(t_s: float, sip: Sip) -> Told:
    motion = Motion(
        signed(sip.x) / 1000,
        signed(sip.y) / 1000,
        sip.th / 4096 * math.tau,
        (sip.left_vel + sip.right_vel) / 2000,
        (sip.right_vel - sip.left_vel) / TRACK_MM,
    )
    return Told(t_s, motion, tuple((number, mm / 1000) for number, mm in sip.sonars))


def drive(mission: Mission) -> Iterator[Told]:
    """Yield what a driver is told on a mission."""
    sil = Sil(mission)
    sil.traffic = []
    while not sil.over:
        sil.step()
        for packet in sil.traffic:
            if packet.to_robot:
                continue
            try:
                content = decode(packet.data[3:-2])
            except PacketError:
                continue
            if isinstance(content, Sip):
                yield told(packet.t_ms / 1000, content)
        sil.traffic.clear()
