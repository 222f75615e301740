# SPDX-License-Identifier: MIT
"""`argus-log faults`: what the fault manager would have said from a log alone, by the C core that argusd runs."""

from __future__ import annotations

import argparse
import itertools
import json
from array import array
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final, NamedTuple

from argus_tools.chunks import CLIENT_TO_ROBOT, ROBOT_TO_CLIENT, LogError
from argus_tools.log.common import Input, add_log_arguments, add_robot_arguments, show_table, use_colour
from argus_tools.log.opening import identity_in, is_sip, opened
from argus_tools.log.packets import JUNK, Row
from argus_tools.log.summary import Summary
from hil_sim.arcos import FLAG, SIP, TIMING, Command, SyncReply
from hil_sim.core.library import Core, CoreEvent, kind_name, setting_value
from hil_sim.faults.values import value_words
from hil_sim.sonar.params import NO_ECHO_MM

EXAMPLES: Final = """\
  argus-log faults capture.bin                 what is wrong, a line for each finding; one if it is nothing
  argus-log faults capture.bin --events        everything said on the way, then the state of each sonar
  argus-log faults --json drive.rec            one JSON object per event, as argusd --json writes them
  argus-log faults drive.rec --set suspect_readings=5 --set stale_ms=3000

The manager only listens: it cannot turn the robot, so a suspect that only a turn could judge stays a suspect.
One that gives only "no echo", where nothing that others hear contradicts it, may be dead or right: it is not judged.
A log without times is taken as one SIP each 100 ms. The exit code is 1 where a sonar is disabled, or a suspect with a
name for its fault (--exit-zero: 0). Of a damaged log no sonar is given out as silent.
"""
_SIP_MS: Final = TIMING["SIP_CYCLE_MS"]
# SIPs that were on their way when the client closed the session or switched an array.
_SIPS_AFTER: Final = 5
_TINT: Final = {"ERROR": "\033[31m", "WARN": "\033[33m"}
_PLAIN: Final = "\033[0m"
_DISABLED: Final = "SONAR_DISABLED"
_STATUS: Final = {"event": "STATUS", "id": 91, "level": 0, "name": "status"}
_FLAGS_AT: Final = SIP["OFFSET_FLAGS"] - SIP["OFFSET_TYPE"]
_COUNT_AT: Final = SIP["OFFSET_SONAR_COUNT"] - SIP["OFFSET_TYPE"]
# So many rows are taken together; fewer SIPs than this are sooner taken one by one.
_BATCH_ROWS: Final = 512
_FEW_ROWS: Final = 4
# What a client says that bears on which arrays fire, or on the session.
_OF_SESSION: Final = frozenset(("SONAR", "CLOSE"))
_ALL_ARRAYS: Final = (1 << TIMING["ARRAYS_MAX"]) - 1
_ARRAY: Final = TIMING["TRANSDUCERS_PER_ARRAY"]
_ABSENT, _UNKNOWN, _HEALTHY = "ABSENT", "UNKNOWN", "HEALTHY"
_COUNTS: Final = ("sips", "bad_checksums", "skipped_bytes")
_UNSEEN: Final = 0xFFFFFFFF
EXIT_FAULTS: Final = 1
# Of so many packets, when one in so many is damaged, the damage may be all that a silent sonar has said.
_LOOKED_AT: Final = 200
_DAMAGED_SHARE: Final = 8
_SILENT: Final = "silent"
_SILENT_EVENTS: Final = frozenset(("SONAR_SILENT", "SONAR_STALE"))


class Said(NamedTuple):
    """One event, with the log's time (None if it keeps none) and the place of the packet that brought it."""

    t: float | None
    offset: int
    event: CoreEvent


