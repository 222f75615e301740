# SPDX-License-Identifier: MIT
"""Checks of the server information packet."""

from __future__ import annotations

import itertools
import statistics
from typing import Final

from hil_sim.arcos import (
    COMMAND,
    SIP,
    TIMING,
    TYPE,
    Command,
    Sip,
    frame,
)
from hil_sim.conformance.ask import config_of, names_of
from hil_sim.conformance.check import Group, require
from hil_sim.conformance.client import Client
from hil_sim.conformance.sonar_checks import _ALL_SONAR_FLAGS

CHECKS: Final = Group()


@CHECKS.check("sip")
def rate(client: Client) -> str:
    """The rate is the SIPCYCLE of the CONFIGpac, within 3 %."""
    client.start()
    cycle_ms = config_of(client).sip_cycle_ms or TIMING["SIP_CYCLE_MS"]
    # On a slow line the SIPs right after a CONFIGpac come late.
    client.sips(5)
    times = [t for t, _ in client.timed_sips(31)]
    mean = (times[-1] - times[0]) / 30 * 1000
    return require(abs(mean - cycle_ms) <= 0.03 * cycle_ms, f"{mean:.1f} ms of {cycle_ms} ms")


@CHECKS.check("sip")
def jitter(client: Client) -> str:
    """Nine in ten SIPs come within 30 % of a cycle of their time."""
    client.start()
    times = [t * 1000 for t, _ in client.timed_sips(41)]
    gaps = [b - a for a, b in itertools.pairwise(times)]
    off = sorted(abs(gap - statistics.median(gaps)) for gap in gaps)
    limit = 0.3 * statistics.median(gaps)
    return require(off[35] <= limit, f"p50 {off[20]:.1f} ms, p90 {off[35]:.1f} ms, max {off[-1]:.1f} ms")


@CHECKS.check("sip")
def first_sip(client: Client) -> str:
    """A session starts at (0, 0, 0), motors off, sonar on."""
    client.start()
    (sip,) = client.sips(1)
    fine = (sip.x, sip.y, sip.th, sip.flags & 1) == (0, 0, 0, 0) and sip.flags & _ALL_SONAR_FLAGS != 0
    return require(fine, f"x {sip.x} y {sip.y} th {sip.th} flags 0x{sip.flags:04X}")


@CHECKS.check("sip")
def type_at_rest(client: Client) -> str:
    """Type 0x32 at rest."""
    client.start()
    types = {sip.type for sip in client.sips(5)}
    return require(types == {TYPE["SIP_STATIONARY"]}, " ".join(f"0x{kind:02X}" for kind in sorted(types)))


@CHECKS.check("sip")
def length(client: Client) -> str:
    """Fields up to FAULTFLAGS, and no more."""
    client.start()
    (sip,) = client.sips(1)
    count = len(sip.data) + 2 - SIP["SONAR_BYTES"] * len(sip.sonars)
    return require(
        count == SIP["COUNT_BARE"], f"COUNT {count} without readings, {SIP['COUNT_BARE']} expected"
    )


@CHECKS.check("sip")
def ignored_commands(client: Client) -> str:
    """Unknown commands and accessories a P3-DX lacks are ignored, the stream goes on."""
    client.start()
    numbers = [14, 46, 64, 69, 94, 130, 199] + [
        COMMAND[name]
        for name in ("SAY", "GRIPPER", "TCM2", "GYRO", "BATTERYINFO", "PLAYLIST", "LATVEL", "CHARGE")
    ]
    for number in numbers:
        client.send(frame(Command(number).data))
        client.send(frame(Command.integer(number, 1).data))
        client.hear(0.02)
    packets = [heard.packet for heard in client.hear(1.0)]
    others = [packet for packet in packets if not isinstance(packet, Sip)]
    sips = len(packets) - len(others)
    return require(sips >= 8 and not others, f"{sips} SIPs in 1 s, others: {names_of(others)}")
