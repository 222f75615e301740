# SPDX-License-Identifier: MIT
"""Rule: a recorded drive with odometry and a laser becomes a stream of sonars, whatever its form, and faults put into
it are found; without recordings the bench is skipped, and says so."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path

import bags
import pytest
from argus_tools.chunks import LogError
from argus_tools.rings.drives import lines_of
from bags import Drive, Sent

from hil_sim.bench.plan import FAULTS
from hil_sim.bench.semi_real import Run, drive_files, faults_of, low_things, read_drive, way_mm
from hil_sim.cli.main import main
from hil_sim.errors import SimError
from hil_sim.tables.robot import robot_table

DRIVE = Drive(seconds=24.0)


def sent(drive: Drive = DRIVE) -> Iterator[Sent]:
    for t, place, heading, _ in drive.steps:
        yield bags.odometry(t, place, heading)
        yield bags.scan(t + 0.01, place, heading)


def carmen(path: Path, drive: Drive = DRIVE) -> Path:
    """A log as CARMEN writes it: 181 beams of half a turn, laser and robot at one place; one line is cut."""
    lines = ["# CARMEN log", "PARAM robot_front_laser_max 81.9"]
    for t, place, heading, _ in drive.steps:
        scan = bags.scan(t, place, heading).fields["ranges"][30:211]
        pose = f"{place[0] / 1000:.4f} {place[1] / 1000:.4f} {heading:.5f}"
        ranges = " ".join(f"{min(far, 81.91):.2f}" for far in scan)
        lines.append(f"FLASER 181 {ranges} {pose} {pose} {t - bags.START:.3f} host {t - bags.START:.3f}")
    path.write_text("\n".join([*lines, "FLASER 181 1.0 2.0"]) + "\n", encoding="utf-8")
    return path


def table(path: Path, drive: Drive = DRIVE, beams: int = 181) -> Path:
    """A table with a column for each beam of half a turn, in m; some cells are empty, one row is cut."""
    lines = ["t_s,x_m,y_m,heading_rad," + ",".join(f"range_{k}_m" for k in range(beams))]
    for t, place, heading, _ in drive.steps:
        scan = bags.scan(t, place, heading).fields["ranges"][30 : 30 + beams]
        ranges = ",".join("" if far > 81.0 else f"{far:.3f}" for far in scan)
        pose = f"{place[0] / 1000:.4f},{place[1] / 1000:.4f},{heading:.5f}"
        lines.append(f"{t - bags.START:.3f},{pose},{ranges}")
    path.write_text("\n".join([*lines, "1.0,2.0"]) + "\n", encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("drives")
    bags.write(made / "wall.bag", sent())
    bags.write(made / "second", sent(), "sqlite3")
    carmen(made / "third.log")
    table(made / "fourth.csv")
    return made


def test_each_form_is_found_and_reads_alike(folder: Path) -> None:
    files = drive_files(folder)
    assert [path.name for path in files] == ["second", "fourth.csv", "third.log", "wall.bag"]
    drives = [read_drive(path, 300.0) for path in files]
    for drive in drives:
        assert len(drive.sweeps) == pytest.approx(len(DRIVE.steps), abs=1)
        assert way_mm(drive) == pytest.approx(bags.SPEED_MM_S * DRIVE.seconds, rel=0.03)
        low, high = bags.ROOM[1]
        ys = drive.sweeps[50].returns[:, 1]
        assert ys.min() == pytest.approx(low, abs=30)
        assert ys.max() == pytest.approx(high, abs=30)
    robot = robot_table()
    assert set(drives[2].covered(robot)) == {*range(8)} | {8, 15}
    assert drives[1].covered(robot) == drives[2].covered(robot)
    assert set(drives[3].covered(robot)) == {*range(8)} | {8, 15, 9, 14} - {9, 14}


def test_the_longest_stretch_without_a_gap_is_the_drive(tmp_path: Path) -> None:
    late = [one for one in sent() if not 5 < one.t - bags.START < 12]
    drive = read_drive(bags.write(tmp_path / "gap.bag", late), 300.0)
    assert drive.sweeps[0].t_ms == 0
    assert drive.end_ms == pytest.approx(11_900, abs=300)


def test_what_holds_no_drive_is_named(tmp_path: Path) -> None:
    alone = bags.write(tmp_path / "alone.bag", (one for one in sent() if one.topic != "/scan"))
    with pytest.raises(LogError, match="no scan"):
        list(lines_of(alone))
    still = bags.write(tmp_path / "still.bag", (one for one in sent() if one.topic == "/scan"))
    with pytest.raises(SimError, match="no odometry"):
        read_drive(still, 300.0)
    text = tmp_path / "words.log"
    text.write_text("hello\nFLASER x\nFLASER 3 1 2\n", encoding="utf-8")
    with pytest.raises(SimError, match="CARMEN"):
        read_drive(text, 300.0)
    with pytest.raises(SimError, match="no such folder"):
        drive_files(tmp_path / "missing")


def test_bearings_of_a_table_are_as_it_says_and_sonars_are_no_laser(tmp_path: Path) -> None:
    rows = [
        {
            "t": k,
            "x": k / 10,
            "y": 0,
            "heading": 0,
            "angle_min": -1.0,
            "angle_increment": 0.05,
            "ranges": [2.0] * 40,
        }
        for k in range(5)
    ]
    file = tmp_path / "scans.jsonl"
    file.write_text("\n".join(map(json.dumps, rows)), encoding="utf-8")
    lines = list(lines_of(file))
    assert [line["angles"] for line in lines] == [[-1.0, 0.05]] * 5
    assert lines[4]["x"] == pytest.approx(0.4)
    assert lines[4]["mm"] == [2000] * 40
    with pytest.raises(SimError, match="16 ranges a row are of sonars"):
        read_drive(table(tmp_path / "ring.csv", beams=16), 300.0)
    words = tmp_path / "words.csv"
    words.write_text("name,value\na,1\n", encoding="utf-8")
    with pytest.raises(SimError, match="no columns of time, pose and ranges"):
        read_drive(words, 300.0)


def test_a_fault_is_found_and_the_healthy_are_left_alone(folder: Path) -> None:
    drive = read_drive(folder / "wall.bag", 300.0)
    faulty = Run(drive, "garbage:3@travelled>1500", 1).go()
    assert [finding.named_right for finding in faulty.findings] == [True]
    assert faulty.disables == []
    healthy = Run(drive, "", 1).go()
    assert healthy.findings == []
    assert healthy.disables == []
    assert healthy.hours == pytest.approx(DRIVE.seconds / 3600, rel=0.02)


def test_sonars_have_the_statistics_of_recorded_ones(folder: Path) -> None:
    """Silence is drawn whole: nothing of it is the model's own. Low things make echoes that a laser has not."""
    drive = read_drive(folder / "wall.bag", 300.0)
    silent, short, all_ = 0, 0, 0
    for seed in range(1, 3):
        run = Run(drive, "", seed)
        run.go()
        for _, mm, true_mm, _, _ in run.rows:
            all_ += true_mm < 4600
            silent += true_mm < 4600 and mm == 5000
        short += len(run._low)
    assert 0.15 < silent / all_ < 0.65
    assert short > 0