class _Arrays:
    """Which sonar arrays fire, a bit for each: as the SIPs' flags show, or as the client asked where none ever do."""

    def __init__(self) -> None:
        self._asked = _ALL_ARRAYS
        self._shown: int | None = None

    @property
    def firing(self) -> int:
        """The arrays that fire now."""
        return self._asked if self._shown is None else self._shown

    def take(self, row: Row, is_read: bool) -> bool:
        """Take a packet, which may be a SIP that can be read; return whether other arrays fire since."""
        before, was_shown = self.firing, self._shown is not None
        if row.dir == CLIENT_TO_ROBOT and row.type == "SONAR":
            self._ask(Command.decode(row.data).value)
        elif row.dir == ROBOT_TO_CLIENT and is_read:
            shown = (
                int.from_bytes(row.data[_FLAGS_AT : _FLAGS_AT + 2], "little") // FLAG["SONAR1"] & _ALL_ARRAYS
            )
            # Flags that were never set show nothing: some firmware has none.
            self._shown = shown if shown or was_shown else None
        # The first flags only name the arrays that the robot has.
        return self.firing != before and was_shown == (self._shown is not None)

    def _ask(self, argument: int) -> None:
        """Take the argument of SONAR: twice the array, and 1 for on; array 0 stands for all."""
        array = argument >> 1 & 7
        mask = (1 << (array - 1) if array else _ALL_ARRAYS) & _ALL_ARRAYS
        self._asked = self._asked | mask if argument & 1 else self._asked & ~mask


