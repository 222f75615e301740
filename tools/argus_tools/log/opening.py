# SPDX-License-Identifier: MIT
"""A session for a fault manager that only listens: with a robot that is made up and has reported nothing yet."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Final

from argus_tools.chunks import ROBOT_TO_CLIENT, LogError
from argus_tools.log.packets import Row
from hil_sim.arcos import COMMAND, TIMING, Command, PacketError, Sip, SyncEcho, SyncReply, Unframer, frame
from hil_sim.core.library import Core
from hil_sim.tables.robot import own_ring

_STEP_MS: Final = 10
_LIMIT_MS: Final = 10_000
_SIP_MS: Final = TIMING["SIP_CYCLE_MS"]


def identity_in(row: Row) -> SyncReply | None:
    """Return who the robot says it is; None of any other packet, and of a SYNC2 without strings.

    Such is the client's own, which an adapter with echo gives back, or a damaged one whose checksum fits.
    """
    if not row.ok or row.dir != ROBOT_TO_CLIENT or row.type != "SYNC2":
        return None
    try:
        reply = SyncReply.decode(row.data)
    except PacketError:
        return None
    return reply if reply.subclass else None


def is_sip(row: Row) -> bool:
    """Whether a row is a SIP that can be read, and not only called one."""
    if not row.ok or row.type != "SIP":
        return False
    try:
        Sip.decode(row.data)
    except PacketError:
        return False
    return True


class _Robot:
    """The robot that is made up to open a session with."""

    def __init__(self, identity: SyncReply, sip: bytes) -> None:
        self._identity = identity
        self._sip = frame(replace(Sip.decode(sip), sonars=()).data)
        self._unframer = Unframer()
        self._is_synced = False
        self._is_open = False

    def answers(self, packet: bytes) -> Iterator[bytes]:
        """Yield what the robot says to a packet of the manager."""
        for data in self._unframer.feed(packet):
            number = Command.decode(data).number
            if self._is_open:
                continue
            if self._is_synced and number == COMMAND["OPEN"]:
                self._is_open = True
            elif number == COMMAND["CLOSE"]:
                self._is_synced = True
                yield frame(self._identity.data)
            else:
                yield frame(SyncEcho(number).data)

    def due(self, now_ms: int) -> list[bytes]:
        """Return the SIPs that are due."""
        return [self._sip] if self._is_open and now_ms % _SIP_MS == 0 else []


def opened(settings: Mapping[str, int], identity: SyncReply, sip: bytes) -> tuple[Core, int]:
    """Return a manager that has a session, and its time in ms. `sip`: the first, of which no reading is taken."""
    core = Core(0, settings, own_ring(identity.subclass.decode("latin-1")))
    robot = _Robot(identity, sip)
    core.link_up(0)
    now_ms = 0
    while not core.is_open:
        now_ms += _STEP_MS
        if now_ms > _LIMIT_MS:
            raise LogError("the fault manager does not open a session with this log")
        core.process(now_ms)
        for packet in core.transmit():
            for answer in robot.answers(packet):
                core.receive(now_ms, answer)
        for packet in robot.due(now_ms):
            core.receive(now_ms, packet)
    core.transmit()
    return core, now_ms
