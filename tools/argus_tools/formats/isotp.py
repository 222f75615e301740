# SPDX-License-Identifier: MIT
"""The ISO-TP link on a CAN bus: which frames are a robot's, and the messages that they carry.

11-bit normal addressing (ISO 15765-2): ids 0x640+k to robot k and 0x648+k from it (docs/can.md).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from argus_tools.chunks import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    Direction,
    LogError,
    Offsets,
    ReadOptions,
)

ID_TO_ROBOT: Final = 0x640
ID_FROM_ROBOT: Final = 0x648
ROBOTS: Final = 8
NEXT_BYTES: Final = tuple(bytes((0x20 | number,)) for number in range(16))
_FRAME_BYTES: Final = 8
# More than any message of a robot's link.
_MESSAGE_MAX: Final = 1 << 16
_SINGLE, _FIRST, _NEXT, _FLOW_CONTROL = range(4)
# So many ids are named when none is a robot's.
_IDS_SHOWN: Final = 4


def is_robot_id(can_id: int) -> bool:
    """Whether frames of this 11-bit id are of a robot's link."""
    return ID_TO_ROBOT <= can_id < ID_FROM_ROBOT + ROBOTS


@dataclass
class Transfer:
    """A message whose frames are still coming; `place` is that of its first."""

    total: int
    place: int
    data: bytearray
    next_number: int = 1