class Listener:
    """Feeds a log into passive managers: a new one for each session, and for other arrays that fire.

    A manager opens its session by itself, with a robot that is made up before the first SIP. That robot gives
    SIPs without readings, and the answers that the log lacks or has for another client. An array that the client
    puts off is not silent, so nobody is judged by what it does not say.
    """

    def __init__(
        self,
        given: Mapping[str, int],
        subclass: str | None = None,
        absent: Callable[[], frozenset[int]] = frozenset,
    ) -> None:
        self._absent = absent
        self.core: Core | None = None
        self._given = {**given, "active": 0}
        name = (subclass or "p3dx-sh").encode("latin-1", "replace")
        self._identity = SyncReply(b"", b"Pioneer", name)
        self._is_told = subclass is not None
        self._clock_ms = 0
        self._start_ms = 0
        self._origin_ms = 0
        self._now_ms = 0
        self._is_untimed = False
        self._held_off = 0
        self._arrays = _Arrays()
        self._heard = _ALL_ARRAYS
        self._lately: deque[bool] = deque(maxlen=_LOOKED_AT)
        self._unborne: set[int] = set()
        self._reported: set[int] = set()
        self._echoed: set[int] = set()
        self._last: Core | None = None
        self._before: Counter[str] = Counter()
        # Of the last SIP, and the lengths and numbers of readings of those that could be read.
        self._flags = b""
        self._shapes: set[tuple[int, int]] = set()

    def take_many(self, rows: list[Row]) -> Iterator[tuple[int, Said]]:
        """Take many rows; yield what is reported with the number of its row, as `take` does it row by row."""
        at = 0
        while at < len(rows):
            alike, end = self._alike(rows, at)
            if len(alike) < _FEW_ROWS:
                end = max(end, at + 1)
                for number in range(at, end):
                    yield from ((number, said) for said in self.take(rows[number]))
                at = end
                continue
            taken = 0
            for number, said in self._feed_many([rows[n] for n in alike]):
                taken = number + 1
                if said is not None:
                    yield alike[number], said
            at = end if taken == len(alike) else alike[taken]

    def _alike(self, rows: list[Row], at: int) -> tuple[list[int], int]:
        """Return the SIPs from there on that change nothing but the manager in its session, and where they end.

        What a client sends meanwhile, and that says nothing of the arrays or the session, is passed over.
        """
        alike: list[int] = []
        if self.core is None:
            return alike, at
        flags, shapes = self._flags, self._shapes
        has_times: bool | None = None
        for number in range(at, len(rows)):
            t, _, direction, kind, is_ok, data, _ = rows[number]
            if direction != ROBOT_TO_CLIENT:
                if kind in _OF_SESSION:
                    return alike, number
                continue
            if (
                kind != "SIP"
                or not is_ok
                or data[_FLAGS_AT : _FLAGS_AT + 2] != flags
                or has_times not in (None, t is not None)
                or (len(data), data[_COUNT_AT]) not in shapes
            ):
                return alike, number
            has_times = t is not None
            alike.append(number)
        return alike, len(rows)

    def _feed_many(self, rows: list[Row]) -> Iterator[tuple[int, Said | None]]:
        """Take SIPs that are alike; yield the number of each that reports something, and of the last one taken."""
        core = self.core
        assert core is not None
        clocks = self._clocks(rows)
        due = array("I", (max(clock - self._origin_ms, self._now_ms) & 0xFFFFFFFF for clock in clocks))
        lengths = array("H", (len(row[5]) for row in rows))
        begin_ms = self._now_ms
        fed = core.feed(begin_ms, due.tobytes(), lengths.tobytes(), b"".join(row[5] for row in rows))
        seen = 0
        for number, now_ms, event in fed.said:
            self._lately.extend([True] * (number + 1 - seen))
            seen = number + 1
            self._clock_ms, self._now_ms = clocks[number], begin_ms + (now_ms - begin_ms & 0xFFFFFFFF)
            if said := self._placed(event, rows[number]):
                yield number, said
        self._lately.extend([True] * (fed.taken - seen))
        for row in rows[: fed.taken]:
            self._note_echoes(row.data)
        self._clock_ms = clocks[fed.taken - 1]
        self._now_ms = begin_ms + (fed.now_ms - begin_ms & 0xFFFFFFFF)
        if not core.is_open:
            self.core = None
        yield fed.taken - 1, None

    def _clocks(self, rows: list[Row]) -> list[int]:
        """Return the log's clock at each of these SIPs, ms."""
        if rows[0].t is None:
            self._is_untimed = True
            return [self._clock_ms + _SIP_MS * n for n in range(1, len(rows) + 1)]
        self._rejoin(rows[0].t)
        times = itertools.accumulate(
            (round((row[0] or 0.0) * 1000) for row in rows), max, initial=self._clock_ms
        )
        return list(times)[1:]

    def take(self, row: Row) -> Iterator[Said]:
        """Take the next packet or damage of the log."""
        is_read = is_sip(row)
        if is_read:
            self._flags = row.data[_FLAGS_AT : _FLAGS_AT + 2]
            self._shapes.add((len(row.data), row.data[_COUNT_AT]))
            self._note_echoes(row.data)
        if row.ok and self._arrays.take(row, is_read):
            self._leave()
        if row.dir != ROBOT_TO_CLIENT:
            if row.type == "CLOSE":
                self._arrays = _Arrays()
                self._flags = b""
                if self.core is not None:
                    self._leave()
            return
        self._lately.append(row.ok)
        self._pass_time(row, is_read)
        if not self._is_told and (reply := identity_in(row)):
            self._identity = reply
        if self.core is None and is_read and self._arrays.firing:
            self._held_off -= 1
            if self._held_off < 0:
                yield from self._open(row)
        if self.core is not None:
            yield from self._feed(self.core, row)
        elif row.type == JUNK:
            self._before["skipped_bytes"] += len(row.data)  # of no session, as the text of a boot before it

    def _pass_time(self, row: Row, is_read: bool) -> None:
        if row.t is not None:
            self._rejoin(row.t)
            self._clock_ms = max(self._clock_ms, round(row.t * 1000))
        elif is_read:
            self._is_untimed = True
            self._clock_ms += _SIP_MS

    def _rejoin(self, t: float) -> None:
        """Take a time behind SIPs without any as the next SIP's: how long a silence was between nobody knows."""
        if self._is_untimed:
            self._origin_ms += max(0, round(t * 1000) - self._clock_ms - _SIP_MS)
        self._is_untimed = False

    @property
    def status(self) -> dict[str, Any] | None:
        """What the last manager knows, and the packets of all; None when the log held no session."""
        if self._last is None:
            return None
        status = self._last.status()
        for number in range(len(status["health"])):
            if not self._is_heard(number):
                status["health"][number], status["kind"][number] = _ABSENT, ""
            elif number in self.unheard and status["health"][number] == _HEALTHY:
                status["health"][number] = _UNKNOWN
            elif number in self._unborne and status["health"][number] != _HEALTHY:
                status["health"][number], status["kind"][number] = _UNKNOWN, ""
            elif status["health"][number] == "STALE" and self._is_damaged():
                self._unborne.add(number)
                status["health"][number] = _UNKNOWN
        return {**status, **{name: status[name] + self._before[name] for name in _COUNTS}}

    @property
    def unborne(self) -> list[int]:
        """Sonars that gave no reading while the log was damaged, which may be why."""
        return sorted(self._unborne)

    @property
    def unheard(self) -> list[int]:
        """Sonars that gave readings, and no echo among them: no echo is right where nothing is."""
        return sorted(self._reported - self._echoed)

    def _note_echoes(self, data: bytes) -> None:
        for at in range(_COUNT_AT + 1, _COUNT_AT + 1 + 3 * data[_COUNT_AT], 3):
            sonar = data[at]
            if sonar not in self._echoed:
                self._reported.add(sonar)
                if data[at + 1] | data[at + 2] << 8 < NO_ECHO_MM:
                    self._echoed.add(sonar)

    def _is_damaged(self) -> bool:
        return _DAMAGED_SHARE * (len(self._lately) - sum(self._lately)) >= max(1, len(self._lately))

    def _is_unborne(self, event: CoreEvent) -> bool:
        """Whether an event gives a sonar out as silent that may only be so by the log's damage."""
        if event.sonar is None:
            return False
        is_silent = event.event in _SILENT_EVENTS or (
            event.event == _DISABLED and kind_name(event.value) == _SILENT
        )
        if is_silent and self._is_damaged():
            self._unborne.add(event.sonar)
        return event.sonar in self._unborne and (is_silent or event.event == "SONAR_PROBATION")

    def _is_heard(self, sonar: int) -> bool:
        """Whether a sonar is there and its array fires; the manager itself does not know that one may be off."""
        return bool(self._heard >> sonar // _ARRAY & 1) and sonar not in self._absent()

    def _leave(self) -> None:
        self.core = None
        self._held_off = _SIPS_AFTER

    def _open(self, row: Row) -> Iterator[Said]:
        """Bring a new manager to where it has a session and nothing was read yet."""
        core, now_ms = opened(self._given, self._identity, row.data)
        if self._last is not None:
            status = self._last.status()
            self._before.update({name: status[name] for name in _COUNTS})
        self.core = self._last = core
        self._heard = self._arrays.firing
        self._now_ms = now_ms
        self._start_ms = self._clock_ms
        self._origin_ms = self._clock_ms - now_ms - _SIP_MS
        yield from self._said(core, row)

    def _feed(self, core: Core, row: Row) -> Iterator[Said]:
        until_ms = max(self._clock_ms - self._origin_ms, self._now_ms)
        while self._now_ms < until_ms and core.is_open:
            self._now_ms = min(self._now_ms + max(1, core.process(self._now_ms)), until_ms)
            core.transmit()
            yield from self._said(core, row)
        core.receive(self._now_ms, row.wire)
        core.process(self._now_ms)
        core.transmit()
        yield from self._said(core, row)
        if not core.is_open:
            self.core = None

    def _said(self, core: Core, row: Row) -> Iterator[Said]:
        for event in core.events():
            if said := self._placed(event, row):
                yield said

    def _placed(self, event: CoreEvent, row: Row) -> Said | None:
        """Return an event with the log's time; None for what the log bears out nothing of."""
        if event.sonar is not None and not self._is_heard(event.sonar):
            return None
        if self._is_unborne(event):
            return None
        behind_ms = (self._now_ms - event.t_ms) & 0xFFFFFFFF
        at_ms = self._origin_ms + self._now_ms - (behind_ms if behind_ms < 1 << 31 else 0)
        # What was said while the session was made up belongs to where the log begins.
        t = None if row.t is None else max(at_ms, self._start_ms) / 1000
        return Said(t, row.offset, event)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_log_arguments(parser, follow=True)
    parser.add_argument(
        "--events", action="store_true", help="each event as a line, then all sonars (default with --follow)"
    )
    parser.add_argument(
        "--exit-zero", action="store_true", help="exit code 0 also where faults are found (default: 1)"
    )
    parser.add_argument("--json", action="store_true", help="one JSON object per line, as argusd --json")
    parser.add_argument(
        "--profile", default="argus", metavar="NAME", help="rule set (default: argus, as argusd)"
    )
    parser.add_argument(
        "--set", action="append", default=[], metavar="KEY=VALUE", help="a setting, see argusd --list-config"
    )
    add_robot_arguments(parser)


def _given(args: argparse.Namespace) -> dict[str, int]:
    words = [f"profile={args.profile}", *args.set]
    given = {}
    for word in words:
        key, separator, value = word.partition("=")
        if not separator:
            raise LogError(f"--set {word}: write KEY=VALUE")
        given[key.strip()] = setting_value(key.strip(), value.strip())
    if "active" in given:
        raise LogError("--set active: a manager that reads a log is passive")
    return given


def run(args: argparse.Namespace) -> int:
    """Print what the manager says; return the exit code."""
    source = Input(args)
    listener = Listener(_given(args), args.subclass, lambda: source.log.options.absent)
    colour = use_colour()
    summary = Summary()
    is_short = not (args.json or args.events or args.follow)
    t: float | None = None
    rows = source.rows()
    while batch := list(itertools.islice(rows, 1 if source.is_live else _BATCH_ROWS)):
        seen = 0
        for number, said in listener.take_many(batch):
            summary.see_all(batch[seen : number + 1])
            seen = number + 1
            summary.add(said.event, said.t, said.offset)
            if not is_short:
                print(_json(said) if args.json else _line(said, colour), flush=args.follow)
        summary.see_all(batch[seen:])
        t = batch[-1].t
    status = listener.status
    if status is None:
        raise LogError(f"{args.log}: holds no SIP from the robot, so there is nothing to judge")
    if is_short:
        unread = sum(entries.unread for entries in source.log.damage_lists)
        print("\n".join(summary.lines(status, unread, listener.unborne, listener.unheard)))
    else:
        print(json.dumps({"t": t, **_STATUS, **status}) if args.json else _table(status, colour))
    return EXIT_FAULTS if summary.has_faults(status) and not args.exit_zero else source.exit_code


def _json(said: Said) -> str:
    event = said.event
    fields = {
        "t": said.t,
        "event": event.event,
        "id": event.id,
        "level": event.level,
        "name": event.name,
        "value": event.value,
        "state": event.state,
        "offset": said.offset,
    }
    return json.dumps(fields)


def _line(said: Said, colour: bool) -> str:
    event = said.event
    when = f"byte {said.offset}" if said.t is None else f"{said.t:.3f}"
    tint = _TINT.get(event.level_name, "") if colour else ""
    meaning, _, _ = event.meaning.partition("; value:")
    value = value_words(event.event, event.value)
    level = f"{tint}{event.level_name:<5}{_PLAIN if tint else ''}"
    return f"{when:>14} {level} {event.name:<14} {event.event}{value}: {meaning}"


def _table(status: dict[str, Any], colour: bool) -> str:
    rows = [("sonar", "health", "fault", "last mm")]
    for number, health in enumerate(status["health"]):
        kind = status["kind"][number]
        seen = status["age_ms"][number] != _UNSEEN
        rows.append(
            (
                str(number),
                health,
                kind,
                str(status["reading_mm"][number]) if seen else "-",
            )
        )
    counts = f"{status['sips']} SIPs, {status['bad_checksums']} bad checksums, {status['skipped_bytes']} bytes skipped"
    lines = show_table(rows, frozenset((0, 3))).splitlines()
    if colour:
        bad = {at + 1 for at, health in enumerate(status["health"]) if health == "DISABLED"}
        lines = [f"{_TINT['ERROR']}{line}{_PLAIN}" if at in bad else line for at, line in enumerate(lines)]
    return "\n".join(("", *lines, "", f"{status['failure']}; {counts}"))
