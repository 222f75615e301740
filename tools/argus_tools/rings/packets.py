# SPDX-License-Identifier: MIT
"""A recording of ranges as what a robot with that ring would have sent: who it is, then a packet each 100 ms."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import Final

from argus_tools.chunks import ROBOT_TO_CLIENT, Chunk, Damage, DamageList, Offsets, ReadOptions
from argus_tools.rings.dated import Dated
from argus_tools.rings.intake import Odd
from argus_tools.rings.motion import Motion
from argus_tools.rings.packet import identity_of, packet
from argus_tools.rings.plan import Place, Plan, planned
from argus_tools.rings.recording import Broken, Message, Recording
from argus_tools.rings.stamps import Newer
from hil_sim.arcos import TIMING, frame
from hil_sim.tables.robot import RobotTable

SIP_S: Final = TIMING["SIP_CYCLE_MS"] / 1000
LATE_MOST_S: Final = 0.06
"""A message of all sonars is waited for so much longer than a cycle before a packet without readings goes."""
EARLY_MOST_S: Final = 0.02
"""Messages of all sonars that come faster than a cycle, but for so much, are passed over: they repeat readings."""
GAP_S: Final = 2.0


class RangeLog:
    """The reader: chunks of a robot's link, made of the messages of a recording."""

    def __init__(self, opened: Callable[[], Recording], options: ReadOptions) -> None:
        self.damage = DamageList()
        self.place = ""
        self._opened = opened
        self._options = options
        self._discarded: Counter[str] = Counter()

    def __iter__(self) -> Iterator[Chunk]:
        recording = self._opened()
        try:
            plan = planned(recording, self._options.name, self._options.topic, self._options.subclass)
            self._options.absent = frozenset(range(plan.table.sonars)) - plan.present
            for line in plan.words:
                self._options.tell(line)
            yield from self._chunks(recording, plan)
        finally:
            recording.close()

    def _chunks(self, recording: Recording, plan: Plan) -> Iterator[Chunk]:
        offsets, sips, newer = Offsets(), _Packets(plan), Newer(plan.first)
        plan.first = []
        ring = plan.topics[:1] if plan.sensors.is_array else plan.topics
        for message, stands in Dated(self._whole(recording, plan), ring, self.damage):
            self.place = f"{message.topic} at {message.t:.3f} s"
            try:
                made = sips.take(message, newer)
            except Odd as error:
                self._discard(message, str(error))
                continue
            for at, data in made:
                t = None if stands else at
                if not offsets.at[ROBOT_TO_CLIENT]:
                    yield offsets.chunk(t, ROBOT_TO_CLIENT, frame(identity_of(plan.table).data))
                yield offsets.chunk(t, ROBOT_TO_CLIENT, data)
        for line in newer.words():
            self._options.tell(line)
        for what, count in self._discarded.items():
            self._options.tell(f"discarded: {count} x {what}")

    def _whole(self, recording: Recording, plan: Plan) -> Iterator[Message]:
        wanted = [*plan.topics, *plan.transforms, *filter(None, [plan.odometry])]
        try:
            yield from recording.messages(wanted)
        except Broken as error:
            self.damage.append(Damage(self.place or "its beginning", f"{error}; the rest is not read"))

    def _discard(self, message: Message, why: str) -> None:
        self._discarded[f"{message.topic}: {why}"] += 1


class Pacer:
    """Gathers readings and gives packets: with each message of all sonars, and one a cycle where these are missing."""

    def __init__(self, table: RobotTable, is_array: bool, motion_at: Callable[[float], Motion]) -> None:
        self._table, self._is_array, self._motion_at = table, is_array, motion_at
        self._fresh: dict[int, int] = {}
        self._last: float | None = None

    def due(self, t: float) -> list[tuple[float, bytes]]:
        """Return the packets between the last and a time, one a cycle; none over a gap."""
        made: list[tuple[float, bytes]] = []
        if self._last is None:
            return made
        if not 0 <= t - self._last <= GAP_S:
            self._last = t - SIP_S
        late_s = LATE_MOST_S if self._is_array else 0.0
        while t - self._last >= SIP_S + late_s:
            made.append(self._packet(self._last + SIP_S))
        return made

    def take(self, t: float, readings: Mapping[int, int | None]) -> list[tuple[float, bytes]]:
        """Take the readings of a message, None for none; return the packet that they make, if they make one."""
        self._fresh |= {number: reading for number, reading in readings.items() if reading is not None}
        if self._last is None:
            self._last = t - SIP_S
        is_due = self._is_array and t - self._last >= SIP_S - EARLY_MOST_S
        return [self._packet(t)] if is_due else []

    def _packet(self, t: float) -> tuple[float, bytes]:
        fresh, self._fresh, self._last = self._fresh, {}, t
        return round(t, 6), packet(self._table, self._motion_at(t), fresh)


class _Packets:
    """Packets of messages, with the robot's motion at their times."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._place = Place(plan)
        self._ring = frozenset(plan.topics)
        self._pacer = Pacer(plan.table, plan.sensors.is_array, self._place.at)

    def take(self, message: Message, newer: Newer) -> list[tuple[float, bytes]]:
        """Take the next message; return the packets that are due, with their times."""
        made = self._pacer.due(message.t)
        if message.topic not in self._ring:
            if message.topic == self._plan.odometry:
                newer.check(message)
            self._place.take(message)
            return made
        newer.check(message)
        readings = self._plan.sensors.take(message)
        return made + self._pacer.take(message.t, self._plan.millimetres(readings))
