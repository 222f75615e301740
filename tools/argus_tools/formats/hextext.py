# SPDX-License-Identifier: MIT
"""Bytes as hexadecimal text, as terminal programs save them: with or without a time and a direction in each line."""

from __future__ import annotations

import re
from binascii import unhexlify
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from io import BufferedReader
from itertools import pairwise
from typing import Final, NamedTuple

from argus_tools.catalogue import HELP
from argus_tools.chunks import (
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
from argus_tools.formats.marks import UNTOLD, directions, mark_at
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.stamps import Times
from argus_tools.formats.text import first_lines, is_passed, pieces
from hil_sim.arcos import Unframer

_HEADER: Final = b"\xfa\xfb"
_REPEATED: Final = "a * stands for lines that are not in the file; dump it again with -v, or with offsets"
_SNIFF_BYTES: Final = 6
_LINES: Final = 1 << 12
_BYTE_MIN, _BYTE_MAX = -128, 255
_HEX_BASE: Final = 16
_BLANK, _DELETE = 0x20, 0x7F
# No line with a column of characters is longer; bytes of a letter in UTF-8; what may stand round the column.
_SHOWN_MOST: Final = 1 << 10
_LETTER_MOST: Final = 3
_ROUND_SHOWN: Final = 80
# So many labels tell; so many digits has an offset where each line begins anew; sides that count for themselves.
_LABELS_MIN: Final = 2
_SIDES_MIN: Final = 2
# Of so many lines what stands before the bytes, and the base, are found.
_LABEL_LINES: Final = 1 << 7
_DIGIT_LINES: Final = 1 << 10
_OFFSET_DIGITS: Final = 4
_COUNTERS: Final = 3
_WIDE: Final = re.compile(rb"[ \t]{2}|\t|[|;#]")
_PREFIX: Final = rb"(?:0[xX]|\\x|\$)?"
_PAIR: Final = _PREFIX + rb"[0-9A-Fa-f]{2}[hH]?"
# No gap can be read in two ways: a line that is none would take for ever. Between tabs stands one byte each.
_GAP: Final = rb"(?:[ ]*[,;:-])?[ ]*"
_RUN: Final = re.compile(
    rb"[\"'{b]{0,2}(?P<run>"
    + _PAIR
    + rb"(?:(?:"
    + _GAP
    + _PAIR
    + rb")*|(?:[ ]*\t[ ]*"
    + _PAIR
    + rb")+))[,;]?[ ]*[\"'}]?;?[ -]*"
)
# What may part the bytes from the characters that some print behind them; the first that leaves only bytes counts.
_BEHIND: Final = tuple(map(re.compile, (rb"\Z", rb"\s*[|\t]", rb"\s{3}", rb"\s{2}", rb"\s[;<>\"'(]", rb",,")))
# What socat, jpnevulator and PuTTY write into a line of its own before the bytes, and between two of them.
_HEADING: Final = re.compile(rb"length=\d|/dev/|--\Z|(?:raw )?data\b")
# "Follow stream" of Wireshark as arrays of C, or raw: the side that spoke first, and the other.
_PEER: Final = re.compile(rb"char peer([01])_\d+\[\d*\] = \{")
_PEERS: Final = (b">", b"<")
_RAW: Final = re.compile(rb"\t?(?:[0-9A-Fa-f]{2})+\s*")
_PREFIXES: Final = re.compile(rb"0[xX]|\\x")
_NO_DIGITS: Final = b" \t,;:-hH$"
# An offset, or the number of a line or of milliseconds, before the bytes: with what programs put round it.
_LABEL: Final = re.compile(
    rb"(?:[0-9A-Fa-f]{4}:(?=[0-9A-Fa-f]{4}\s))?[\[(<]?(?:0[xX])?(?P<label>[0-9A-Fa-f]{1,16})[hH]?[\])>]?"
    rb"(?P<end>:[ \t]*|[ \t]+|[ \t]*\Z)"
)
_LABEL_BASES: Final = (16, 10, 8)
# Where the characters may begin, and what may stand before them.
_EACH_PAIR: Final = re.compile(_PREFIX + rb"([0-9A-Fa-f]{2})[hH]?")
_BEFORE_SHOWN: Final = re.compile(rb"[ \t]*[|;#'\"<>(][ ]?|[ \t]+")


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
    return re.compile(
        rb"(?:-[ ]+)?(?P<run>" + digits + rb"(?:[,;]?[ ]+" + digits + rb"|[,;]" + digits + rb")*)[,;]?"
    )


_HEX: Final = _Digits(_RUN, _hexadecimal)


def _binary(run: bytes) -> bytes | None:
    return bytes(int(number, 2) for number in re.findall(rb"[01]+", run))


def _unpadded(run: bytes) -> bytes | None:
    return bytes(int(number[-2:].lstrip(b"xX"), _HEX_BASE) for number in re.findall(rb"[0-9A-Fa-fxX]+", run))


_OTHER_DIGITS: Final = (
    _Digits(_numbers(rb"-?\d{1,3}"), _decimal),
    _Digits(_numbers(rb"\\?[0-3][0-7]{2}"), _octal),
    _Digits(_numbers(rb"[01]{8}"), _binary),
    _Digits(_numbers(rb"(?:0[xX])?[0-9A-Fa-f]{1,2}"), _unpadded),
)


@dataclass(frozen=True)
class _Shape:
    """What all lines have in common: the base of the bytes, and whether a number stands before them."""

    digits: _Digits
    is_labelled: bool = False


def _start(line: bytes, begins: bool, times: Times) -> tuple[float | None, bytes | None, bytes]:
    """Return time, mark and what stands behind them."""
    t = mark = None
    rest = line.strip()
    if begins:
        for _ in range(2):
            if t is None and (stamp := times.take(rest)):
                t, rest = stamp
            if mark is None and (found := mark_at(rest)):
                mark, rest = found.name, rest[found.end :]
    return t, mark, rest


def _shown(rest: bytes) -> bytes | None:
    """Return what stands before a column of characters; these are known by showing the very bytes before them.

    Gaps between the bytes do not mislead so, and characters that look like bytes are not taken for some.
    """
    if len(rest) > _SHOWN_MOST:
        return None
    pairs = list(_EACH_PAIR.finditer(rest))
    for count in range(len(pairs), 0, -1):
        end = pairs[count - 1].end()
        behind = _BEFORE_SHOWN.match(rest, end)
        if behind and _is_shown([int(pair[1], _HEX_BASE) for pair in pairs[:count]], rest[behind.end() :]):
            return rest[:end]
        if len(rest) - end > _LETTER_MOST * count + _ROUND_SHOWN:
            return None
    return None


def _is_shown(data: Sequence[int], column: bytes) -> bool:
    """Whether these characters are those of the bytes, one for each; blanks at the end of a line may be lost."""
    try:
        text = column.decode()
    except UnicodeDecodeError:
        text = column.decode("latin-1")
    if len(text) > len(data) and text[-1:] in "|\"'>)":
        text = text[:-1]
    if not text or len(text) > len(data):
        return False
    return all(_shows(letter, byte) for letter, byte in zip(text.ljust(len(data)), data, strict=True))


def _shows(letter: str, byte: int) -> bool:
    if _BLANK <= byte < _DELETE:
        return letter == chr(byte)
    return not (letter.isascii() and letter.isalnum())


def _candidates(rest: bytes) -> Iterator[bytes]:
    """Yield what may be the bytes of a line without the characters behind them, the likeliest first."""
    if not _WIDE.search(rest):
        yield rest
    if shown := _shown(rest):
        yield shown
    for behind in _BEHIND:
        yield behind.split(rest, maxsplit=1)[0]


def _data(rest: bytes, digits: _Digits) -> bytes | None:
    """Return the bytes of a line without what stands before them."""
    for candidate in _candidates(rest):
        # Words that begin as bytes do, and bytes that are cut, are none.
        if match := digits.run.fullmatch(candidate):
            data = digits.read(match["run"])
            if data is not None:
                return data
    return None


def _parse(line: bytes, begins: bool, times: Times, shape: _Shape = _Shape(_HEX)) -> _Piece:
    t, mark, rest = _start(line, begins, times)
    if shape.is_labelled and begins and (label := _LABEL.match(rest)):
        rest = rest[label.end() :]
        if not rest:
            return _Piece(t, mark, None)
    data = _data(rest, shape.digits)
    if data is not None:
        return _Piece(t, mark, data)
    if match := _PEER.match(rest):
        return _Piece(t, _PEERS[match[1] == b"1"], None)
    return _Piece(t, mark, None, bool(rest) and not _HEADING.match(rest))


def _is_labelled(lines: Sequence[bytes], digits: _Digits) -> bool:
    """Whether a number stands before the bytes of each line that is none of them: it counts bytes, or only rises."""
    times = Times()
    labels: list[bytes] = []
    sizes: list[int] = []
    is_parted = True
    for line in lines:
        _, _, rest = _start(line, True, times)
        label = _LABEL.match(rest)
        data = _data(rest[label.end() :], digits) if label else None
        if label and data is not None:
            labels.append(label["label"])
            sizes.append(len(data))
            is_parted &= label["end"].startswith(b":")
        elif _data(rest, digits) is not None and not (label and label.end() == len(rest)):
            labels.append(b"")
            sizes.append(0)
    if len(labels) < _LABELS_MIN or 2 * labels.count(b"") > len(labels):
        return False
    return any(_counts_bytes(labels, sizes, base) for base in _LABEL_BASES) or (is_parted and _rises(labels))


def _counts_bytes(labels: Sequence[bytes], sizes: Sequence[int], base: int) -> bool:
    """Whether each label is where the bytes before it end, of one side or of both, or begins anew."""
    try:
        numbers = [int(label, base) if label else -1 for label in labels]
    except ValueError:
        return False
    known = [0]
    fits = rising = 0
    for number, size in zip(numbers, sizes, strict=True):
        fits += number in known or not number
        rising += number in known and number > 0
        known = [*(end for end in known if end != number), number + size][-_COUNTERS:]
    return 4 * fits > 3 * len(labels) and (rising > 0 or min(map(len, labels)) >= _OFFSET_DIGITS)


def _rises(labels: Sequence[bytes]) -> bool:
    numbers = [int(label) if label.isdigit() else -1 for label in labels]
    return all(before <= after for before, after in pairwise(numbers)) and 0 <= numbers[0] < numbers[-1]


def _shape(lines: Sequence[bytes]) -> _Shape:
    return _shape_of(tuple(lines))


@lru_cache(maxsize=2)
def _shape_of(lines: tuple[bytes, ...]) -> _Shape:
    """Return how the lines hold most packets: the base is 16 unless they hold more in another."""
    usual = _Shape(_HEX, _is_labelled(lines[:_LABEL_LINES], _HEX))
    times = Times()
    pieces_of = [_parse(line, True, times, usual) for line in lines]
    if _packets(b"".join(piece.data or b"" for piece in pieces_of)) and not any(
        piece.is_strange for piece in pieces_of
    ):
        return usual
    few = lines[:_DIGIT_LINES]
    shapes = [usual, *(_Shape(digits, _is_labelled(few[:_LABEL_LINES], digits)) for digits in _OTHER_DIGITS)]
    return max(shapes, key=lambda shape: _packets(_bytes_of(few, shape)))


def _packets(data: bytes) -> int:
    return sum(1 for _ in Unframer().feed(data))


def _bytes_of(lines: Iterable[bytes], shape: _Shape) -> bytes:
    times = Times()
    return b"".join(_parse(line, True, times, shape).data or b"" for line in lines)


class HextextReader:
    """Reads the lines; time and direction of a line hold for those behind it that have none."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self.place = ""
        self._stream = stream
        self._asked = options.direction

    def __iter__(self) -> Iterator[Chunk]:
        offsets, times = Offsets(), Times()
        head = first_lines(self._stream.peek(HEAD_BYTES), _LINES)
        shape = _shape(head)
        is_follow = _is_follow(head)
        directions = self._directions(head, shape, is_follow)
        t: float | None = None
        mark = b""
        for number, text, begins in pieces(self._stream):
            if begins and is_passed(text):
                continue
            piece = _parse(text, begins, times, shape)
            t = t if piece.t is None else piece.t
            mark = _mark(mark, piece, text, is_follow and begins)
            if piece.data:
                direction = directions.get(mark) or directions[b""]
                self.place = f"line {number}"
                yield offsets.chunk(t, direction, piece.data)
            elif piece.is_strange:
                self.damage.append(
                    Damage(f"line {number}", _REPEATED if text.strip() == b"*" else "no hexadecimal bytes")
                )

    def _directions(self, head: Sequence[bytes], shape: _Shape, is_follow: bool) -> dict[bytes, Direction]:
        """Say which direction each mark is."""
        samples: dict[bytes, bytearray] = {}
        times, mark = Times(), b""
        for line in head:
            piece = _parse(line, True, times, shape)
            mark = _mark(mark, piece, line, is_follow)
            if piece.data:
                samples.setdefault(mark, bytearray()).extend(piece.data)
        found = directions({name: bytes(data) for name, data in samples.items()}, self._asked)
        if self._asked is None and set(samples) == {b""} and _has_both(head, shape):
            self.damage.append(Damage("line 1", f"{UNTOLD}; all is taken as {found[b'']}"))
        return found


def _has_both(lines: Sequence[bytes], shape: _Shape) -> bool:
    """Whether whole packets of both sides stand in lines of their own."""
    times = Times()
    each = (_parse(line, True, times, shape).data or b"" for line in lines)
    sides = [guess_direction(data) for data in each if any(len(one) > 1 for one in Unframer().feed(data))]
    return min(map(sides.count, (CLIENT_TO_ROBOT, ROBOT_TO_CLIENT))) >= _SIDES_MIN


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
    return _bytes_of(lines, _shape(lines))


def _sniff(head: bytes) -> bool:
    """Most of the first lines are such bytes, some of them at least, or the header of a packet is among them."""
    lines = first_lines(head)
    times, shape = Times(), _shape(lines)
    parsed = [_parse(line, True, times, shape) for line in lines]
    data = b"".join(piece.data for piece in parsed if piece.data)
    with_data = sum(piece.data is not None for piece in parsed)
    with_more = sum(piece.t is not None or piece.mark is not None for piece in parsed if piece.data is None)
    if len(data) < _SNIFF_BYTES and _HEADER not in data:
        return False
    return _HEADER in data if 2 * (with_data + with_more) < len(lines) else True


FORMAT: Final = Format(
    name="hextext",
    help=HELP["hextext"],
    sniff=_sniff,
    reader=HextextReader,
)
