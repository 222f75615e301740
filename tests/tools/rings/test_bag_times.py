# SPDX-License-Identifier: MIT
"""Rule: of a bag, too, whatever the recorder's clock does is corrected and reported, and gives no false verdict."""

from __future__ import annotations

import math
import re
import sqlite3
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import bags
import pytest
from argus_tools.rings.written import falls
from bags import START, Drive, Sent
from logs import decode, run

FORMS = ("ros1", "sqlite3", "mcap")
STUCK, STUCK_FROM_S, SET_S = 2, 5.0, 20.0
DAY_S = 86400.0
DRIVE = Drive(seconds=40)
STANDS = "stands at"

CLOCKS: dict[str, tuple[Callable[[float], float], str]] = {
    "good": (lambda s: START + s, ""),
    "since boot": (lambda s: s, ""),
    "falls an hour": (lambda s: START + s - 3600 * (s > SET_S), "the clock falls by 3599.9"),
    "falls 10 s": (lambda s: START + s - 10 * (s > SET_S), "the clock falls by 9.9"),
    "falls twice": (
        lambda s: START + s - 50 * (s > SET_S) - 1000 * (s > SET_S + 5),
        "the clock falls by 999.9",
    ),
    "stands, right again": (lambda s: START + (SET_S if SET_S < s < 32 else s), STANDS),
    "stands, set ahead": (lambda s: START + (SET_S if SET_S < s < 32 else s + 3600 * (s >= 32)), "s ahead"),
    "stands throughout": (lambda s: START, STANDS),
    "zero throughout": (lambda s: 0.0, STANDS),
    "set ahead 3 s": (lambda s: START + s + 3 * (s > SET_S), "the clock is set 3 s ahead"),
    "set ahead an hour": (lambda s: START + s + 3600 * (s > SET_S), "the clock is set 3600 s ahead"),
    "set ahead 400 days": (
        lambda s: START + s + 400 * DAY_S * (s > SET_S),
        "the clock is set 34560000 s ahead",
    ),
    "set from boot to date": (lambda s: 30 + s + START * (s > SET_S), "the clock is set 1700000000 s ahead"),
    "one message ahead": (lambda s: START + s + 400 * DAY_S * (20.05 < s < 20.15), "the clock falls by"),
    "whole seconds": (lambda s: START + math.floor(s), "gives whole seconds"),
    "steps of 5 s": (lambda s: START + s // 5 * 5, "gives steps of 5 s"),
    "over midnight": (lambda s: (DAY_S - 15 + s) % DAY_S, ""),
    "below zero": (lambda s: s - 12.5, "times begin at -12.5"),
}


def drive(clock: Callable[[float], float], stamps: Callable[[float], float] | None = None) -> Iterator[Sent]:
    """A sonar gets stuck on the way; stamp: of another clock, which is good, where nothing else is given."""
    for t, place, heading, ranges in DRIVE.steps:
        s = t - START
        mm = [700.0 if k == STUCK and s > STUCK_FROM_S else value for k, value in enumerate(ranges)]
        stamp = START + s if stamps is None else stamps(s)
        yield bags.odometry(clock(s), place, heading, stamp=stamp)
        yield bags.cloud(clock(s + 0.001), mm, stamp=stamp)


def written(tmp_path: Path, storage: str, sent: Iterable[Sent]) -> Path:
    return bags.write(tmp_path / ("a.bag" if storage == "ros1" else "a"), sent, storage)


def is_possible(clock: str, storage: str) -> bool:
    """Whether a storage can have such times: ROS 1 and MCAP have none below zero."""
    return clock != "below zero" or storage == "sqlite3"


@pytest.mark.parametrize(
    ("clock", "storage"), [(clock, form) for clock in CLOCKS for form in FORMS if is_possible(clock, form)]
)
def test_the_answer_is_that_of_a_good_clock(clock: str, storage: str, tmp_path: Path) -> None:
    time_of, words = CLOCKS[clock]
    path = written(tmp_path, storage, drive(time_of))
    done = run("faults", path)
    told = done.stdout.decode()
    assert done.returncode == 1, done
    assert told.startswith(f"sonar/front/0{STUCK} disabled as stuck at "), told
    assert re.search(r"7 of 8 sonars healthy in 400 SIPs over (39|40) s", told), told
    assert "also:" not in told, told
    corrections = done.stderr.decode()
    assert words in corrections, corrections
    if not words:
        assert not re.search("clock (falls|is set)|its clock|times begin", corrections), corrections
    assert "discarded" not in corrections, corrections


@pytest.mark.parametrize("storage", FORMS)
@pytest.mark.parametrize("clock", ["falls an hour", "set from boot to date", "whole seconds", "steps of 5 s"])
def test_stamps_of_the_same_clock_change_nothing(clock: str, storage: str, tmp_path: Path) -> None:
    time_of, words = CLOCKS[clock]
    done = run("faults", written(tmp_path, storage, drive(time_of, time_of)))
    told = done.stdout.decode()
    assert told.startswith(f"sonar/front/0{STUCK} disabled as stuck at "), told
    assert "also:" not in told, told
    assert words in done.stderr.decode()


def busy(clock: Callable[[float], float]) -> Iterator[Sent]:
    """A topic a sonar, fired one after the other, with odometry and transforms at 50 Hz: 230 messages a second."""
    for t, place, heading, ranges in DRIVE.steps:
        for part in range(5):
            s, way = t - START + part * 0.02, bags.SPEED_MM_S * part * 0.02
            x, y = place[0] + way * math.cos(heading), place[1] + way * math.sin(heading)
            yield bags.odometry(clock(s), (x, y), heading, stamp=START + s)
            yield bags.transform(clock(s), "base_link", "odom", x / 1000, y / 1000, heading)
            yield bags.transform(clock(s), "laser", "base_link", 0.1, 0.0, 0.0)
            for k in range(part, 8, 5):
                range_m = 0.7 if k == STUCK and s > STUCK_FROM_S else ranges[k] / 1000
                yield bags.single(clock(s + 0.001), k, range_m, f"/us/{k}", f"us{k}", stamp=START + s)


@pytest.mark.parametrize(
    "clock",
    ["good", "falls an hour", "stands, right again", "stands throughout", "whole seconds", "steps of 5 s"],
)
def test_many_messages_a_second_change_nothing(clock: str, tmp_path: Path) -> None:
    done = run("faults", written(tmp_path, "ros1", busy(CLOCKS[clock][0])))
    told = done.stdout.decode()
    assert told.startswith(f"sonar/front/0{STUCK} disabled as stuck at "), told
    assert re.search(r"7 of 8 sonars healthy in (399|400) SIPs over (39|40) s", told), told
    assert "also:" not in told, told
    assert CLOCKS[clock][1] in done.stderr.decode()


@pytest.mark.parametrize("storage", FORMS)
def test_a_link_that_rests_is_lost(storage: str, tmp_path: Path) -> None:
    # Stamps bear out what the recorder's clock says: nothing came for a minute.
    def clock(s: float) -> float:
        return START + s + 60 * (s > SET_S + 0.05)

    done = run("faults", written(tmp_path, storage, drive(clock, clock)))
    assert "1 x LINK_LOST" in done.stdout.decode()
    assert "set" not in done.stderr.decode(), done.stderr.decode()


def test_a_recorder_that_is_late_does_not_set_its_clock(tmp_path: Path) -> None:
    # What waited for 4 s comes at once, with stamps that go on.
    def clock(s: float) -> float:
        return START + (24.0 + s / 1000 if SET_S < s < 24 else s)

    told = run("faults", written(tmp_path, "ros1", drive(clock))).stderr.decode()
    assert not re.search("clock (falls|is set)", told), told


@pytest.mark.parametrize("storage", FORMS)
@pytest.mark.parametrize("clock", ["falls an hour", "whole seconds"])
def test_every_command_has_the_corrected_times(clock: str, storage: str, tmp_path: Path) -> None:
    path = written(tmp_path, storage, drive(CLOCKS[clock][0]))
    times = [row["t"] for row in decode(path) if row["type"] == "SIP"]
    assert len(times) == 400
    assert times == sorted(times)
    assert times[-1] - times[0] == pytest.approx(39.9, abs=0.15)
    done = run("stats", path)
    assert b"401 packets" in done.stdout
    assert CLOCKS[clock][1] in done.stderr.decode()


@pytest.mark.parametrize("storage", FORMS)
def test_topics_that_are_written_one_after_the_other_are_no_fall(storage: str, tmp_path: Path) -> None:
    sent = sorted(drive(CLOCKS["good"][0]), key=lambda one: one.topic)
    path = written(tmp_path, storage, sent)
    done = run("faults", path)
    assert "sonar/front/02 disabled as stuck at +12.0 s\n7 of 8" in done.stdout.decode()
    assert "also:" not in done.stdout.decode()
    assert "the clock" not in re.sub("the recorder's clock", "", done.stderr.decode())


@pytest.mark.parametrize(
    "clock", ["falls 10 s", "stands, right again", "set from boot to date", "whole seconds"]
)
def test_times_of_an_own_mcap_are_corrected(clock: str, tmp_path: Path) -> None:
    from mcap.reader import make_reader
    from mcap.writer import Writer

    good, path = tmp_path / "good.mcap", tmp_path / "own.mcap"
    assert run("convert", written(tmp_path, "ros1", drive(CLOCKS["good"][0])), good).returncode == 0
    with good.open("rb") as source, path.open("wb") as target:
        writer: Any = Writer(target, chunk_size=2000)
        writer.start("ros2")
        channels: dict[int, int] = {}
        for schema, channel, message in make_reader(source).iter_messages(log_time_order=False):
            if schema is None:
                continue
            if channel.id not in channels:
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.id] = writer.register_channel(
                    channel.topic, channel.message_encoding, number, channel.metadata
                )
            t_ns = round(CLOCKS[clock][0](message.log_time / 1e9 - START) * 1e9)
            writer.add_message(channels[channel.id], t_ns, message.data, t_ns)
        writer.finish()
    done = run("faults", path)
    told = done.stdout.decode()
    assert told.startswith("sonar/front/02 disabled as stuck at "), told
    assert "7 of 8 sonars healthy in 40" in told, told
    assert "also:" not in told, told
    assert CLOCKS[clock][1].partition(" by ")[0] in done.stderr.decode()


