# SPDX-License-Identifier: MIT
"""JSON lines {"t", "dir", "hex"}: one received chunk each; records without "hex" are passed over."""

from __future__ import annotations

import json
from collections.abc import Iterator
from io import BufferedReader
from typing import Any, BinaryIO, Final

from argus_tools.formats.base import Chunk, Damage, Direction, Format, Offsets, ReadOptions

LINE_MAX: Final = 1 << 20
_DIRECTIONS: Final = ("r2c", "c2r")
_DIRS: Final[dict[bytes, Direction]] = {b"r2c": "r2c", b"c2r": "c2r"}


def _sniff(head: bytes) -> bool:
    text = head.removeprefix(b"\xef\xbb\xbf").lstrip()
    return text.startswith(b"{") and b"\0" not in text[:256]


def _what_is_wrong(record: Any) -> str:
    if not isinstance(record, dict):
        return "not an object"
    if record.get("dir") not in _DIRECTIONS:
        return f'"dir" is {json.dumps(record.get("dir"))}, not "r2c" or "c2r"'
    t = record.get("t")
    if t is not None and (isinstance(t, bool) or not isinstance(t, int | float) or not abs(t) < 1e12):
        return f'"t" is {json.dumps(t)[:40]}, not seconds or null'
    return '"hex" is no even number of hexadecimal digits'


class JsonlReader:
    """Reads JSON lines; a line that is none is damage and the next one is read."""

    def __init__(self, stream: BufferedReader, _options: ReadOptions) -> None:
        self.damage: list[Damage] = []
        self._stream = stream

    def _lines(self) -> Iterator[tuple[int, bytes]]:
        readline = self._stream.readline
        number = 0
        while line := readline(LINE_MAX):
            number += 1
            if len(line) == LINE_MAX and line[-1] != 10:
                self.damage.append(Damage(f"line {number}", f"longer than {LINE_MAX} bytes"))
                while (line := readline(LINE_MAX)) and line[-1] != 10:
                    pass
                continue
            yield number, line

    def __iter__(self) -> Iterator[Chunk]:
        parse = json.JSONDecoder().raw_decode
        offsets = Offsets()
        at = offsets.at
        for number, line in self._lines():
            # As we write it ourselves; anything else is read as JSON.
            part = line.split(b'"')
            if (
                len(part) == 11
                and part[1] == b"t"
                and part[3] == b"dir"
                and part[7] == b"hex"
                and part[10] == b"}\n"
                and part[5] in _DIRS
            ):
                try:
                    t = float(part[2][2:-2])
                    data = bytes.fromhex(part[9].decode())
                except ValueError:
                    pass
                else:
                    if abs(t) < 1e12:
                        direction = _DIRS[part[5]]
                        offset = at[direction]
                        at[direction] = offset + len(data)
                        yield Chunk(t, direction, data, offset)
                        continue
            try:
                record, _ = parse(line.decode().lstrip("\ufeff \t\r"))
            except (ValueError, RecursionError):
                if line.strip():
                    self.damage.append(Damage(f"line {number}", "no JSON record"))
                continue
            try:
                text = record.get("hex")
                if text is None:
                    continue
                t, direction = record.get("t"), record["dir"]
                if type(t) is not float and _what_is_wrong({**record, "hex": ""})[:4] != '"hex':
                    raise ValueError
                data = bytes.fromhex(text)
                offset = at[direction]
                at[direction] = offset + len(data)
                if t is not None and not abs(t) < 1e12:
                    raise ValueError
            except (ValueError, KeyError, TypeError, AttributeError):
                self.damage.append(Damage(f"line {number}", _what_is_wrong(record)))
                continue
            yield Chunk(t, direction, data, offset)


class JsonlWriter:
    """Writes one line for each chunk."""

    def __init__(self, stream: BinaryIO, _options: ReadOptions) -> None:
        self._stream = stream

    def write(self, chunk: Chunk) -> None:
        """Append a line."""
        t = "null" if chunk.t is None else repr(chunk.t)
        self._stream.write(f'{{"t": {t}, "dir": "{chunk.dir}", "hex": "{chunk.data.hex()}"}}\n'.encode())

    def close(self) -> None:
        """Nothing stands at the end."""


FORMAT: Final = Format(
    name="jsonl",
    help='JSON lines {"t", "dir", "hex"}',
    sniff=_sniff,
    reader=JsonlReader,
    writer=JsonlWriter,
    suffixes=(".jsonl", ".json", ".ndjson"),
)
