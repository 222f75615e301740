# SPDX-License-Identifier: MIT
"""Checks of the handshake and of sessions."""

from __future__ import annotations

import time
from typing import Final

from hil_sim.arcos import (
    Sip,
    SyncEcho,
    SyncReply,
)
from hil_sim.conformance.ask import framed, names_of, packets_within, several
from hil_sim.conformance.check import Group, require
from hil_sim.conformance.client import QUIET_S, Client, Failed

CHECKS: Final = Group()


@CHECKS.check("handshake")
def silent_before_sync(client: Client) -> str:
    """Nothing is sent before the client speaks."""
    client.fresh()
    packets = packets_within(client, 0.5)
    return require(not packets, names_of(packets))


@CHECKS.check("handshake")
def three_syncs(client: Client) -> str:
    """SYNC0 and SYNC1 echoed; SYNC2 answered by name, class Pioneer, subclass."""
    client.fresh()
    first, second, third = client.sync("PULSE"), client.sync("OPEN"), client.sync("CLOSE")
    if not isinstance(third, SyncReply):
        raise Failed(names_of([packet for packet in (first, second, third) if packet is not None]))
    fine = first == SyncEcho(0) and second == SyncEcho(1) and third.robot_class == b"Pioneer"
    return require(
        fine, " ".join(s.decode("latin-1") for s in (third.name, third.robot_class, third.subclass))
    )


@CHECKS.check("handshake")
def sync0_repeated(client: Client) -> str:
    """SYNC0 repeated is echoed again."""
    client.fresh()
    replies = [client.sync("PULSE") for _ in range(3)]
    return require(replies == [SyncEcho(0)] * 3, f"{sum(r is not None for r in replies)} of 3 echoed")


@CHECKS.check("handshake")
def syncs_in_one_write(client: Client) -> str:
    """Three SYNCs in one write get three answers."""
    client.fresh()
    client.send(framed("PULSE") + framed("OPEN") + framed("CLOSE"))
    packets = several(client, 3)
    fine = (
        len(packets) == 3 and packets[:2] == [SyncEcho(0), SyncEcho(1)] and isinstance(packets[2], SyncReply)
    )
    return require(fine, names_of(packets))


@CHECKS.check("handshake")
def sync2_repeated(client: Client) -> str:
    """SYNC2 repeated before OPEN is answered again."""
    client.fresh()
    replies = [client.sync(name) for name in ("PULSE", "OPEN", "CLOSE", "CLOSE")]
    return require(
        isinstance(replies[3], SyncReply), f"second answer: {names_of([r for r in replies[3:] if r])}"
    )


@CHECKS.check("handshake")
def sync1_first(client: Client) -> str:
    """SYNC1 first is ignored, and the server goes on waiting for SYNC0."""
    client.waiting()
    early = client.sync("OPEN", QUIET_S)
    echo = client.sync("PULSE")
    observed = f"SYNC1: {names_of([early] if early else [])}; SYNC0: {names_of([echo] if echo else [])}"
    return require(early is None and echo == SyncEcho(0), observed)


@CHECKS.check("handshake")
def sync2_too_early(client: Client) -> str:
    """SYNC2 after SYNC0 is ignored."""
    client.waiting()
    client.sync("PULSE")
    early = client.sync("CLOSE", QUIET_S)
    return require(early is None, names_of([early] if early else []))


@CHECKS.check("handshake")
def junk_before(client: Client) -> str:
    """Junk before a packet is skipped (WMS2, header bytes)."""
    client.fresh()
    client.send(b"WMS2\r" + b"\xfa\xfa\x00\xfb" + framed("PULSE"))
    packets = several(client, 1)
    return require(packets == [SyncEcho(0)], names_of(packets))


@CHECKS.check("handshake")
def byte_by_byte(client: Client) -> str:
    """A packet that comes byte by byte is heard."""
    client.fresh()
    for byte in framed("PULSE"):
        client.send(bytes((byte,)))
        time.sleep(0.005)
    packets = several(client, 1)
    return require(packets == [SyncEcho(0)], names_of(packets))


@CHECKS.check("handshake")
def bad_checksum(client: Client) -> str:
    """A packet with a bad checksum is ignored, the next one heard."""
    client.fresh()
    client.send(framed("PULSE")[:-1] + b"\x01")
    bad = packets_within(client, QUIET_S)
    echo = client.sync("PULSE")
    return require(
        not bad and echo == SyncEcho(0), f"bad one: {names_of(bad)}; next: {names_of([echo] if echo else [])}"
    )


@CHECKS.check("handshake")
def open_forms(client: Client) -> str:
    """OPEN is taken with and without argument."""
    for value in (None, 1):
        client.fresh()
        for name in ("PULSE", "OPEN", "CLOSE"):
            client.sync(name)
        client.command("OPEN", value)
        client.in_session = True
        client.sips(2)
    return "SIPs after both"


@CHECKS.check("handshake")
def close_keeps_the_line(client: Client) -> str:
    """CLOSE ends the SIPs, the line stays, and SYNC0 is echoed on it."""
    client.start()
    client.command("CLOSE", 1)
    client.in_session = False
    client.hear(0.2)
    if not client.connected:
        raise Failed("the server closed the connection")
    late = [packet for packet in packets_within(client, QUIET_S) if isinstance(packet, Sip)]
    echo = client.sync("PULSE")
    return require(
        not late and echo == SyncEcho(0), f"{len(late)} late SIPs; SYNC0: {names_of([echo] if echo else [])}"
    )


@CHECKS.check("handshake")
def second_client(client: Client) -> str:
    """A client that vanished in a session is followed by one that connects."""
    client.start()
    client.in_session = False
    client.start()
    return "connected again"
