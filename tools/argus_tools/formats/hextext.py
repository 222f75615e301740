# SPDX-License-Identifier: MIT
"""Bytes as hexadecimal text, as terminal programs save them: with or without a time and a direction in each line."""

from __future__ import annotations

import re
from binascii import unhexlify
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
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
from argus_tools.formats.stamps import Times
from argus_tools.formats.text import first_lines, is_passed, pieces
from hil_sim.arcos import Unframer

_HEADER: Final = b"\xfa\xfb"
_REPEATED: Final = "a * stands for lines that are not in the file; dump it again with -v, or with offsets"
_SNIFF_BYTES: Final = 6
_LINES: Final = 1 << 12
_BYTE_MIN, _BYTE_MAX = -128, 255
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
# "Follow stream" of Wireshark as arrays of C, or raw: the side that spoke first, and the other.
_PEER: Final = re.compile(rb"char peer([01])_\d+\[\d*\] = \{")
_PEERS: Final = (b">", b"<")
_RAW: Final = re.compile(rb"\t?(?:[0-9A-Fa-f]{2})+\s*")
_PREFIXES: Final = re.compile(rb"0[xX]|\\x")
_NO_DIGITS: Final = b" ,;:-hH$"


class _Piece(NamedTuple):
    """What stands in a line: its time, its mark of direction and its bytes, each None if it has none."""

    t: float | None
    mark: bytes | None
    data: bytes | None
    # Whether there is something else.
    is_strange: bool = False


@dataclass(frozen=True)
class _Digits:
    """A base in which bytes are written: how a run of them looks, and how it is read."""

    run: re.Pattern[bytes]
    read: Callable[[bytes], bytes | None]


def _hexadecimal(run: bytes) -> bytes:
    return unhexlify(_PREFIXES.sub(b"", run).translate(None, _NO_DIGITS))


def _decimal(run: bytes) -> bytes | None:
    values = [int(number) for number in re.findall(rb"-?\d+", run)]
    if not all(_BYTE_MIN <= value <= _BYTE_MAX for value in values):
        return None
    return bytes(value & _BYTE_MAX for value in values)


def _octal(run: bytes) -> bytes | None:
    values = [int(number, 8) for number in re.findall(rb"\d+", run)]
    return bytes(values) if max(values) <= _BYTE_MAX else None


def _numbers(digits: bytes) -> re.Pattern[bytes]:
    return re.compile(rb"(?P<run>" + digits + rb"(?:[,;]?[ ]+" + digits + rb"|[,;]" + digits + rb")*)[,;]?")


_HEX: Final = _Digits(_RUN, _hexadecimal)
_OTHER_DIGITS: Final = (
    _Digits(_numbers(rb"-?\d{1,3}"), _decimal),
    _Digits(_numbers(rb"\\?[0-3][0-7]{2}"), _octal),
)


def _parse(line: bytes, begins: bool, times: Times, digits: _Digits = _HEX) -> _Piece:
    t = mark = None
    rest = line.strip()
    if begins:
        for _ in range(2):
            if t is None and (stamp := times.take(rest)):
                t, rest = stamp
            if mark is None and (match := _MARK.match(rest)):
                mark, rest = match["mark"].upper().replace(b"-", b""), rest[match.end() :]
    for behind in _BEHIND:
        # Words that begin as bytes do, and bytes that are cut, are none.
        if match := digits.run.fullmatch(behind.split(rest, maxsplit=1)[0]):
            data = digits.read(match["run"])
            if data is not None:
                return _Piece(t, mark, data)
    if match := _PEER.match(rest):
        return _Piece(t, _PEERS[match[1] == b"1"], None)
    return _Piece(t, mark, None, bool(rest) and not _HEADING.match(rest))


def _digits(lines: Sequence[bytes]) -> _Digits:
    """Return the base in which the lines hold packets; it is 16 unless they hold some in another alone."""
    if _HEADER in _bytes_of(lines, _HEX):
        return _HEX
    holding = (other for other in _OTHER_DIGITS if any(Unframer().feed(_bytes_of(lines, other))))
    return next(holding, _HEX)


def _bytes_of(lines: Iterable[bytes], digits: _Digits) -> bytes:
    times = Times()
    return b"".join(_parse(line, True, times, digits).data or b"" for line in lines)


class HextextReader:
    """Reads the lines; time and direction of a line hold for those behind it that have none."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._asked = options.direction

    def __iter__(self) -> Iterator[Chunk]:
        offsets, times = Offsets(), Times()
        head = first_lines(self._stream.peek(HEAD_BYTES), _LINES)
        digits = _digits(head)
        is_follow = _is_follow(head)
        directions = self._directions(head, digits, is_follow)
        t: float | None = None
        mark = b""
        for number, text, begins in pieces(self._stream):
            piece = _parse(text, begins, times, digits)
            t = t if piece.t is None else piece.t
            mark = _mark(mark, piece, text, is_follow and begins)
            if piece.data:
                direction = directions.get(mark) or directions[b""]
                yield offsets.chunk(t, direction, piece.data)
            elif piece.is_strange and not is_passed(text):
                self.damage.append(
                    Damage(f"line {number}", _REPEATED if text.strip() == b"*" else "no hexadecimal bytes")
                )

    def _directions(self, head: Sequence[bytes], digits: _Digits, is_follow: bool) -> dict[bytes, Direction]:
        """Say which direction each mark is; what a client calls sent goes to the robot, if the bytes do not deny it."""
        samples: dict[bytes, bytearray] = {}
        times, mark = Times(), b""
        for line in head:
            piece = _parse(line, True, times, digits)
            mark = _mark(mark, piece, line, is_follow)
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


def _is_follow(lines: Sequence[bytes]) -> bool:
    """Whether these are "follow stream" in raw form, where the lines of one side begin with a tab."""
    indents = {line.startswith(b"\t") for line in lines if _RAW.fullmatch(line)}
    return len(indents) > 1 and all(_RAW.fullmatch(line) for line in lines)


def _mark(last: bytes, piece: _Piece, line: bytes, is_follow: bool) -> bytes:
    """Return the mark of a line, which is that of the line before if it has none."""
    if is_follow and piece.data:
        return _PEERS[line.startswith(b"\t")]
    return last if piece.mark is None else piece.mark


def bytes_of_lines(lines: Sequence[bytes]) -> bytes:
    """Return what these lines hold as text of this form, whatever the direction."""
    return _bytes_of(lines, _digits(lines))


def _sniff(head: bytes) -> bool:
    """Most of the first lines are such bytes, some of them at least, or the header of a packet is among them."""
    lines = first_lines(head)
    times, digits = Times(), _digits(lines)
    parsed = [_parse(line, True, times, digits) for line in lines]
    data = b"".join(piece.data for piece in parsed if piece.data)
    with_data = sum(piece.data is not None for piece in parsed)
    with_more = sum(piece.t is not None or piece.mark is not None for piece in parsed if piece.data is None)
    if len(data) < _SNIFF_BYTES and _HEADER not in data:
        return False
    return _HEADER in data if 2 * (with_data + with_more) < len(lines) else True


FORMAT: Final = Format(
    name="hextext",
    help="hexadecimal, decimal or octal text of a terminal program, with or without times",
    sniff=_sniff,
    reader=HextextReader,
)
