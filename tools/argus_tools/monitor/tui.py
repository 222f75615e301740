# SPDX-License-Identifier: MIT
"""`argus-monitor --tui`: argusd's own screen on a terminal in the place of the page."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from argus_tools.monitor.sim import Simulation, SimulationError, argusd_of

CONTROL_WITHIN_S: Final = 10.0
_POLL_S: Final = 0.05


def screen(argusd: str | None, address: str, token: str | None) -> list[str]:
    """Return the command that shows the screen of the argusd whose control socket is at ADDRESS."""
    words = [argusd_of(argusd), "--attach", address]
    return [*words, "--control-token", token] if token else words


def become(words: Sequence[str]) -> None:
    """Go on as that program: it has the terminal to itself."""
    os.execv(words[0], list(words))


async def _control_socket(simulation: Simulation) -> None:
    """Wait for the control socket of a simulation; SimulationError when one of the two ends before, or none comes."""
    ended = asyncio.create_task(simulation.ended())
    try:
        async with asyncio.timeout(CONTROL_WITHIN_S):
            while not Path(simulation.address.path).exists():
                if (await asyncio.wait([ended], timeout=_POLL_S))[0]:
                    raise SimulationError(ended.result())
    except TimeoutError:
        raise SimulationError("argusd opened no control socket") from None
    finally:
        ended.cancel()


async def beside(simulation: Simulation, argusd: str | None) -> int:
    """Start a simulation and show its screen until its user leaves; return its exit code.

    A screen that is given up is ended before this returns: it gives the terminal back.
    """
    await simulation.start()
    await _control_socket(simulation)
    shown = await asyncio.create_subprocess_exec(*screen(argusd, str(simulation.address), None))
    try:
        return await shown.wait()
    finally:
        with contextlib.suppress(ProcessLookupError):
            shown.terminate()
        await shown.wait()
