# SPDX-License-Identifier: MIT
"""Rule: a bag is read by one command, with right poses and ranges, and no sonar that is not there."""

from __future__ import annotations

import copy
import gzip
import math
import random
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bags
import pytest
from bags import Drive, Sent
from logs import decode, run

from hil_sim.tables.robot import robot_table

FORMS = ("ros1", "sqlite3", "mcap")
DRIVE = Drive()


def rosaria(drive: Drive, stamps: float = 0.0) -> Iterator[Sent]:
    """As RosAria sends: all points in each message, of which one in four is new; the rear ones are (0, 0, 0)."""
    held = list(drive.steps[0][3])
    for n, (t, place, heading, ranges) in enumerate(drive.steps):
        for k in range(16):
            if (n + k) % 3 == 0:
                held[k] = ranges[k]
        yield bags.odometry(t, place, heading, stamp=t + stamps)
        yield bags.cloud(t + 0.001, held, stamp=t + stamps)


def ahead(place: bags.Place, heading: float) -> bags.Place:
    """Where the laser is, 100 mm before the centre."""
    return place[0] + 100 * math.cos(heading), place[1] + 100 * math.sin(heading)


def path_of(tmp_path: Path, storage: str) -> Path:
    return tmp_path / ("a.bag" if storage == "ros1" else "a")


def sips(path: Path, *arguments: str) -> list[dict[str, Any]]:
    return [row for row in decode(path, *arguments) if row["type"] == "SIP"]


@pytest.mark.parametrize("storage", FORMS)
def test_a_healthy_drive_has_nothing_wrong(tmp_path: Path, storage: str) -> None:
    path = bags.write(path_of(tmp_path, storage), rosaria(DRIVE), storage)
    done = run("faults", path)
    assert done.stdout.decode().startswith("nothing wrong: 8 of 8 sonars healthy in 200 SIPs"), done
    told = done.stderr.decode()
    assert "8 points are (0, 0, 0) throughout" in told
    assert "ring of p3dx-sh" in told
    assert "pose: /pose" in told


@pytest.mark.parametrize("storage", FORMS)
def test_poses_and_ranges_are_those_that_were_written(tmp_path: Path, storage: str) -> None:
    sent = [
        one
        for t, place, h, ranges in DRIVE.steps
        for one in (bags.odometry(t, place, h), bags.cloud(t, ranges))
    ]
    rows = sips(bags.write(path_of(tmp_path, storage), sent, storage))
    assert len(rows) == len(DRIVE.steps)
    for row, (t, place, heading, ranges) in zip(rows, DRIVE.steps, strict=True):
        assert row["t"] == pytest.approx(t, abs=1e-3)
        assert row["x_mm"] == pytest.approx(place[0], abs=1)
        assert row["y_mm"] == pytest.approx(place[1], abs=1)
        assert row["heading_deg"] == pytest.approx(math.degrees(heading), abs=0.1)
        assert (row["vel_left_mm_s"] + row["vel_right_mm_s"]) / 2 == pytest.approx(bags.SPEED_MM_S, abs=1)
        assert row["sonar"] == {str(k): pytest.approx(ranges[k], abs=1) for k in range(8)}


def test_ranges_are_rounded(tmp_path: Path) -> None:
    # 1234 mm along a bearing of 50 degrees, as float32, comes back as 1233.99996.
    sent = [bags.cloud(bags.START + n / 10, [1234.0 + n + k for k in range(16)]) for n in range(30)]
    rows = sips(bags.write(tmp_path / "a.bag", sent))
    assert [row["sonar"] for row in rows] == [{str(k): 1234 + n + k for k in range(8)} for n in range(30)]


