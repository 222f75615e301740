# SPDX-License-Identifier: MIT
"""`argus-monitor --tui`: argusd's own screen on a terminal in the place of the page."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from argus_tools.monitor.sim import Simulation, find_argusd

CONTROL_WITHIN_S: Final = 10.0
_POLL_S: Final = 0.05


def screen(argusd: str | None, address: str, token: str | None) -> list[str]:
    """Return the command that shows the screen of the argusd whose control socket is at ADDRESS."""
    words = [find_argusd(argusd), "--attach", address]
    return [*words, "--control-token", token] if token else words


def become(words: Sequence[str]) -> None:
    """Go on as that program: it has the terminal to itself."""
    os.execv(words[0], list(words))


async def beside(simulation: Simulation, argusd: str | None) -> int:
    """Show the screen of a simulation until its user leaves; return its exit code."""
    async with asyncio.timeout(CONTROL_WITHIN_S):
        while not Path(simulation.address.path).exists():
            await asyncio.sleep(_POLL_S)
    shown = await asyncio.create_subprocess_exec(*screen(argusd, str(simulation.address), None))
    return await shown.wait()
