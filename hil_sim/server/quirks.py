# SPDX-License-Identifier: MIT
"""Which habits the emulator has: the robot's, or those of the vendor's emulator."""

from __future__ import annotations

from typing import Final

from hil_sim.arguments import offer
from hil_sim.errors import SimError
from hil_sim.server.mobilesim import MobileSimServer
from hil_sim.server.server import ArcosServer

QUIRKS: Final[dict[str, type[ArcosServer]]] = {"robot": ArcosServer, "mobilesim": MobileSimServer}


def server_kind(quirks: str) -> type[ArcosServer]:
    """Return the server with these habits; SimError for habits that there are not."""
    if quirks not in QUIRKS:
        raise SimError(f"no quirks '{quirks}'{offer(quirks, QUIRKS)}")
    return QUIRKS[quirks]
