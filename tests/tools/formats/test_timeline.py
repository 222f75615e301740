# SPDX-License-Identifier: MIT
"""Rule: whatever a log's clock does, its times rise, and each correction is reported with its place."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from argus_tools.chunks import ROBOT_TO_CLIENT, Chunk, DamageList
from argus_tools.formats import open_log
from argus_tools.timeline import DAY_S, SECOND_MOST, STANDS_BYTES, YEAR_S, Timeline, Wrapping

SIP_BYTES = 50


class Reader:
    """Gives chunks with these times, and the line of each."""

    def __init__(self, times: Sequence[float | None]) -> None:
        self._times = times
        self.place = ""

    def __iter__(self) -> Iterator[Chunk]:
        for number, t in enumerate(self._times, start=1):
            self.place = f"line {number}"
            yield Chunk(t, ROBOT_TO_CLIENT, b"x", number - 1)


def times(given: list[float | None]) -> tuple[list[float | None], list[tuple[str, str]]]:
    damage = DamageList()
    found = [chunk.t for chunk in Timeline(Reader(given), damage)]
    assert damage.unread == 0
    return found, [(entry.place, entry.what.split(";")[0]) for entry in damage]


@pytest.mark.parametrize(
    ("given", "expected", "reports"),
    [
        ([5.0, 5.1, 5.25], [5.0, 5.1, 5.25], []),
        ([None, None], [None, None], []),
        # Two directions out of order by less than a second stay so.
        ([5.0, 5.4, 5.1, 5.5], [5.0, 5.4, 5.1, 5.5], []),
        (
            [7200.5, 7200.6, 3600.5, 3600.6],
            [7200.5, 7200.6, 7200.7, 7200.8],
            [("line 3", "the clock falls by 3600.100 s")],
        ),
        (
            [100.5, 50.5, 10.5],
            [100.5, 100.6, 100.7],
            [("line 2", "the clock falls by 50.000 s"), ("line 3", "the clock falls by 40.000 s")],
        ),
        # A clock of the day over midnight is no correction.
        ([86399.5, 0.5, 1.25], [86399.5, 86400.5, 86401.25], []),
        ([86399.5, 0.5, 86399.5, 0.5], [86399.5, 86400.5, 172799.5, 172800.5], []),
        # The clock of a computer that has none is set once it has a network.
        (
            [12.5, 12.75, 1.8e9 + 0.5, 1.8e9 + 0.75],
            [12.5, 12.75, 12.85, 13.1],
            [("line 3", "the clock is set 1799999988 s ahead")],
        ),
        # Two drives of two days are what they are.
        ([1.7e9 + 0.5, 1.8e9 + 0.5], [1.7e9 + 0.5, 1.8e9 + 0.5], []),
        ([-3.25, -3.0, 0.5], [0.0, 0.25, 3.75], [("line 1", "times begin at -3.250000 s")]),
        ([1e-9 - 1.7e9, 0.25 - 1.7e9], [0.0, 0.25], [("line 1", "times begin at -1700000000.000000 s")]),
    ],
)
def test_times_rise(given: list[float | None], expected: list[float], reports: list[tuple[str, str]]) -> None:
    found, told = times(given)
    assert found == pytest.approx(expected, abs=1e-6)
    assert told == reports


def test_whole_seconds_are_spread() -> None:
    given: list[float | None] = [t for t in (7.0, 8.0, 9.0, 10.0, 12.0) for _ in range(4)]
    found, told = times(given)
    assert found == [t + k / 4 for t in (7.0, 8.0, 9.0, 10.0, 12.0) for k in range(4)]
    assert told == [("its clock", "gives whole seconds")]


@pytest.mark.parametrize("step_s", [2, 5, 10])
def test_steps_of_several_seconds_are_spread(step_s: int) -> None:
    starts = [1000.0 + step_s * k for k in (0, 1, 2, 3, 5, 6)]
    found, told = times([t for t in starts for _ in range(13 * step_s)])
    assert found == [round(t + k / 13, 6) for t in starts for k in range(13 * step_s)]
    assert told == [("its clock", f"gives steps of {step_s} s")]


@pytest.mark.parametrize(
    "given",
    [
        [0.0] * 20,
        [0.0] * (SECOND_MOST + 5) + [1.0] * 5,
        [float(t) for t in range(20)],
        [1.0, 1.0, 2.0, 2.0, 2.5, 3.0],
        [1.0, 1.0, None, 2.0, 2.0],
    ],
    ids=["all at once", "more than a link carries", "one a second", "a fraction", "a gap"],
)
def test_what_only_looks_like_whole_seconds_stays(given: list[float | None]) -> None:
    assert times(list(given)) == (given, [])


def test_a_second_that_never_ends_is_not_held() -> None:
    steady: list[float | None] = [7.0, 7.0, 8.0, 8.0, 9.0, 9.0, 10.0, 10.0]
    reader, damage = Reader([*steady, *[11.0] * (3 * SECOND_MOST), 12.0, 12.0]), DamageList()
    chunks = iter(Timeline(reader, damage))
    found = [next(chunks).t for _ in range(8 + SECOND_MOST + 1)]
    assert reader.place == f"line {8 + SECOND_MOST + 1}"
    found += [chunk.t for chunk in chunks]
    assert found[8:-2] == [11.0] * (3 * SECOND_MOST)
    assert found[:4] == [7.0, 7.5, 8.0, 8.5]
    assert found[-2:] == [12.0, 12.5]
    assert [entry.what for entry in damage if "stands at 11.0" in entry.what]


def test_a_log_that_stands_long_at_first_begins_at_that_time() -> None:
    # More than is waited for: the first keeps its time, so that what follows lasts from there.
    given = [*[7.25] * (2 * SECOND_MOST), 99.5, 99.6]
    chunks = [Chunk(t, ROBOT_TO_CLIENT, bytes(SIP_BYTES), 0) for t in given]
    found = [chunk.t for chunk in Timeline(chunks, DamageList())]
    assert found == [7.25, *[None] * (2 * SECOND_MOST - 1), 99.5, 99.6]


@pytest.mark.parametrize("most", [SECOND_MOST, 3 * SECOND_MOST])
def test_as_many_as_may_come_in_a_second_are_spread(most: int) -> None:
    given = [float(t) for t in (7, 8, 9, 10, 11) for _ in range(2 * SECOND_MOST)]
    chunks = [Chunk(t, ROBOT_TO_CLIENT, bytes(SIP_BYTES), 0) for t in given]
    found = [chunk.t for chunk in Timeline(chunks, DamageList(), most=most)]
    assert (None in found) is (most == SECOND_MOST)
    assert len(set(found)) == (6 if most == SECOND_MOST else len(given))


@pytest.mark.parametrize("is_followed", [False, True], ids=["file", "followed"])
@pytest.mark.parametrize(
    ("before", "behind"), [([], []), ([5.1, 5.2, 5.3], []), ([5.1, 5.2], [99.5, 99.6]), ([5.0, 6.0], [])]
)
def test_a_clock_that_stands_gives_no_times(
    before: list[float], behind: list[float], is_followed: bool
) -> None:
    stand = 7.25
    data = bytes(SIP_BYTES)
    chunks = [Chunk(t, ROBOT_TO_CLIENT, data, 0) for t in (*before, *[stand] * 200, *behind)]
    damage = DamageList()
    found = [chunk.t for chunk in Timeline(chunks, damage, is_followed)]
    assert found[: len(before)] == before
    assert found[len(found) - len(behind) :] == behind
    timed = found[len(before) : len(found) - len(behind)].count(stand)
    assert timed * SIP_BYTES <= STANDS_BYTES
    assert timed == 0 or before or is_followed, "all of the log is known to stand"
    assert timed <= 1 or is_followed, (
        "what came first has the time at which the clock stopped, the others none"
    )
    assert set(found) - {*before, *behind} <= {stand, None}
    assert [entry.what.split(":")[0] for entry in damage] == [f"stands at {stand}"]
    assert damage.unread == 0


def test_what_a_late_reader_finds_waiting_is_no_clock_that_stands() -> None:
    data = bytes(SIP_BYTES)
    given = [5.0, 5.1, *[13.0] * (STANDS_BYTES // SIP_BYTES), 13.1]
    damage = DamageList()
    found = [chunk.t for chunk in Timeline([Chunk(t, ROBOT_TO_CLIENT, data, 0) for t in given], damage)]
    assert (found, list(damage)) == (given, [])


@pytest.mark.parametrize("step_s", [1, 2])
@pytest.mark.parametrize("last", range(1, 11))
@pytest.mark.parametrize("first", range(1, 11))
def test_seconds_that_are_cut_have_no_other_rate_than_the_whole_ones(
    first: int, last: int, step_s: int
) -> None:
    counts = [first * step_s, *[10 * step_s] * 5, last * step_s]
    given: list[float | None] = [step_s * (7.0 + k) for k, count in enumerate(counts) for _ in range(count)]
    found, _ = times(given)
    assert [round(b - a, 6) for a, b in itertools.pairwise(found) if a is not None and b is not None] == [
        0.1
    ] * (len(given) - 1)


def test_a_first_second_that_is_cut_does_not_hide_whole_seconds() -> None:
    given: list[float | None] = [6.0, *(t for t in (7.0, 8.0, 9.0, 10.0) for _ in range(4))]
    found, told = times(given)
    assert found[:6] == [6.75, 7.0, 7.25, 7.5, 7.75, 8.0]
    assert told == [("its clock", "gives whole seconds")]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("period", [DAY_S, YEAR_S])
def test_a_clock_known_to_begin_anew_does_so_after_any_pause(period: float, seed: int) -> None:
    rng = random.Random(seed)
    given: list[float | None] = []
    right: list[float] = []
    t = period * rng.uniform(0.6, 0.99)
    for n in range(50):
        t += rng.choice([0.1, 0.1, 0.1, period * rng.uniform(0.0, 0.49)]) * (n > 0)
        given.append(Wrapping(t % period, period))
        right.append(t)
    found, told = times(given)
    assert found == pytest.approx(right, abs=1e-5), seed
    assert told == []


def test_two_directions_out_of_order_over_midnight() -> None:
    given: list[float | None] = [86399.9, 0.05, 86399.95, 0.15, 0.25]
    found, told = times(given)
    assert found == pytest.approx([86399.9, 86400.05, 86399.95, 86400.15, 86400.25])
    assert told == []


def test_followed_whole_seconds_are_spread_once_they_are_known() -> None:
    given = [t for t in (7.0, 8.0, 9.0, 10.0, 11.0) for _ in range(4)]
    damage = DamageList()
    found = [chunk.t for chunk in Timeline(Reader(given), damage, is_followed=True)]
    assert found[:12] == given[:12]
    assert found[12:] == [10.0, 10.25, 10.5, 10.75, 11.0, 11.25, 11.5, 11.75]
    assert len(damage) == 1


def test_a_log_that_is_followed_is_not_held_up() -> None:
    reader = Reader([7.0] * 3 + [8.0] * 3)
    given = iter(Timeline(reader, DamageList(), is_followed=True))
    assert [next(given).t for _ in range(4)] == [7.0, 7.0, 7.0, 8.0]
    assert reader.place == "line 4"


@pytest.mark.parametrize("seed", range(20))
def test_no_clock_makes_times_fall_or_loses_a_chunk(seed: int) -> None:
    rng = random.Random(seed)
    t = rng.choice([0.0, -1e6, 1.8e9, 86390.0])
    given: list[float | None] = []
    for _ in range(300):
        t += rng.choice([0.001, 0.1, 1.0, rng.uniform(-1e5, 1e5) if rng.random() < 0.1 else 0.05])
        given.append(rng.choice([t, t, t, float(int(t))]))
    found, _ = times(given)
    assert len(found) == len(given)
    rising = [one for one in found if one is not None]
    assert all(after > before - 2.1 for before, after in itertools.pairwise(rising)), seed


def test_candump_with_times_since_the_line_before(tmp_path: Path) -> None:
    lines = [
        f"(000.1{n:05d}) can0 640#06FAFB03000000CC" if n % 2 else "(000.000009) can0 648#06FAFB03000000CC"
        for n in range(40)
    ]
    log = tmp_path / "delta.log"
    log.write_text("\n".join(lines) + "\n")
    found = [chunk.t for chunk in open_log(str(log))]
    assert found[0] == pytest.approx(0.000009)
    assert found[-1] == pytest.approx(sum(float(line[1:11]) for line in lines))


NEGATIVE = {
    "candump -L": ("({:.6f}) can0 640#06FAFB03000000CC", "({:.6f}) can0 648#06FAFB03000000CC"),
    "candump": ("({:.6f})  can0  640   [7]  06 FA FB 03 00 00 00", "({:.6f})  can0  648   [7]  06 FA FB 03 00 00 00"),
    "bytes": ("[{:.6f}] TX: FA FB 03 00 00 00", "[{:.6f}] RX: FA FB 03 00 00 00"),
    "python-can": (
        "Timestamp: {:15.6f}        ID: 640    S Rx                DL:  7    06 fa fb 03 00 00 00",
        "Timestamp: {:15.6f}        ID: 648    S Rx                DL:  7    06 fa fb 03 00 00 00",
    ),
    "CRTD": ("{:.6f} 1T11 640 06 FA FB 03 00 00 00", "{:.6f} 1R11 648 06 FA FB 03 00 00 00"),
}  # fmt: skip


@pytest.mark.parametrize("form", NEGATIVE)
def test_negative_times_of_any_text_are_counted_from_the_first(form: str, tmp_path: Path) -> None:
    log = tmp_path / "log.txt"
    log.write_text("".join(NEGATIVE[form][n % 2].format(-2.5 + n / 4) + "\n" for n in range(20)))
    reader = open_log(str(log))
    assert [chunk.t for chunk in reader] == [n / 4 for n in range(20)]
    assert [entry.what for entry in reader.damage] == [
        "times begin at -2.500000 s; they are counted from there"
    ]


def test_an_asc_with_a_date_and_negative_times_is_absolute(tmp_path: Path) -> None:
    log = tmp_path / "mdf.asc"
    log.write_text(
        "date Fri Nov 27 03:33:04.500 AM 2026\nbase hex  timestamps absolute\nno internal events logged\n"
        "-2.500000 0  640             Tx   d 7 06 FA FB 03 00 00 00\n"
        "1.250000 0  648             Rx   d 7 06 FA FB 03 00 00 00\n"
    )
    assert [chunk.t for chunk in open_log(str(log))] == [1795750382.0, 1795750385.75]


@pytest.mark.parametrize(
    ("date", "t"),
    [
        ("Fri Nov 27 03:33:04.500 AM 2026", 1795750384.5),
        ("Fre Nov 27 03:33:04.500 2026", 1795750384.5),
        ("Die Okt 6 10:20:00 2026", 1791282000.0),
        ("Mi M\xe4r 4 10:20:00 2026", 1772619600.0),
        ("Mit Mrz 4 10:20:00 2026", 1772619600.0),
        ("Don Mai 7 10:20:00.250 2026", 1778149200.25),
        ("Sam Dez 5 10:20:00 2026", 1796466000.0),
    ],
)
@pytest.mark.parametrize("encoding", ["latin-1", "utf-8"])
def test_an_asc_has_its_date_in_english_or_german(date: str, t: float, encoding: str, tmp_path: Path) -> None:
    log = tmp_path / "a.asc"
    log.write_bytes(
        f"date {date}\nbase hex  timestamps absolute\nno internal events logged\n"
        "0.500000 0  648             Rx   d 7 06 FA FB 03 00 00 00\n".encode(encoding)
    )
    reader = open_log(str(log))
    assert [chunk.t for chunk in reader] == [t + 0.5]
    assert not reader.damage


def test_an_asc_whose_date_is_not_understood_is_told(tmp_path: Path) -> None:
    log = tmp_path / "a.asc"
    log.write_text(
        "date ven. d\u00e9c. 4 10:20:00 2026\nbase hex  timestamps absolute\nno internal events logged\n"
        "0.500000 0  648             Rx   d 7 06 FA FB 03 00 00 00\n",
        "utf-8",
    )
    reader = open_log(str(log))
    assert [chunk.t for chunk in reader] == [0.5]
    (entry,) = reader.damage
    assert (entry.place, entry.what.partition("'")[0]) == ("line 1", "the date ")
    assert entry.what.endswith("is not understood; times are since the log's start")
