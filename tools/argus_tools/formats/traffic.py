# SPDX-License-Identifier: MIT
"""The robot's link in the frames of a capture, whatever the captured interface: TCP over IP, or ISO-TP on CAN."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from argus_tools.chunks import Chunk, Damage, DamageList, LogError, ReadOptions
from argus_tools.formats.isotp import CanLink, is_robot_id
from argus_tools.formats.tcp import IP_LINKS, Streams, parse

LINK_CAN: Final = 227
# "Linux cooked" captures of any interface: bytes of the header, where in it the protocol stands, and the interface.
COOKED: Final = {113: (16, 14, None), 276: (20, 0, 4)}
CAN_PROTOCOLS: Final = (0x000C, 0x000D)
# Wireshark saves what it read from a candump log as these: tags of type and size, then the frame of SocketCAN.
LINK_EXPORTED: Final = 252
_EXPORTED_END, _EXPORTED_NAME = 0, 12
_EXPORTED_CAN: Final = {b"can-hostendian": "little", b"canfd": "little", b"can-bigendian": "big"}
_CAN_HEADER: Final = 8
_LONG_ID, _REMOTE, _ERROR = 1 << 31, 1 << 30, 1 << 29
_LONG_ID_MASK: Final = (1 << 29) - 1
# By number: what it is, and what records the robot's link instead (tcpdump.org, LINK-LAYER HEADER TYPES).
_CAN_REMEDY: Final = "capture the interface itself: tcpdump -i can0 -w can0.pcap"
_SERIAL_REMEDY: Final = f"record the port itself with argusd --record; of a CAN adapter, {_CAN_REMEDY}"
_IP_REMEDY: Final = "capture where the client runs: tcpdump -i any -w robot.pcap tcp port 8101"
_LINKS: Final = {
    105: ("802.11 radio frames", _IP_REMEDY),
    127: ("802.11 radio frames with radiotap headers", _IP_REMEDY),
    147: ("frames of a user's own type (DLT_USER0)", _CAN_REMEDY),
    186: ("USB frames (FreeBSD)", _SERIAL_REMEDY),
    187: ("Bluetooth HCI frames", _SERIAL_REMEDY),
    189: ("USB frames (usbmon)", _SERIAL_REMEDY),
    190: ("CAN frames with an adapter's own header (CAN20B)", _CAN_REMEDY),
    195: ("802.15.4 radio frames", _SERIAL_REMEDY),
    201: ("Bluetooth HCI frames", _SERIAL_REMEDY),
    210: ("FlexRay frames", _CAN_REMEDY),
    212: ("LIN frames", _CAN_REMEDY),
    220: ("USB frames (usbmon)", _SERIAL_REMEDY),
    249: ("USB frames (USBPcap)", _SERIAL_REMEDY),
    250: ("serial frames of an RTAC", _SERIAL_REMEDY),
    LINK_EXPORTED: ("PDUs that Wireshark exported", "save the frames themselves: File, Save As"),
    266: ("USB frames (macOS)", _SERIAL_REMEDY),
}


@dataclass(frozen=True)
class Captured:
    """One frame of a capture: its time in s, number in the file, link type, and its interface where that is told."""

    t: float | None
    number: int
    link: int
    data: bytes
    interface: str = ""


class Traffic:
    """Takes the frames of a capture and yields what went over the robot's link."""

    def __init__(self, options: ReadOptions, damage: DamageList) -> None:
        self._options = options
        self._damage = damage
        self._streams = Streams(options, damage)
        self._can = CanLink(options, damage, "frame")
        self._others: dict[int, int] = {}
        self._is_read = False
        self._is_empty = True

    def take(self, frame: Captured) -> Iterator[Chunk]:
        """Take the next frame."""
        self._is_empty = False
        link = frame.link
        if link == LINK_CAN:
            yield from self._take_can(frame, frame.data, frame.interface)
        elif link == LINK_EXPORTED and (data := _exported_can(frame.data)) is not None:
            yield from self._take_can(frame, data, frame.interface)
        elif link in COOKED:
            head, kind_at, index_at = COOKED[link]
            if int.from_bytes(frame.data[kind_at : kind_at + 2], "big") in CAN_PROTOCOLS:
                name = frame.interface
                if index_at is not None:
                    name = f"number {int.from_bytes(frame.data[index_at : index_at + 4], 'big')}"
                yield from self._take_can(frame, frame.data[head:], name)
            else:
                yield from self._take_ip(frame)
        elif link in IP_LINKS:
            yield from self._take_ip(frame)
        else:
            self._pass_over(frame)

    def finish(self) -> Iterator[Chunk]:
        """Yield what waited; LogError if the capture is of a kind that is not read."""
        if self._is_empty and not self._damage:
            raise LogError(f"{self._options.name}: a capture that holds no frames; {_IP_REMEDY}")
        yield from self._streams.finish()
        if not self._is_read and self._others:
            link = max(self._others, key=lambda number: self._others[number])
            name, remedy = _LINKS.get(link, ("frames that argus-log does not know", _IP_REMEDY))
            raise LogError(
                f"{self._options.name}: a capture of {name}, link type {link}, which is not read; expected IP, "
                f"or CAN (link type {LINK_CAN}); {remedy}"
            )
        if not self._streams.is_used:
            yield from self._can.finish()

    def _pass_over(self, frame: Captured) -> None:
        if frame.link not in self._others:
            name = _LINKS.get(frame.link, ("unknown frames", ""))[0]
            what = f"{name}, link type {frame.link}, are passed over"
            self._damage.append(Damage(f"frame {frame.number}", what))
        self._others[frame.link] = self._others.get(frame.link, 0) + 1

    def _take_ip(self, frame: Captured) -> Iterator[Chunk]:
        self._is_read = True
        segment = parse(frame.link, frame.data)
        if segment:
            yield from self._streams.take(frame.t, frame.number, segment)

    def _take_can(self, frame: Captured, data: bytes, interface: str) -> Iterator[Chunk]:
        self._is_read = True
        if len(data) < _CAN_HEADER:
            self._damage.append(Damage(f"frame {frame.number}", "a CAN frame shorter than its header"))
            return
        can_id = _can_id(data)
        size = data[4]
        payload = data[_CAN_HEADER : _CAN_HEADER + size]
        if can_id & (_REMOTE | _ERROR):
            return
        direction = self._can.direction(
            interface, can_id & _LONG_ID_MASK, bool(can_id & _LONG_ID), frame.number
        )
        if direction is None:
            return
        if len(payload) < size:
            what = f"{len(payload)} of a CAN frame's {size} bytes were captured; take tcpdump without -s"
            self._damage.append(Damage(f"frame {frame.number}", what))
        yield from self._can.take(frame.t, direction, payload, frame.number)


def _exported_can(data: bytes) -> bytes | None:
    """Return the frame of SocketCAN behind the tags of an exported PDU; None if it is for another dissector.

    Its id has the byte order of the machine that wrote it, which nothing tells: nearly all are little-endian.
    """
    at, order = 0, None
    while at + 4 <= len(data):
        tag, size = struct.unpack_from(">HH", data, at)
        at += 4
        if tag == _EXPORTED_END:
            head = data[at : at + 4]
            return None if order is None else (head[::-1] if order == "little" else head) + data[at + 4 :]
        if tag == _EXPORTED_NAME:
            order = _EXPORTED_CAN.get(data[at : at + size].rstrip(b"\0"))
        at += size
    return None


def _can_id(data: bytes) -> int:
    """Return id and flags; the recorder's own byte order, which cooked captures may have, is seen by the id."""
    big, little = struct.unpack_from(">I", data)[0], struct.unpack_from("<I", data)[0]
    return int(little if is_robot_id(little) and not is_robot_id(big) else big)
