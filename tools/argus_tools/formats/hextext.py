# SPDX-License-Identifier: MIT
"""Bytes as hexadecimal text, as terminal programs save them: with or without a time and a direction in each line."""

from __future__ import annotations

import re
from binascii import unhexlify
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from io import BufferedReader
from typing import Final, NamedTuple

from argus_tools.formats.base import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    Direction,
    Format,
    Offsets,
    ReadOptions,
)
from argus_tools.formats.bin import guess_direction
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.text import BOM, first_lines, pieces

_HEADER: Final = b"\xfa\xfb"
_REPEATED: Final = "a * stands for lines that are not in the file; dump it again with -v, or with offsets"
_SNIFF_BYTES: Final = 6
_DAY_S: Final = 86400.0
_DATES: Final = ("%Y-%m-%d", "%Y/%m/%d", "%Y.%m.%d", "%d.%m.%Y", "%m/%d/%Y", "%d/%m/%Y")
# [2026-11-25T06:38:47.479+01:00], (06:38:47:479), 06:38:47, and the time since the line before, which some add.
_CLOCK: Final = (
    rb"(?:(?P<date>\d{4}([-/.])\d\d?\2\d\d?|\d\d?([-/.])\d\d?\3\d{4})[ T,]+)?"
    rb"(?P<hour>\d\d?):(?P<minute>\d\d):(?P<second>\d\d)(?:[.,:](?P<fraction>\d{1,9}))?"
    rb"(?:[ ]?(?P<half>[AaPp][Mm]))?(?:Z|(?P<zone>[+-]\d\d:?\d\d))?"
)
_SINCE: Final = rb"(?P<since>[+]?\d{1,12}\.\d{1,9})(?:[ ]?s)?"
_TIME: Final = re.compile(
    rb"[\[({]?[ ]*(?:"
    + _CLOCK
    + rb"|"
    + _SINCE
    + rb")(?:[ ]+[+]?\d{1,9}\.\d{1,9})?[ ]*[\])}]?[ \t]*(?:[:;,|-]?(?:[ \t]+|\Z)|[,;])"
)
_MARK: Final = re.compile(
    rb"[\[(<]?(?P<mark>RXD?|TXD?|RECV|SENT|SEND|RECEIVED|READ|WRITE|WRITTEN|IN|OUT|RCV|SND|-+>|<-+|<<|>>|<|>)[\])>]?"
    rb"[ \t]*[:=|-]?(?:[ \t]+|\Z)",
    re.IGNORECASE,
)
_TO_ROBOT: Final = frozenset(
    (b"TX", b"TXD", b"SENT", b"SEND", b"WRITE", b"WRITTEN", b"OUT", b"SND", b">", b">>")
)
_PAIR: Final = rb"(?:0[xX]|\\x|\$)?[0-9A-Fa-f]{2}[hH]?"
_RUN: Final = re.compile(
    rb"[\"'{b]{0,2}(?P<run>" + _PAIR + rb"(?:[,;:-]?[ ]*" + _PAIR + rb")*)[,;]?[ ]*[\"'}]?;?"
)
# What may part the bytes from the characters that some print behind them; the first that leaves only bytes counts.
_BEHIND: Final = tuple(map(re.compile, (rb"\Z", rb"\s*[|\t]", rb"\s{3}", rb"\s{2}", rb"\s[;<>\"'(]", rb",,")))
# What socat and jpnevulator write into a line of its own before the bytes, and between two of them.
_HEADING: Final = re.compile(rb"length=\d|/dev/|--\Z")
_PREFIXES: Final = re.compile(rb"0[xX]|\\x")
_NO_DIGITS: Final = b" ,;:-hH$"


class _Piece(NamedTuple):
    """What stands in a line: its time, its mark of direction and its bytes, each None if it has none."""

    t: float | None
    mark: bytes | None
    data: bytes | None
    # Whether there is something else.
    is_strange: bool = False


@dataclass
class _Times:
    """Makes one rising time of clocks without a date, which begin anew at midnight."""

    days_s: float = 0.0
    last: float = 0.0

    def at(self, match: re.Match[bytes]) -> float:
        if match["since"]:
            return float(match["since"])
        hour = int(match["hour"])
        if match["half"]:
            hour = hour % 12 + 12 * (match["half"].lower() == b"pm")
        t = hour * 3600.0 + int(match["minute"]) * 60 + int(match["second"])
        t += float(b"0." + (match["fraction"] or b"0"))
        if match["date"]:
            return _midnight(match["date"].decode()) + t - _zone_s(match["zone"])
        if t + self.days_s < self.last - _DAY_S / 2:
            self.days_s += _DAY_S
        self.last = t + self.days_s
        return self.last


