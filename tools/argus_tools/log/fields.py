# SPDX-License-Identifier: MIT
"""The fields of a packet in units for people: the contract of `argus-log decode --json`."""

from __future__ import annotations

import dataclasses
import itertools
import json
from collections.abc import Iterable, Iterator, Sequence
from operator import itemgetter
from struct import Struct
from typing import Any, Final, NamedTuple

from argus_tools.chunks import CLIENT_TO_ROBOT, ROBOT_TO_CLIENT
from argus_tools.log.packets import Row
from hil_sim.arcos import (
    ARGUMENT,
    COMMAND,
    FLAG,
    SIP,
    TYPE,
    Command,
    ConfigPac,
    GyroPac,
    IoPac,
    OtherPacket,
    PacketError,
    Sip,
    SyncReply,
    decode,
)

_TURN: Final = SIP["TURN"]
_SPAN: Final = 1 << SIP["POSITION_BITS"]
_HALF: Final = _SPAN >> 1
DEFAULT_SUBCLASS: Final = "p3dx-sh"
# Position units in mm; a subclass that is not here has those of p3dx-sh.
UNIT_MM: Final = {DEFAULT_SUBCLASS: 1.0, "p3dx": SIP["OLD_UNIT_UM"] / 1000}
# After SETO a SIP this near to the origin is one that the robot sent after it obeyed.
_ORIGIN_UNITS: Final = 200
_PAIRS: Final = (COMMAND["VEL2"], COMMAND["DIGOUT"], COMMAND["PTUPOS"])
_INTEGERS: Final = (ARGUMENT["POSITIVE"], ARGUMENT["NEGATIVE"])
_HEAD: Final = 20  # data bytes of a SIP before its readings
_PORTS: Final = {TYPE["SERAUXPAC"]: 1, TYPE["SERAUX2PAC"]: 2, TYPE["SERAUX3PAC"]: 3}
_CACHE_MAX: Final = 4096
_BATCH_ROWS: Final = 1024
# Fewer SIPs than this are sooner done one by one.
_FEW_ROWS: Final = 16
_NOWHERE: Final = '{"t": null, "offset": 0, '
_TAIL: Final = tuple(name for name, _ in Sip._TAIL)