class CanLink:
    """Puts the messages of one robot's link together again; other traffic on the bus is passed over.

    Of a message that is broken off, what came is passed on, so that its packet is seen as damaged.
    Places are numbers of a `unit`: "line" or "frame".
    """

    def __init__(self, options: ReadOptions, damage: DamageList, unit: str) -> None:
        self.transfers: dict[Direction, Transfer] = {}
        self.is_used = False
        self._damage = damage
        self._unit = unit
        self._name = options.name
        self._robot = options.robot
        self._is_asked = options.robot is not None
        self._bus: str | None = None
        self._others: set[int | str] = set()
        self._strange: dict[str, None] = {}
        self._robots: set[int] = set()
        self._torn: set[Direction] = set()
        self._offsets = Offsets()
        self._directions: dict[tuple[str, int, bool], Direction | None] = {}
        self._t: float | None = None
        self._place = 0

    @property
    def place(self) -> str:
        """Where in the file the last frame taken stands."""
        return f"{self._unit} {self._place}"

    def direction(self, bus: str, can_id: int, is_long_id: bool, place: int) -> Direction | None:
        """Return which way frames of this id go, None if they are not of the robot that is read."""
        key = (bus, can_id, is_long_id)
        if key not in self._directions:
            self.is_used = True
            self._directions[key] = self._new_direction(bus, can_id, is_long_id, place)
        return self._directions[key]

    def _new_direction(self, bus: str, can_id: int, is_long_id: bool, place: int) -> Direction | None:
        if is_long_id or not is_robot_id(can_id):
            if len(self._strange) < _IDS_SHOWN:
                self._strange[f"0x{can_id:08X} (29 bits)" if is_long_id else f"0x{can_id:03X}"] = None
            return None
        robot = can_id & (ROBOTS - 1)
        self._robots.add(robot)
        if self._robot is None:
            self._robot = robot
        if robot != self._robot and self._is_asked:
            return None
        if robot != self._robot:
            first = f"robot {self._robot} came first; choose with --robot"
            self._leave_out(robot, f"robot {robot} is left out, as {first}", place)
            return None
        if self._bus is None:
            self._bus = bus
        if bus != self._bus:
            what = f"interface {bus} is left out, as robot {robot} was first on {self._bus}"
            self._leave_out(bus, what, place)
            return None
        return CLIENT_TO_ROBOT if can_id < ID_FROM_ROBOT else ROBOT_TO_CLIENT

    def _leave_out(self, other: int | str, what: str, place: int) -> None:
        if other not in self._others:
            self._others.add(other)
            self._complain(place, what)

    def take(self, t: float | None, direction: Direction, frame: bytes, place: int) -> Iterator[Chunk]:
        """Take a frame; yield the message that it completes, or what came of one that it breaks off."""
        self._t = t
        self._place = place
        kind = frame[0] >> 4 if frame else -1
        if kind == _SINGLE:
            yield from self._give_up(direction, "is broken off")
            # Frames of CAN FD have their length in a second byte.
            at = 1 if len(frame) <= _FRAME_BYTES or frame[0] & 0xF else 2
            size = frame[at - 1] & (0xF if at == 1 else 0xFF)
            if 0 < size <= len(frame) - at:
                yield self._chunk(direction, frame[at : at + size])
            else:
                self._complain(place, f"an ISO-TP single frame of a wrong length, {size}")
        elif kind == _FIRST:
            yield from self._give_up(direction, "is broken off")
            self._begin(direction, frame, place)
        elif kind == _NEXT:
            yield from self._continue(direction, frame, place)
        elif kind != _FLOW_CONTROL and frame:
            self._complain(place, "no ISO-TP frame")

    def finish(self) -> Iterator[Chunk]:
        """Yield what came of messages without an end; LogError if no frame was of the robot that is asked for."""
        for direction in tuple(self.transfers):
            yield from self._give_up(direction, "has no end")
        if not self.is_used or self._robot in self._robots:
            return
        if self._robots:
            there = ", ".join(map(str, sorted(self._robots)))
            raise LogError(f"{self._name}: holds no frame of robot {self._robot}; give --robot {there}")
        some = ", ".join(self._strange)
        raise LogError(
            f"{self._name}: no CAN frame is of a robot's link, whose ids of 11 bits are 0x{ID_TO_ROBOT:03X} to "
            f"0x{ID_FROM_ROBOT + ROBOTS - 1:03X}; there are {some}{'' if len(self._strange) < _IDS_SHOWN else ' ...'}"
        )

    def _chunk(self, direction: Direction, data: bytes) -> Chunk:
        return self._offsets.chunk(self._t, direction, data)

    def _give_up(self, direction: Direction, why: str) -> Iterator[Chunk]:
        transfer = self.transfers.pop(direction, None)
        if transfer:
            got = f"{len(transfer.data)} of {transfer.total} bytes"
            self._complain(transfer.place, f"an ISO-TP message {why}: {got} came")
            yield self._chunk(direction, bytes(transfer.data))

    def _begin(self, direction: Direction, frame: bytes, place: int) -> None:
        total, at = int.from_bytes(frame[:2], "big") & 0xFFF, 2
        if not total:
            # Longer ones have their length in four bytes more.
            total, at = int.from_bytes(frame[2:6], "big"), 6
        if len(frame) < _FRAME_BYTES or not len(frame) - at < total <= _MESSAGE_MAX:
            self._torn.add(direction)
            self._complain(place, f"an ISO-TP first frame of a wrong length, {total}")
            return
        self._torn.discard(direction)
        self.transfers[direction] = Transfer(total, place, bytearray(frame[at:]))

    def _continue(self, direction: Direction, frame: bytes, place: int) -> Iterator[Chunk]:
        transfer = self.transfers.get(direction)
        if transfer is None:
            if direction not in self._torn:
                self._torn.add(direction)
                self._complain(place, "the end of an ISO-TP message whose beginning is missing")
            return
        if frame[0] & 0xF != transfer.next_number:
            self._torn.add(direction)
            yield from self._give_up(direction, "lacks a frame")
            return
        transfer.next_number = (transfer.next_number + 1) & 0xF
        transfer.data += frame[1:]
        if len(transfer.data) >= transfer.total:
            del self.transfers[direction]
            yield self._chunk(direction, bytes(transfer.data[: transfer.total]))

    def _complain(self, place: int, what: str) -> None:
        self._damage.append(Damage(f"{self._unit} {place}", what))
