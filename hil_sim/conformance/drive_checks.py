# SPDX-License-Identifier: MIT
"""Checks of translation."""

from __future__ import annotations

import itertools
import statistics
from typing import Final

from hil_sim.arcos import (
    TIMING,
    TYPE,
)
from hil_sim.conformance.ask import at_rest, come_back, moved, percent, rest, settle, speed_of
from hil_sim.conformance.check import Group, require
from hil_sim.conformance.client import Client, Failed

CHECKS: Final = Group()


@CHECKS.check("drive", motion=True)
def enable(client: Client) -> str:
    """ENABLE shows in FLAGS bit 0."""
    client.start(motors=True)
    client.command("ENABLE", 0)
    client.until("FLAGS bit 0 clear after ENABLE 0", lambda sip: not sip.flags & 1, 10)
    return "on and off"


@CHECKS.check("drive", motion=True)
def motors_off(client: Client) -> str:
    """Without ENABLE the motors are off, and VEL moves nothing."""
    client.start()
    client.command("VEL", 100)
    sips = client.sips(8)
    client.command("VEL", 0)
    return require(all(map(at_rest, sips)), f"fastest {max(abs(speed_of(sip)) for sip in sips):g} mm/s")


@CHECKS.check("drive", motion=True)
def vel(client: Client) -> str:
    """VEL +-150: both wheels within 10 %, type 0x33, STALL clear."""
    client.start(motors=True)
    seen = []
    for wanted in (150, -150):
        client.command("VEL", wanted)
        client.sips(12)
        (sip,) = client.sips(1)
        seen.append(f"{wanted}: {sip.left_vel}/{sip.right_vel} type 0x{sip.type:02X}")
        right = percent(sip.left_vel, wanted) < 10 and percent(sip.right_vel, wanted) < 10
        require(right and sip.type == TYPE["SIP_MOVING"], seen[-1])
    rest(client)
    return "; ".join(seen)


@CHECKS.check("drive", motion=True)
def odometry(client: Client) -> str:
    """Odometry grows as the wheel speeds say, within 5 %."""
    client.start(motors=True)
    client.command("VEL", 150)
    client.sips(12)
    sips = client.sips(11)
    way, _ = moved(sips[0], sips[-1])
    summed = sum(speed_of(sip) for sip in sips[1:]) * TIMING["SIP_CYCLE_MS"] / 1000
    client.command("VEL", -150)
    client.sips(18)
    rest(client)
    return require(percent(way, summed) < 5, f"{way:g} mm, speeds give {summed:.0f} mm")


@CHECKS.check("drive", motion=True)
def move(client: Client) -> str:
    """MOVE +-200 ends at rest 200 mm on, within 10 mm."""
    client.start(motors=True)
    seen = []
    for distance in (200, -200):
        before = rest(client)
        client.command("MOVE", distance)
        way, _ = moved(before, settle(client, 60))
        seen.append(f"{distance}: {way:.0f} mm")
        require(abs(way - abs(distance)) <= 10, seen[-1])
    return "; ".join(seen)


@CHECKS.check("drive", motion=True)
def setv(client: Client) -> str:
    """SETV caps VEL, within 5 %."""
    client.start(motors=True)
    client.command("SETV", 120)
    client.command("VEL", 400)
    client.sips(12)
    (sip,) = client.sips(1)
    client.command("VEL", -400)
    client.sips(16)
    rest(client)
    return require(percent(speed_of(sip), 120) < 5, f"{speed_of(sip):g} mm/s")


def _steps(speeds: list[float], low: float, high: float) -> list[float]:
    """The changes from one SIP to the next, both within the bounds."""
    return [b - a for a, b in itertools.pairwise(speeds) if low < min(a, b) and max(a, b) < high]


@CHECKS.check("drive", motion=True)
def seta(client: Client) -> str:
    """SETA +100 -400: the speed grows by 100 mm/s in a second and falls four times as fast."""
    client.start(motors=True)
    client.command("SETA", 100)
    client.command("SETA", -400)
    client.command("VEL", 200)
    up = [speed_of(sip) for sip in client.sips(24)]
    client.command("VEL", 0)
    down = [speed_of(sip) for sip in client.sips(16)]
    rises = _steps(up, 10, 190)
    falls = [-step for step in _steps(down, 2, 195)]
    if not rises or not falls:
        raise Failed(f"speeds {up[:8]} and {down[:8]}")
    rise, fall = statistics.mean(rises), statistics.mean(falls)
    cycle_s = TIMING["SIP_CYCLE_MS"] / 1000
    observed = f"{rise / cycle_s:.0f} mm/s2 up, {fall / cycle_s:.0f} mm/s2 down"
    client.command("SETA", 300)
    come_back(client, -250)
    return require(percent(rise / cycle_s, 100) < 15 and percent(fall / cycle_s, 400) < 20, observed)


@CHECKS.check("drive", motion=True)
def stop(client: Client) -> str:
    """STOP brakes as SETA says and leaves the motors on."""
    client.start(motors=True)
    client.command("VEL", 200)
    client.sips(12)
    client.command("STOP")
    sips = client.sips(14)
    ways = [speed_of(sip) for sip in sips]
    come_back(client, -220)
    braking = sum(5 < speed < 195 for speed in ways)
    return require(at_rest(sips[-1]) and braking >= 3 and bool(sips[-1].flags & 1), f"speeds {ways[:10]}")


@CHECKS.check("drive", motion=True)
def e_stop(client: Client) -> str:
    """E_STOP stands still within three SIPs, whatever SETA says."""
    client.start(motors=True)
    client.command("SETA", -50)
    client.command("VEL", 200)
    client.sips(12)
    client.command("E_STOP")
    speeds = [speed_of(sip) for sip in client.sips(4)]
    client.command("SETA", -300)
    come_back(client, -180)
    return require(abs(speeds[-1]) < 10, f"speeds {speeds}")


@CHECKS.check("drive", motion=True)
def seto(client: Client) -> str:
    """SETO makes odometry (0, 0, 0)."""
    client.start(motors=True)
    client.command("VEL", 120)
    client.sips(12)
    far = rest(client)
    client.command("SETO")
    sip = client.until("x, y and th 0 after SETO", lambda sip: (sip.x, sip.y, sip.th) == (0, 0, 0), 6)
    come_back(client, -120)
    return f"x {far.x} then {sip.x}"
