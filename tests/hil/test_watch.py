# SPDX-License-Identifier: MIT
"""Rule (S1 to S8): the monitor finds in the record of a drive each rule that was broken, and none where none was."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pytest
from argus_tools.chunks import CLIENT_TO_ROBOT, ROBOT_TO_CLIENT
from harness import Bench
from rules import assert_reached
from watch import Fact, facts_of, watch
from worlds import hall

from hil_sim.arcos import COMMAND, TYPE, Command, Unframer, frame

SETTINGS: Final = {"profile": "paper"}
SIPS: Final = (TYPE["SIP_MOVING"], TYPE["SIP_STATIONARY"])


def altered(facts: list[Fact], change: Callable[[bytes], bytes | None]) -> list[Fact]:
    """The same drive, had argusd sent others of its packets."""
    frames, made = Unframer(), []
    for fact in facts:
        if fact.what != CLIENT_TO_ROBOT:
            made.append(fact)
            continue
        packets = [change(bytes(one)) for one in frames.feed(fact.about, fact.unix_s * 1000)]
        made.append(fact._replace(about=b"".join(frame(one) for one in packets if one is not None)))
    return made


def without(*names: str) -> Callable[[bytes], bytes | None]:
    """A manager that never sends these."""
    numbers = {COMMAND[name] for name in names}
    return lambda data: None if data[0] in numbers else data


def faster(data: bytes) -> bytes:
    """A manager that sets too high a speed."""
    return Command.integer(COMMAND["SETV"], 750).data if data[0] == COMMAND["SETV"] else data


def deafened(facts: list[Fact]) -> list[Fact]:
    """The sonars ahead have never reported, and it drives on their readings nonetheless."""
    frames, made = Unframer(), []
    for fact in facts:
        if fact.what != ROBOT_TO_CLIENT:
            made.append(fact)
            continue
        packets = [bytes(one) for one in frames.feed(fact.about, fact.unix_s * 1000)]
        # The list of readings becomes an empty one; what follows it is read by nobody here.
        packets = [one[:19] + b"\0" + one[20:] if one[0] in SIPS else one for one in packets]
        made.append(fact._replace(about=b"".join(frame(one) for one in packets)))
    return made


def touching(facts: list[Fact]) -> list[Fact]:
    """It meets something at its fastest."""
    fastest = max(
        (fact for fact in facts if fact.what == "state"), key=lambda fact: float(fact.about["v_mm_s"])
    )
    hit = Fact(fastest.unix_s + 0.001, 1, "collision", {"type": "collision"})
    return sorted([*facts, hit], key=lambda fact: (fact.unix_s, fact.order))


MUTANTS: Final[dict[str, tuple[set[int], Callable[[list[Fact]], list[Fact]]]]] = {
    "no E_STOP": ({21}, lambda facts: altered(facts, without("E_STOP", "STOP"))),
    "SETV 750": ({55}, lambda facts: altered(facts, faster)),
    "S6, nothing heard": ({61}, deafened),
    "contact": ({54}, touching),
}


@pytest.mark.long
@pytest.mark.monitored
def test_it_finds_each_breach_in_a_recorded_drive(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "bumper:3@6s-8s")
    argusd = bench.argusd("--goal", "1500,0", config=SETTINGS)
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, 1500)
    bench.close()
    facts = facts_of(sim, argusd, bench.recordings[0], float("inf"))
    assert {fact.what for fact in facts} >= {CLIENT_TO_ROBOT, ROBOT_TO_CLIENT, "state", "status", "event"}
    assert not (found := watch(facts, SETTINGS)), [str(one) for one in found]
    for name, (rules, mutate) in MUTANTS.items():
        broken = {one.rule for one in watch(mutate(facts), SETTINGS)}
        assert broken & rules, f"{name}: {broken}"
