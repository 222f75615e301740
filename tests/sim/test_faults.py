# SPDX-License-Identifier: MIT
"""Rule: each fault does what its definition says and nothing else, from its start to its end, to the sonars named;
and any text is a fault or one line that says what is wrong with it."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hil_sim.errors import SimError
from hil_sim.faults.execute import FaultSet
from hil_sim.faults.grammar import fault_help, parse_fault
from hil_sim.faults.kinds import LINK_KINDS, SONAR_KINDS, BumperHit, Fault, LinkFault, SonarFault
from hil_sim.sonar.params import SonarParams
from hil_sim.sonar.ring import SonarRing
from hil_sim.world.model import Pose, World

HOME = Pose(0, 0, 0)
LOW, HIGH = 100, 5000


def no_angle(angle_deg: float) -> int:
    raise AssertionError("nobody asked for another axis")


def faults(*texts: str, seed: int = 1) -> FaultSet:
    """The faults, begun where they begin at once."""
    made = FaultSet([parse_fault(text) for text in texts], np.random.default_rng(seed))
    made.update(0.0, HOME, 0.0)
    return made


def report(
    made: FaultSet, value: int, number: int = 3, remeasure: Callable[[float], int] = no_angle
) -> int | None:
    return made.apply(number, 0.0, value, remeasure)[0]


# ---- the seven kinds --------------------------------------------------------------------------------------------


def test_off_reads_5000_in_each_slot() -> None:
    made = faults("off:3")
    assert [made.apply(3, 0.0, value, no_angle) for value in (100, 777, 5000)] == [(5000, "off")] * 3
    assert made.apply(4, 0.0, 777, no_angle) == (777, None)


def test_silent_yields_no_reading() -> None:
    made = faults("silent:3")
    assert [made.apply(3, 0.0, value, no_angle) for value in (100, 777, 5000)] == [(None, "silent")] * 3


def test_stuck_repeats_the_reading_at_onset() -> None:
    made = faults("stuck:3+4@10s")
    assert [report(made, value) for value in (500, 600)] == [500, 600]
    made.update(10_000.0, HOME, 0.0)
    assert [report(made, value) for value in (701, 802, 903)] == [701, 701, 701]
    # Each sonar is stuck at its own.
    assert [report(made, value, 4) for value in (1111, 2222)] == [1111, 1111]


def test_stuck_keeps_the_reading_at_onset_while_another_fault_hides_it() -> None:
    made = faults("stuck:3@10s", "off:3@9s-20s")
    made.update(10_000.0, HOME, 0.0)
    assert [report(made, value) for value in (400, 500)] == [5000, 5000]
    made.update(20_000.0, HOME, 0.0)
    assert report(made, 600) == 400


def test_stuck_at_a_value() -> None:
    made = faults("stuck:3:value=400")
    assert [report(made, value) for value in (701, 802)] == [400, 400]


@pytest.mark.parametrize(
    ("text", "measured", "reported"),
    [
        ("wrong:3:scale=0.5", 1000, 500),
        ("wrong:3:scale=0.5", 5000, 2500),
        ("wrong:3:scale=1.3", 1001, 1301),
        ("wrong:3:offset=-200", 1000, 800),
        ("wrong:3:offset=77.6", 1000, 1078),
        # Scale first, then offset.
        ("wrong:3:scale=2:offset=-300", 1000, 1700),
        ("wrong:3:offset=-300:scale=2", 1000, 1700),
        # Clipping, at both ends.
        ("wrong:3:scale=0.01", 1000, 100),
        ("wrong:3:offset=-950", 1000, 100),
        ("wrong:3:scale=9", 1000, 5000),
        ("wrong:3:offset=5000", 1000, 5000),
        ("wrong:3:scale=0", 1000, 100),
    ],
)
def test_wrong_scales_then_shifts_then_clips(text: str, measured: int, reported: int) -> None:
    assert report(faults(text), measured) == reported


def test_wrong_by_an_angle_sees_along_the_turned_axis() -> None:
    asked = []

    def remeasure(angle_deg: float) -> int:
        asked.append(angle_deg)
        return 1234

    assert report(faults("wrong:3:angle=-25"), 900, remeasure=remeasure) == 1234
    assert asked == [-25.0]
    assert report(faults("wrong:3:angle=10:scale=0.5:offset=7"), 900, remeasure=remeasure) == 624


def test_an_angle_turns_the_axis_counter_clockwise_in_the_world() -> None:
    # A wall to the left only: sonar 3 (10 degrees) turned by 80 looks straight at it, turned by -80 away from it.
    wall = World("left", np.array([[-4000.0, 1000.0, 4000.0, 1000.0]]), np.ones(1))
    params = SonarParams(noise_mm=0, noise_part=0, crosstalk=0)
    for text, expected in (("wrong:3:angle=80", 1000 - 27), ("wrong:3:angle=-80", HIGH)):
        ring = SonarRing(wall, params, faults(text))
        (reading,) = [r for r in ring.fire_all(0.0, HOME) if r.number == 3]
        assert (reading.range_mm, reading.fault) == (expected, "wrong")
        assert reading.true_mm != reading.range_mm


@pytest.mark.parametrize("seed", range(3))
def test_garbage_is_uniform_from_100_to_5000(seed: int) -> None:
    made = faults("garbage:3", seed=seed)
    values = [report(made, 700) for _ in range(20_000)]
    assert all(v is not None and LOW <= v <= HIGH for v in values)
    counts, _ = np.histogram([v for v in values if v is not None], bins=20, range=(LOW, HIGH + 1))
    # 1000 in each of 20 bins; chi-square with 19 degrees of freedom is above 60 once in 300,000 times.
    assert ((counts - 1000) ** 2 / 1000).sum() < 60, f"seed {seed}: {counts}"
    # Both ends are met: each of the 4901 values is missed by 60,000 draws once in 200,000 times.
    many = np.array([report(made, 700) for _ in range(60_000)])
    assert (many.min(), many.max()) == (LOW, HIGH), f"seed {seed}"


@pytest.mark.parametrize("n", [1, 2, 5, 100])
def test_slow_reports_the_echo_of_n_firings_ago(n: int) -> None:
    made = faults(f"slow:3@1s:n={n}")
    before = [report(made, 1000 + k) for k in range(150)]
    assert before == [1000 + k for k in range(150)]
    made.update(1000.0, HOME, 0.0)
    assert [report(made, 1150 + k) for k in range(150)] == [1150 + k - n for k in range(150)]


def test_slow_takes_five_firings_unless_told_and_the_oldest_echo_while_there_are_fewer() -> None:
    made = faults("slow:3")
    assert [report(made, 1000 + k) for k in range(8)] == [1000, 1000, 1000, 1000, 1000, 1000, 1001, 1002]


@pytest.mark.parametrize("p", [0.0, 0.05, 0.5, 1.0])
def test_intermittent_is_5000_with_its_probability_and_true_otherwise(p: float) -> None:
    made, n = faults(f"intermittent:3:p={p}", seed=5), 5000
    values = [report(made, 700) for _ in range(n)]
    assert set(values) <= {700, HIGH}
    assert abs(values.count(HIGH) - n * p) <= 5 * math.sqrt(n * p * (1 - p)), "seed 5"


def test_intermittent_beyond_a_range_loses_farther_echoes_only() -> None:
    made = faults("intermittent:3:p=1:beyond=2000")
    assert [report(made, value) for value in (100, 2000, 2001, 5000)] == [100, 2000, 5000, 5000]
    made = faults("intermittent:3:p=0.5:beyond=2000", seed=3)
    assert {report(made, 3000) for _ in range(100)} == {3000, 5000}
    assert {report(made, 1000) for _ in range(100)} == {1000}


@pytest.mark.parametrize(
    ("text", "at", "value"),
    [
        ("wrong:3:scale=0.5:ramp=60s", (30_000.0, 0.0), 1500),
        ("wrong:3:offset=-400:ramp=60s", (15_000.0, 0.0), 1900),
        ("wrong:3:offset=-400:ramp=20000", (99_000.0, 5000.0), 1900),
        ("wrong:3@10s:offset=-400:ramp=20s", (20_000.0, 0.0), 1800),
        ("wrong:3@travelled>1000:scale=1.5:ramp=1000", (0.0, 1500.0), 2500),
        ("intermittent:3:p=1:beyond=1000:ramp=100s", (50_000.0, 0.0), 2000),
        ("intermittent:3:p=1:beyond=1000:ramp=100s", (80_000.0, 0.0), 5000),
    ],
)
def test_a_fault_with_a_ramp_grows_to_itself_and_stays(
    text: str, at: tuple[float, float], value: int
) -> None:
    """A row is where the fault is partly there, driving 1 mm for each 1 ms or standing, and what 2000 then reads."""
    made = faults(text)
    steps = [k / 100 for k in range(1, 101)]
    assert report(made, 2000) == 2000
    for step in steps:
        made.update(at[0] * step, HOME, at[1] * step)
    assert report(made, 2000) == pytest.approx(value, abs=15)
    for k in range(1, 200):
        made.update(at[0] + 1000.0 * k, HOME, at[1] + 1000.0 * k)
    grown = faults(re.sub(":ramp=.*|@[^:]*", "", text))
    assert [report(made, v) for v in (500, 2000, 4000)] == [report(grown, v) for v in (500, 2000, 4000)]


def test_a_ramp_turns_the_axis_little_by_little() -> None:
    made = faults("wrong:3:angle=-20:ramp=10s")
    made.update(5000.0, HOME, 0.0)
    assert report(made, 2000, remeasure=lambda angle: round(1000 + angle)) == 990


def test_dropouts_grow_with_their_ramp() -> None:
    made = faults("intermittent:3:p=0.8:ramp=10s", seed=5)
    shares = []
    for now_ms in (0.0, 2500.0, 5000.0, 10_000.0, 50_000.0):
        made.update(now_ms, HOME, 0.0)
        shares.append(sum(report(made, 777) == HIGH for _ in range(4000)) / 4000)
    assert shares == pytest.approx([0, 0.2, 0.4, 0.8, 0.8], abs=0.03)


def test_a_ramp_ends_with_its_fault() -> None:
    made = faults("wrong:3@1s-3s:offset=-400:ramp=1s")
    for now_ms in range(0, 5000, 10):
        made.update(float(now_ms), HOME, 0.0)
    assert report(made, 2000) == 2000


def test_intermittent_is_one_in_two_unless_told() -> None:
    fault = parse_fault("intermittent:3")
    assert isinstance(fault, SonarFault)
    assert fault.p == 0.5


def test_the_kinds_are_the_seven() -> None:
    assert set(SONAR_KINDS) == {"off", "silent", "stuck", "wrong", "garbage", "slow", "intermittent"}


# ---- who, when --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("target", "numbers"),
    [
        ("0", {0}),
        ("15", {15}),
        ("3+6", {3, 6}),
        ("6+3+3", {3, 6}),
        ("front", set(range(8))),
        ("rear", set(range(8, 16))),
        ("all", set(range(16))),
    ],
)
def test_targets(target: str, numbers: set[int]) -> None:
    made = faults(f"off:{target}")
    assert {n for n in range(16) if report(made, 700, n) == HIGH} == numbers
    assert {n for n in range(16) if made.active(n) is not None} == numbers


@pytest.mark.parametrize(
    ("when", "before", "after"),
    [
        ("12s", (11_999.0, HOME, 0.0), (12_000.0, HOME, 0.0)),
        ("0.25s", (249.0, HOME, 0.0), (250.0, HOME, 0.0)),
        ("x>2000", (0.0, Pose(2000, 0, 0), 0.0), (0.0, Pose(2000.1, 0, 0), 0.0)),
        ("x<-50", (0.0, Pose(-50, 0, 0), 0.0), (0.0, Pose(-50.1, 0, 0), 0.0)),
        ("y>500", (0.0, Pose(900, 500, 0), 0.0), (0.0, Pose(0, 501, 0), 0.0)),
        ("y<500", (0.0, Pose(0, 500, 0), 0.0), (0.0, Pose(900, 499, 0), 0.0)),
        ("travelled>1500", (0.0, Pose(9999, 0, 0), 1500.0), (0.0, HOME, 1500.5)),
    ],
)
def test_starts_and_ends_at_a_time_or_place(
    when: str, before: tuple[float, Pose, float], after: tuple[float, Pose, float]
) -> None:
    made = FaultSet([parse_fault(f"off:3@{when}")])
    assert made.update(*before) == []
    assert report(made, 700) == 700
    (change,) = made.update(*after)
    assert (change.kind, change.on, change.sonar) == ("off", True, 3)
    assert change.as_record() == {"kind": "off", "on": True, "text": f"off:3@{when}", "sonar": 3}
    assert report(made, 700) == HIGH
    # A place once passed counts as passed.
    assert made.update(*before) == []
    assert report(made, 700) == HIGH

    made = FaultSet([parse_fault(f"off:3@0s-{when}")])
    made.update(*before)
    assert report(made, 700) == HIGH
    (change,) = made.update(*after)
    assert (change.on, change.sonar) == (False, 3)
    assert report(made, 700) == 700
    assert made.update(*before) == []
    assert report(made, 700) == 700


def test_without_a_start_a_fault_is_there_before_the_first_update_and_is_told_once() -> None:
    made = FaultSet([parse_fault("off:3+4")])
    assert report(made, 700) == HIGH
    assert [(c.sonar, c.on) for c in made.update(0.0, HOME, 0.0)] == [(3, True), (4, True)]
    assert made.update(9e6, HOME, 9e6) == []


def test_of_two_faults_the_one_written_last_wins_while_it_lasts() -> None:
    made = FaultSet([parse_fault("off:3"), parse_fault("wrong:all@5s-9s:scale=0.5")])
    seen = []
    for t in (0.0, 5000.0, 9000.0):
        made.update(t, HOME, 0.0)
        seen.append((report(made, 700), report(made, 700, 4)))
    assert seen == [(HIGH, 700), (350, 350), (HIGH, 700)]


def test_a_bumper_hit_presses_its_segment_from_start_to_end() -> None:
    made = FaultSet([parse_fault("bumper:1@2s"), parse_fault("bumper:5@2.2s-4s")])
    pressed = {}
    for t in (0, 1999, 2000, 2199, 2200, 2499, 2500, 3999, 4000):
        pressed[t] = made.bumper(float(t))
    assert pressed == {0: 0, 1999: 0, 2000: 2, 2199: 2, 2200: 34, 2499: 34, 2500: 32, 3999: 32, 4000: 0}
    told = [(c.t_ms, c.kind, c.segment, c.on) for t in pressed for c in made.update(float(t), HOME, 0.0)]
    expected = [(2000, 1, True), (2200, 5, True), (2500, 1, False), (4000, 5, False)]
    assert told == [(t, "bumper", segment, on) for t, segment, on in expected]


# ---- the grammar ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("link-cut", LinkFault("", "cut")),
        ("link-cut@3s", LinkFault("", "cut", 3000.0)),
        ("link-drop@6s-9s:p=0.1", LinkFault("", "drop", 6000.0, 9000.0, 0.1)),
        ("link-drop:p=0.1", LinkFault("", "drop", probability=0.1)),
        ("link-drop:p=0.1:dir=to_robot", LinkFault("", "drop", probability=0.1, direction="to_robot")),
        ("link-corrupt@9s:dir=to_client", LinkFault("", "corrupt", 9000.0, direction="to_client")),
        ("link-delay:ms=250", LinkFault("", "delay", delay_ms=250.0)),
        ("link-delay@14s-16s:ms=250:dir=both", LinkFault("", "delay", 14e3, 16e3, delay_ms=250.0)),
        ("bumper:3@8s", BumperHit("", 3, 8000.0, 8500.0)),
        ("bumper:3@8s-9s", BumperHit("", 3, 8000.0, 9000.0)),
    ],
)
def test_link_faults_and_bumper_hits_are_parsed(text: str, expected: Fault) -> None:
    assert parse_fault(text) == dataclasses.replace(expected, text=text)
    assert str(parse_fault(f"  {text} ")) == text


def test_link_faults_are_left_to_the_link() -> None:
    made = faults("link-cut", "off:3", "link-drop@2s")
    assert [str(fault) for fault in made.link_faults] == ["link-cut", "link-drop@2s"]
    assert report(made, 700, 4) == 700


BAD = [
    "",
    "off",
    "off:",
    "of:3",
    "OFF:3",
    "off:16",
    "off:-1",
    "off:3+",
    "off:3-5",
    "off:left",
    "off:3@",
    "off:3@12",
    "off:3@12 s",
    "off:3@-1s",
    "off:3@1s-",
    "off:3@1s-2s-3s",
    "off:3@2s-1s",
    "off:3@2s-2s",
    "off:3@z>1",
    "off:3@x=1",
    "off:3@x>",
    "off:3@x>1e3",
    "off:3@" + "9" * 400 + "s",
    "off:3@x>" + "9" * 400,
    "off:3:p=1",
    "off:3@1s@2s",
    "silent:3:x",
    "stuck:3:value=-1",
    "stuck:3:value=65536",
    "stuck:3:value=400.5",
    "stuck:3:value=",
    "wrong:3",
    "wrong:3@1s",
    "wrong:3:scale=nan",
    "wrong:3:scale=-1",
    "wrong:3:scale=51",
    "wrong:3:offset=inf",
    "wrong:3:offset=65536",
    "wrong:3:angle=181",
    "wrong:3:scale=1:scale=2",
    "wrong:scale=0.5",
    "slow:3:n=0",
    "slow:3:n=101",
    "slow:3:n=1.5",
    "intermittent:3:beyond=99",
    "intermittent:3:ramp=0s",
    "intermittent:3:ramp=-5",
    "intermittent:3:ramp=fast",
    "intermittent:3:ramp=99999999999",
    "wrong:3:ramp=60s",
    "slow:3:ramp=60s",
    "intermittent:3:p=1.1",
    "intermittent:3:p=-0.1",
    "bumper:3",
    "bumper:0@1s",
    "bumper:6@1s",
    "bumper:12@1s",
    "bumper:@1s",
    "bumper:3@x>5",
    "bumper:3@1s:p=1",
    "link-drop:3",
    "link-drop:3@1s",
    "link-drop@x>5",
    "link-drop@1s:q=1",
    "link-drop@1s:dir=up",
    "link-delay@1s",
    "link-delay@1s:ms=60001",
    "link-delay@1s:ms=-1",
    "link-cut@1s:p=1",
    "link-lost@1s",
]


@pytest.mark.parametrize("text", BAD)
def test_bad_faults_are_refused_in_one_line_that_quotes_them(text: str) -> None:
    with pytest.raises(SimError, match=re.escape(f"fault '{text}': ")) as caught:
        parse_fault(text)
    assert str(caught.value).isprintable()


PIECES = st.sampled_from(
    [
        *SONAR_KINDS,
        *LINK_KINDS,
        "bumper",
        "front",
        "all",
        "3",
        "16",
        "3+6",
        "x>",
        "y<",
        "travelled>",
        "-",
        "1.5",
        "s",
        "p=",
        "n=",
        "ms=",
        "dir=",
        "value=",
        "scale=",
        "offset=",
        "angle=",
        "nan",
        "inf",
        "1e9",
        "٣",
        "９",
        "_",
        "@",
        ":",
    ]
)


@settings(max_examples=400, deadline=None)
@example("off:٣@1s")
@example("slow:3:n=" + "9" * 5000)
@example("off:3\n")
@given(st.lists(PIECES, max_size=9).map("".join) | st.lists(PIECES, max_size=6).map(":".join) | st.text())
def test_any_text_is_a_fault_or_one_line(text: str) -> None:
    try:
        fault = parse_fault(text)
    except SimError as error:
        refused = str(error)
    else:
        assert parse_fault(str(fault)) == fault
        if not isinstance(fault, LinkFault):
            made = FaultSet([fault])
            made.update(1e12, HOME, 1e12)
            assert report(made, 700, remeasure=lambda _: 700) in (None, *range(LOW, HIGH + 1))
        return
    assert refused.startswith("fault '")
    assert refused.isprintable()


def test_the_help_names_every_kind_and_its_examples_parse() -> None:
    text = fault_help()
    for kind in (*SONAR_KINDS, *LINK_KINDS, "bumper"):
        assert kind in text
    examples = text.split("examples:")[1].split()
    assert len(examples) >= 7
    for line in examples:
        parse_fault(line)