def test_a_database_that_is_damaged_gives_what_comes_before(tmp_path: Path) -> None:
    path = written(tmp_path, "sqlite3", drive(CLOCKS["good"][0]))
    (file,) = path.glob("*.db3")
    database = sqlite3.connect(file)
    database.execute("UPDATE messages SET timestamp = 'none' WHERE rowid = 700")
    database.commit()
    database.close()
    done = run("decode", path)
    assert done.returncode in (0, 2)
    assert "Traceback" not in done.stderr.decode()
    assert len(done.stdout.splitlines()) > 300, done


@pytest.mark.parametrize(
    ("times", "expected"),
    [
        ([], False),
        ([("a", 0), ("a", 10**9), ("b", 0)], False),
        ([("a", 10**10), ("a", 10**10 - 10**9)], False),
        ([("a", 10**10), ("a", 10**10 - 10**9 - 1)], True),
        ([("a", 10**10), ("b", 0), ("a", 2 * 10**10)], False),
        ([("a", 10**10), ("a", 95 * 10**8), ("a", 89 * 10**8)], True),
    ],
)
def test_a_clock_falls_where_one_topic_does(times: list[tuple[str, int]], expected: bool) -> None:
    assert falls(times) is expected


def test_one_topic_is_one(tmp_path: Path) -> None:
    sent = [bags.single(START + n / 10, 3, 1.5, "/sonar/range_3", "") for n in range(30)]
    assert (
        "1 topic is a sonar of p3dx-sh by" in run("faults", written(tmp_path, "ros1", sent)).stderr.decode()
    )
