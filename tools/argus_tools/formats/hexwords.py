# SPDX-License-Identifier: MIT
"""Bytes that stand among other words: in logs of programs, in brackets, as literals of Python, as lists of numbers."""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterable, Iterator
from io import BufferedReader
from typing import Final

from argus_tools.formats.base import Chunk, DamageList, Format, Offsets, ReadOptions
from argus_tools.formats.bin import guess_direction
from argus_tools.formats.hextext import bytes_of_lines
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.text import BOM, first_lines, pieces
from hil_sim.arcos import Unframer

_PACKETS: Final = 2
"""So many whole packets with the right checksum are no chance."""
_BYTE_MAX: Final = 255
_LINES: Final = 1 << 12
# What some draw between columns, and in the middle of one.
_FRAME: Final = re.compile(rb"\xe2[\x94\x95].")
_MIDDLE: Final = re.compile(rb" *\xe2\x94\x8a *")
_LITERAL: Final = re.compile(rb"""b(?:'(?:[^'\\]|\\.)*'|"(?:[^"\\]|\\.)*")""")
_BRACKETED: Final = re.compile(rb"(?:\[|<|\(|\{)(?:0[xX])?([0-9A-Fa-f]{2})(?:\]|>|\)|\})")
_PREFIXED: Final = re.compile(rb"(?<![0-9A-Za-z])0[xX]([0-9A-Fa-f]{2})(?![0-9A-Za-z])")
_RUN: Final = re.compile(rb"(?<![0-9A-Za-z.])[0-9A-Fa-f]{2}(?:[,:;-]?[ ]{0,2}[0-9A-Fa-f]{2})*(?![0-9A-Za-z])")
_NUMBERS: Final = re.compile(rb"\[\s*\d{1,3}(?:\s*,\s*\d{1,3})+\s*\]")
_NO_DIGITS: Final = b" ,:;-"


def _literals(line: bytes) -> bytes:
    try:
        return b"".join(ast.literal_eval(text.decode("latin-1")) for text in _LITERAL.findall(line))
    except (SyntaxError, ValueError):
        return b""


def _bracketed(line: bytes) -> bytes:
    return bytes.fromhex(b"".join(_BRACKETED.findall(line)).decode())


def _prefixed(line: bytes) -> bytes:
    return bytes.fromhex(b"".join(_PREFIXED.findall(line)).decode())


def _run(line: bytes) -> bytes:
    """The last run that is not much shorter than the longest: times and addresses stand before, and are short."""
    found = [
        run.translate(None, _NO_DIGITS) for run in _RUN.findall(_FRAME.sub(b"|", _MIDDLE.sub(b" ", line)))
    ]
    long = [run for run in found if 2 * len(run) >= max(map(len, found))]
    return bytes.fromhex(long[-1].decode()) if long else b""


def _numbers(line: bytes) -> bytes:
    values = [int(text) for found in _NUMBERS.findall(line) for text in found.strip(b"[]").split(b",")]
    return bytes(values) if values and max(values) <= _BYTE_MAX else b""


_Way = Callable[[bytes], bytes]
_WAYS: Final[tuple[_Way, ...]] = (_literals, _bracketed, _prefixed, _run, _numbers)


def _holds_packets(data: bytes, least: int = _PACKETS) -> bool:
    return sum(len(packet) > 1 for packet in Unframer().feed(data)) >= least


def _way(lines: Iterable[bytes]) -> _Way | None:
    """In which of these ways the lines hold packets, if in any."""
    kept = list(lines)
    return next((way for way in _WAYS if _holds_packets(b"".join(map(way, kept)))), None)


class HexwordsReader:
    """Takes the bytes out of each line; what else stands there is passed over."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._direction = options.direction

    def __iter__(self) -> Iterator[Chunk]:
        offsets = Offsets()
        head = first_lines(self._stream.peek(HEAD_BYTES), _LINES)
        way = _way(head) or _run
        usual = self._direction or guess_direction(b"".join(map(way, head)))
        for _, text, _ in pieces(self._stream):
            line = text.removeprefix(BOM)
            if data := b"" if line.startswith(b"#") else way(line):
                tells = self._direction is None and _holds_packets(data, 1)
                yield offsets.chunk(None, guess_direction(data) if tells else usual, data)


def _sniff(head: bytes) -> bool:
    lines = first_lines(head, _LINES)
    return bool(lines) and not _holds_packets(bytes_of_lines(lines)) and _way(lines) is not None


FORMAT: Final = Format(
    name="hexwords",
    help="bytes among other words: logs of programs, brackets, literals of Python, lists of numbers",
    sniff=_sniff,
    reader=HexwordsReader,
)
