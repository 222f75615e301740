# SPDX-License-Identifier: MIT
"""Times as programs write them at the beginning of a line: found, and turned into seconds."""

from __future__ import annotations

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Final, NamedTuple

from argus_tools.timeline import DAY_S, LEAP_YEAR_S, YEAR_S, Wrapping

_DATES: Final = (
    "%Y-%m-%d", "%Y/%m/%d", "%Y.%m.%d", "%d.%m.%Y", "%m/%d/%Y", "%d/%m/%Y", "%d-%m-%Y",
    "%d.%m.%y", "%m/%d/%y", "%d/%m/%y", "%y-%m-%d",
)  # fmt: skip
# In English and German, of which one has a letter of two encodings.
_MONTHS: Final = {
    b"jan": 1, b"feb": 2, b"mar": 3, b"apr": 4, b"may": 5, b"jun": 6, b"jul": 7, b"aug": 8, b"sep": 9, b"oct": 10,
    b"nov": 11, b"dec": 12, b"m\xe4r": 3, b"m\xc3\xa4r": 3, b"mrz": 3, b"mai": 5, b"okt": 10, b"dez": 12,
}  # fmt: skip
_WEEKDAYS: Final = rb"(?:mon|tue|wed|thu|fri|sat|sun|die|mit|don|fre|sam|son|mo|di|mi|do|fr|sa|so)"
# A date without a year is counted from a year that has no 29 February, unless that day comes.
_YEAR, _LEAP_YEAR = 1970, 1972
_MONTH: Final = rb"(?:" + b"|".join(map(re.escape, _MONTHS)) + rb")"
# 2026-11-25, 25.11.26, 11-25 as logcat has it, Nov 25 of syslog, Wed Nov 25 of ctime, 25 Nov 2026, 25/Nov/2026.
_DATE: Final = (
    rb"(?P<date>\d{4}([-/.])\d\d?\2\d\d?|\d\d?([-/.])\d\d?\3(?:\d{4}|\d\d))[ T,]+"
    rb"|(?P<short>\d\d-\d\d)[ ]+"
    rb"|(?P<weekday>" + _WEEKDAYS + rb"[a-z]*\.?,?[ ]+)?"
    rb"(?:(?P<month>" + _MONTH + rb")[a-z]*\.?[ ]+(?P<day>\d\d?),?(?:[ ]+(?P<year>\d{4}))?"
    rb"|(?P<first>\d\d?)[ /-](?P<second>" + _MONTH + rb")[a-z]*\.?[ /-](?P<third>\d{4}))[ :T,]+"
)
# 06:38:47.479+01:00, (06:38:47:479), 06:38:47 PM; ctime has its year behind.
_CLOCK: Final = (
    rb"(?:" + _DATE + rb")?"
    rb"(?P<hour>\d\d?):(?P<minute>\d\d):(?P<of_minute>\d\d)(?:[.,:](?P<fraction>\d{1,9}))?"
    rb"(?:[ ]?(?P<half>[ap]m)(?![0-9a-z]))?"
    rb"(?:[ ]?(?:Z|UTC|GMT)(?![0-9a-z])|[ ]?(?P<zone>[+-]\d\d:?\d\d)|(?P<hours>[+-]\d\d))?"
    rb"(?(weekday)(?:[ ]+[A-Z]{3,5})?(?:[ ]+(?P<behind>\d{4})(?![0-9a-z]))?|)"
)
_SINCE: Final = rb"(?P<since>[+-]?\d{1,12}\.\d{1,9})(?:[ ]?s)?"
# Whole seconds, milliseconds or microseconds since 1970 before bytes in pairs.
_EPOCH: Final = (
    rb"(?P<epoch>1\d{9}(?:\d{3}){0,2})(?=[\])}]?[\s:;,|]+(?:0x)?(?:[0-9a-f]{2}(?![0-9a-f])|fa[ ,:]?fb))"
)
# The time since the line before may follow, and what parts the time from the rest.
_TIME: Final = re.compile(
    rb"[\[({]?[ ]*(?:" + _CLOCK + rb"|" + _SINCE + rb"|" + _EPOCH + rb")"
    rb"(?:[ ]+[+]?\d{1,9}\.\d{1,9})?[ ]*[\])}]?[ \t]*(?:[:;,|-]?(?:[ \t]+|\Z)|[,;])",
    re.IGNORECASE,
)
_BASIC: Final = re.compile(rb"([\[({]?)(\d{4})(\d\d)(\d\d)T(\d\d)(\d\d)(\d\d)(?!\d)")
_EPOCH_DIGITS: Final = 10


class Stamp(NamedTuple):
    """A time and what stands behind it."""

    t: float
    rest: bytes


@dataclass
class Times:
    """Turns the times of a log's lines into seconds, those of a clock without a date or a year as `Wrapping`."""

    last: float = 0.0
    is_leap: bool = False

    def take(self, line: bytes) -> Stamp | None:
        """Return the time at the beginning of a line; None if there is none."""
        line = _BASIC.sub(rb"\1\2-\3-\4T\5:\6:\7", line, count=1) if b"T" in line[:20] else line
        match = _TIME.match(line)
        return Stamp(self._at(match), line[match.end() :]) if match else None

    def _at(self, match: re.Match[bytes]) -> float:
        if match["since"]:
            return float(match["since"])
        if digits := match["epoch"]:
            return round(int(digits) / float(10 ** (len(digits) - _EPOCH_DIGITS)), 6)
        t = _of_day(match)
        if match["date"]:
            return _midnight(match["date"].decode()) + t - _zone_s(match)
        month, day, year = _day(match)
        if month is None:
            return Wrapping(t, DAY_S)
        self.is_leap |= (month, day) == (2, 29)
        whole = int(year) if year else (_LEAP_YEAR if self.is_leap else _YEAR)
        try:
            t += datetime(whole, month, day, tzinfo=UTC).timestamp() - _zone_s(match)
        except ValueError:  # no such day
            return self.last
        if year:
            return t
        self.last = t - datetime(whole, 1, 1, tzinfo=UTC).timestamp()
        return Wrapping(self.last, LEAP_YEAR_S if self.is_leap else YEAR_S)


def _of_day(match: re.Match[bytes]) -> float:
    hour = int(match["hour"])
    if match["half"]:
        hour = hour % 12 + 12 * (match["half"].lower() == b"pm")
    t = hour * 3600.0 + int(match["minute"]) * 60 + int(match["of_minute"])
    return t + float(b"0." + (match["fraction"] or b"0"))


def _day(match: re.Match[bytes]) -> tuple[int | None, int, bytes | None]:
    """Return month, day and year of a date in words, None for what it lacks."""
    if match["short"]:
        month, day = map(int, match["short"].split(b"-"))
        return month, day, None
    name = match["month"] or match["second"]
    if name is None:
        return None, 0, None
    day = int(match["day"] or match["first"])
    return _MONTHS[name.lower()], day, match["year"] or match["third"] or match["behind"]


def _zone_s(match: re.Match[bytes]) -> float:
    zone = match["zone"] or match["hours"]
    if not zone:
        return 0.0
    hours, minutes = int(zone[1:3]), int(zone[3:].strip(b":") or b"0")
    return (hours * 3600.0 + minutes * 60.0) * (-1 if zone[:1] == b"-" else 1)


def _midnight(date: str) -> float:
    for form in _DATES:
        try:
            return datetime.strptime(date, form).replace(tzinfo=UTC).timestamp()
        except ValueError:
            continue
    return 0.0
