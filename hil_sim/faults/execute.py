# SPDX-License-Identifier: MIT
"""Executes the sonar faults and bumper hits of a run when they are due."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable

import numpy as np

from hil_sim.faults.kinds import BumperHit, Fault, FaultChange, LinkFault, SonarFault, WheelFault, When
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM
from hil_sim.world.model import Pose


class _State:
    """How far one sonar fault has come."""

    def __init__(self, fault: SonarFault) -> None:
        self.fault = fault
        self.started = fault.start is None
        self.ended = False
        self.told = False
        self.held: dict[int, int] = {}
        self.mended: set[int] = set()
        self.since: float | None = None
        self.part = 1.0 if fault.ramp is None else 0.0

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> list[FaultChange]:
        """Begin or end; return the change of each sonar."""
        if self.ended:
            return []
        fault = self.fault
        if not self.started:
            assert fault.start is not None
            self.started = fault.start.met(now_ms, pose, travelled_mm)
        if self.started and fault.end is not None:
            self.ended = fault.end.met(now_ms, pose, travelled_mm)
        self._grow(now_ms, travelled_mm)
        if self.on == self.told:
            return []
        self.told = self.on
        return [self.change(now_ms, number) for number in fault.sonars if number not in self.mended]

    def change(self, now_ms: float, number: int) -> FaultChange:
        """What is to be told of a sonar that has it now, or has it no longer."""
        on = self.has(number)
        return FaultChange(now_ms, self.fault.kind, on, self.fault.text, sonar=number)

    def _grow(self, now_ms: float, travelled_mm: float) -> None:
        """Let a fault with a ramp grow, from where it began."""
        ramp = self.fault.ramp
        if ramp is not None and self.on:
            here = now_ms if ramp.variable == "t" else travelled_mm
            self.since = here if self.since is None else self.since
            self.part = ramp.grown(self.since, here)

    def has(self, number: int) -> bool:
        """Whether it is on and of this sonar."""
        return self.on and number in self.fault.sonars and number not in self.mended

    def may_have(self, number: int) -> bool:
        """Whether it is of this sonar, or will be."""
        return not self.ended and number in self.fault.sonars and number not in self.mended

    def hold(self, number: int, measured: int) -> None:
        """Keep the reading at onset of one that is stuck; also while another fault hides it."""
        if self.fault.kind == "stuck" and self.has(number):
            value = self.fault.value
            self.held.setdefault(number, measured if value is None else value)

    @property
    def on(self) -> bool:
        return self.started and not self.ended

    @property
    def spent(self) -> bool:
        """It is over for every sonar that it was of."""
        return self.ended or self.mended.issuperset(self.fault.sonars)

    @property
    def settled(self) -> bool:
        """It has ended, or is on for good: it does not change any more."""
        return self.ended or (self.on and self.fault.end is None and self.part >= 1.0)


class _Wheel:
    """How far one fault of a wheel has come."""

    def __init__(self, fault: WheelFault) -> None:
        self.fault = fault
        self.started = self.ended = self.told = False

    @property
    def on(self) -> bool:
        return self.started and not self.ended

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> list[FaultChange]:
        """Begin or end; return the change."""
        fault = self.fault
        here = now_ms, pose, travelled_mm
        self.started = self.started or fault.start is None or fault.start.met(*here)
        self.ended = self.ended or (self.started and fault.end is not None and fault.end.met(*here))
        if self.on == self.told:
            return []
        self.told = self.on
        return [FaultChange(now_ms, "wheel", self.on, fault.text)]


def _awaited(one: _State | _Wheel) -> When | None:
    """What must come before it begins or ends."""
    if one.ended:
        return None
    return one.fault.end if one.started else one.fault.start


class FaultSet:
    """Executes the faults of sonars and wheels and the bumper hits of a run; link faults are left to the link."""

    def __init__(self, faults: Iterable[Fault] = (), rng: np.random.Generator | None = None) -> None:
        self.faults = list(faults)
        self._rng = rng if rng is not None else np.random.default_rng(0)
        self._states: list[_State] = []
        self._hits = [fault for fault in self.faults if isinstance(fault, BumperHit)]
        self._pressed = [False] * len(self._hits)
        self._wheels = [_Wheel(fault) for fault in self.faults if isinstance(fault, WheelFault)]
        self._waiting: list[_State] = []
        self._afflicted: set[int] = set()
        self._echoes: dict[int, deque[int]] = {}
        self._mended: list[tuple[_State, int]] = []
        for fault in self.faults:
            if isinstance(fault, SonarFault):
                self._take(fault)

    def _take(self, fault: SonarFault) -> None:
        state = _State(fault)
        self._states.append(state)
        self._waiting.append(state)
        self._afflicted.update(fault.sonars)
        for number in fault.sonars if fault.kind == "slow" else ():
            kept = self._echoes.get(number, deque(maxlen=1))
            self._echoes[number] = deque(kept, maxlen=max(fault.n + 1, kept.maxlen or 0))

    def inject(self, fault: SonarFault) -> None:
        """Take one fault more while the robot runs; as the last one written it wins."""
        self.faults.append(fault)
        self._take(fault)

    def mend(self, number: int) -> bool:
        """Take every fault from a sonar, those to come too; tell whether it had one."""
        found = [state for state in self._states if state.may_have(number)]
        self._mended += [(state, number) for state in found if state.told]
        for state in found:
            state.mended.add(number)
        self._states = [state for state in self._states if not state.spent]
        self._waiting = [state for state in self._waiting if not state.spent]
        return bool(found)

    @property
    def link_faults(self) -> list[LinkFault]:
        """The faults of the link."""
        return [fault for fault in self.faults if isinstance(fault, LinkFault)]

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> list[FaultChange]:
        """Begin and end faults; return what changed. Call it before the ring fires."""
        changes = [state.change(now_ms, number) for state, number in self._mended]
        self._mended.clear()
        for wheel in self._wheels:
            changes += wheel.update(now_ms, pose, travelled_mm)
        if not self._waiting and not self._hits:
            return changes
        begun = [change for state in self._waiting for change in state.update(now_ms, pose, travelled_mm)]
        if begun:
            self._waiting = [state for state in self._waiting if not state.settled]
        return changes + begun + self._press(now_ms)

    def _press(self, now_ms: float) -> list[FaultChange]:
        """Press and release bumpers."""
        changes: list[FaultChange] = []
        for k, hit in enumerate(self._hits):
            pressed = hit.start_ms <= now_ms < hit.end_ms
            if pressed != self._pressed[k]:
                self._pressed[k] = pressed
                changes.append(FaultChange(now_ms, "bumper", pressed, hit.text, segment=hit.segment))
        return changes

    def waits(self, now_ms: float) -> list[When] | None:
        """What must come before `update` has something to do; None: it has now."""
        waiting: list[_State | _Wheel] = [*self._waiting, *self._wheels]
        if self._mended or any(one.on != one.told for one in waiting):
            return None
        found = [when for one in waiting if (when := _awaited(one)) is not None]
        bounds = [ms for hit in self._hits for ms in (hit.start_ms, hit.end_ms) if ms > now_ms]
        return found + [When("t", 1, ms) for ms in bounds]

    @property
    def afflicted(self) -> int:
        """Sonars that have or had faults, or will, as a mask."""
        return sum(1 << number for number in self._afflicted)

    def active(self, number: int) -> SonarFault | None:
        """Return the fault that a sonar has now: of several the one written last."""
        for state in reversed(self._states):
            if state.has(number):
                return state.fault
        return None

    def apply(
        self, number: int, now_ms: float, true_measured_mm: int, remeasure: Callable[[float], int]
    ) -> tuple[int | None, str | None]:
        """Return what a sonar reports for what it measured, None for a silent slot, and the fault's kind.

        `remeasure(angle_deg)` gives what it would have measured with its axis turned.
        """
        del now_ms  # `update` has decided what is on
        if number not in self._afflicted:
            return true_measured_mm, None
        echoes = self._echoes.get(number)
        if echoes is not None:
            echoes.append(true_measured_mm)
        for state in self._states:
            state.hold(number, true_measured_mm)
        for state in reversed(self._states):
            if state.has(number):
                return self._report(state, number, true_measured_mm, remeasure), state.fault.kind
        return true_measured_mm, None

    def _report(
        self, state: _State, number: int, measured: int, remeasure: Callable[[float], int]
    ) -> int | None:
        fault = state.fault
        if fault.kind == "off":
            return NO_ECHO_MM
        if fault.kind == "silent":
            return None
        if fault.kind == "stuck":
            return state.held[number]
        if fault.kind == "garbage":
            return int(self._rng.integers(_low(fault), _high(fault) + 1))
        if fault.kind == "slow":
            echoes = self._echoes[number]
            return echoes[max(0, len(echoes) - 1 - fault.n)]
        if fault.kind == "intermittent":
            return self._drop(state, measured)
        base = measured if fault.angle is None else remeasure(fault.angle * state.part)
        scale = 1.0 + (fault.scale - 1.0) * state.part
        return int(min(_high(fault), max(_low(fault), round(base * scale + fault.offset * state.part))))

    def _drop(self, state: _State, measured: int) -> int:
        fault = state.fault
        if fault.beyond is None:
            lost = self._rng.random() < fault.p * state.part
        else:
            hears_to = NO_ECHO_MM + (fault.beyond - NO_ECHO_MM) * state.part
            lost = self._rng.random() < fault.p and measured > hears_to
        return measured if not lost else NO_ECHO_MM if fault.value is None else fault.value

    def note_ping(self, t_ms: float, number: int, true_mm: int, heard_mm: int, value: int | None) -> None:
        """Note a ping that a fault may have changed; for those that judge by it."""

    def wheels(self) -> tuple[float, float]:
        """Return the part that the left and the right wheel turn of what they should."""
        parts = {"left": 1.0, "right": 1.0}
        for wheel in self._wheels:
            parts[wheel.fault.side] *= wheel.fault.part if wheel.on else 1.0
        return parts["left"], parts["right"]

    def bumper(self, now_ms: float) -> int:
        """Return the front bumper bits that hits press now: bit 1 leftmost to bit 5 rightmost."""
        mask = 0
        for hit in self._hits:
            if hit.start_ms <= now_ms < hit.end_ms:
                mask |= 1 << hit.segment
        return mask


def _low(fault: SonarFault) -> int:
    return MIN_MM if fault.low is None else fault.low


def _high(fault: SonarFault) -> int:
    return NO_ECHO_MM if fault.high is None else fault.high