@pytest.mark.parametrize(
    ("kind", "silent", "told"),
    [
        *((kind, mm, f"{mm / 1000:.3f} m") for kind in ("array", "cloud") for mm in (5000.0, 4999.0, 5201.0)),
        *(("array", value, told) for value, told in ((0.0, "0"), (math.inf, "inf"), (math.nan, "NaN"))),
    ],
)
def test_what_stands_for_no_echo_is_found_and_told(
    tmp_path: Path, kind: str, silent: float, told: str
) -> None:
    drive = Drive(dead=(3,))
    sent = []
    for t, place, heading, ranges in drive.steps:
        mm = [silent if value >= bags.NO_ECHO_MM else value for value in ranges]
        sent += [
            bags.odometry(t, place, heading),
            bags.cloud(t, mm) if kind == "cloud" else bags.array(t, [value / 1000 for value in mm]),
        ]
    path = bags.write(tmp_path / "a.bag", sent)
    assert {row["sonar"]["3"] for row in sips(path)} == {5000}
    assert f"no echo is {told} (" in run("decode", path).stderr.decode()


def test_a_greatest_reading_that_comes_once_is_an_echo(tmp_path: Path) -> None:
    sent = [
        bags.array(bags.START + n / 10, [4.9 + n / 300 + k / 1e4 if n < 20 else 1.0 for k in range(16)])
        for n in range(40)
    ]
    values = {row["sonar"]["0"] for row in sips(bags.write(tmp_path / "a.bag", sent))}
    assert max(values) == 4963, values
    assert 5000 not in values


def test_stamps_of_another_clock_change_nothing_but_are_told(tmp_path: Path) -> None:
    path = bags.write(tmp_path / "a.bag", rosaria(DRIVE, stamps=1336.0))
    done = run("faults", path)
    assert done.stdout.decode().startswith("nothing wrong: 8 of 8")
    assert "stamps of /sonar are 1,336.0 s ahead of the recorder's clock" in done.stderr.decode()


def test_messages_out_of_order_are_discarded_and_counted(tmp_path: Path) -> None:
    sent = []
    for n, one in enumerate(rosaria(DRIVE)):
        one.stamp = one.t - (0.35 if n % 20 == 11 else 0.0)
        sent.append(one)
    done = run("faults", bags.write(tmp_path / "a.bag", sent))
    assert done.stdout.decode().startswith("nothing wrong: 8 of 8")
    assert "discarded: 20 x /sonar: stamp is not newer than the last" in done.stderr.decode()


def wall(stamps: Callable[[float], float], storage: str, tmp_path: Path, seconds: float = 6.0) -> Path:
    """A sonar that hears one wall all the time, of a robot at rest: the stamp of each message is made of its time."""
    times = [bags.START + n / 10 for n in range(int(seconds * 10))]
    sent = [bags.single(t, 3, 1.5, "/sonar/range_3", "", stamp=stamps(t)) for t in times]
    return bags.write(path_of(tmp_path, storage), sent, storage)


STAMPS: dict[str, tuple[Callable[[float], float], str]] = {
    "stand still": (lambda t: bags.START - 40.0, "stand still or fall in 59 messages"),
    "stand still from 3 s": (lambda t: min(t, bags.START + 3.0), "stand still or fall in 29 messages"),
    "whole seconds": (math.floor, "stand still or fall in 54 messages"),
    "none": (lambda t: 0.0, "60 stamps of /sonar/range_3 are zero or no time"),
    "before 1970": (lambda t: t - bags.START - 100.0, "60 stamps of /sonar/range_3 are zero or no time"),
    "none after 3 s": (lambda t: t if t < bags.START + 2.95 else 0.0, "30 stamps"),
    "an hour ahead": (lambda t: t + 3600, "are 3,600.0 s ahead of the recorder's clock"),
    "set back": (
        lambda t: t - (3600 if t > bags.START + 3.05 else 0),
        f"jump 3,600.0 s back at {bags.START + 3.1:.3f} s;",
    ),
    "one jumps": (
        lambda t: t + (1e6 if 3.05 < t - bags.START < 3.15 else 0),
        f"jump 1,000,000.0 s ahead at {bags.START + 3.1:.3f} s, at most (of 2 jumps)",
    ),
    "half speed": (lambda t: bags.START + (t - bags.START) / 2, "run at 0.50 times the speed"),
    "backwards": (lambda t: 2 * bags.START - t, "stand still or fall in"),
}


