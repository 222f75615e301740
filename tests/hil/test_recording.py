# SPDX-License-Identifier: MIT
"""Rule: --record holds what was on the wire, to the second before the program was killed; a disk that refuses is
said once and the drive goes on."""

from __future__ import annotations

import json
import resource
import time
from pathlib import Path

import pytest
from argus_tools.chunks import Chunk, ReadOptions
from argus_tools.formats.record import FORMAT
from argus_tools.log.cli import main
from harness import PATIENCE_S, Bench, Record
from rules import assert_reached
from worlds import hall

from hil_sim.arcos import Unframer

GOAL_MM = 900


def read(path: Path) -> list[Chunk]:
    with path.open("rb") as stream:
        reader = FORMAT.reader(stream, ReadOptions(name=str(path)))
        chunks = list(reader)
    assert reader.damage == []
    return chunks


def stream(chunks: list[Chunk], direction: str) -> bytes:
    return b"".join(chunk.data for chunk in chunks if chunk.dir == direction)


def test_both_ends_record_the_same_wire(bench: Bench) -> None:
    files = [bench.path / "argusd.rec", bench.path / "sim.rec"]
    sim = bench.sim(bench.world(**hall()), extra=["--record", str(files[1])])
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", "--record", str(files[0]))
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)
    sim.process.terminate()
    sim.process.wait(PATIENCE_S)
    ours, theirs = map(read, files)
    assert stream(ours, "c2r") == stream(theirs, "c2r")
    heard = Unframer()
    heard.feed(stream(ours, "r2c"), 0.0)
    assert heard.counters.packets > 50
    assert stream(ours, "r2c") in stream(theirs, "r2c")
    times = [chunk.t for chunk in ours if chunk.t is not None]
    assert len(times) == len(ours)
    assert times == sorted(times)
    assert abs(times[-1] - time.time()) < 120


def test_a_killed_argusd_leaves_all_but_the_last_second(bench: Bench) -> None:
    file = bench.path / "argusd.rec"
    bench.sim(bench.world(**hall()))
    argusd = bench.argusd("--record", str(file), active=False)
    argusd.wait("HEALTH_CHECK")
    time.sleep(1.5)
    killed = time.time()
    argusd.process.kill()
    argusd.process.wait()
    chunks = read(file)
    assert chunks[-1].t is not None
    assert killed - 1.0 < chunks[-1].t < killed + 0.1


def test_a_disk_that_refuses_does_not_stop_the_drive(bench: Bench) -> None:
    file = bench.path / "argusd.rec"
    sim = bench.sim(bench.world(**hall()))
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", "--record", str(file))
    resource.prlimit(argusd.process.pid, resource.RLIMIT_FSIZE, (1500, 1500))
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)
    assert file.stat().st_size <= 1500
    said = "\n".join(argusd.errors)
    assert said.count("File too large; going on without") == 1, said
    assert "bytes are missing" in said


def test_the_log_alone_tells_what_argusd_told(bench: Bench, capsys: pytest.CaptureFixture[str]) -> None:
    """The live manager judges from the same bytes; only what came before its session was open differs."""
    file = bench.path / "argusd.rec"
    bench.sim(bench.world(**hall()), "off:3@6s", "silent:12@6s")
    argusd = bench.argusd("--record", str(file), active=False)
    argusd.wait("SONAR_DISABLED", name="sonar/front/03")
    time.sleep(3)
    argusd.end()
    assert main(["faults", "--json", "--exit-zero", "--profile", "paper", str(file)]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    wanted = ("SONAR_DEAD", "SONAR_DISABLED", "SONAR_STALE", "FAILURE_STATE", "PLAN", "PLAN_ROTATION")

    def told(events: list[Record]) -> list[tuple[object, ...]]:
        # The value of SONAR_STALE is an age in ms, which the host's scheduling shifts by a SIP.
        timed = ("SONAR_STALE",)
        return [
            (e["event"], e["name"], None if e["event"] in timed else e["value"])
            for e in events
            if e["event"] in wanted
        ]

    assert told(events) == told(argusd.events)
    assert ("SONAR_DISABLED", "sonar/front/03", 1) in told(events)