HEADINGS: Final = tuple((turn if turn <= _TURN // 2 else turn - _TURN) * 360 / _TURN for turn in range(_TURN))
_HEADING_TEXT: Final = tuple(map(repr, HEADINGS))
_STATE: Final = (
    "battery_v", "stall_left", "stall_right", "bumpers_front", "bumpers_rear", "moving", "motors", "flags", "compass",
)  # fmt: skip
_COMMON: Final = frozenset(("t", "offset", "dir", "type", "ok"))
_TYPE_AND_OK: Final = itemgetter(3, 4)
_ALL_SIPS: Final = {("SIP", True)}


def _text(value: bytes | None) -> str | None:
    return None if value is None else value.decode("latin-1")


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.decode("latin-1")
    return [_plain(item) for item in value] if isinstance(value, tuple) else value


class _Layout(NamedTuple):
    """How SIPs with one list of sonar numbers and one length are read and printed."""

    unpack: Any
    tail_at: int
    text: str


class Decoder:
    """Reads the rows of one log, in their order.

    `track` must see every row, printed or not: the position is unwrapped from SIP to SIP. Its unit is that of
    the subclass which the robot named.
    """

    def __init__(self, subclass: str | None = None) -> None:
        self._asked = subclass
        self._unit = 1.0
        self._is_mm = True
        self._x = self._y = 0
        self._raw = b""
        self._origin_due = False
        # Of the last SIP, unwrapped.
        self.x_mm: float = 0
        self.y_mm: float = 0
        self._layouts: dict[tuple[bytes, int], _Layout | None] = {}
        self._states: dict[bytes, tuple[str, str]] = {}
        self._bodies: dict[tuple[str, str, bytes], str] = {}
        self.subclass = DEFAULT_SUBCLASS
        self._learn(subclass)

    def _learn(self, subclass: str | None) -> None:
        if subclass:
            self.subclass = subclass.lower()
            self._unit = UNIT_MM.get(self.subclass, 1.0)
            self._is_mm = self._unit == 1.0

    def track(self, row: Row) -> None:
        """Take note of what the row changes for those behind it."""
        if not row[4]:
            return
        data = row[5]
        if row[3] == "SIP":
            raw = data[1:5]
            if len(data) >= _HEAD and (raw != self._raw or self._origin_due):
                self._raw = raw
                raw_x, raw_y = data[1] | data[2] << 8, data[3] | data[4] << 8
                x, y = self._x, self._y
                if self._origin_due and self._is_origin(raw_x) and self._is_origin(raw_y):
                    self._origin_due = False
                    x = y = 0
                self._x = x + ((raw_x - x + _HALF) & (_SPAN - 1)) - _HALF
                self._y = y + ((raw_y - y + _HALF) & (_SPAN - 1)) - _HALF
                self.x_mm = self._x if self._is_mm else round(self._x * self._unit, 3)
                self.y_mm = self._y if self._is_mm else round(self._y * self._unit, 3)
        elif row.type == "SETO":
            self._origin_due = True
        elif row.dir == ROBOT_TO_CLIENT and row.type in ("SYNC2", "CONFIGPAC"):
            if row.type == "SYNC2":
                self._x = self._y = 0
            self._raw = b""
            if self._asked is None:
                self._learn(_subclass_of(data))

    @staticmethod
    def heading_deg(data: bytes) -> float:
        """Return the heading in a SIP's data."""
        return HEADINGS[(data[5] | data[6] << 8) & (_TURN - 1)]

    @staticmethod
    def _is_origin(raw: int) -> bool:
        return (raw + _ORIGIN_UNITS) & (_SPAN - 1) <= 2 * _ORIGIN_UNITS

    def fields(self, row: Row) -> dict[str, Any]:
        """Return the row as the JSON contract has it; a packet that contradicts itself comes with ok false."""
        found: dict[str, Any] = {
            "t": row.t,
            "offset": row.offset,
            "dir": row.dir,
            "type": row.type,
            "ok": row.ok,
        }
        if not row.ok:
            return {**found, "bytes": len(row.data), "error": row.error, "hex": row.data[:256].hex()}
        if row.dir == CLIENT_TO_ROBOT:
            return found | _command_fields(Command.decode(row.data))
        try:
            packet = decode(row.data)
        except PacketError as error:
            return {**found, "ok": False, "bytes": len(row.wire), "error": str(error), "hex": row.wire.hex()}
        if isinstance(packet, Sip):
            return found | self.sip_fields(packet)
        return found | _packet_fields(packet)

    def sip_fields(self, sip: Sip) -> dict[str, Any]:
        """Return what a SIP holds, with the position of the last one that was tracked."""
        tenths = sip.battery if sip.battery_x10 is None else sip.battery_x10
        found = {
            "x_mm": self.x_mm,
            "y_mm": self.y_mm,
            "heading_deg": HEADINGS[sip.th & (_TURN - 1)],
            "vel_left_mm_s": sip.left_vel,
            "vel_right_mm_s": sip.right_vel,
            "battery_v": tenths / 10,
            "stall_left": sip.left_stalled,
            "stall_right": sip.right_stalled,
            "bumpers_front": sip.front_bumpers,
            "bumpers_rear": sip.rear_bumpers,
            "moving": sip.type == TYPE["SIP_MOVING"],
            "motors": bool(sip.flags & FLAG["MOTORS"]),
            "flags": sip.flags,
            "compass": sip.compass,
            "sonar": {str(number): range_mm for number, range_mm in sip.sonars},
        }
        tail = {name: getattr(sip, name) for name in _TAIL}
        found |= {name: value for name, value in tail.items() if value is not None}
        return found | ({"rest": sip.rest.hex()} if sip.rest else {})

    def json_detail(self, row: Row) -> str:
        """Return as JSON what a packet holds beside its time, place, direction and name."""
        fields = self.fields(row)
        return json.dumps({name: value for name, value in fields.items() if name not in _COMMON})

    def json(self, row: Row) -> str:
        """Return `fields` as one line of JSON."""
        data = row[5]
        if row[3] == "SIP" and row[4] and len(data) >= _HEAD:
            layout = self._layout(data)
            if layout is not None:
                t = row[0]
                th, left, right, *ranges = layout.unpack(data)
                state, tail = self._state(data, layout.tail_at)
                return layout.text % (
                    "null" if t is None else repr(t),
                    row[1],
                    self.x_mm,
                    self.y_mm,
                    _HEADING_TEXT[th & 4095],
                    left,
                    right,
                    state,
                    *ranges,
                    tail,
                )
        elif row[4]:
            key = (row[2], row[3], data)
            body = self._bodies.get(key)
            if body is None:
                # All but t and offset follows from the packet alone, and most commands repeat.
                body = json.dumps(self.fields(row._replace(t=None, offset=0))).removeprefix(_NOWHERE)
                if len(self._bodies) >= _CACHE_MAX:
                    self._bodies.clear()
                self._bodies[key] = body
            t = row[0]
            return f'{{"t": {"null" if t is None else repr(t)}, "offset": {row[1]}, {body}'
        return json.dumps(self.fields(row))

    def json_lines(self, rows: Iterable[Row], at_once: bool = True) -> Iterator[str]:
        """Track the rows and yield the JSON of each; without `at_once` many lines in one string."""
        if at_once:
            for row in rows:
                self.track(row)
                yield self.json(row)
            return
        rows = iter(rows)
        while batch := list(itertools.islice(rows, _BATCH_ROWS)):
            yield from self._json_many(batch)

    def _json_many(self, rows: list[Row]) -> list[str]:
        if set(map(_TYPE_AND_OK, rows)) == _ALL_SIPS and (text := self._json_sips(rows)):
            return text
        lines: list[str] = []
        sips: list[Row] = []
        places: list[int] = []
        for row in rows:
            if row[3] == "SIP" and row[4]:
                sips.append(row)
                places.append(len(lines))
                lines.append("")
                continue
            if row[2] == ROBOT_TO_CLIENT or row[3] == "SETO":
                self._fill(lines, places, sips)
                places, sips = [], []
                self.track(row)
            lines.append(self.json(row))
        self._fill(lines, places, sips)
        return lines

    def _fill(self, lines: list[str], places: list[int], sips: list[Row]) -> None:
        """Track the SIPs and put their lines where they belong."""
        found = self._json_sips(sips, in_one=False)
        if not found:
            for row in sips:
                self.track(row)
                found.append(self.json(row))
        for place, line in zip(places, found, strict=True):
            lines[place] = line

    def _json_sips(self, rows: list[Row], in_one: bool = True) -> list[str]:
        """Track SIPs and return their lines, if possible `in_one` string; nothing if they are to be done singly."""
        data = [row[5] for row in rows]
        if len(rows) < _FEW_ROWS or self._origin_due or min(map(len, data)) < _HEAD:
            return []
        from argus_tools.log import bulk

        sips = bulk.Sips(data)
        kinds = list(sips.kinds())
        if any(_HEAD + 3 * count > size for _, size, count in kinds):
            return []
        for members, size, count in kinds:
            for numbers, first in sips.layouts(members, count).items():
                if (numbers, size) not in self._layouts and self._layout(data[first]) is None:
                    return []
                if self._layouts.get((numbers, size)) is None:
                    return []
        heads = self._heads(rows, sips)
        lines = [""] * len(rows)
        for members, size, count in kinds:
            states: list[str] = []
            tails: list[str] = []
            for begin, end in itertools.pairwise(sips.changes(members, size, count)):
                state, tail = self._state(data[members[begin]], _HEAD + 3 * count)
                states += [f', {state}, "sonar": {{'] * (end - begin)
                tails += [f"}}{tail}}}\n"] * (end - begin)
            parts = sips.texts(members, count, heads, states, tails)
            if in_one and len(kinds) == 1:
                parts[-1, -1] = parts[-1, -1][:-1]
                return ["".join(parts.ravel().tolist())]
            for n, words in zip(members.tolist(), parts.tolist(), strict=True):
                lines[n] = "".join(words)[:-1]
        return lines

    def _heads(self, rows: list[Row], sips: Any) -> list[str]:
        """Track the SIPs; return the beginnings of their lines."""
        from argus_tools.log.bulk import unwrapped

        xs: Sequence[float] = unwrapped(sips.x, self._x, _SPAN)
        ys: Sequence[float] = unwrapped(sips.y, self._y, _SPAN)
        self._x, self._y, self._raw = int(xs[-1]), int(ys[-1]), rows[-1][5][1:5]
        if not self._is_mm:
            xs, ys = ([round(value * self._unit, 3) for value in values] for values in (xs, ys))
        self.x_mm, self.y_mm = xs[-1], ys[-1]
        return [
            f'{{"t": {"null" if row[0] is None else repr(row[0])}, "offset": {row[1]}, "dir": "r2c", "type": "SIP", '
            f'"ok": true, "x_mm": {x}, "y_mm": {y}, "heading_deg": '
            for row, x, y in zip(rows, xs, ys, strict=True)
        ]

    def _layout(self, data: bytes) -> _Layout | None:
        """Return how SIPs like this one are printed; None for those that are read the long way."""
        key = (data[_HEAD : _HEAD + 3 * data[19] : 3], len(data))
        try:
            return self._layouts[key]
        except KeyError:
            layout = _make_layout(key[0], data)
        if len(self._layouts) < _CACHE_MAX:
            self._layouts[key] = layout
        return layout

    def _state(self, data: bytes, tail_at: int) -> tuple[str, str]:
        """Return the text of what seldom changes from SIP to SIP: the state before the readings and the tail."""
        key = data[:1] + data[11:19] + data[tail_at:]
        found = self._states.get(key)
        if found is None:
            fields = self.sip_fields(Sip.decode(data))
            state = json.dumps({name: fields[name] for name in _STATE})[1:-1]
            tail = json.dumps({name: fields[name] for name in _TAIL if name in fields})[1:-1]
            found = state, ", " + tail if tail else ""
            if len(self._states) >= _CACHE_MAX:
                self._states.clear()
            self._states[key] = found
        return found


def _make_layout(numbers: bytes, data: bytes) -> _Layout | None:
    count = data[19]
    left = len(data) - _HEAD - 3 * count
    if left < 0 or len(set(numbers)) < count or Sip.decode(data).rest:
        return None
    sonar = ", ".join(f'"{number}": %d' for number in numbers)
    text = (
        '{"t": %s, "offset": %d, "dir": "r2c", "type": "SIP", "ok": true, "x_mm": %s, "y_mm": %s, '
        '"heading_deg": %s, "vel_left_mm_s": %d, "vel_right_mm_s": %d, %s, "sonar": {' + sonar + "}%s}"
    )
    return _Layout(Struct("<5xhhh9x" + "xH" * count).unpack_from, _HEAD + 3 * count, text)


def _subclass_of(data: bytes) -> str | None:
    try:
        packet = decode(data)
    except PacketError:
        return None
    if isinstance(packet, SyncReply):
        return _text(packet.subclass)
    return _text(packet.subtype) if isinstance(packet, ConfigPac) else None


def _command_fields(command: Command) -> dict[str, Any]:
    argument = command.argument
    if not argument:
        return {"arg": None}
    if argument[0] == ARGUMENT["STRING"]:
        return {"arg": _text(command.text), "hex": argument.hex()}
    if argument[0] not in _INTEGERS or len(argument) > 3:
        return {"arg": None, "hex": argument.hex()}
    found: dict[str, Any] = {"arg": command.value}
    if command.number in _PAIRS:
        found["high"], found["low"] = command.bytes_pair
    return found


def _packet_fields(packet: Any) -> dict[str, Any]:
    if isinstance(packet, OtherPacket):
        port = _PORTS.get(packet.type)
        name = next((n for n, number in TYPE.items() if number == packet.type and "_" not in n), None)
        found: dict[str, Any] = {"name": name} if name and port is None else {}
        if port:
            found |= {"port": port, "text": _text(packet.body)}
        return found | {"hex": packet.body.hex()}
    found = {field.name: getattr(packet, field.name) for field in dataclasses.fields(packet)}
    if isinstance(packet, IoPac):
        found["digital_in"], found["digital_out"] = list(packet.digital_in), list(packet.digital_out)
    elif isinstance(packet, GyroPac):
        found["samples"] = [list(sample) for sample in packet.samples]
    found.pop("number", None)
    rest = found.pop("rest", b"")
    found = {name: _plain(value) for name, value in found.items() if value is not None}
    return found | ({"rest": rest.hex()} if rest else {})
