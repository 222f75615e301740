# SPDX-License-Identifier: MIT
"""candump logs of the ISO-TP link: `candump -L`, and what candump prints on the screen, with any of its options."""

from __future__ import annotations

import re
from binascii import unhexlify
from collections.abc import Iterator
from datetime import UTC, datetime
from io import BufferedReader
from itertools import pairwise
from typing import Any, BinaryIO, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    Direction,
    Format,
    ReadOptions,
)
from argus_tools.formats.isotp import ID_FROM_ROBOT, ID_TO_ROBOT, NEXT_BYTES, CanLink
from argus_tools.formats.text import first_lines

PDU_MAX: Final = 4095
_PADDING: Final = b"\xcc"
_FRAME_BYTES: Final = 8
_LINE_MAX: Final = 4096
_ID: Final = rb"([0-9A-Fa-f]{3}|[0-9A-Fa-f]{8})"
# No interface has a colon in its name; a number that is none of a channel is a time that something else put there.
_BUS: Final = rb"((?!\d+\.\d)[^\s#()\[\]{}:]+)"
# No computer has more of them.
_BUSES_MOST: Final = 16
_LINE: Final = re.compile(
    rb"\s*(?:\(\s*(-?\d{1,12}\.\d{1,9})\)\s+)?(?:" + _BUS + rb"\s+)?" + _ID + rb"#"
    rb"(?:R[0-9A-Fa-f_]*|(?:#[0-9A-Fa-f])?([0-9A-Fa-f.]*))(?:\s+[RTX])*\s*(?:::.*)?",
    re.DOTALL,
)
# Time and interface may be missing: as cansend takes it, "640#06.FA.FB".
_USUAL: Final = re.compile(rb"\((\d{1,12}\.\d{1,9})\) (\S+) ([0-9A-Fa-f]{3})#([0-9A-Fa-f]{2,16})\n")
# What candump prints without -L: time by -t, marks by -x, length in braces by -8.
_SCREEN: Final = re.compile(
    rb"\s*(?:\(\s*(?:(\d{4}-\d\d-\d\d[ T]\d\d:\d\d:\d\d\.\d{1,9})|(-?\d{1,12}\.\d{1,9}))\)\s+)?"
    + _BUS
    + rb"\s+(?:[RT]X\s+\S\s+\S\s+)?"
    + _ID
    + rb"\s+([\[{])\s*([0-9A-Fa-f]{1,2})\s*[\]}](.*)",
    re.DOTALL,
)
_RELATIVE: Final = re.compile(rb"^\s*\(\s*(-?\d{1,8}\.\d{1,9})\)", re.MULTILINE)
# What cantools decode prints below a frame that its database knows, up to the closing bracket.
_MESSAGE: Final = re.compile(rb"\w+\(\s*\Z")
_COLOUR: Final = re.compile(rb"\x1b\[[0-9;]*[A-Za-z]")
# The digits of -i are eight to a byte; -S turns the bytes round and marks them with another separator.
_BITS: Final = re.compile(rb"[01]{8}(?:[ `][01]{8})*")
_SWAPPED: Final = b"`"
_ID_DIGITS: Final = 3
_NO_DATA: Final = (b"remote request", b"ERRORFRAME")
# Below this a time is not since 1970 but since another line.
_RELATIVE_MAX_S: Final = 1e8
# A log of `candump -td` has more falling times than one of these; one of -tz falls where it was begun anew.
_FALLS_OF_DELTA: Final = 10

Fields = tuple[bytes | float | None, bytes, bytes, bytes]


class _Clock:
    """Adds up the times of -td, which count from the line before; those of the other options are as they are."""

    def __init__(self, head: bytes) -> None:
        times = [float(match[1]) for match in _RELATIVE.finditer(head)]
        falls = sum(after < before for before, after in pairwise(times))
        self.is_delta = falls * _FALLS_OF_DELTA > len(times)
        self._sum = 0.0

    def at(self, t: float) -> float:
        if not self.is_delta or t > _RELATIVE_MAX_S:
            return t
        self._sum += t
        return round(self._sum, 9)


