# SPDX-License-Identifier: MIT
"""pcapng captures of the TCP or CAN link, as Wireshark writes them."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from typing import BinaryIO, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, Damage, DamageList, Format, LogError, ReadOptions
from argus_tools.formats.pcap import FRAME_MAX
from argus_tools.formats.tcp import DEFAULT_PORT, LINK_ETHERNET, Connection
from argus_tools.formats.traffic import Captured, Traffic
from argus_tools.timeline import nanoseconds

_SECTION, _INTERFACE, _SIMPLE, _ENHANCED, _OLD_PACKET = 0x0A0D0D0A, 1, 3, 6, 2
_ORDER_MAGIC: Final = 0x1A2B3C4D
_OPTION_NAME: Final = 2
_OPTION_TSRESOL: Final = 9
_OPTION_TSOFFSET: Final = 14


@dataclass
class _Interface:
    link: int
    units_per_s: int = 1_000_000
    offset_s: int = 0
    name: str = ""


def _interface(order: str, body: bytes) -> _Interface:
    found = _Interface(struct.unpack_from(order + "H", body)[0])
    at = 8
    while at + 4 <= len(body):
        code, size = struct.unpack_from(order + "HH", body, at)
        value = body[at + 4 : at + 4 + size]
        if code == 0:
            break
        if code == _OPTION_TSRESOL and size == 1:
            found.units_per_s = 2 ** (value[0] & 0x7F) if value[0] & 0x80 else 10 ** min(value[0], 18)
        elif code == _OPTION_TSOFFSET and size == 8:
            found.offset_s = struct.unpack(order + "q", value)[0]
        elif code == _OPTION_NAME:
            found.name = value.rstrip(b"\0").decode("utf-8", "replace")
        at += 4 + size + (-size & 3)
    return found


class PcapngReader:
    """Reads block by block; kinds of blocks that it does not know are passed over."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._options = options
        self._order = "<"
        self._interfaces: list[_Interface] = []

    def __iter__(self) -> Iterator[Chunk]:
        traffic = Traffic(self._options, self.damage)
        number = 0
        for kind, body in self._blocks():
            try:
                if kind == _INTERFACE:
                    self._interfaces.append(_interface(self._order, body))
                elif kind in (_ENHANCED, _SIMPLE, _OLD_PACKET):
                    number += 1
                    yield from traffic.take(self._packet(kind, body, number))
            except (struct.error, IndexError):
                self.damage.append(Damage(f"frame {number}", "a block contradicts its length"))
        yield from traffic.finish()

    def _packet(self, kind: int, body: bytes, number: int) -> Captured:
        if kind == _SIMPLE:
            size = struct.unpack_from(self._order + "I", body)[0]
            return Captured(
                0.0, number, self._interfaces[0].link, body[4 : 4 + size], self._interfaces[0].name
            )
        form = "IIIII" if kind == _ENHANCED else "HHIIII"
        values = struct.unpack_from(self._order + form, body)
        high, low, size = values[-4:-1]
        interface = self._interfaces[values[0]]
        t = (high << 32 | low) / interface.units_per_s + interface.offset_s
        return Captured(round(t, 9), number, interface.link, body[20 : 20 + size], interface.name)

    def _blocks(self) -> Iterator[tuple[int, bytes]]:
        at = 0
        while head := self._stream.read(8):
            if len(head) == 8 and head[:4] == b"\x0a\x0d\x0d\x0a":
                magic = self._stream.read(4)
                self._order = "<" if magic == _ORDER_MAGIC.to_bytes(4, "little") else ">"
                if magic != struct.pack(self._order + "I", _ORDER_MAGIC):
                    if at == 0:
                        raise LogError(f"{self._options.name}: no pcapng file")
                    self.damage.append(Damage(f"byte {at}", "a damaged section; the rest is not read"))
                    return
                self._interfaces = []
                held = 4
            else:
                held = 0
            kind, size = struct.unpack(self._order + "II", head.ljust(8, b"\0"))
            if len(head) == 8 and not (12 + held <= size <= FRAME_MAX + 1024 and size % 4 == 0):
                self.damage.append(Damage(f"byte {at}", f"a block of {size} bytes; the rest is not read"))
                return
            body = self._stream.read(max(0, size - 8 - held))
            if len(head) < 8 or len(body) < size - 8 - held:
                self.damage.append(Damage(f"byte {at}", "the capture ends inside a block"))
                return
            at += size
            yield kind, body[:-4]


class PcapngWriter:
    """Writes a capture of a TCP connection that carried the chunks, in nanoseconds."""

    def __init__(self, stream: BinaryIO, options: ReadOptions) -> None:
        self._stream = stream
        self._connection = Connection(options.port or DEFAULT_PORT)
        self._t = 0.0
        self._opened = False
        self._block(_SECTION, struct.pack("<IHHq", _ORDER_MAGIC, 1, 0, -1))
        resolution = struct.pack("<HHBxxxHH", _OPTION_TSRESOL, 1, 9, 0, 0)
        self._block(_INTERFACE, struct.pack("<HHI", LINK_ETHERNET, 0, 0) + resolution)

    def write(self, chunk: Chunk) -> None:
        """Append the frames that carry one chunk."""
        self._t = self._t if chunk.t is None else max(chunk.t, 0.0)
        frames = [] if self._opened else self._connection.opening()
        self._opened = True
        for frame in frames + self._connection.frames(chunk.dir, chunk.data):
            t_ns = nanoseconds(self._t)
            head = struct.pack("<IIIII", 0, t_ns >> 32, t_ns & 0xFFFFFFFF, len(frame), len(frame))
            self._block(_ENHANCED, head + frame + b"\0" * (-len(frame) & 3))

    def close(self) -> None:
        """Nothing stands at the end."""

    def _block(self, kind: int, body: bytes) -> None:
        size = struct.pack("<I", len(body) + 12)
        self._stream.write(struct.pack("<I", kind) + size + body + size)


FORMAT: Final = Format(
    name="pcapng",
    help=HELP["pcapng"],
    sniff=lambda head: head[:4] == b"\x0a\x0d\x0d\x0a",
    reader=PcapngReader,
    writer=PcapngWriter,
    suffixes=(".pcapng",),
)