def _zone_s(zone: bytes | None) -> float:
    if not zone:
        return 0.0
    hours, minutes = int(zone[1:3]), int(zone[-2:])
    return (hours * 3600.0 + minutes * 60.0) * (-1 if zone[:1] == b"-" else 1)


def _midnight(date: str) -> float:
    for form in _DATES:
        try:
            return datetime.strptime(date, form).replace(tzinfo=UTC).timestamp()
        except ValueError:
            continue
    return 0.0


def _parse(line: bytes, begins: bool, times: _Times) -> _Piece:
    t = mark = None
    rest = line.strip()
    if begins:
        for _ in range(2):
            if t is None and (match := _TIME.match(rest)):
                t, rest = times.at(match), rest[match.end() :]
            if mark is None and (match := _MARK.match(rest)):
                mark, rest = match["mark"].upper().replace(b"-", b""), rest[match.end() :]
    for behind in _BEHIND:
        # Words that begin as bytes do, and bytes that are cut, are none.
        if match := _RUN.fullmatch(behind.split(rest, maxsplit=1)[0]):
            text = _PREFIXES.sub(b"", match["run"])
            return _Piece(t, mark, unhexlify(text.translate(None, _NO_DIGITS)))
    return _Piece(t, mark, None, bool(rest) and not _HEADING.match(rest))


class HextextReader:
    """Reads the lines; time and direction of a line hold for those behind it that have none."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._asked = options.direction

    def __iter__(self) -> Iterator[Chunk]:
        offsets, times = Offsets(), _Times()
        directions = self._directions(self._stream.peek(HEAD_BYTES))
        t: float | None = None
        mark = b""
        for number, text, begins in pieces(self._stream):
            piece = _parse(text.removeprefix(BOM), begins, times)
            t = t if piece.t is None else piece.t
            mark = mark if piece.mark is None else piece.mark
            if piece.data:
                direction = directions.get(mark) or directions[b""]
                yield offsets.chunk(t, direction, piece.data)
            elif piece.is_strange and not text.startswith(b"#"):
                self.damage.append(
                    Damage(f"line {number}", _REPEATED if text.strip() == b"*" else "no hexadecimal bytes")
                )

    def _directions(self, head: bytes) -> dict[bytes, Direction]:
        """Say which direction each mark is; what a client calls sent goes to the robot, if the bytes do not deny it."""
        samples: dict[bytes, bytearray] = {}
        times, mark = _Times(), b""
        for line in first_lines(head, 1 << 12):
            piece = _parse(line, True, times)
            mark = mark if piece.mark is None else piece.mark
            if piece.data:
                samples.setdefault(mark, bytearray()).extend(piece.data)
        everything = b"".join(samples.values())
        found: dict[bytes, Direction] = {b"": self._asked or guess_direction(everything)}
        marked = {name: bytes(data) for name, data in samples.items() if name}
        turned = any(
            name in _TO_ROBOT and guess_direction(data) == ROBOT_TO_CLIENT for name, data in marked.items()
        )
        for name in marked:
            found[name] = CLIENT_TO_ROBOT if (name in _TO_ROBOT) != turned else ROBOT_TO_CLIENT
        return found


def bytes_of_lines(lines: Iterable[bytes]) -> bytes:
    """Return what these lines hold as text of this form, whatever the direction."""
    times = _Times()
    return b"".join(_parse(line, True, times).data or b"" for line in lines)


def _sniff(head: bytes) -> bool:
    """Most of the first lines are such bytes, some of them at least, or the header of a packet is among them."""
    lines = first_lines(head)
    times = _Times()
    parsed = [_parse(line, True, times) for line in lines]
    data = b"".join(piece.data for piece in parsed if piece.data)
    with_data = sum(piece.data is not None for piece in parsed)
    with_more = sum(piece.t is not None or piece.mark is not None for piece in parsed if piece.data is None)
    if len(data) < _SNIFF_BYTES and _HEADER not in data:
        return False
    return _HEADER in data if 2 * (with_data + with_more) < len(lines) else True


FORMAT: Final = Format(
    name="hextext",
    help="hexadecimal text of a terminal program, with or without times",
    sniff=_sniff,
    reader=HextextReader,
)
