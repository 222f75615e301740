# SPDX-License-Identifier: MIT
"""Tables of CAN frames as comma-separated values, of SavvyCAN, PCAN, python-can and others: found by their headings."""

from __future__ import annotations

import csv
import re
from base64 import b64decode
from binascii import Error as Base64Error
from collections.abc import Iterator
from dataclasses import dataclass, replace
from io import BufferedReader
from typing import Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, Damage, DamageList, Format, LogError, ReadOptions
from argus_tools.formats.isotp import CanLink, is_robot_id
from argus_tools.formats.source import HEAD_BYTES
from argus_tools.formats.stamps import Times
from argus_tools.formats.text import first_lines, is_passed

_LINE_MAX: Final = 4096
_HEADING_LINES: Final = 40
_SEPARATORS: Final = (",", ";", "\t")
_BYTES_MAX: Final = 64
_HEADINGS_MIN: Final = 2
_PAIR_MOST: Final = 4
_ROWS_LOOKED_AT: Final = 1 << 10
_SHORT_ID_MAX: Final = 0x7FF
# In English, and in German as spreadsheets and analysers write it there; an umlaut may be of any code page.
_UNIT: Final = r"( ?[(\[]?(s|sec|seconds|sek|sekunden|ms|us|µs|ns)[)\]]?)?"
_ID: Final = re.compile(
    r"(can[ -]?|message[ -]?|msg[ -]?|arb(?:itration)?[ -]|frame[ -]?|nachrichten[ -]?|botschafts[ -]?)?"
    r"(id|identifier|addr(?:ess)?|kennung)( ?[(\[]?(hex|dec|dez)[)\]]?)?"
)
_TIME: Final = re.compile(
    r"(time ?(stamps?|offset)?|abs(olute)? ?time|t|(?:absolute |relative |system)?zeit ?(?:stempel|punkt)?)"
    + _UNIT
)
_SIZE: Final = re.compile(
    r"len|length|dlc?|dl|data ?length( code)?|size|bytes|(?:daten)?l.{1,3}nge|anzahl(?: bytes)?"
)
_CODE: Final = re.compile(r"dlc|.*code")
_DATA: Final = re.compile(r"(data|payload|(?:nutz)?daten)[ -]?(bytes|f(?:ie|e)ld)?( ?[(\[]?hex[)\]]?)?")
_ONE: Final = re.compile(r"(?:d|b|db|data|byte|data ?byte|daten(?:byte)?)[ _-]?\[?(\d{1,2})\]?")
_BUS: Final = re.compile(r"bus|channel|chn?|interface|network|kanal|schnittstelle")
_LONG: Final = re.compile(r"e?xt(ended|d)?|is[ _]extended([ _]id)?|ide|erweitert")
_KIND: Final = re.compile(r"type|frame ?type|typ")
_FLAG: Final = re.compile(r"remote|error|rtr|er|fehler")
# A time or the number of a line before the first heading stands before each row, too.
_PREFIXED: Final = re.compile(r"^[\W\d]|[:|]")
_UNITS: Final = {
    "s": 1.0,
    "sec": 1.0,
    "seconds": 1.0,
    "ms": 1e-3,
    "us": 1e-6,
    "µs": 1e-6,
    "ns": 1e-9,
    "sek": 1.0,
    "sekunden": 1.0,
}
# SavvyCAN counts microseconds; so does each program that writes times without a point under this heading.
_MICROSECONDS: Final = 1e-6
# A spreadsheet writes many digits with an exponent; no time in seconds is as large.
_SECONDS_MAX: Final = 1e11
# A point or a comma before the fraction, the other one or none between thousands.
_DECIMAL_COMMA: Final = re.compile(r"(-?\d{1,3}(?:\.\d{3})*|-?\d+),(\d*(?:e[+-]?\d+)?)", re.IGNORECASE)
# Bytes by the code of their number, above eight.
_CODED: Final = {9: 12, 10: 16, 11: 20, 12: 24, 13: 32, 14: 48, 15: 64}
_TRUE: Final = ("1", "t", "true", "yes", "x", "ext", "extended", "wahr", "ja")
_NO_DATA_KINDS: Final = ("rtr", "remote", "error", "errorframe", "rr", "er", "ec", "st")


