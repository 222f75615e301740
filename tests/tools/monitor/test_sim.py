# SPDX-License-Identifier: MIT
"""Rule: the simulation knows what is broken at each moment, whether an order, an option or the time did it."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from argus_tools.monitor.sim import Simulation


@pytest.fixture
def argusd(tmp_path: Path) -> str:
    """One that does nothing."""
    program = tmp_path / "argusd"
    program.write_text("#!/bin/sh\nexec sleep 300\n")
    program.chmod(0o755)
    return str(program)


@pytest.mark.soak
def test_faults_of_options_and_of_orders_are_known(argusd: str) -> None:
    told: list[dict[str, str]] = []

    async def run() -> None:
        words = ["--world", "hall", "--fault", "stuck:2", "--fault", "off:3@3s-5s"]
        simulation = Simulation(words, argusd, [])
        simulation.changed = lambda: told.append(simulation.broken)
        try:
            await simulation.start()
            assert simulation.broken["2"] == "stuck", "it is known before the first page comes"
            async with asyncio.timeout(120):
                while {"2": "stuck", "3": "off"} not in told or told[-1] != {"2": "stuck"}:
                    await asyncio.sleep(0.02)
                answer = await simulation.order("break silent:7")
                assert (answer["ok"], answer["broken"]) == (True, {"2": "stuck", "7": "silent"})
                assert (await simulation.order("mend all"))["broken"] == {}
                assert (await simulation.order("nonsense"))["ok"] is False
        finally:
            await simulation.close()

    asyncio.run(run())
    assert told == [
        {"2": "stuck"},
        {"2": "stuck", "3": "off"},
        {"2": "stuck"},
        {"2": "stuck", "7": "silent"},
        {},
    ]


def test_an_emulator_that_does_not_answer_is_told(argusd: str) -> None:
    async def run() -> None:
        simulation = Simulation(["--world", "hall"], argusd, [])
        try:
            await simulation.start()
            assert simulation._sim is not None
            simulation._sim.kill()
            await simulation._sim.wait()
            answer = await simulation.order("break off:3")
            assert (answer["ok"], answer["say"]) == (False, "the emulator does not answer")
        finally:
            await simulation.close()

    asyncio.run(run())
