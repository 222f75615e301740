# SPDX-License-Identifier: MIT
"""Rule under attack: ranges that come without ARCOS are judged as the same ones in SIPs are."""

from __future__ import annotations

import math
from pathlib import Path

import argus
import numpy as np
import pytest
from argus.ranges import Observer

ROOT = Path(__file__).resolve().parents[2]
SAMPLE = ROOT / "docs/samples/two-failing-sonars.rec.gz"
_CONFIG = {"suspect_readings": 3}


def observed() -> tuple[Observer, set[tuple[str, int | None]]]:
    """Feed the SIPs of a drive as poses and ranges in numpy arrays; return what is said."""
    watch = Observer("p3dx-sh", _CONFIG)
    said = set()
    for sip in argus.log.decode(SAMPLE):
        if "sonar" not in sip:
            continue
        ranges = np.full(16, math.nan)
        for number, range_mm in sip["sonar"].items():
            ranges[int(number)] = math.inf if range_mm >= 5000 else range_mm
        left, right = sip["vel_left_mm_s"], sip["vel_right_mm_s"]
        pose = np.array([sip["x_mm"], sip["y_mm"], math.radians(sip["heading_deg"])])
        speeds = np.array([(left + right) / 2, (right - left) / 330])
        said |= {(event.event, event.sonar) for event in watch.observe(sip["t"], pose, speeds, ranges)}
    return watch, said


def test_the_verdicts_are_those_of_the_log() -> None:
    watch, said = observed()
    found = argus.diagnose(SAMPLE, config=_CONFIG)
    assert watch.kind == list(found.kind)[:16]
    assert watch.health == list(found.health)[:16]
    theirs = {(one.event.event, one.event.sonar) for one in found.events}
    wanted = ("SONAR_NAMED", "SONAR_SUSPECT", "SONAR_KIND")
    assert {one for one in said if one[0] in wanted} == {one for one in theirs if one[0] in wanted}
    assert ("SONAR_NAMED", 3) in said


def test_a_ring_out_of_a_file_is_watched() -> None:
    watch = Observer(str(ROOT / "docs/samples/rings/roundbot.toml"))
    for k in range(20):
        watch.observe(1e9 + k / 10, (k * 20, 0, 0), (200, 0), np.full(8, 900.0))
    assert watch.kind == [""] * 8
    assert set(watch.health) <= {"HEALTHY", "UNKNOWN"}


@pytest.mark.parametrize(
    ("t_s", "pose", "speeds", "ranges", "why"),
    [
        (1.0, (0, 0, 0), (0, 0), [900] * 7, "7 ranges of the 8 sonars"),
        (1.0, (0, 0, math.nan), (0, 0), [900] * 8, "finite"),
        (math.inf, (0, 0, 0), (0, 0), [900] * 8, "finite"),
        (1.0, (0, 0), (0, 0), [900] * 8, "finite times, a pose"),
        (-1.0, (0, 0, 0), (0, 0), [900] * 8, "before the last time"),
    ],
)
def test_what_does_not_hold_is_refused(
    t_s: float, pose: tuple[float, ...], speeds: tuple[float, ...], ranges: list[float], why: str
) -> None:
    watch = Observer("amigo-sh")
    watch.observe(0.0, (0, 0, 0), (0, 0), [900] * 8)
    with pytest.raises(argus.ranges.InputError, match=why):
        watch.observe(t_s, pose, speeds, ranges)


def test_values_at_their_ends_break_nothing() -> None:
    watch = Observer("amigo-sh")
    for k, value in enumerate((1e300, -1e300, 0.0, 2.0**31)):
        watch.observe(
            k / 10, (value, value, value), (value, value), [math.inf, -math.inf, value, 0, -5, 1e9, 3, 4]
        )
    assert len(watch.kind) == 8


def test_old_ranges_are_left_out() -> None:
    watch = Observer("amigo-sh")
    first = watch.observe(0.0, (0, 0, 0), (0, 0), [900] * 8, [9.0] * 8)
    assert not any(event.event == "SONAR_HEALTHY" for event in first)
