# SPDX-License-Identifier: MIT
"""Rule: the examples of docs/python.md that take a robot run as they stand there, on the emulated one."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from pathlib import Path

import argus
import pytest
from harness import PATIENCE_S, ROOT, Argusd, Bench, wait_for
from rules import assert_reached
from worlds import hall

EXAMPLES = ROOT / "examples/python"


def place_of(bench: Bench) -> str:
    return f"unix:{bench.path}/control.sock"


def start(bench: Bench) -> Argusd:
    argusd = bench.argusd("--control", place_of(bench), "--inject")
    argusd.wait("HEALTH_CHECK")
    return argusd


def example(name: str, bench: Bench) -> subprocess.Popen[str]:
    words = [sys.executable, str(EXAMPLES / f"{name}.py"), place_of(bench)]
    return subprocess.Popen(words, stdout=subprocess.PIPE, text=True)


def output(process: subprocess.Popen[str]) -> str:
    told, _ = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0
    return told


def test_drive_and_print_health_beside_a_monitor(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    argusd = start(bench)
    watching = example("monitor", bench)
    assert watching.stdout is not None
    assert " s  at 0,0 mm, 0 failing" in watching.stdout.readline()
    told = output(example("drive", bench))
    assert "sonar  0 at   90 deg: HEALTHY" in told
    assert told.splitlines()[0].endswith("V")
    assert "0 of 16 sonars are not relied on" in told
    assert output(watching).splitlines()[-1].endswith("GOAL_REACHED")
    argusd.wait("GOAL_REACHED")
    assert_reached(sim, 2000)


def test_a_fault_is_seen_and_a_drive_that_is_cut_off_stops(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    argusd = start(bench)
    with argus.connect(place_of(bench)) as robot:
        robot.fail(3, "off", for_s=600)
        for event in robot.events(timeout_s=PATIENCE_S):
            if (event.sonar, event.event) == (3, "SONAR_DISABLED"):
                break
        assert [sonar.number for sonar in robot.state().failing] == [3]
        assert robot.state().sonars[3].kind == "off"
        assert robot.turn(90).mode in ("IDLE", "WAITING")
        with pytest.raises(TimeoutError):
            robot.drive_to(2000, 0, timeout_s=1.0)
        assert robot.state().paused
    argusd.wait("OPERATOR", value=1)
    wait_for("it stands", lambda: abs(sim.now["v_mm_s"]) < 1.0, PATIENCE_S)


def test_the_async_client_drives_and_is_refused_while_another_has_control(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    start(bench)

    async def talk() -> None:
        async with (
            argus.connect_async(place_of(bench)) as first,
            argus.connect_async(place_of(bench)) as second,
        ):
            await first.take()
            with pytest.raises(argus.Refused) as refusal:
                await second.drive_to(500, 0)
            assert refusal.value.why == "taken"
            state = await first.drive_to(500, 0, timeout_s=PATIENCE_S)
            assert (state.mission, abs(state.x_mm - 500) < 100) == ("reached", True)
            await second.take(force=True)
            with pytest.raises(argus.Refused):
                await first.turn(10)

    asyncio.run(talk())


def test_the_page_shows_the_examples() -> None:
    page = (ROOT / "docs/python.md").read_text(encoding="utf-8")
    assert sorted(path.stem for path in Path(EXAMPLES).glob("*.py")) == [
        "bag",
        "drive",
        "frame",
        "guard",
        "monitor",
        "sweep",
    ]
    for path in EXAMPLES.glob("*.py"):
        assert path.read_text(encoding="utf-8").partition("\n")[2].strip() in page