@dataclass(frozen=True)
class _Columns:
    """Where in a row what stands."""

    separator: str
    can_id: int
    time: int | None
    unit_s: float | None
    size: int | None
    data: int | None
    ones: tuple[int, ...]
    bus: int | None
    long: int | None
    # Whether the size is a code, which is no count above eight bytes.
    is_code: bool
    width: int
    kinds: tuple[int, ...]
    flags: tuple[int, ...]
    is_base64: bool
    # Base of the ids, and of the bytes.
    is_decimal: bool
    has_decimal_data: bool = False
    # Whether times have a comma that parts the cells, too.
    is_split: bool = False


def _columns(line: bytes) -> _Columns | None:
    """Understand a line of headings; None if it is none of CAN frames."""
    text = line.decode("utf-8", "replace").strip().lstrip(";# ").lower()
    for separator in _SEPARATORS:
        names = [re.sub(r"[ _]+", " ", name.strip().strip('"')) for name in text.split(separator)]
        names = _without_group(names)
        if (
            len(names) >= _HEADINGS_MIN
            and not _PREFIXED.search(names[0])
            and (found := _understand(separator, names))
        ):
            return found
    return None


def _without_group(names: list[str]) -> list[str]:
    """Return headings without the name of the group before a point, which MDF's channels have in common."""
    groups = {name.rpartition(".")[0] for name in names if "." in name}
    return [name.rpartition(".")[2] for name in names] if len(groups) == 1 else names


def _understand(separator: str, names: list[str]) -> _Columns | None:
    def find(pattern: re.Pattern[str]) -> int | None:
        return next((at for at, name in enumerate(names) if pattern.fullmatch(name)), None)

    can_id, time, data = find(_ID), find(_TIME), find(_DATA)
    ones = sorted((int(m[1]), at) for at, name in enumerate(names) if (m := _ONE.fullmatch(name)))
    if can_id is None or (data is None and not ones):
        return None
    unit = _TIME.fullmatch(names[time]) if time is not None else None
    size = find(_SIZE)
    return _Columns(
        separator=separator,
        can_id=can_id,
        time=time,
        unit_s=_UNITS[unit[5]] if unit and unit[5] else None,
        size=size,
        data=data,
        ones=tuple(at for _, at in ones),
        bus=find(_BUS),
        long=find(_LONG),
        is_code=size is not None and bool(_CODE.fullmatch(names[size])),
        width=len(names),
        kinds=tuple(at for at, name in enumerate(names) if _KIND.fullmatch(name)),
        flags=tuple(at for at, name in enumerate(names) if _FLAG.fullmatch(name)),
        # python-can's own.
        is_base64=names[:7] == ["timestamp", "arbitration id", "extended", "remote", "error", "dlc", "data"],
        is_decimal=bool(re.search("dec|dez", names[can_id])),
    )


def _in_their_base(columns: _Columns, head: bytes) -> _Columns:
    """Say in which base a table is whose headings do not tell it: its ids are a robot's in that base alone."""
    lines = head.splitlines()[1:_ROWS_LOOKED_AT]
    if not any(map(is_robot_id, _ids(lines, columns))):
        split = replace(columns, is_split=columns.separator == "," and columns.time is not None)
        columns = split if any(map(is_robot_id, _ids(lines, split))) else columns
    cells = [_Cells(columns, row) for line in lines if (row := _cells(line, columns))]
    is_decimal = columns.is_decimal or _are_decimal([cell.id_text() for cell in cells])
    data = [text for cell in cells for text in cell.one_texts() or cell.list_texts()]
    return replace(columns, is_decimal=is_decimal, has_decimal_data=_is_decimal_data(data, is_decimal))


