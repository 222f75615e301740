# SPDX-License-Identifier: MIT
"""What several checks ask of a target."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from typing import Final

from hil_sim.arcos import (
    COMMAND,
    FLAG,
    SIP,
    TIMING,
    Command,
    ConfigPac,
    Packet,
    Sip,
    frame,
)
from hil_sim.conformance.client import PATIENCE_S, Client, Failed

TURN: Final = SIP["TURN"]
ARRAY_FLAGS: Final = tuple(FLAG[f"SONAR{k + 1}"] for k in range(TIMING["ARRAYS_MAX"]))


def framed(name: str, value: int | None = None) -> bytes:
    """Return a command as it goes over the wire."""
    number = COMMAND[name]
    return frame((Command(number) if value is None else Command.integer(number, value)).data)


def names_of(packets: Sequence[Packet]) -> str:
    """Say of which types packets are."""
    return ", ".join(f"type 0x{packet.data[0]:02X}" for packet in packets) or "silence"


def packets_within(client: Client, seconds: float) -> list[Packet]:
    """Return the packets of so many seconds."""
    return [heard.packet for heard in client.hear(seconds)]


def several(client: Client, count: int) -> list[Packet]:
    """The next `count` packets, or fewer when no more come."""
    found: list[Packet] = []
    while len(found) < count:
        heard = client.hear(PATIENCE_S / 2, lambda _: True)
        if not heard:
            break
        found.append(heard[-1].packet)
    return found


def config_of(client: Client) -> ConfigPac:
    """Return the CONFIGpac, asked for."""
    client.command("CONFIG", 1)
    packet = client.answer(ConfigPac)
    if not isinstance(packet, ConfigPac):
        raise Failed("no CONFIGpac")
    return packet


def moved(a: Sip, b: Sip) -> tuple[float, float]:
    """Distance in units of the SIP and turn in degrees from one SIP to another."""
    half = 1 << SIP["POSITION_BITS"] - 1

    def delta(new: int, old: int) -> int:
        return ((new - old + half) & 2 * half - 1) - half

    turn = ((b.th - a.th + TURN // 2) % TURN - TURN // 2) * 360 / TURN
    return math.hypot(delta(b.x, a.x), delta(b.y, a.y)), turn


def speed_of(sip: Sip) -> float:
    """Return the translation speed that a SIP tells, mm/s."""
    return (sip.left_vel + sip.right_vel) / 2


def at_rest(sip: Sip) -> bool:
    """Whether both wheels stand."""
    return abs(sip.left_vel) < 2 and abs(sip.right_vel) < 2


def rest(client: Client) -> Sip:
    """Stop and return a SIP of the robot at rest."""
    client.command("VEL", 0)
    client.command("RVEL", 0)
    client.until("at rest after VEL 0, RVEL 0", at_rest, 40)
    return client.sips(1)[0]


def settle(client: Client, sips: int) -> Sip:
    """Wait until a motion has begun and ended; the SIP at its end."""
    client.until("the motion begins", lambda sip: not at_rest(sip), 12)
    client.until("the motion ends", at_rest, sips)
    return client.sips(1)[0]


def come_back(client: Client, mm: int) -> None:
    """Drive back the way of a check, for 6 s at most; how the target ends a MOVE is no matter here."""
    client.command("MOVE", mm)
    with contextlib.suppress(Failed):
        settle(client, 60)
    rest(client)


def percent(value: float, wanted: float) -> float:
    """Return by how many per cent a value is off."""
    return abs(value - wanted) / abs(wanted) * 100
