# SPDX-License-Identifier: MIT
"""Checks of the watchdog and of what a session leaves behind."""

from __future__ import annotations

from typing import Final

from hil_sim.conformance.ask import at_rest, come_back, config_of, speed_of
from hil_sim.conformance.check import Group, require
from hil_sim.conformance.client import Client

CHECKS: Final = Group()


@CHECKS.check("safety", motion=True)
def watchdog(client: Client) -> str:
    """The watchdog stops the robot 2 s after the last packet, SIPs go on; a PULSE resumes."""
    client.start(motors=True)
    client.command("VEL", 100)
    client.sips(8)
    client.pulses = False
    client.command("PULSE")
    # The limit of the check: watchdog, braking from 100 mm/s at 300 mm/s2, and half a second for the link.
    sips = client.sips(30)
    client.pulses = True
    moving = [k for k, sip in enumerate(sips) if abs(speed_of(sip)) > 50]
    observed = f"last above 50 mm/s {(moving[-1] + 1) / 10 if moving else 0:.1f} s after the last packet"
    require(at_rest(sips[-1]) and bool(moving) and 17 <= moving[-1] + 1 <= 25, observed)
    client.command("PULSE")
    client.until("the robot takes up its set point again", lambda sip: speed_of(sip) > 80, 15)
    come_back(client, -350)
    return observed


@CHECKS.check("safety", motion=True)
def close_in_motion(client: Client) -> str:
    """CLOSE in motion: at rest and motors off at the next session."""
    client.start(motors=True)
    client.command("VEL", 150)
    client.sips(8)
    client.start()
    (sip,) = client.sips(1)
    flags = f"speed {speed_of(sip):g}, flags 0x{sip.flags:04X}"
    client.command("ENABLE", 1)
    come_back(client, -120)
    return require(at_rest(sip) and not sip.flags & 1, flags)


@CHECKS.check("safety", motion=True)
def defaults_after_close(client: Client) -> str:
    """Run-time settings return to their defaults with CLOSE."""
    client.start()
    before = config_of(client)
    client.command("SETV", 111)
    client.command("SETA", 77)
    client.command("SONAR_CYCLE", 60)
    changed = config_of(client)
    client.start()
    after = config_of(client)
    observed = f"SETV {before.trans_vel_max}, {changed.trans_vel_max}, {after.trans_vel_max}"
    fine = changed.trans_vel_max == 111 and changed.trans_acc == 77 and after == before
    return require(fine, observed)
