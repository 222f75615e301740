# SPDX-License-Identifier: MIT
"""Rule: the sonar readings on the wire follow POLLING, SONAR_CYCLE and the switches to the transducer."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from doubles import PERFECT, Session, WallAhead, cmd, sips
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hil_sim.arcos import COMMAND, TIMING, Command, frame
from hil_sim.robot.robot import Robot
from hil_sim.server.server import ArcosServer
from hil_sim.sonar.params import SonarParams
from hil_sim.sonar.ring import SonarRing
from hil_sim.world.model import Pose, World

PER_ARRAY = TIMING["TRANSDUCERS_PER_ARRAY"]
ORDER_MAX = TIMING["POLLING_MAX_PER_ARRAY"]
CYCLE_MS = 40
# A wall so near that every echo is in within the slot it was fired in.
WALLS = np.array(
    [(500, -500, 500, 500), (-500, -500, -500, 500), (-500, 500, 500, 500), (-500, -500, 500, -500)]
)


def new_session() -> Session:
    world = World("box", WALLS.astype(float), np.ones(len(WALLS)), Pose(0, 0, 0))
    ring = SonarRing(world, SonarParams(crosstalk=0.0), rng=np.random.default_rng(1))
    session = Session(ArcosServer(Robot(WallAhead(), ring, Pose(0, 0, 0), odometry_error=PERFECT)))
    session.connect(enable=False)
    return session


@dataclass
class Model:
    """What the protocol reference says an array does, slot by slot, counted from the last POLLING that named it."""

    orders: list[list[int]] = field(
        default_factory=lambda: [list(range(PER_ARRAY)), list(range(PER_ARRAY, 2 * PER_ARRAY))]
    )
    quiet: bool = False

    def poll(self, numbers: list[int]) -> None:
        """Take a POLLING string."""
        self.quiet = not numbers
        for array in (0, 1):
            named = [number - 1 for number in numbers if (number - 1) // PER_ARRAY == array]
            if named:
                self.orders[array] = named[:ORDER_MAX]


def cyclic_from(fired: list[int], order: list[int], first: int | None = None) -> bool:
    """Whether `fired` is `order` repeated; begun at its element `first` if given, else anywhere."""
    starts = range(len(order)) if first is None else [first]
    return any(fired == [order[(s + k) % len(order)] for k in range(len(fired))] for s in starts)


def by_array(numbers: list[int]) -> list[list[int]]:
    return [[n for n in numbers if n // PER_ARRAY == array] for array in (0, 1)]


def readings(session: Session, ms: float) -> list[list[int]]:
    """The sonar numbers of each array on the wire during a time, as they come."""
    return by_array([number for sip in sips(session.run(ms)) for number, _ in sip.sonars])


sequences = st.lists(st.integers(1, 32), max_size=40)


@settings(max_examples=60, deadline=None)
@example([[1, 1, 1]])
@example([[]])
@example([[8] * 20, [16]])
@example([[], [5, 3]])
@given(st.lists(sequences, min_size=1, max_size=4))
def test_any_polling_sequence_comes_out_as_it_went_in(strings: list[list[int]]) -> None:
    session, model = new_session(), Model()
    for numbers in strings:
        session.send(frame(Command.string(COMMAND["POLLING"], bytes(numbers)).data))
        named = [bool(by_array([n - 1 for n in numbers])[array]) for array in (0, 1)]
        model.poll(numbers)
        # What was fired before is through with the next SIP; its own readings begin the new sequence.
        slots = 3 * ORDER_MAX
        before, fired = readings(session, 100), readings(session, slots * CYCLE_MS - slots * CYCLE_MS % 100)
        for array in (0, 1):
            order = model.orders[array]
            if model.quiet:
                assert fired[array] == [], (numbers, array)
                continue
            expected = (slots * CYCLE_MS - slots * CYCLE_MS % 100) / CYCLE_MS
            assert abs(len(fired[array]) - expected) <= 1, (numbers, array, fired[array])
            assert cyclic_from(fired[array], order), (numbers, array, fired[array])
            if named[array]:
                # From the first firing on it is the order itself, begun at its beginning.
                start = [
                    k
                    for k in range(len(before[array]) + 1)
                    if cyclic_from(before[array][k:] + fired[array], order, 0)
                ]
                assert start, (numbers, array, before[array], fired[array][:8])


@settings(max_examples=40, deadline=None)
@given(sequences.filter(bool), st.integers(20, 120), st.lists(st.integers(0, 5), max_size=4))
def test_cycle_and_switches_change_the_pace_and_the_arrays_not_the_order(
    numbers: list[int], cycle_ms: int, switches: list[int]
) -> None:
    session, model = new_session(), Model()
    session.send(frame(Command.string(COMMAND["POLLING"], bytes(numbers)).data), cmd("SONAR_CYCLE", cycle_ms))
    model.poll(numbers)
    on = [True, True]
    for argument in switches:
        session.send(cmd("SONAR", argument))
        on = [bool(argument & 1) if argument >> 1 in (0, array + 1) else on[array] for array in (0, 1)]
    session.run(300)
    fired = readings(session, 3000)
    for array in (0, 1):
        if not on[array]:
            assert fired[array] == []
            continue
        assert cyclic_from(fired[array], model.orders[array]), (numbers, array, fired[array])
        assert abs(len(fired[array]) - 3000 / cycle_ms) <= 2
