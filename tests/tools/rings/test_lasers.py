# SPDX-License-Identifier: MIT
"""Rule: a bag with a laser is judged by its ring's sectors, alone or beside sonars; a sound one has nothing wrong."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import bags
import numpy as np
import pytest
from bags import Drive, Sent
from logs import ROOT, decode, run

RINGS = ROOT / "hil_sim/laser/rings"
DRIVE = Drive(seed=46, seconds=20.0)


def scans(drive: Drive, frozen_s: float = math.inf) -> Iterator[Sent]:
    """A pose and a scan at each step; from a time on the same scan."""
    rng, last = np.random.default_rng(drive.seed), None
    for t, place, heading, _ in drive.steps:
        yield bags.odometry(t, place, heading)
        one = bags.scan(t + 0.001, place, heading)
        one.fields["ranges"] = (one.fields["ranges"] + rng.normal(0, 0.01, 241)).astype(np.float32)
        if last is not None and t - bags.START >= frozen_s:
            one.fields["ranges"] = last
        last = one.fields["ranges"]
        yield one


def with_sonars(drive: Drive) -> Iterator[Sent]:
    for t, place, heading, ranges in drive.steps:
        yield bags.odometry(t, place, heading)
        yield bags.cloud(t + 0.001, ranges)
        yield bags.scan(t + 0.002, place, heading)


@pytest.mark.parametrize("storage", ["ros1", "mcap"])
def test_a_laser_alone_that_is_sound_has_nothing_wrong(tmp_path: Path, storage: str) -> None:
    path = bags.write(tmp_path / ("a.bag" if storage == "ros1" else "a"), scans(DRIVE), storage)
    done = run("faults", path, "--ring", RINGS / "laser.toml")
    assert done.stdout.decode().startswith("nothing wrong: 15 of 15 sonars healthy"), done
    assert "15 sectors of 12 degrees" in done.stderr.decode()


def test_a_frozen_one_is_found(tmp_path: Path) -> None:
    path = bags.write(tmp_path / "a.bag", scans(DRIVE, frozen_s=10.0))
    done = run("faults", path, "--ring", RINGS / "laser.toml", "--events")
    assert done.returncode == 1
    assert "LASER_FAULT" in done.stdout.decode()


def test_a_sector_reads_the_nearest_return_in_it(tmp_path: Path) -> None:
    path = bags.write(tmp_path / "a.bag", scans(DRIVE))
    rows = [row for row in decode(path, "--ring", str(RINGS / "laser.toml")) if row["type"] == "SIP"]
    y_mm = DRIVE.steps[0][1][1] + 2200  # of the wall on the right; the last sector looks there
    assert rows[0]["sonar"]["14"] == pytest.approx(y_mm / math.cos(math.radians(0)), abs=60), "seed 46"
    assert len(rows[0]["sonar"]) == 15


def test_sonars_and_laser_are_judged_together(tmp_path: Path) -> None:
    path = bags.write(tmp_path / "a.bag", with_sonars(DRIVE))
    done = run("faults", path, "--ring", RINGS / "sonars-laser.toml")
    assert done.stdout.decode().startswith("nothing wrong: 23 of 23 sonars healthy"), done
    dead = bags.write(tmp_path / "b.bag", with_sonars(Drive(seed=46, seconds=20.0, dead=(7,))))
    done = run("faults", dead, "--ring", RINGS / "sonars-laser.toml", "--events")
    named = [line for line in done.stdout.decode().splitlines() if "SONAR_NAMED" in line]
    assert named
    assert all("sonar/front/07" in line for line in named), named


def test_a_bag_without_a_scan_is_no_bag_of_a_laser_alone(tmp_path: Path) -> None:
    sent = [one for t, _, _, ranges in DRIVE.steps for one in (bags.cloud(t, ranges),)]
    done = run("faults", bags.write(tmp_path / "a.bag", sent), "--ring", RINGS / "laser.toml")
    assert done.returncode == 2
    assert "no scan of a laser" in done.stderr.decode()
