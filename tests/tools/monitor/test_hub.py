# SPDX-License-Identifier: MIT
"""Rule: whoever started the page is told on the terminal why argusd is not reached, once, and when it is."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.monitor import hub as hubs
from argus_tools.monitor.hub import Hub
from argus_tools.monitor.upstream import Address
from fake_argusd import FakeArgusd


async def until(what: Callable[[], bool]) -> None:
    async with asyncio.timeout(30):
        while not what():
            await asyncio.sleep(0.01)


def test_it_is_told_once_why_argusd_is_not_reached_and_when_it_is(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hubs, "_PAUSES_S", (0.01,))
    place, tries = tmp_path / "argus.sock", [0]
    told: list[str] = []

    async def drive() -> None:
        hub = Hub(Address(str(place)))
        hub.told = told.append
        watch = hub._watch

        async def counted() -> None:
            tries[0] += 1
            await watch()

        monkeypatch.setattr(hub, "_watch", counted)
        running = asyncio.create_task(hub.run())
        await until(lambda: tries[0] > 5)
        assert told == [f"unix:{place}: No such file or directory; trying again"]
        argusd = FakeArgusd(place)
        await argusd.start()
        await until(lambda: len(told) == 2)
        assert told[1] == "argusd is reached"
        running.cancel()
        await argusd.stop()

    asyncio.run(drive())