class CandumpReader:
    """Reads lines of either form, also of both; comments (#) and what explains an error frame are passed over."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._link = CanLink(options, self.damage, "line")
        self._in_message = False

    @property
    def place(self) -> str:
        """Where in the file the last chunk ends."""
        return self._link.place

    def __iter__(self) -> Iterator[Chunk]:
        directions: dict[tuple[bytes, bytes], Direction | None] = {}
        usual, transfers, link = _USUAL.fullmatch, self._link.transfers, self._link
        number = 0
        clock: _Clock | None = None
        while line := self._stream.readline(_LINE_MAX):
            number += 1
            match = usual(line)
            fields: Any = match.groups() if match else self._unusual(line, number)
            if fields is None:
                continue
            t, bus, can_id, digits = fields
            if t is not None and (clock is None or clock.is_delta):
                clock = clock or _Clock(line + self._stream.peek(_LINE_MAX))
                t = clock.at(float(t))
            try:
                direction = directions[bus, can_id]
            except KeyError:
                is_long = len(can_id) != _ID_DIGITS
                direction = link.direction(bus.decode("latin-1"), int(can_id, 16), is_long, number)
                directions[bus, can_id] = direction
            if direction is None or not digits:
                continue
            try:
                frame = unhexlify(digits)
            except ValueError:
                frame = self._dotted(digits, number)
            transfer = transfers.get(direction)
            if (
                transfer
                and frame[:1] == NEXT_BYTES[transfer.next_number]
                and len(transfer.data) + len(frame) <= transfer.total
            ):
                # The middle of a message: most lines of most logs.
                transfer.data += frame[1:]
                transfer.next_number = (transfer.next_number + 1) & 0xF
                continue
            yield from link.take(None if t is None else float(t), direction, frame, number)
        yield from link.finish()

    def _unusual(self, line: bytes, number: int) -> Fields | None:
        """Return time, bus, id and digits of a line that is not as -L writes most of them."""
        line = _COLOUR.sub(b"", line)
        if match := _LINE.fullmatch(line):
            t, bus, can_id, digits = match.groups()
            return t, bus or b"", can_id, digits
        if match := _SCREEN.fullmatch(line):
            return self._screen(match, number)
        if line.strip() and not line.startswith((b"#", b"\t")) and not self._is_decoded(line):
            self.damage.append(Damage(f"line {number}", "no line of candump"))
        return None

    def _is_decoded(self, line: bytes) -> bool:
        """Whether a line is one of those in which cantools decode explains the frame before."""
        self._in_message |= bool(_MESSAGE.match(line))
        is_inside = self._in_message
        self._in_message &= not line.startswith(b")")
        return is_inside

    def _screen(self, match: re.Match[bytes], number: int) -> Fields | None:
        date, t, bus, can_id, bracket, length, shown = match.groups()
        # Braces hold the length's code, which is above 8 for 8 bytes, too.
        size = min(int(length, 16), _FRAME_BYTES) if bracket == b"{" else _decimal(length)
        digits = _screen_digits(shown.split(b" ::", 1)[0], size)  # behind :: stands what cantools decode adds
        if digits is None:
            self.damage.append(Damage(f"line {number}", f"a frame that has not the {size} bytes it tells of"))
            return None
        if date:
            return _seconds(date.decode()), bus, can_id, digits
        return t, bus, can_id, digits

    def _dotted(self, digits: bytes, number: int) -> bytes:
        try:
            return unhexlify(digits.replace(b".", b""))
        except ValueError:
            self.damage.append(Damage(f"line {number}", "an odd number of hexadecimal digits"))
            return b""


def _decimal(digits: bytes) -> int:
    return int(digits) if digits.isdigit() else 0


def _screen_digits(shown: bytes, size: int) -> bytes | None:
    """Return the digits of a frame's bytes as -L has them; None if they are not `size` bytes."""
    text = shown.strip()
    if text.startswith(_NO_DATA) or not size:
        return b""
    # Behind them may stand the characters (-a), between quotes.
    if match := _BITS.match(text):
        bits = re.split(rb"[ `]", match[0])
        if len(bits) >= size:
            pairs = [b"%02X" % int(word, 2) for word in bits]
            return b"".join(pairs[:size] if _SWAPPED not in match[0] else pairs[size - 1 :: -1])
    width = 3 * size - 1
    front = text[:width]
    behind = text[width:].strip()
    if len(front) != width or (behind and not behind.startswith((b"'", *_NO_DATA))):
        return None
    pairs = re.split(rb"[ `]", front)
    if len(pairs) != size or not all(re.fullmatch(rb"[0-9A-Fa-f]{2}", pair) for pair in pairs):
        return None
    return b"".join(pairs[::-1] if _SWAPPED in front else pairs)