def _is_decimal_data(texts: list[str], with_decimal_ids: bool) -> bool:
    """A number of three digits is no byte in hexadecimal; without one, bytes are written as the ids are."""
    if any(len(text) > 2 and text.isdigit() for text in texts):
        return True
    return with_decimal_ids and bool(texts) and all(map(str.isdigit, texts))


def _are_decimal(ids: list[str]) -> bool:
    numbers = [text for text in ids if text.isdigit()]
    # One in ten may be spoilt.
    if 10 * len(numbers) < 9 * len(ids):
        return False
    return any(is_robot_id(int(one)) for one in numbers) and not any(
        is_robot_id(int(one, 16)) for one in numbers
    )


def _ids(lines: list[bytes], columns: _Columns) -> Iterator[int]:
    """Yield the ids of these rows, in either base."""
    for line in lines:
        text = _Cells(columns, _cells(line, columns)).id_text().lower().removeprefix("0x")
        for base in (10, 16):
            try:
                yield int(text, base)
            except ValueError:
                continue


def _cells(line: bytes, columns: _Columns) -> list[str]:
    """Return the cells of a row, none if it has none."""
    try:
        cells = next(csv.reader([line.decode("latin-1")], delimiter=columns.separator))
    except (csv.Error, StopIteration):
        return []
    at = columns.time
    if columns.is_split and at is not None and len(cells) > at + 1:
        cells[at : at + 2] = [",".join(cells[at : at + 2])]
    return cells


def _number(text: str) -> float:
    """Return a number with a point or a comma before its fraction."""
    if match := _DECIMAL_COMMA.fullmatch(text):
        text = f"{match[1].replace('.', '')}.{match[2]}"
    return float(text)


@dataclass(frozen=True)
class _Row:
    t: float | None
    bus: str
    can_id: int
    is_long_id: bool
    data: bytes


class _Cells:
    """One row's cells by what they are."""

    def __init__(self, columns: _Columns, cells: list[str], times: Times | None = None) -> None:
        self._columns = columns
        self._times = times or Times()
        self._cells = [cell.strip() for cell in cells]

    def _at(self, column: int | None) -> str:
        return self._cells[column] if column is not None and column < len(self._cells) else ""

    def id_text(self) -> str:
        """The cell of the id."""
        return self._at(self._columns.can_id)

    def list_texts(self) -> list[str]:
        """The numbers in the one cell of all bytes, where spaces or commas part them."""
        texts = re.split(r"[\s,;]+", self._at(self._columns.data).strip("[]").strip())
        return [] if self._columns.is_base64 or len(texts) == 1 else texts

    def one_texts(self) -> list[str]:
        """The cells of single bytes that are not empty."""
        return [text for at in self._columns.ones if (text := self._at(at))]

    def row(self) -> _Row | None:
        """Return the frame; None if it has no data; ValueError if the row is none."""
        columns = self._columns
        if any(self._at(at).lower() in _NO_DATA_KINDS for at in columns.kinds):
            return None
        if any(self._at(at).lower() in _TRUE for at in columns.flags):
            return None
        text = self._at(columns.can_id).lower()
        is_long = text.endswith("x") or self._at(columns.long).lower() in _TRUE
        can_id = int(text.removeprefix("0x").strip("hx"), 10 if columns.is_decimal else 16)
        return _Row(self._t(), self._at(columns.bus), can_id, is_long or can_id > _SHORT_ID_MAX, self._data())

    def _t(self) -> float | None:
        text = self._at(self._columns.time)
        if not text:
            return None
        if ":" in text and (stamp := self._times.take(text.encode())):
            return stamp.t
        value = _number(text)
        unit = self._columns.unit_s
        if unit is None:
            is_seconds = ("." in text or "," in text) and value < _SECONDS_MAX
            unit = 1.0 if is_seconds else _MICROSECONDS
        return round(value * unit, 9)

    def _size(self) -> int | None:
        text = self._at(self._columns.size)
        return int(text, 16 if self._columns.is_code and text.isalpha() else 10) if text else None

    def _bytes_texts(self, size: int | None) -> list[str]:
        """Return the cells of single bytes: of CAN FD there may be more than headings."""
        ones = self._columns.ones
        texts = self.one_texts()
        if size is not None and size > len(ones) and ones[-1] == self._columns.width - 1:
            texts += [text for text in self._cells[self._columns.width :] if text]
        return texts

    def _data(self) -> bytes:
        columns = self._columns
        size = self._size()
        if columns.is_base64:
            data = b64decode(self._at(columns.data), validate=True)
        elif columns.ones and columns.has_decimal_data:
            data = bytes(map(int, self._bytes_texts(size)))
        elif columns.ones:
            texts = self._bytes_texts(size)
            data = bytes.fromhex("".join(text.lower().removeprefix("0x").rjust(2, "0") for text in texts))
        else:
            # Unquoted bytes may have cells of their own behind the last heading.
            assert columns.data is not None
            text = self._at(columns.data)
            if len(text) <= _PAIR_MOST and self._is_last(columns.data):
                text = " ".join(self._cells[columns.data :])
            text = text.strip("[]")
            if columns.has_decimal_data:
                data = bytes(map(int, re.split(r"[\s,;]+", text.strip())))
            else:
                data = bytes.fromhex(re.sub(r"0x|[-:|']", " ", text.lower()))
        return self._sized(data, size)

    def _sized(self, data: bytes, size: int | None) -> bytes:
        """Return so many of the bytes; a code above eight stands for more."""
        if size is None:
            return data[:_BYTES_MAX]
        if self._columns.is_code and len(data) >= _CODED.get(size, _BYTES_MAX + 1):
            size = _CODED[size]
        if len(data) < size:
            raise ValueError(f"{len(data)} of {size} bytes")
        return data[:size]

    def _is_last(self, column: int) -> bool:
        others = (self._columns.can_id, self._columns.time, self._columns.size, self._columns.bus)
        return all(other is None or other < column for other in others)


