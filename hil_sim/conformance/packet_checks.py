# SPDX-License-Identifier: MIT
"""Checks of the other packets."""

from __future__ import annotations

from typing import Final

from hil_sim.arcos import (
    BAUD_OF_CODE,
    ConfigPac,
    EncoderPac,
    IoPac,
    Packet,
    SimStat,
    Sip,
)
from hil_sim.conformance.ask import config_of, packets_within
from hil_sim.conformance.check import Group, require
from hil_sim.conformance.client import Client, NotApplicable

CHECKS: Final = Group()


@CHECKS.check("packets")
def config(client: Client) -> str:
    """CONFIGpac with and without argument: subclass of SYNC2, watchdog, cycles, ceilings above settings."""
    client.start()
    packet = config_of(client)
    client.command("CONFIG")
    again = client.answer(ConfigPac)
    subclass = client.identity.subclass if client.identity else b""
    observed = (
        f"{packet.subtype!r} cycles {packet.sip_cycle_ms}/{packet.sonar_cycle_ms} ms, watchdog {packet.watchdog_ms} ms,"
        f" top {packet.trans_vel_top} mm/s {packet.rot_vel_top} deg/s, revcount {packet.rev_count}"
    )
    plausible = bool(
        packet.sip_cycle_ms and packet.sonar_cycle_ms and packet.watchdog_ms and packet.rev_count
    )
    tops = (packet.trans_vel_top or 0) >= (packet.trans_vel_max or 0) > 0
    return require(again == packet and packet.subtype == subclass and plausible and tops, observed)


def _on_request(client: Client, name: str, kind: type[Packet]) -> str:
    client.start()
    client.command(name, 1)
    once = [packet for packet in packets_within(client, 0.8) if isinstance(packet, kind)]
    client.command(name, 2)
    client.sips(1)
    stream = client.hear(1.6)
    client.command(name, 0)
    client.hear(0.4)
    after = [packet for packet in packets_within(client, 0.6) if isinstance(packet, kind)]
    streamed = sum(isinstance(heard.packet, kind) for heard in stream)
    sips = sum(isinstance(heard.packet, Sip) for heard in stream)
    fine = len(once) == 1 and streamed >= 3 and abs(streamed - sips) <= 2 and not after
    return require(
        fine, f"once {len(once)}, streamed {streamed} with {sips} SIPs, after the end {len(after)}"
    )


@CHECKS.check("packets")
def encoder(client: Client) -> str:
    """ENCODER: 1 once, 2 after each SIP, 0 off."""
    return _on_request(client, "ENCODER", EncoderPac)


@CHECKS.check("packets")
def io_request(client: Client) -> str:
    """IOREQUEST: 1 once, 2 after each SIP, 0 off."""
    return _on_request(client, "IOREQUEST", IoPac)


@CHECKS.check("packets")
def sim_stat(client: Client) -> str:
    """SIM_STAT gives the true pose (simulators only)."""
    client.start()
    client.command("SIM_STAT", 1)
    packet = client.answer(SimStat, 1.0)
    if not isinstance(packet, SimStat):
        raise NotApplicable("no SIMSTAT: not a simulator")
    return f"{packet.x_mm} mm, {packet.y_mm} mm, {packet.th_deg} deg"


@CHECKS.check("packets")
def adsel(client: Client) -> str:
    """ADSEL shows as ANPORT."""
    client.start()
    client.command("ADSEL", 3)
    sip = client.until("ANPORT 3", lambda sip: sip.anport == 3, 6)
    client.command("ADSEL", 0)
    return f"ANPORT {sip.anport}"


@CHECKS.check("packets")
def digout(client: Client) -> str:
    """DIGOUT: high byte mask, low byte values, shown as DIGOUT."""
    client.start()
    before = client.sips(1)[0].digout or 0
    client.command("DIGOUT", 0x0F05)
    try:
        sip = client.until("DIGOUT xxxx0101", lambda sip: (sip.digout or 0) == before & 0xF0 | 5, 6)
    finally:
        client.command("DIGOUT", 0x0F00 | before & 0x0F)
    return f"DIGOUT 0x{before:02X} then 0x{sip.digout:02X}"


@CHECKS.check("packets")
def host_baud(client: Client) -> str:
    """HOSTBAUD changes the rate until CLOSE (serial only)."""
    if client.target.is_tcp:
        raise NotApplicable("a TCP link has no rate")
    code = 2 if client.target.baud != BAUD_OF_CODE[2] else 0
    client.start()
    client.command("HOSTBAUD", code)
    client.hear(0.1)
    try:
        client.set_baud(BAUD_OF_CODE[code])
        client.hear(0.3)
        client.sips(5)
    finally:
        client.command("CLOSE", 1)
        client.in_session = False
        client.hear(0.2)
        client.set_baud(client.target.baud)
    client.start()
    return f"SIPs at {BAUD_OF_CODE[code]}, then again at {client.target.baud}"
