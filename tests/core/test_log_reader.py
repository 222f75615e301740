# SPDX-License-Identifier: MIT
"""Rule: the log reader finds exactly the packets that the firmware's parser finds, whatever was done to the bytes."""

from __future__ import annotations

import ctypes
import itertools
import os
import random
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
from argus_tools.chunks import Offsets
from argus_tools.log.packets import Row, packets

from hil_sim.arcos import COMMAND, Command, ConfigPac, Sip, frame

ROOT = Path(__file__).resolve().parents[2]
SEED = int(os.environ.get("ARGUS_SEED", "20261121"))
STREAMS, PARTS, FEW_PARTS = 100_000, 20, 2
LATER_MS = 1_000_000
PARSER_BYTES = 4096  # room for an argus_parser_t
_HEADER = b"\xfa\xfb"


# What is inline has no name of its own in a library.
CALLS = """
#include "arcos/frame.h"
size_t push(argus_parser_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count);
bool next(argus_parser_t *self, uint32_t now_ms, argus_packet_t *packet);
size_t push(argus_parser_t *self, uint32_t now_ms, const uint8_t *bytes, size_t count) {
    return argus_parser_push(self, now_ms, bytes, count);
}
bool next(argus_parser_t *self, uint32_t now_ms, argus_packet_t *packet) {
    return argus_parser_next(self, now_ms, packet);
}
"""


class _Packet(ctypes.Structure):
    _fields_ = (("data", ctypes.POINTER(ctypes.c_uint8)), ("count", ctypes.c_uint8))


class Parser:
    """The firmware's parser, compiled into a library of its own."""

    def __init__(self) -> None:
        core = _compiled()
        self._init, self._push, self._next = (
            getattr(core, name) for name in ("argus_parser_init", "push", "next")
        )
        self._push.restype, self._next.restype = ctypes.c_size_t, ctypes.c_bool
        self._self = ctypes.create_string_buffer(PARSER_BYTES)
        self._packet = _Packet()

    def parse(self, pieces: list[bytes]) -> list[bytes]:
        """Return the packets in bytes that arrive so, and those that silence releases."""
        found: list[bytes] = []
        self._init(self._self)
        now = ctypes.c_uint32(0)
        for data in pieces:
            while data:
                data = data[self._push(self._self, now, data, ctypes.c_size_t(len(data))) :]
                found += self._fetch(0)
        return found + list(self._fetch(LATER_MS))

    def _fetch(self, now_ms: int) -> Iterator[bytes]:
        packet = self._packet
        while self._next(self._self, ctypes.c_uint32(now_ms), ctypes.byref(packet)):
            yield ctypes.string_at(packet.data, packet.count)


@cache
def _compiled() -> ctypes.CDLL:
    firmware = ROOT / "firmware"
    with tempfile.TemporaryDirectory() as folder:
        made, calls = Path(folder, "frame.so"), Path(folder, "calls.c")
        calls.write_text(CALLS, encoding="ascii")
        command: list[str | Path] = [
            "gcc",
            "-std=c11",
            "-O2",
            "-fPIC",
            "-shared",
            "-I",
            firmware,
            "-o",
            made,
            "-I",
            firmware / "include",
            firmware / "arcos/frame.c",
            calls,
        ]
        subprocess.run(command, check=True, timeout=600)
        return ctypes.CDLL(str(made))


@cache
def samples() -> list[bytes]:
    """Packets of both directions, some with a header among their data."""
    rng = random.Random(SEED)
    sips = [
        Sip(
            type=rng.choice((0x32, 0x33)),
            x=rng.choice((0xFBFA, rng.randrange(65536))),
            th=rng.randrange(-2048, 2049),
            sonars=tuple((n, rng.randrange(200, 5001)) for n in rng.sample(range(16), rng.randrange(5))),
        ).data
        for _ in range(40)
    ]
    commands = [Command.integer(COMMAND["VEL"], -300).data, b"\0", b"\1", bytes((COMMAND["STOP"],))]
    return [frame(data) for data in [*sips, *commands * 3, ConfigPac().data, b"\xb0\xfa\xfb\x03\0\0\0"]]


