# SPDX-License-Identifier: MIT
"""`python -m hil_sim.cli` is `argus-sim`."""

from __future__ import annotations

import sys

from hil_sim.start import begun

TYPE_CHECKING = False
if TYPE_CHECKING:
    from hil_sim.start import Main


def load() -> Main:
    """Import what it does."""
    from hil_sim.cli.main import main

    return main


sys.exit(begun(load))
