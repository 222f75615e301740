# SPDX-License-Identifier: MIT
"""An MCAP that argus-log or the Foxglove bridge wrote, as the packets that it was made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, Final

from argus_tools.chunks import ROBOT_TO_CLIENT, Chunk, Damage, DamageList, Offsets, ReadOptions
from argus_tools.rings.dated import Dated
from argus_tools.rings.motion import Motion
from argus_tools.rings.packet import identity_of, sip_of
from argus_tools.rings.recording import Broken, Message, Recording, Topic
from argus_tools.ros2_messages import SIP
from hil_sim.arcos import Sip, frame
from hil_sim.tables.robot import DEFAULT_ROBOT, robot_table

STATE: Final = "argus.RobotState"
RANGE: Final = "argus.SonarRange"
_MM: Final = 1000


def is_own(topics: list[Topic]) -> bool:
    """Whether a recording has the topics of Argus itself."""
    kinds = {topic.type for topic in topics}
    return SIP in kinds or {STATE, RANGE} <= kinds


class OwnLog:
    """The reader: a packet for each state of the robot, with the ranges up to the next one."""

    def __init__(self, opened: Callable[[], Recording], options: ReadOptions) -> None:
        self.damage = DamageList()
        self.place = ""
        self._opened = opened
        self._table = robot_table(options.subclass or DEFAULT_ROBOT)

    def __iter__(self) -> Iterator[Chunk]:
        recording, offsets = self._opened(), Offsets()
        try:
            for t, sip in self._sips(recording):
                if not offsets.at[ROBOT_TO_CLIENT]:
                    yield offsets.chunk(t, ROBOT_TO_CLIENT, frame(identity_of(self._table).data))
                yield offsets.chunk(t, ROBOT_TO_CLIENT, frame(sip.data))
        finally:
            recording.close()

    def _sips(self, recording: Recording) -> Iterator[tuple[float | None, Sip]]:
        state: Message | None = None
        t: float | None = None
        ranges: dict[int, int] = {}
        ring = [topic.name for topic in recording.topics if topic.type in (SIP, STATE)]
        for message, stands in Dated(self._whole(recording), ring, self.damage):
            self.place = f"{message.topic} at {message.t:.3f} s"
            if message.type == SIP:
                body = message.body
                yield (
                    _time_of(message, stands),
                    self._sip(body, dict(zip(body.sonar, body.range_mm, strict=True))),
                )
                continue
            if message.type == RANGE:
                ranges[int(message.body.sonar)] = int(message.body.range_mm)
                continue
            if state is not None:
                yield t, self._sip(state.body, ranges)
            state, t, ranges = message, _time_of(message, stands), {}
        if state is not None:
            yield t, self._sip(state.body, ranges)

    def _whole(self, recording: Recording) -> Iterator[Message]:
        wanted = [topic.name for topic in recording.topics if topic.type in (SIP, STATE, RANGE)]
        try:
            yield from recording.messages(wanted)
        except Broken as error:
            self.damage.append(Damage(self.place or "its beginning", f"{error}; the rest is not read"))

    def _sip(self, state: Any, ranges: dict[int, int]) -> Sip:
        motion = Motion(state.x_mm / _MM, state.y_mm / _MM, math.radians(state.heading_deg))
        unit = self._table.odometry["vel_conv_um_s"] / 1000
        return replace(
            sip_of(self._table, motion, ranges),
            left_vel=round(state.vel_left_mm_s / unit),
            right_vel=round(state.vel_right_mm_s / unit),
            flags=int(state.flags),
            battery=round(state.battery_v * 10) & 0xFF,
            stall_left=int(state.stall_left) | int(state.bumpers_rear) << 1,
            stall_right=int(state.stall_right) | int(state.bumpers_front) << 1,
        )


def _time_of(message: Message, stands: bool) -> float | None:
    return None if stands else round(message.t, 6)
