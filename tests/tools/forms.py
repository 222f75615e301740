# SPDX-License-Identifier: MIT
"""The same session in the many forms that other programs write it in, made without the readers under test."""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from argus_tools.chunks import Chunk
from argus_tools.formats import Log, open_log
from logs import command, sip

SIPS = [sip(x=5 * n, sonars=((0, 1000 + n), (1, 2000 - n), (7, 0xFAFB))) for n in range(12)]
COMMANDS = [command("VEL", 100 + n) for n in range(12)]
ROBOT = b"".join(SIPS)
CLIENT = b"".join(COMMANDS)
START_S = 1795577927.479113
ID_TO_ROBOT, ID_FROM_ROBOT = 0x640, 0x648


class CanFrame(NamedTuple):
    """One frame on the bus."""

    t: float
    can_id: int
    data: bytes


def frames() -> list[CanFrame]:
    """The session as ISO-TP frames, a SIP and a command each 100 ms, 1 ms between frames, no flow control."""
    out = []
    for n, pair in enumerate(zip(SIPS, COMMANDS, strict=True)):
        t = START_S + 0.1 * n
        for data, can_id in zip(pair, (ID_FROM_ROBOT, ID_TO_ROBOT), strict=True):
            parts = [(0x1000 | len(data)).to_bytes(2, "big") + data[:6]]
            parts += [
                bytes((0x20 | at // 7 & 15,)) + data[at - 1 : at + 6] for at in range(7, len(data) + 1, 7)
            ]
            for part in parts:
                out.append(CanFrame(round(t, 6), can_id, part.ljust(8, b"\xcc")))
                t += 0.001
    return out


def rows(data: bytes, width: int = 16) -> Iterator[tuple[int, bytes]]:
    """Offset and bytes of each line of a dump."""
    for at in range(0, len(data), width):
        yield at, data[at : at + width]


def shown(data: bytes) -> str:
    """The column of characters."""
    return "".join(chr(byte) if 32 <= byte < 127 else "." for byte in data)


def words(data: bytes, size: int, form: Callable[[int], str]) -> str:
    """Little-endian words, the last filled up with zeros."""
    padded = data + bytes(-len(data) % size)
    return " ".join(
        form(int.from_bytes(padded[at : at + size], "little")) for at in range(0, len(padded), size)
    )


def hexdump_c(data: bytes) -> str:
    """`hexdump -C -v`."""
    lines = [
        f"{at:08x}  {part[:8].hex(' '):<23}  {part[8:].hex(' '):<23}  |{shown(part)}|"
        for at, part in rows(data)
    ]
    return "\n".join([*lines, f"{len(data):08x}"]) + "\n"


def xxd(data: bytes, group: int = 2, width: int = 16) -> str:
    """`xxd -g GROUP -c WIDTH`."""
    lines = []
    for at, part in rows(data, width):
        text = " ".join(part[n : n + group].hex() for n in range(0, len(part), group))
        lines.append(f"{at:08x}: {text:<{2 * width + -(-width // group) - 1}}  {shown(part)}")
    return "\n".join(lines) + "\n"


def od(data: bytes, address: str = "07o", size: int = 1, digits: str = "02x") -> str:
    """`od -v -A ADDRESS -t TYPE`."""
    lines = [
        f"{at:{address}} " + words(part, size, lambda value: f"{value:{digits}}") for at, part in rows(data)
    ]
    return "\n".join([*lines, f"{len(data):{address}}"]) + "\n"


def pcap(link: int, packets: list[tuple[float, bytes]], order: str = "<", nanoseconds: bool = False) -> bytes:
    """A capture of any link type."""
    unit = 10**9 if nanoseconds else 10**6
    magic = 0xA1B23C4D if nanoseconds else 0xA1B2C3D4
    out = struct.pack(order + "IHHiIII", magic, 2, 4, 0, 0, 65535, link)
    for t, data in packets:
        whole = round(t * unit)
        out += struct.pack(order + "IIII", whole // unit, whole % unit, len(data), len(data)) + data
    return out


def pcapng(link: int, packets: list[tuple[float, bytes]], name: bytes = b"can0") -> bytes:
    """A capture of one named interface, in microseconds."""

    def block(kind: int, body: bytes) -> bytes:
        size = struct.pack("<I", len(body) + 12)
        return struct.pack("<I", kind) + size + body + size

    named = struct.pack("<HH", 2, len(name)) + name + bytes(-len(name) % 4) + bytes(4)
    out = block(0x0A0D0D0A, struct.pack("<IHHq", 0x1A2B3C4D, 1, 0, -1))
    out += block(1, struct.pack("<HHI", link, 0, 0) + named)
    for t, data in packets:
        micros = round(t * 1e6)
        head = struct.pack("<IIIII", 0, micros >> 32, micros & 0xFFFFFFFF, len(data), len(data))
        out += block(6, head + data + bytes(-len(data) % 4))
    return out


def read(path: Path, text: str, **options: str) -> Log:
    """Write TEXT as it is, and open it."""
    path.write_text(text, newline="")
    return open_log(str(path), **options)


def joined(chunks: Iterable[Chunk], direction: str) -> bytes:
    """The bytes of one direction."""
    return b"".join(chunk.data for chunk in chunks if chunk.dir == direction)
