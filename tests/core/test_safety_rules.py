# SPDX-License-Identifier: MIT
"""Rule: each rule of the safety monitor fires on a trace that breaks it, and not on one at its border."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

import pytest
from safety_monitor import Monitor

MOTORS: Final = 1
ARRAY: Final = range(16)
NAME: Final = b"\x02Robot\0Pioneer\0"


def packet(data: bytes) -> bytes:
    """Frame the data."""
    total = 0
    for at in range(0, len(data) - 1, 2):
        total = (total + (data[at] << 8 | data[at + 1])) & 0xFFFF
    if len(data) % 2:
        total ^= data[-1]
    return bytes([0xFA, 0xFB, len(data) + 2]) + data + bytes([total >> 8, total & 0xFF])


def signed(value: int) -> bytes:
    """Two bytes, low first."""
    return (value & 0xFFFF).to_bytes(2, "little")


class Trace:
    """A monitor, and a clock that goes on by 100 ms with each SIP."""

    def __init__(self, subclass: str = "p3dx-sh", **settings: int) -> None:
        self.monitor = Monitor(**settings)
        self.t_ms = 1000
        self.x = self.deg = 0.0
        self.monitor.from_robot(self.t_ms, packet(NAME + subclass.encode() + b"\0"))
        self.say(1)

    def say(self, command: int, value: int | None = None) -> Trace:
        """To the robot."""
        sign = 0x1B if value is not None and value < 0 else 0x3B
        data = bytes([command]) + (b"" if value is None else bytes([sign]) + signed(abs(value)))
        self.monitor.to_robot(self.t_ms, packet(data))
        return self

    def sip(
        self,
        readings: dict[int, int] | None = None,
        v: int = 0,
        *,
        front: int = 0,
        rear: int = 0,
        deg: float | None = None,
        after_ms: int = 100,
    ) -> Trace:
        """From the robot: it has gone on at v since the last one."""
        self.t_ms += after_ms
        self.x += v * after_ms / 1000
        self.deg = self.deg if deg is None else deg
        data = bytes([0x33]) + signed(round(self.x)) + signed(0) + signed(round(self.deg * 4096 / 360))
        data += signed(v) * 2 + bytes([126, rear, front]) + signed(0) + signed(MOTORS | 6) + b"\0"
        listed = {n: 3000 for n in ARRAY} if readings is None else readings
        data += bytes([len(listed)]) + b"".join(bytes([n]) + signed(mm) for n, mm in listed.items())
        self.monitor.from_robot(self.t_ms, packet(data + bytes(5) + signed(126) + bytes(5)))
        return self

    def wait(self, ms: int) -> Trace:
        """Nothing passes."""
        self.t_ms += ms
        self.monitor.tick(self.t_ms)
        return self

    @property
    def rules(self) -> set[int]:
        """What was broken."""
        self.monitor.tick(self.t_ms + 1)
        return {one.rule for one in self.monitor.violations}


def near(sonar: int, mm: int) -> dict[int, int]:
    """All read far, but one."""
    return {**dict.fromkeys(ARRAY, 3000), sonar: mm}


def drives() -> Trace:
    """A trace in which the robot is told to go ahead at 200 mm/s, and does."""
    return Trace().sip().say(6, 200).say(8, 3000).sip(v=200)


def blind(trace: Trace, metres: int) -> Trace:
    """Sonar 3 is out, and the robot goes on with a heading that never swings."""
    trace.monitor.health([("DISABLED", "off") if n == 3 else ("HEALTHY", "none") for n in ARRAY])
    for _ in range(metres):
        trace.sip(v=200)
    return trace


def alone(out: int, sips: int) -> Trace:
    """So many sonars are out, and the robot goes on."""
    trace = drives()
    trace.monitor.health([("DISABLED", "off")] * out)
    for _ in range(sips):
        trace.sip(v=200)
    return trace


def without(sonar: int, sips: int) -> Trace:
    """One sonar reports no more, and the robot goes on."""
    trace = drives()
    for _ in range(sips):
        trace.sip({n: 3000 for n in ARRAY if n != sonar}, 200)
    return trace


def truth(trace: Trace, v: float, w: float, *, contact: bool) -> Trace:
    """The robot as it really is."""
    trace.monitor.truth(trace.t_ms, v, w, 0 if contact else 500, contact)
    return trace


def after_silence(v: float) -> Trace:
    """For 6 s nobody has spoken to it."""
    trace = drives()
    for _ in range(60):
        trace.t_ms += 100
        truth(trace, v, 0, contact=False)
    return trace


def swept(back_deg: int) -> Trace:
    """It stands, turns aside and back, says SWEEP and goes on."""
    trace = Trace().sip().say(12, 40).sip(deg=40).say(12, back_deg).sip(deg=back_deg)
    trace.monitor.event(trace.t_ms, 55)
    return trace.say(6, 100).say(8, 200)


Case = Callable[[], Trace]
CASES: Final[dict[str, tuple[int, Case, Case]]] = {
    "S1 far": (11, lambda: blind(drives(), 40), lambda: blind(drives(), 2)),
    "S1 none": (12, lambda: alone(16, 20), lambda: alone(15, 1)),
    "S2 bumper": (21, lambda: drives().sip(v=200, front=8), lambda: drives().sip(v=200, front=8).say(55)),
    "S2 bumper, STOP is not enough": (
        21,
        lambda: drives().sip(v=200, front=8).say(29),
        lambda: drives().say(29).sip(v=100, front=8),
    ),
    "S2 stall": (22, lambda: drives().sip(v=200, front=1), lambda: drives().sip(v=200, front=1).say(29)),
    "S2 object": (23, lambda: drives().sip(near(3, 250), 200), lambda: drives().sip(near(3, 251), 200)),
    "S2 silent": (24, lambda: without(3, 20), lambda: without(3, 14)),
    "S2 no SIP": (25, lambda: drives().wait(800), lambda: drives().wait(640).say(29).wait(400)),
    "S2 resume": (
        26,
        lambda: drives().wait(640).say(29).sip().say(8, 100),
        lambda: drives().wait(640).say(29).sip().say(11, 0).say(21, 0).say(8, 100),
    ),
    "S3": (31, lambda: after_silence(200), lambda: after_silence(0)),
    "S4": (41, lambda: swept(20), lambda: swept(4)),
    "S5 speed": (
        51,
        lambda: Trace().sip().say(6, 500).say(8, 3000).sip(v=500).sip(near(3, 400), 500),
        lambda: Trace().sip().say(6, 500).say(8, 3000).sip(v=500).sip(near(3, 400), 500).say(6, 325),
    ),
    "S5 no echo": (
        52,
        lambda: (
            Trace()
            .sip(dict.fromkeys(ARRAY, 5000))
            .say(6, 200)
            .say(8, 900)
            .sip(dict.fromkeys(ARRAY, 5000), 200)
        ),
        lambda: (
            Trace()
            .sip(dict.fromkeys(ARRAY, 5000))
            .say(6, 100)
            .say(8, 900)
            .sip(dict.fromkeys(ARRAY, 5000), 100)
        ),
    ),
    "S5 body": (53, lambda: Trace("pioneer9").say(4, 1), lambda: Trace("P3DX-SH").say(4, 1)),
    "S5 contact": (
        54,
        lambda: truth(drives(), 100, 0, contact=True),
        lambda: truth(drives(), 0, 0, contact=True),
    ),
    "S5 ceiling": (55, lambda: Trace().say(6, 501), lambda: Trace().say(6, 500)),
    "S6": (
        61,
        lambda: Trace().sip({n: 3000 for n in ARRAY if n != 5}).say(8, 400),
        lambda: Trace().sip({n: 3000 for n in ARRAY if n != 9}).say(8, 400),
    ),
    "S7 bumper": (71, lambda: Trace().sip(front=8).say(12, 5), lambda: Trace().sip(front=8).say(12, 0)),
    "S7 echo": (
        72,
        lambda: Trace().sip(near(8, 110)).say(12, 15),
        lambda: Trace().sip(near(8, 200)).say(12, 15),
    ),
    "S7 contact": (
        73,
        lambda: truth(drives(), 0, 30, contact=True),
        lambda: truth(drives(), 0, 2, contact=True),
    ),
    "S7 circle": (
        74,
        lambda: Trace().sip(near(7, 205)).say(12, 40),
        lambda: Trace().sip(near(7, 260)).say(12, 40),
    ),
    "S8 command": (82, lambda: Trace().say(11, 100), lambda: Trace().say(11, 0)),
}


@pytest.mark.parametrize("case", CASES)
def test_it_fires_on_a_breach_and_not_at_the_border(case: str) -> None:
    rule, breach, border = CASES[case]
    assert rule in breach().rules
    assert rule not in border().rules


def upper_deck(mm: int) -> Trace:
    """A PeopleBot at 400 mm/s, and sonar 19 of its upper deck, 89 mm behind the others, reads so much."""
    ring = dict.fromkeys(range(32), 3000)
    trace = Trace("peoplebot-sh", sonars=32).sip(ring).say(6, 400).say(8, 3000).sip(ring, 400)
    return trace.sip(ring | {19: mm}, 400).say(8, 2000)


def test_an_upper_deck_sees_the_way_from_behind() -> None:
    """At 374 mm/s, which the monitor lets pass for 400, it stands after 415 mm: 574 mm of what such a sonar reads."""
    assert upper_deck(560).rules == {51}
    assert not upper_deck(600).rules


@pytest.mark.parametrize(("v", "broken"), [(80, set()), (200, {12})])
def test_with_leave_and_no_sonar_left_it_may_creep(v: int, broken: set[int]) -> None:
    trace = Trace(creep_mm_s=80).sip().say(6, v).say(8, 3000).sip(v=v)
    trace.monitor.health([("DISABLED", "silent")] * 16)
    for _ in range(60):
        trace.sip(v=v)
    assert trace.rules & {11, 12} == broken


@pytest.mark.parametrize(("seto", "broken"), [(True, set()), (False, {11})])
def test_a_new_origin_is_no_way_back(seto: bool, broken: set[int]) -> None:
    """A client lets the robot count from here while one that looks astern is out: nobody drove astern."""
    trace = Trace(guard=1).sip().say(6, 100).say(8, 3000)
    trace.monitor.health([("DISABLED", "off") if n == 11 else ("HEALTHY", "none") for n in ARRAY])
    for _ in range(39):
        trace.sip(v=100)
    if seto:
        trace.say(7)
    trace.x = 0
    assert trace.sip(v=100).rules & {11} == broken


def test_bytes_that_are_no_packet_are_found() -> None:
    trace = Trace()
    trace.monitor.to_robot(trace.t_ms, packet(b"\x1d")[:-1] + b"\x00")
    assert 81 in trace.rules


def test_an_operator_who_holds_it_is_heeded() -> None:
    trace = Trace().sip()
    trace.monitor.hold(trace.t_ms, holds=True)
    assert 91 in trace.say(8, 100).rules
    trace = Trace().sip()
    trace.monitor.hold(trace.t_ms, holds=True)
    trace.monitor.hold(trace.t_ms, holds=False)
    assert not trace.say(8, 100).rules


def test_packets_in_parts_are_read_as_whole_ones() -> None:
    whole, parts = Monitor(), Monitor()
    for monitor in (whole, parts):
        monitor.from_robot(0, packet(NAME + b"p3dx-sh\0"))
    data = packet(b"\x01") + packet(bytes([8, 0x3B]) + signed(400))
    whole.to_robot(10, data)
    for byte in data:
        parts.to_robot(10, bytes([byte]))
    assert [one.rule for one in whole.violations] == [one.rule for one in parts.violations] == [61]