def mutated(rng: random.Random) -> bytes:
    """A short stream with up to four mutations."""
    data = bytearray(b"".join(rng.choices(samples(), k=rng.randrange(1, 5))))
    for _ in range(rng.randrange(5)):
        at = rng.randrange(len(data))
        action = rng.randrange(6)
        if action == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif action == 1:
            del data[at : at + rng.choice((1, 1, 2, 9))]
        elif action == 2:
            data[at:at] = rng.choice((b"\xfa", _HEADER, rng.randbytes(5), bytes(data[:at][-12:])))
        elif action == 3:
            data[at : at + 3] = _HEADER + bytes((rng.randrange(256),))
        elif action == 4:
            del data[at:]
        elif (start := data.find(_HEADER, at)) >= 0 and start + 2 < len(data):
            data[start + 2] = rng.randrange(256)
        if not data:
            data = bytearray(b"\xfa")
    return bytes(data)


def cut(rng: random.Random, data: bytes) -> list[bytes]:
    """The stream in some pieces."""
    edges = [0, *sorted(rng.randrange(len(data) + 1) for _ in range(rng.choice((0, 0, 1, 4)))), len(data)]
    return [data[a:b] for a, b in itertools.pairwise(edges)]


def read(pieces: list[bytes], at_once: bool) -> list[Row]:
    """Read the pieces as the chunks of a log."""
    offsets = Offsets()
    return list(packets([offsets.chunk(None, "r2c", data) for data in pieces], at_once))


@pytest.mark.tour(1)
@pytest.mark.parametrize(
    "part",
    [part if part < FEW_PARTS else pytest.param(part, marks=pytest.mark.wide) for part in range(PARTS)],
)
def test_agrees_with_the_firmware_on_mutated_streams(part: int) -> None:
    parser = Parser()
    for number in range(part * STREAMS // PARTS, (part + 1) * STREAMS // PARTS):
        rng = random.Random(SEED + number)
        data = mutated(rng)
        pieces = cut(rng, data)
        rows = read(pieces, number % 4 > 0)
        told = f"seed {SEED}, stream {number}: {[piece.hex() for piece in pieces]}"
        assert [row.data for row in rows if row.ok] == parser.parse(pieces), told
        assert b"".join(row.wire for row in rows) == data, told
        assert all(data.startswith(row.wire, row.offset) for row in rows), told


def _flip(rng: random.Random, packet: bytes) -> bytes:
    at = rng.randrange(len(packet))
    return packet[:at] + bytes((packet[at] ^ rng.randrange(1, 256),)) + packet[at + 1 :]


def _false_count(rng: random.Random, packet: bytes) -> bytes:
    return packet[:2] + bytes((rng.choice([n for n in range(256) if n != packet[2]]),)) + packet[3:]


def _delete(rng: random.Random, packet: bytes) -> bytes:
    at = rng.randrange(len(packet))
    return packet[:at] + packet[at + 1 :]


# Each with whether the packet that was hit is itself still whole.
DAMAGE: dict[str, tuple[Callable[[random.Random, bytes], bytes], bool]] = {
    "any byte flipped": (_flip, False),
    "wrong length byte": (_false_count, False),
    "a byte deleted": (_delete, False),
    "stray FA before": (lambda _, packet: b"\xfa" + packet, True),
    "stray FA FB before": (lambda _, packet: _HEADER + packet, True),
}


def drive(count: int) -> list[bytes]:
    """SIPs of a robot that drives about; no two are equal."""
    rng = random.Random(SEED)
    return [
        frame(
            Sip(
                type=0x33,
                x=n & 0x7FFF,
                y=n >> 15,
                th=rng.randrange(-2048, 2048),
                left_vel=rng.randrange(300),
                right_vel=rng.randrange(300),
                battery_x10=n & 0xFF,
                sonars=tuple(((5 * n + k) % 16, rng.randrange(150, 5001)) for k in range(5)),
            ).data
        )
        for n in range(count)
    ]


@pytest.mark.tour(2, 4)
@pytest.mark.parametrize("at_once", [True, False], ids=["each chunk", "many chunks"])
@pytest.mark.parametrize("kind", DAMAGE)
def test_of_ten_thousand_sips_no_intact_one_is_lost_and_none_made_up(kind: str, at_once: bool) -> None:
    action, is_whole = DAMAGE[kind]
    rng = random.Random(f"{SEED} {kind}")
    sips = drive(10_000)
    sent = [action(rng, packet) if n % 10 == 5 else packet for n, packet in enumerate(sips)]
    found = {row.wire for row in read(sent, at_once) if row.ok}
    intact = {packet for n, packet in enumerate(sips) if is_whole or n % 10 != 5}
    assert (len(intact - found), len(found - set(sips))) == (0, 0), f"seed {SEED}"
