# SPDX-License-Identifier: MIT
"""Checks of rotation."""

from __future__ import annotations

import itertools
import statistics
from typing import Final

from hil_sim.arcos import (
    COMMAND,
    TIMING,
    Command,
    frame,
)
from hil_sim.conformance.ask import TURN, moved, percent, rest, settle
from hil_sim.conformance.check import Group, require
from hil_sim.conformance.client import Client, Failed

CHECKS: Final = Group()


@CHECKS.check("turn", motion=True)
def rvel(client: Client) -> str:
    """RVEL +-30: ROTVEL and the heading agree within 10 %, + is left."""
    client.start(motors=True)
    seen = []
    for wanted in (30, -30):
        client.command("RVEL", wanted)
        client.sips(10)
        sips = client.sips(11)
        turn = sum(moved(a, b)[1] for a, b in itertools.pairwise(sips))
        rate = (sips[-1].rotvel or 0) / 10
        seen.append(f"{wanted}: ROTVEL {rate:g}, turned {turn:.1f} in 1 s")
        require(percent(turn, wanted) < 10 and percent(rate, wanted) < 10, seen[-1])
        require((sips[-1].right_vel > sips[-1].left_vel) == (wanted > 0), seen[-1])
    rest(client)
    return "; ".join(seen)


@CHECKS.check("turn", motion=True)
def rotate(client: Client) -> str:
    """ROTATE is a speed: it goes on."""
    client.start(motors=True)
    client.command("ROTATE", 25)
    client.sips(25)
    rate = (client.sips(1)[0].rotvel or 0) / 10
    rest(client)
    return require(percent(rate, 25) < 10, f"{rate:g} deg/s after 2.5 s")


@CHECKS.check("turn", motion=True)
def setrv(client: Client) -> str:
    """SETRV caps RVEL, within 5 %."""
    client.start(motors=True)
    client.command("SETRV", 20)
    client.command("RVEL", 90)
    client.sips(10)
    rate = (client.sips(1)[0].rotvel or 0) / 10
    rest(client)
    return require(percent(rate, 20) < 5, f"{rate:g} deg/s")


@CHECKS.check("turn", motion=True)
def setra(client: Client) -> str:
    """SETRA +50: the turn rate grows by 50 deg/s in a second."""
    client.start(motors=True)
    client.command("SETRA", 50)
    client.command("RVEL", 60)
    rates = [(sip.rotvel or 0) / 10 for sip in client.sips(18)]
    rest(client)
    rises = [b - a for a, b in itertools.pairwise(rates) if a > 3 and b < 57]
    if not rises:
        raise Failed(f"rates {rates[:8]}")
    rise = statistics.mean(rises) * 1000 / TIMING["SIP_CYCLE_MS"]
    return require(percent(rise, 50) < 15, f"{rise:.0f} deg/s2")


@CHECKS.check("turn", motion=True)
def head(client: Client) -> str:
    """HEAD 60, -170, 170: the shortest way to the heading, within 2 degrees."""
    client.start(motors=True)
    seen = []
    for wanted in (60, 170, -170, 0):
        client.command("HEAD", wanted)
        end = settle(client, 60)
        angle = (end.th * 360 / TURN + 180) % 360 - 180
        seen.append(f"{wanted}: {angle:.1f}")
        require(abs((angle - wanted + 180) % 360 - 180) <= 2, seen[-1])
    return "; ".join(seen)


@CHECKS.check("turn", motion=True)
def dhead(client: Client) -> str:
    """DHEAD +-45 turns by 45 degrees from here, within 2."""
    client.start(motors=True)
    seen = []
    for wanted in (45, -45):
        before = rest(client)
        client.command("DHEAD", wanted)
        _, turn = moved(before, settle(client, 40))
        seen.append(f"{wanted}: {turn:.1f}")
        require(abs(turn - wanted) <= 2, seen[-1])
    return "; ".join(seen)


@CHECKS.check("turn", motion=True)
def dchead(client: Client) -> str:
    """DCHEAD turns relative to the heading set point."""
    client.start(motors=True)
    before = rest(client)
    client.command("DHEAD", 40)
    client.command("DCHEAD", -20)
    _, turn = moved(before, settle(client, 40))
    return require(abs(turn - 20) <= 2, f"{turn:.1f} degrees after DHEAD 40, DCHEAD -20")


@CHECKS.check("turn", motion=True)
def vel2(client: Client) -> str:
    """VEL2: left wheel in the high byte, right in the low, 20 mm/s; both encodings; VEL ends it."""
    client.start(motors=True)
    seen = []
    raw = frame(Command(COMMAND["VEL2"], bytes((0x3B, 3, 0xFB))).data)
    for data in (frame(Command.pair(COMMAND["VEL2"], -5, 3).data), raw):
        client.send(data)
        client.sips(10)
        (sip,) = client.sips(1)
        seen.append(f"{sip.left_vel}/{sip.right_vel}")
        require(abs(sip.left_vel + 100) <= 10 and abs(sip.right_vel - 60) <= 10, seen[-1])
        rest(client)
    return "; ".join(seen)
