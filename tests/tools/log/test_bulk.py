# SPDX-License-Identifier: MIT
"""Rule: rows that are taken many at a time give what they give one by one: statistics, and what is reported."""

from __future__ import annotations

import json
import random
from pathlib import Path
from typing import Any

import pytest
from argus_tools.formats import open_log
from argus_tools.log.faults import Listener, Said
from argus_tools.log.packets import Row, packets
from argus_tools.log.stats import Stats
from argus_tools.log.stats_bulk import add_rows
from argus_tools.log.summary import Summary

from hil_sim.arcos import Sip

ROOT = Path(__file__).resolve().parents[3]
CAPTURES = sorted((ROOT / "tests" / "data" / "captures").glob("*.jsonl"))
SAMPLE = ROOT / "docs" / "samples" / "two-failing-sonars.rec.gz"
SEEDS = range(4)


def strange_rows(rng: random.Random, count: int) -> list[Row]:
    """SIPs as no robot sends them: doubled sonars, cut lists, gaps, equal times, damage and commands between."""
    rows: list[Row] = []
    t = 1000.0
    has_times = rng.random() < 0.8
    for _ in range(count):
        t += rng.choice((0.0, 0.1, 0.1, 0.1, 0.25, 2.0))
        when = round(t, 3) if has_times else None
        kind = rng.random()
        if kind < 0.05:
            rows.append(
                Row(when, 0, "r2c", "JUNK", False, rng.randbytes(7), "7 bytes that belong to no packet")
            )
        elif kind < 0.1:
            rows.append(Row(when, 0, "c2r", "VEL", True, bytes((11, 0x3B, 1, 0))))
        elif kind < 0.12:
            rows.append(Row(when, 0, "r2c", "SIP", True, bytes((0x32, 1, 2, 3))))
        else:
            readings = tuple((rng.randrange(20), rng.randrange(6000)) for _ in range(rng.randrange(9)))
            data = Sip(type=0x33, flags=7, sonars=readings).data
            if rng.random() < 0.05:
                data = data[: rng.randrange(20, len(data))]
            rows.append(Row(when, 0, "r2c", "SIP", True, data))
    return rows


def statistics(rows: list[Row], size: int) -> str:
    stats = Stats()
    for at in range(0, len(rows), size):
        add_rows(stats, rows[at : at + size])
    return json.dumps(stats.summary())


@pytest.mark.parametrize("seed", SEEDS)
def test_statistics_of_columns_are_those_of_rows(seed: int) -> None:
    rng = random.Random(f"stats {seed}")
    rows = strange_rows(rng, 700)
    singly = Stats()
    for row in rows:
        singly.add(row)
    for size in (1, 7, 256, 1000):
        assert statistics(rows, size) == json.dumps(singly.summary()), (seed, size)


@pytest.mark.parametrize("path", [*CAPTURES, SAMPLE], ids=lambda path: path.stem)
def test_a_recorded_log_has_the_same_statistics(path: Path) -> None:
    rows = list(packets(open_log(str(path))))
    singly = Stats()
    for row in rows:
        singly.add(row)
    assert statistics(rows, 512) == json.dumps(singly.summary())


def reports(rows: list[Row], size: int) -> tuple[list[Said], dict[str, Any], list[str]]:
    """What a listener reports of rows, taken so many at a time; 0: one by one."""
    listener, summary = Listener({}), Summary()
    found: list[Said] = []
    for at in range(0, len(rows), max(1, size)):
        batch = rows[at : at + max(1, size)]
        seen = 0
        each = listener.take_many(batch) if size else ((0, said) for said in listener.take(batch[0]))
        for number, said in each:
            summary.see_all(batch[seen : number + 1])
            seen = number + 1
            summary.add(said.event, said.t, said.offset)
            found.append(said)
        summary.see_all(batch[seen:])
    status = listener.status
    assert status is not None
    return found, status, summary.lines(status, 0, listener.unborne)


@pytest.mark.parametrize("path", [*CAPTURES, SAMPLE], ids=lambda path: path.stem)
def test_a_recorded_log_brings_the_same_reports(path: Path) -> None:
    rows = list(packets(open_log(str(path))))
    expected = reports(rows, 0)
    assert expected[0]
    for size in (200,):
        assert reports(rows, size) == expected


@pytest.mark.parametrize("seed", SEEDS)
def test_a_mutilated_log_brings_the_same_reports(seed: int) -> None:
    rng = random.Random(f"reports {seed}")
    rows = list(packets(open_log(str(SAMPLE))))
    for _ in range(60):
        at = rng.randrange(len(rows))
        mutation = rng.randrange(6)
        row = rows[at]
        if mutation == 0 and row.ok:
            rows[at] = row._replace(ok=False, error="checksum is 0000, not 0001")
        elif mutation == 1 and row.type == "SIP" and len(row.data) > 20:
            rows[at] = row._replace(data=row.data[:16] + bytes((rng.randrange(256),)) + row.data[17:])
        elif mutation == 2:
            rows[at] = row._replace(t=(row.t or 0.0) + rng.choice((-3.0, 5.0)))
        elif mutation == 3:
            rows.insert(
                at, Row(row.t, 0, "c2r", "SONAR", True, bytes((28, 0x3B, rng.choice((0, 1, 3, 4)), 0)))
            )
        elif mutation == 4:
            # A client speaks between SIPs: rarely of the session, and then sometimes damaged.
            kind, number = rng.choice((("VEL", 11), ("PULSE", 0), ("CLOSE", 2)))
            said = Row(row.t, 0, "c2r", kind, rng.random() < 0.8, bytes((number, 0x3B, 1, 0)))
            for place in range(at, min(at + rng.randrange(1, 60), len(rows)), rng.randrange(1, 4)):
                rows.insert(place, said)
        else:
            del rows[at : at + rng.randrange(40)]
    expected = reports(rows, 0)
    for size in (64,):
        assert reports(rows, size) == expected, seed