def _seconds(date: str) -> float:
    """Return a date of -tA in seconds since 1970; it is of the recorder's zone, which is not told, taken as UTC."""
    whole, _, fraction = date.partition(".")
    try:
        return datetime.fromisoformat(whole).replace(tzinfo=UTC).timestamp() + float(f"0.{fraction}")
    except ValueError:
        return 0.0


def _sniff(head: bytes) -> bool:
    lines = (_COLOUR.sub(b"", line) for line in first_lines(head))
    found = [match for line in lines if (match := _LINE.fullmatch(line) or _SCREEN.fullmatch(line))]
    return bool(found) and not _are_numbered(found)


def _are_numbered(found: list[re.Match[bytes]]) -> bool:
    """Whether what stands where an interface does only counts the lines."""
    names = [match[2 if match.re is _LINE else 3] or b"" for match in found]
    if len(set(names)) > _BUSES_MOST:
        return True
    if len(names) < 2 or not all(map(bytes.isdigit, names)):
        return False
    return all(int(after) == int(before) + 1 for before, after in pairwise(names))


class CandumpWriter:
    """Writes each chunk as ISO-TP frames with the flow control that answers them."""

    def __init__(self, stream: BinaryIO, options: ReadOptions) -> None:
        self._stream = stream
        self._robot = options.robot or 0
        self._t = 0.0

    def write(self, chunk: Chunk) -> None:
        """Append the frames of one chunk, split if it is longer than an ISO-TP message may be."""
        self._t = self._t if chunk.t is None else chunk.t
        for at in range(0, len(chunk.data), PDU_MAX):
            self._message(chunk.dir, chunk.data[at : at + PDU_MAX])

    def close(self) -> None:
        """Nothing stands at the end."""

    def _message(self, direction: Direction, data: bytes) -> None:
        if len(data) < _FRAME_BYTES:
            self._frame(direction, bytes((len(data),)) + data)
            return
        self._frame(direction, bytes((0x10 | len(data) >> 8, len(data) & 0xFF)) + data[:6])
        other = CLIENT_TO_ROBOT if direction == ROBOT_TO_CLIENT else ROBOT_TO_CLIENT
        self._frame(other, b"\x30\0\0")
        for number, at in enumerate(range(6, len(data), 7), start=1):
            self._frame(direction, bytes((0x20 | number & 0xF,)) + data[at : at + 7])

    def _frame(self, direction: Direction, payload: bytes) -> None:
        base = ID_TO_ROBOT if direction == CLIENT_TO_ROBOT else ID_FROM_ROBOT
        padded = payload.ljust(_FRAME_BYTES, _PADDING)
        self._stream.write(f"({self._t:.6f}) can0 {base + self._robot:03X}#{padded.hex().upper()}\n".encode())


FORMAT: Final = Format(
    name="candump",
    help=HELP["candump"],
    sniff=_sniff,
    reader=CandumpReader,
    writer=CandumpWriter,
    suffixes=(".candump", ".log"),
)
