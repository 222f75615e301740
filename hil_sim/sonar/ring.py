# SPDX-License-Identifier: MIT
"""The sonar ring: firing schedule, noise, crosstalk and late echoes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final, NamedTuple, Protocol, SupportsIndex

import numpy as np

from hil_sim.arcos import TIMING
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM, Reading, SonarParams, transducer_pose
from hil_sim.sonar.patch import MovingEchoes
from hil_sim.sonar.rough import Roughness
from hil_sim.sonar.state import ARRAYS, MAX_ORDER, ArrayState, RingState
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.world.model import Pose, World
from hil_sim.world.moving import MovingSolids

PER_ARRAY: Final = TIMING["TRANSDUCERS_PER_ARRAY"]
SOUND_MM_MS: Final = 343.0
RESUME_MS: Final = 1000


class SonarFaults(Protocol):
    """What the ring asks of the injected faults."""

    def apply(
        self, number: int, now_ms: float, true_measured_mm: int, remeasure: Callable[[float], int]
    ) -> tuple[int | None, str | None]:
        """Return the reading after faults (None: the slot stays silent) and the kind that changed it."""

    def note_ping(self, t_ms: float, number: int, true_mm: int, heard_mm: int, value: int | None) -> None:
        """Note a ping that a fault may have changed: what it would have read, and what it reports.

        heard_mm: with noise and crosstalk, without the fault. value: None for a silent slot.
        """


class _Switches(list[bool]):
    """Which arrays fire; remembers that they were set, and which were switched off: that restarts their clock."""

    def __init__(self, values: Iterable[bool]) -> None:
        super().__init__(values)
        self.touched = True
        self.cut: set[int] = set()

    def __setitem__(self, key: SupportsIndex | slice, value: Any) -> None:
        super().__setitem__(key, value)
        self.touched = True
        self.cut |= {array for array, on in enumerate(self) if not on}


class _Ping(NamedTuple):
    """One ping: which sonar, where the robot was, and what was drawn for it, whatever comes of it.

    noise, chance, where: noise, whether it hears another ping, and where that lies. lost, bounced: of `Roughness`.
    others_mm: at which range the ping of another array of the same moment would be heard. late: of `Recorded`.
    """

    number: int
    pose: Pose
    noise: float
    chance: float
    where: float
    lost: bool = False
    bounced: bool = False
    others_mm: float = math.inf
    late: float = 1.0


def _next_ms(state: ArrayState) -> float:
    return state.next_ms


def _completion_ms(reading: Reading) -> float:
    return reading.t_ms


class SonarRing(RingState):
    """The arrays of a robot: every `cycle_ms` each enabled array fires its next transducer.

    enabled: one switch for each array that ARCOS knows; switches of arrays that are not fitted do nothing. kinds: of
    the faults of readings, by the numbers that C knows; None of none.
    """

    def __init__(
        self,
        world: World,
        params: SonarParams | None = None,
        faults: SonarFaults | None = None,
        rng: np.random.Generator | None = None,
        *,
        robot: RobotTable | None = None,
        echoes: EchoModel | None = None,
        moving: MovingSolids | None = None,
        rough: Roughness | None = None,
    ) -> None:
        """`robot`: the one with these sonars; None is the one that is emulated by default.

        `echoes`: a model of the same world, parameters and robot, to share what it has worked out.

        `rough`: departures from the plain model. `moving`: what else is in the way; its owner lets it move.
        """
        self._table = robot if robot is not None else robot_table()
        self._fitted = len(self._table.orders)
        self.params = params or SonarParams()
        self.echoes = echoes if echoes is not None else EchoModel(world, self.params, self._table)
        self.faults = faults
        self.cycle_ms = self._table.cycle_ms
        self.rng = rng = rng if rng is not None else np.random.default_rng(0)
        self._normal: Callable[[], float] = rng.standard_normal
        self._random: Callable[[], float] = rng.random
        self._enabled = _Switches([True] * self._fitted + [False] * (ARRAYS - self._fitted))
        self._arrays = [self._states[array] for array in range(self._fitted)]
        for state, order in zip(self._arrays, self._table.orders, strict=True):
            state.begin(order)
        self._rough = rough
        self._quiet = False
        self._last_ms = math.nan
        self._pending: list[Reading] = []
        self._live: list[ArrayState] = []
        self.kinds: list[str | None] = [None]
        self._fire_ms = -math.inf
        self._ready_ms = math.inf
        self.moving = moving
        self._moving_echoes = MovingEchoes(moving, self.params) if moving is not None else None
        self._known: dict[int, tuple[Pose, int, int]] = {}

    @property
    def enabled(self) -> list[bool]:
        """One switch for each array; set its elements."""
        return self._enabled

    @enabled.setter
    def enabled(self, values: Sequence[bool]) -> None:
        self._enabled[:] = list(values)

    def reset(self) -> None:
        """Return to the power-up firing order and cycle; the switches stay."""
        self.cycle_ms = self._table.cycle_ms
        self._quiet = False
        for state, order in zip(self._arrays, self._table.orders, strict=True):
            state.order = list(order)

    def set_polling(self, numbers: Sequence[int]) -> None:
        """Take a POLLING string: transducers 1 to 32 in firing order.

        An array that is not mentioned keeps its order. In a mentioned one, transducers left out do not fire, and
        repeated ones fire more often. An array takes at most 16 entries; the rest is dropped. Numbers outside 1 to
        32 are passed over. An empty string silences all until the next string that is not empty.
        """
        named = [number - 1 for number in numbers if 1 <= number <= ARRAYS * PER_ARRAY]
        self._quiet = not named
        named = [number for number in named if number < self._table.sonars]
        for array, state in enumerate(self._arrays):
            order = [number for number in named if number // PER_ARRAY == array][:MAX_ORDER]
            if order:
                state.order = order

    def advance(self, now_ms: float, pose_at: Callable[[float], Pose]) -> list[Reading]:
        """Fire what is due up to `now_ms`; return the readings whose echo is in, oldest first.

        `pose_at(t)` gives the true pose at a time since the last call. A pause of more than a second is not made
        up for: firing resumes now.
        """
        last_ms, self._last_ms = self._last_ms, now_ms
        if self._under_way.count:
            self._take_back()
        if now_ms - last_ms > RESUME_MS:
            self._restart(range(self._fitted))
        if self._enabled.touched:
            self._take_switches()
        if now_ms >= self._fire_ms:
            self._fire_due(now_ms, pose_at)
        if now_ms < self._ready_ms:
            return []
        ready = [reading for reading in self._pending if reading.t_ms <= now_ms]
        self._wait_for([reading for reading in self._pending if reading.t_ms > now_ms])
        ready.sort(key=_completion_ms)
        return ready

    # ---- C

    @property
    def is_plain(self) -> bool:
        """Pings are as the plain model has them, apart from faults."""
        return self._rough is None

    @property
    def others(self) -> MovingEchoes | None:
        """What is heard of solids that move."""
        return self._moving_echoes

    @property
    def switched(self) -> bool:
        """An array was switched, which the next sub-step has to note."""
        return self._enabled.touched

    def hand_over(self) -> None:
        """Let C go on with the readings under way."""
        if self._pending:
            self._under_way.put(self._pending, self.kinds)
            self._pending.clear()

    def take_heard(self) -> list[Reading]:
        """Return the readings that C has brought in since the last call."""
        return self._in.take(self.kinds) if self._in.count else []

    def hold(self, readings: Sequence[Reading]) -> None:
        """Let C keep these behind those that it has brought in."""
        self._in.put(readings, self.kinds)

    def _take_back(self) -> None:
        """Go on with the readings under way that C has left."""
        self._pending += self._under_way.take(self.kinds)

    def _take_switches(self) -> None:
        """Note which arrays fire from now on."""
        self._restart(array for array in self._enabled.cut if array < self._fitted)
        self._enabled.cut.clear()
        self._enabled.touched = False
        live = [array for array in range(self._fitted) if self._enabled[array]]
        self._live = [self._arrays[array] for array in live]
        self._live_at[: len(live)] = [*live]
        self._lives = len(live)
        self._fire_ms = -math.inf

    def _wait_for(self, pending: list[Reading]) -> None:
        self._pending = pending
        self._ready_ms = min(map(_completion_ms, pending), default=math.inf)

    def _fire_due(self, now_ms: float, pose_at: Callable[[float], Pose]) -> None:
        live = self._live
        for state in live:
            if math.isnan(state.next_ms):
                state.next_ms = now_ms
        while live:
            first = min(live, key=_next_ms)
            self._fire_ms = _next_ms(first)
            if self._fire_ms > now_ms:
                return
            self._fire(first, self._fire_ms, pose_at)
        self._fire_ms = math.inf

    def fire_all(self, now_ms: float, pose: Pose) -> list[Reading]:
        """Return a reading of every sonar of the enabled arrays, without noise and crosstalk, faults applied.

        This is what emulators that know no schedule do; the firing order and its clock are left alone.
        """
        readings = []
        for array in range(self._fitted):
            if self._enabled[array]:
                for number in self._table.orders[array]:
                    readings += self._fire_one(number, now_ms, pose)
        return readings

    def _fire_one(self, number: int, now_ms: float, pose: Pose) -> list[Reading]:
        true_mm = self.true_range(number, pose)
        value: int | None = true_mm
        if self._rough is not None:
            ping = _Ping(number, pose, 0.0, 1.0, 1.0, *self._rough.draw())
            rough_mm = self._roughly(self._rough, ping, float(true_mm), 0.0)
            value = self._rough.stepped(min(NO_ECHO_MM, max(MIN_MM, round(rough_mm))))
        kind = None
        if self.faults is not None and value is not None:
            value, kind = self.faults.apply(
                number, now_ms, value, lambda angle_deg: self._measure(number, pose, angle_deg)
            )
        return [] if value is None else [Reading(now_ms, number, value, true_mm, kind)]

    def _restart(self, arrays: Iterable[int]) -> None:
        for array in arrays:
            self._arrays[array].next_ms = math.nan
            low = array * PER_ARRAY
            self._wait_for([r for r in self._pending if not low <= r.number < low + PER_ARRAY])
        self._fire_ms = -math.inf

    def _fire(self, state: ArrayState, t_ms: float, pose_at: Callable[[float], Pose]) -> None:
        state.next_ms = t_ms + self.cycle_ms
        if self._quiet:
            return
        number = state.due
        state.place = (state.place + 1) % state.count
        state.last_ms, state.last_number = t_ms, number
        pose = pose_at(t_ms)
        true_mm = self.true_range(number, pose)
        ping = self._draw(state, number, t_ms, pose)
        heard = self._heard(ping, true_mm, 0.0)
        value: int | None = heard
        kind = None
        if self.faults is not None:

            def remeasure(angle_deg: float) -> int:
                return self._heard(ping, self._measure(number, pose, angle_deg), angle_deg)

            value, kind = self.faults.apply(number, t_ms, heard, remeasure)
            if kind is not None:
                self.faults.note_ping(t_ms, number, true_mm, heard, value)
        if value is not None:
            ready_ms = t_ms + min(2 * value / SOUND_MM_MS, self.cycle_ms)
            self._pending.append(Reading(ready_ms, number, value, true_mm, kind))
            if ready_ms < self._ready_ms:
                self._ready_ms = ready_ms

    def _draw(self, state: ArrayState, number: int, t_ms: float, pose: Pose) -> _Ping:
        """Draw what a ping needs: always as much, so that a fault or a world changes no later draw."""
        noise, chance, where = self._normal(), self._random(), self._random()
        if self._rough is None:
            return _Ping(number, pose, noise, chance, where)
        lost, bounced = self._rough.draw()
        others_mm = self._others_mm(self._rough, state, t_ms, pose)
        late = self._rough.recorded.draw() if self._rough.recorded is not None else 1.0
        return _Ping(number, pose, noise, chance, where, lost, bounced, others_mm, late)

    def true_range(self, number: int, pose: Pose) -> int:
        """Return what a sonar reads at a pose without noise, crosstalk and faults."""
        moment = self.moving.moment if self.moving is not None else 0
        known = self._known.get(number)
        if known is not None and known[1] == moment and (known[0] is pose or known[0] == pose):
            return known[2]
        value = self._measure(number, pose, 0.0)
        self._known[number] = (pose, moment, value)
        return value

    def _measure(self, number: int, pose: Pose, angle_deg: float) -> int:
        gain_db = self._rough.gain_db[number] if self._rough is not None else 0.0
        return self.echoes.ping_mm(number, pose, angle_deg, self._moving_echoes, gain_db)

    def _others_mm(self, rough: Roughness, mine: ArrayState, t_ms: float, pose: Pose) -> float:
        """Return at which range the ping of another array of this moment would be heard, at the nearest."""
        found = math.inf
        if not rough.physics.cross_array:
            return found
        for state in self._live:
            number = state.last_number if state.last_ms == t_ms else self._due(state, t_ms)
            if state is not mine and number is not None:
                here, there = self._table.mounts[mine.last_number], self._table.mounts[number]
                apart = math.hypot(here.x_mm - there.x_mm, here.y_mm - there.y_mm)
                range_mm = self.true_range(number, pose)
                if range_mm < NO_ECHO_MM:
                    found = min(found, range_mm + apart / 2)
        return found

    @staticmethod
    def _due(state: ArrayState, t_ms: float) -> int | None:
        return state.due if state.next_ms == t_ms else None

    def _heard(self, ping: _Ping, true_mm: int, angle_deg: float) -> int:
        """Add what a real ping adds: roughness, noise, another sonar's ping, and an echo after the next firing."""
        params = self.params
        value = float(true_mm)
        if self._rough is not None:
            value = self._roughly(self._rough, ping, value, angle_deg)
        crosstalk = params.crosstalk
        recorded = self._rough.recorded if self._rough is not None else None
        if value < NO_ECHO_MM:
            noise_mm = params.noise_mm + params.noise_part * value
            if recorded is None:
                value += ping.noise * noise_mm
            else:
                value = recorded.measured(ping.number, value, noise_mm, ping.noise, ping.late)
        if recorded is not None:  # its short echoes are in the place of these
            crosstalk *= 1 - recorded.strength
        if ping.chance < crosstalk:
            value = MIN_MM + ping.where * (value - MIN_MM)
        if 2 * value / SOUND_MM_MS > self.cycle_ms:
            value = NO_ECHO_MM
        whole = round(value)
        whole = MIN_MM if whole < MIN_MM else min(whole, NO_ECHO_MM)
        return whole if self._rough is None else self._rough.stepped(whole)

    def _roughly(self, rough: Roughness, ping: _Ping, value: float, angle_deg: float) -> float:
        if ping.lost:
            return NO_ECHO_MM
        if ping.bounced:
            way = self.echoes.bounce_mm(ping.number, ping.pose, angle_deg, self._moving_echoes)
            value = float(way) if way is not None and way > value else value
        # A share of the pings as well, by the number that says where a crosstalk reading lies.
        if ping.where < rough.physics.cross_array:
            value = min(value, ping.others_mm)
        if rough.recorded is not None:
            at = transducer_pose(self._table.mounts[ping.number], ping.pose)
            from_ = Pose(at.x_mm, at.y_mm, at.heading_deg + angle_deg)
            value = rough.recorded.heard(ping.number, ping.pose, from_, value)
        return rough.heard(ping.number, value)