def test_low_things_stand_off_the_way(folder: Path) -> None:
    import numpy as np

    drive = read_drive(folder / "wall.bag", 300.0)
    low = low_things(drive, 1.0, np.random.default_rng(1))
    assert len(low) > 5
    for x, y in low:
        assert min(math.hypot(x - s.pose.x_mm, y - s.pose.y_mm) for s in drive.sweeps) > 450
    assert len(low_things(drive, 0.0, np.random.default_rng(1))) == 0


def test_faults_are_of_sonars_that_the_laser_covers(folder: Path) -> None:
    drive = read_drive(folder / "third.log", 300.0)
    covered = drive.fires(robot_table())
    assert covered == tuple(range(8)), "half of the rear array is not there, so none of it is"
    for seed in range(20):
        for text in faults_of(drive, FAULTS, seed, FAULTS):
            assert int(text.split(":")[1].split("@")[0]) in covered
    assert faults_of(drive, ["free"], 1, FAULTS) == [""]


def test_the_bench_is_skipped_without_recordings(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "recorded"]) == 0
    assert capsys.readouterr().out == "skipped: no recordings are given (--bags DIR)\n"


def test_the_bench_over_a_folder(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "figures.json"
    words = [
        "bench",
        "recorded",
        "--bags",
        str(folder),
        "--kinds",
        "free",
        "--jobs",
        "1",
        "--json",
        str(out),
    ]
    assert main(words) == 0
    assert "4 recorded drives" in capsys.readouterr().out
    figures = json.loads(out.read_text(encoding="utf-8"))
    assert figures["drives"] == 4
    assert figures["streams"] == 4
    assert main(["bench", "recorded", "--bags", str(tmp_path)]) == 2