class CanCsvReader:
    """Reads such a table; a row that is none is told and the next one is read."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._name = options.name
        self._link = CanLink(options, self.damage, "line")

    @property
    def place(self) -> str:
        """Where in the file the last chunk ends."""
        return self._link.place

    def __iter__(self) -> Iterator[Chunk]:
        columns: _Columns | None = None
        times = Times()
        number = above = 0
        while line := self._stream.readline(_LINE_MAX):
            number += 1
            if columns is None:
                columns = _columns(line)
                if columns is not None:
                    columns = _in_their_base(columns, line + self._stream.peek(HEAD_BYTES))
                above += bool(line.strip()) and not is_passed(line)
                if columns is None and above >= _HEADING_LINES:
                    break
                continue
            if not line.strip() or line.startswith((b"#", b";")):
                continue
            try:
                row = _Cells(columns, _cells(line, columns), times).row()
            except (ValueError, Base64Error) as error:
                self.damage.append(Damage(f"line {number}", f"no CAN frame ({str(error)[:60]})"))
                continue
            if row is None:
                continue
            direction = self._link.direction(row.bus, row.can_id, row.is_long_id, number)
            if direction is not None:
                yield from self._link.take(row.t, direction, row.data, number)
        if columns is None:
            raise LogError(f"{self._name}: no table of CAN frames: its headings name no ID and no data")
        yield from self._link.finish()


def _sniff(head: bytes) -> bool:
    return any(_columns(line) for line in first_lines(head)[:_HEADING_LINES] + _comments(head))


def _comments(head: bytes) -> list[bytes]:
    """Headings may stand in a comment."""
    return [line for line in head[:_LINE_MAX].splitlines()[:_HEADING_LINES] if line[:1] in (b"#", b";")]


FORMAT: Final = Format(
    name="can-csv",
    help=HELP["can-csv"],
    sniff=_sniff,
    reader=CanCsvReader,
)