@pytest.mark.parametrize("storage", FORMS)
@pytest.mark.parametrize("how", STAMPS)
def test_stamps_that_bear_out_no_order_cost_no_reading(tmp_path: Path, how: str, storage: str) -> None:
    stamps, told = STAMPS[how]
    path = wall(stamps, storage, tmp_path)
    done = run("faults", path)
    assert done.stdout.decode().startswith("nothing wrong: 1 of 1 sonars healthy"), done
    assert told in done.stderr.decode(), done.stderr.decode()
    assert "the recorder's clock is used" in done.stderr.decode()
    assert "discarded" not in done.stderr.decode(), done.stderr.decode()


def test_other_readings_under_the_same_stamp_are_no_repeats(tmp_path: Path) -> None:
    # Two of an array's messages under one stamp: only what repeats the reading, too, is left out.
    sent = [
        bags.single(bags.START + n / 10, 3, 1.0 + n // 2 * 0.01 + n % 2 * 0.1, "/sonar/range_3", "",
                    stamp=bags.START + n // 2 / 5)
        for n in range(60)
    ]  # fmt: skip
    done = run("faults", bags.write(tmp_path / "a.bag", sent))
    assert "stand still or fall in 30 messages" in done.stderr.decode()
    assert "discarded" not in done.stderr.decode()


def test_a_message_that_was_sent_twice_counts_once(tmp_path: Path) -> None:
    sent = []
    for one in rosaria(DRIVE):
        again = copy.deepcopy(one)
        again.t += 0.003
        sent += [one, again]
    done = run("faults", bags.write(tmp_path / "a.bag", sent))
    assert done.stdout.decode().startswith("nothing wrong: 8 of 8 sonars healthy in 200 SIPs")
    assert "discarded: 200 x /sonar: stamp is not newer than the last" in done.stderr.decode()


@pytest.mark.parametrize("storage", FORMS)
def test_a_dead_sonar_is_found_in_a_bag(tmp_path: Path, storage: str) -> None:
    sent = []
    for t, place, heading, ranges in Drive(seconds=30).steps:
        mm = [700.0 if k == 2 and t > bags.START + 5 else value for k, value in enumerate(ranges)]
        sent += [bags.odometry(t, place, heading), bags.cloud2(t, mm)]
    path = bags.write(path_of(tmp_path, storage), sent, storage)
    told = run("faults", path).stdout.decode()
    assert "sonar/front/02" in told, told
    assert told.count("sonar/") == 1, told


@pytest.mark.parametrize("names", ["frames", "numbers", "numbers from 1", "one topic"])
def test_single_ranges_are_told_apart(tmp_path: Path, names: str) -> None:
    sent: list[Sent] = []
    first = 1 if names == "numbers from 1" else 0
    if names == "frames":
        for k in range(8):
            mount = bags.TABLE.mounts[k]
            pose = (mount.x_mm / 1000, mount.y_mm / 1000, math.radians(mount.heading_deg))
            sent.append(
                bags.transform(bags.START, f"us_{'hgfedcba'[k]}", "base_link", *pose, topic="/tf_static")
            )
    for n, (t, place, heading, ranges) in enumerate(DRIVE.steps):
        sent.append(bags.odometry(t, place, heading))
        for k in range(n % 2, 8, 2):
            frame = f"us_{'hgfedcba'[k]}" if names == "frames" else f"us{k + first}"
            topic = "/us" if names == "one topic" else f"/us/{frame}"
            range_m = math.inf if ranges[k] >= bags.NO_ECHO_MM else ranges[k] / 1000
            sent.append(bags.single(t + k / 100, k, range_m, topic, frame))
    path = bags.write(tmp_path / "a.bag", sent)
    done = run("faults", path)
    assert done.stdout.decode().startswith("nothing wrong: 8 of 8"), done
    seen: dict[str, set[int]] = {}
    for row in sips(path):
        for k, value in row["sonar"].items():
            seen.setdefault(k, set()).add(value)
    for k in range(8):
        assert seen[str(k)] <= {min(5000, round(ranges[k])) for *_, ranges in DRIVE.steps}


def test_a_scan_is_read_as_the_sonars_that_it_covers(tmp_path: Path) -> None:
    sent = [bags.transform(bags.START, "laser", "base_link", 0.1, 0.0, 0.0, topic="/tf_static")]
    for t, place, heading, _ in DRIVE.steps:
        sent += [bags.odometry(t, place, heading), bags.scan(t, ahead(place, heading), heading)]
    path = bags.write(tmp_path / "a", sent, "mcap")
    done = run("faults", path)
    assert "nothing wrong" in done.stdout.decode()
    assert "read as sonars 0, 1, 2, 3, 4, 5, 6, 7, 8, 15 of p3dx-sh" in done.stderr.decode()


def test_transforms_stand_in_for_odometry(tmp_path: Path) -> None:
    sent = [
        one
        for t, place, h, ranges in DRIVE.steps
        for one in (
            bags.transform(t, "base_link", "odom", place[0] / 1000, place[1] / 1000, h),
            bags.cloud(t, ranges),
        )
    ]
    path = bags.write(tmp_path / "a.bag", sent)
    rows = sips(path)
    assert [row["x_mm"] for row in rows] == pytest.approx([place[0] for _, place, *_ in DRIVE.steps], abs=1)
    assert rows[50]["vel_left_mm_s"] == pytest.approx(250, abs=30)
    assert run("faults", path).stdout.decode().startswith("nothing wrong: 8 of 8")


def test_of_two_robots_one_is_read_and_the_other_told(tmp_path: Path) -> None:
    sent = []
    for t, place, heading, ranges in DRIVE.steps:
        for name, way in (("/a", 1), ("/b", 0)):
            sent += [
                bags.odometry(t, (place[0] * way, place[1] * way), heading, topic=f"{name}/pose"),
                bags.cloud(t, ranges, topic=f"{name}/sonar"),
            ]
    path = bags.write(tmp_path / "a.bag", sent)
    assert "not read: /b/sonar; --topic chooses" in run("decode", path).stderr.decode()
    assert sips(path)[-1]["x_mm"] > 4000
    assert sips(path, "--topic", "/b")[-1]["x_mm"] == 0


def test_a_laser_in_three_dimensions_is_no_ring(tmp_path: Path) -> None:
    big = bags.cloud(bags.START, [1000.0] * 16, topic="/velodyne")
    big.fields["points"] = [{"x": 1.0, "y": 0.0, "z": 0.0}] * 4000
    done = run("faults", bags.write(tmp_path / "a.bag", [big]))
    assert done.returncode == 2
    assert "no ranges of sonars" in done.stderr.decode()
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("storage", FORMS)
def test_what_was_recorded_is_told_where_there_is_no_ring(tmp_path: Path, storage: str) -> None:
    path = bags.write(path_of(tmp_path, storage), [bags.odometry(bags.START, (0, 0), 0)], storage)
    done = run("stats", path)
    assert done.returncode == 2
    assert "it holds nav_msgs/msg/Odometry" in done.stderr.decode()


@pytest.mark.parametrize("how", ["gzip", "pipe", "name", "file"])
def test_zipped_piped_and_renamed_bags_are_read(tmp_path: Path, how: str) -> None:
    path = bags.write(tmp_path / "a.bag", rosaria(DRIVE))
    if how == "gzip":
        (tmp_path / "a.bag.gz").write_bytes(gzip.compress(path.read_bytes()))
        done = run("faults", tmp_path / "a.bag.gz")
    elif how == "pipe":
        done = run("faults", "-", stdin=path.read_bytes())
    elif how == "name":
        done = run("faults", shutil.copy(path, tmp_path / "recording"))
    else:
        folder = bags.write(tmp_path / "b", rosaria(DRIVE), "mcap")
        done = run("faults", next(folder.glob("*.mcap")))
    assert done.stdout.decode().startswith("nothing wrong: 8 of 8"), done


def test_a_bag_that_is_cut_gives_what_comes_before(tmp_path: Path) -> None:
    path = bags.write(tmp_path / "a.bag", rosaria(DRIVE))
    path.write_bytes(path.read_bytes()[:-1000])
    done = run("faults", path)
    assert done.returncode == 2
    assert "a bag that cannot be read" in done.stderr.decode()
    assert len(done.stderr.splitlines()) == 1


def test_every_command_takes_a_bag(tmp_path: Path) -> None:
    path = bags.write(tmp_path / "a.bag", rosaria(DRIVE))
    assert b"201 packets" in run("stats", path).stdout
    assert run("plot", path, "-o", tmp_path / "a.png").returncode == 0
    assert (tmp_path / "a.png").stat().st_size > 1000
    for name in ("a.rec", "a.jsonl", "a.mcap", "a.csv"):
        assert run("convert", path, tmp_path / name).returncode == 0, name
    again = sips(tmp_path / "a.rec")
    assert again == sips(path)
    assert run("diff", path, tmp_path / "a.rec").returncode == 0


def test_own_mcap_gives_back_what_it_was_made_of(tmp_path: Path) -> None:
    path = bags.write(tmp_path / "a.bag", rosaria(DRIVE))
    assert run("convert", path, tmp_path / "a.mcap").returncode == 0
    keys = ("x_mm", "heading_deg", "sonar", "vel_left_mm_s", "flags", "battery_v", "t")
    before, after = (
        [{key: row[key] for key in keys} for row in sips(one)] for one in (path, tmp_path / "a.mcap")
    )
    assert after == before
    assert run("faults", tmp_path / "a.mcap").stdout.decode().startswith("nothing wrong: 8 of 8")


@pytest.mark.parametrize("robot", ["amigo-sh", "p3at-sh"])
def test_the_robot_is_told_by_where_points_lie(
    tmp_path: Path, robot: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bags, "TABLE", robot_table(robot))
    sent = [
        bags.cloud(bags.START + n / 10, [1000.0 + 10 * n + k for k in range(bags.TABLE.sonars)])
        for n in range(20)
    ]
    done = run("decode", bags.write(tmp_path / "a.bag", sent))
    assert f"ring of {robot}" in done.stderr.decode(), done.stderr.decode()


def test_points_that_lie_on_no_robot_are_refused(tmp_path: Path) -> None:
    sent = []
    for n in range(20):
        one = bags.cloud(bags.START + n / 10, [1000.0] * 16)
        one.fields["points"] = [{"x": 1.0 + k, "y": 0.1 * k - 3, "z": 0.0} for k in range(8)]
        sent.append(one)
    done = run("faults", bags.write(tmp_path / "a.bag", sent))
    assert done.returncode == 2
    assert "no known robot's sonars" in done.stderr.decode()


@pytest.mark.parametrize("magic", [b"#ROSBAG V2.0\n", b"SQLite format 3\0", b"\x89MCAP0\r\n"])
@pytest.mark.parametrize("rest", [b"", b"\0" * 200, b"\xff" * 5000])
def test_what_only_begins_as_a_bag_gives_one_line(tmp_path: Path, magic: bytes, rest: bytes) -> None:
    (tmp_path / "a").write_bytes(magic + rest)
    done = run("faults", tmp_path / "a")
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1, done.stderr


@pytest.mark.parametrize("storage", FORMS)
@pytest.mark.parametrize("seed", range(4))
def test_random_damage_is_no_crash(tmp_path: Path, storage: str, seed: int) -> None:
    rng = random.Random(f"{storage} {seed}")
    path = bags.write(path_of(tmp_path, storage), rosaria(Drive(seconds=3)), storage)
    file = path if storage == "ros1" else next(one for one in path.iterdir() if one.name != "metadata.yaml")
    data = bytearray(file.read_bytes())
    for _ in range(20):
        data[rng.randrange(len(data))] = rng.randrange(256)
    file.write_bytes(data)
    assert run("decode", path).returncode in (0, 2), f"{storage} {seed}"
