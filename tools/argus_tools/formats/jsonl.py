# SPDX-License-Identifier: MIT
"""JSON records {"t", "dir", "hex"}, in lines or in an array: one received chunk each; others are passed over."""

from __future__ import annotations

import json
import re
from binascii import unhexlify
from collections.abc import Iterator
from io import BufferedReader
from typing import Any, BinaryIO, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, Damage, DamageList, Direction, Format, Offsets, ReadOptions
from argus_tools.formats.source import BLOCK_BYTES, HEAD_BYTES
from argus_tools.formats.text import Rewritten, first_lines, is_passed

LINE_MAX: Final = 1 << 20
T_MAX_S: Final = 1e12
_KEY: Final = b'"hex"'
# How records of tshark, of containers and of the journal begin, and what a wiki puts above a block.
_FOREIGN: Final = re.compile(rb'\{\s*"(?:index|timestamp|_index|log|MESSAGE|_[A-Z_]+)"|\{[a-z]+[}:]')
# What nests; a backslash takes the next byte with it.
_TOKEN: Final = re.compile(rb'\\.|["{}]', re.DOTALL)
_PARSER: Final = json.JSONDecoder()
_DIRECTIONS: Final = ("r2c", "c2r")
_USUAL: Final = re.compile(rb'\{"t": (-?[0-9][^,_]*), "dir": "(r2c|c2r)", "hex": "([^"]*)"\}\n')
_DIRS: Final[dict[bytes, Direction]] = {b"r2c": "r2c", b"c2r": "c2r"}


def _sniff(head: bytes) -> bool:
    """A record begins a line, or an array of them; what stands above the first is told as it is read."""
    lines = [line.lstrip() for line in first_lines(head)]
    if not any(line.startswith((b"{", b"[")) for line in lines):
        return False
    return _KEY in head or (lines[0].startswith(b"{") and not _FOREIGN.match(lines[0]))


def _is_array(head: bytes) -> bool:
    lines = first_lines(head)
    return bool(lines) and lines[0].lstrip().startswith(b"[")


class Records(Rewritten):
    """The elements of an array, each in a line of its own however they are laid out."""

    def __init__(self, stream: BufferedReader) -> None:
        super().__init__(stream)
        self._depth = 0
        self._in_string = False
        self._held = b""

    def _rewrite(self, data: bytes) -> bytes:
        """Return what an array's objects hold; what stands between them ends a line."""
        data = self._held + data
        self._held = data[len(data.rstrip(b"\\")) :]
        data = data.removesuffix(self._held)
        out: list[bytes] = []
        at = 0
        for found in _TOKEN.finditer(data):
            token = found[0]
            if self._in_string:
                self._in_string = token != b'"'
            elif token == b'"':
                self._in_string = True
            elif token == b"{":
                at = at if self._depth else found.start()
                self._depth += 1
            elif token == b"}" and self._depth:
                self._depth -= 1
                if not self._depth:
                    out.append(_in_a_line(data[at : found.end()]) + b"\n")
                    at = found.end()
        if self._depth:
            out.append(_in_a_line(data[at:]))
        return b"".join(out)


def _in_a_line(text: bytes) -> bytes:
    return text.replace(b"\n", b" ").replace(b"\r", b" ")


def _what_is_wrong(record: Any) -> str:
    if not isinstance(record, dict):
        return "not an object"
    if record.get("dir") not in _DIRECTIONS:
        return f'"dir" is {json.dumps(record.get("dir"))}, not "r2c" or "c2r"'
    t = record.get("t")
    if t is not None and (isinstance(t, bool) or not isinstance(t, int | float) or not abs(t) < T_MAX_S):
        return f'"t" is {json.dumps(t)[:40]}, not seconds or null'
    return '"hex" is no even number of hexadecimal digits'


class JsonlReader:
    """Reads JSON lines; a line that is none is damage and the next one is read."""

    def __init__(self, stream: BufferedReader, _options: ReadOptions) -> None:
        self.damage = DamageList()
        self._number = 0
        self._stream = stream
        self._unit = "line"

    def _skip_line(self, number: int) -> None:
        self.damage.append(Damage(f"{self._unit} {number}", f"longer than {LINE_MAX} bytes"))
        while (line := self._stream.readline(LINE_MAX)) and line[-1] != 10:
            pass

    @property
    def place(self) -> str:
        """Where in the file the last chunk stands."""
        return f"{self._unit} {self._number}"

    def __iter__(self) -> Iterator[Chunk]:
        if _is_array(self._stream.peek(HEAD_BYTES)):
            self._unit = "record"
            self._stream = BufferedReader(Records(self._stream), BLOCK_BYTES)
        match, new = _USUAL.fullmatch, tuple.__new__
        offsets = Offsets()
        at = offsets.at
        readline = self._stream.readline
        number = 0
        while line := readline(LINE_MAX):
            number += 1
            # As we write it ourselves; anything else is read as JSON.
            if usual := match(line):
                number_text, name, digits = usual.groups()
                try:
                    t = float(number_text)
                    data = unhexlify(digits)
                except ValueError:
                    pass
                else:
                    if abs(t) < T_MAX_S:
                        direction = _DIRS[name]
                        offset = at[direction]
                        at[direction] = offset + len(data)
                        self._number = number
                        yield new(Chunk, (t, direction, data, offset))
                        continue
            if found := self._read(line, number):
                self._number = number
                yield offsets.chunk(*found)

    def _read(self, line: bytes, number: int) -> tuple[float | None, Direction, bytes] | None:
        """Read a line that may hold any JSON; tell what is wrong with it."""
        if len(line) == LINE_MAX and line[-1] != 10:
            self._skip_line(number)
            return None
        try:
            record, _ = _PARSER.raw_decode(line.decode().lstrip(" \t\r"))
        except (ValueError, RecursionError):
            if line.strip() and not is_passed(line):
                self.damage.append(Damage(f"{self._unit} {number}", "no JSON record"))
            return None
        try:
            text = record.get("hex")
            if text is None:
                return None
            t, direction = record.get("t"), record["dir"]
            if type(t) is not float and _what_is_wrong({**record, "hex": ""})[:4] != '"hex':
                raise ValueError
            data = bytes.fromhex(text)
            if direction not in _DIRECTIONS or (t is not None and not abs(t) < T_MAX_S):
                raise ValueError
        except (ValueError, KeyError, TypeError, AttributeError):
            self.damage.append(Damage(f"{self._unit} {number}", _what_is_wrong(record)))
            return None
        return t, direction, data


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
    help=HELP["jsonl"],
    sniff=_sniff,
    reader=JsonlReader,
    writer=JsonlWriter,
    suffixes=(".jsonl", ".json", ".ndjson"),
)
