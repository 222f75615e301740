# SPDX-License-Identifier: MIT
"""pcap captures of the TCP or CAN link, with microseconds or nanoseconds, of either byte order."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from io import BufferedReader
from typing import BinaryIO, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, Damage, DamageList, Format, LogError, ReadOptions
from argus_tools.formats.tcp import DEFAULT_PORT, LINK_ETHERNET, Connection
from argus_tools.formats.traffic import Captured, Traffic

FRAME_MAX: Final = 1 << 20
_SNAPLEN: Final = 262144
# Byte order and fractions of a second by the first four bytes.
_MAGIC: Final = {
    b"\xd4\xc3\xb2\xa1": ("<", 1e-6),
    b"\xa1\xb2\xc3\xd4": (">", 1e-6),
    b"\x4d\x3c\xb2\xa1": ("<", 1e-9),
    b"\xa1\xb2\x3c\x4d": (">", 1e-9),
}


class PcapReader:
    """Reads the frames one by one; a file that is cut gives all frames before the cut."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._options = options

    def __iter__(self) -> Iterator[Chunk]:
        head = self._stream.read(24)
        if len(head) < 24 or head[:4] not in _MAGIC:
            raise LogError(f"{self._options.name}: no pcap file, or cut in its header")
        order, unit = _MAGIC[head[:4]]
        link = struct.unpack(order + "I", head[20:24])[0] & 0xFFFF
        traffic = Traffic(self._options, self.damage)
        at, number = 24, 0
        while record := self._stream.read(16):
            number += 1
            cut = len(record) < 16
            if not cut:
                seconds, fraction, size, _ = struct.unpack(order + "IIII", record)
                if size > FRAME_MAX:
                    self.damage.append(Damage(f"byte {at}", f"a frame of {size} bytes; the rest is not read"))
                    break
                frame = self._stream.read(size)
                cut = len(frame) < size
            if cut:
                self.damage.append(Damage(f"byte {at}", "the capture ends inside a frame"))
                break
            at += 16 + size
            yield from traffic.take(Captured(round(seconds + fraction * unit, 9), number, link, frame))
        yield from traffic.finish()


class PcapWriter:
    """Writes a capture of a TCP connection that carried the chunks."""

    def __init__(self, stream: BinaryIO, options: ReadOptions) -> None:
        self._stream = stream
        self._connection = Connection(options.port or DEFAULT_PORT)
        self._t = 0.0
        self._opened = False
        stream.write(struct.pack("<IHHiIII", 0xA1B2C3D4, 2, 4, 0, 0, _SNAPLEN, LINK_ETHERNET))

    def write(self, chunk: Chunk) -> None:
        """Append the frames that carry one chunk."""
        self._t = self._t if chunk.t is None else max(chunk.t, 0.0)
        frames = [] if self._opened else self._connection.opening()
        self._opened = True
        for frame in frames + self._connection.frames(chunk.dir, chunk.data):
            seconds, micros = divmod(round(self._t * 1e6), 1_000_000)
            self._stream.write(struct.pack("<IIII", seconds, micros, len(frame), len(frame)) + frame)

    def close(self) -> None:
        """Nothing stands at the end."""


FORMAT: Final = Format(
    name="pcap",
    help=HELP["pcap"],
    sniff=lambda head: head[:4] in _MAGIC,
    reader=PcapReader,
    writer=PcapWriter,
    suffixes=(".pcap", ".cap"),
)
