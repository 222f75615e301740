# SPDX-License-Identifier: MIT
"""`python -m hil_sim.demo` is the demonstration."""

from __future__ import annotations

import sys

from hil_sim.start import begun

TYPE_CHECKING = False
if TYPE_CHECKING:
    from hil_sim.start import Main


def load() -> Main:
    """Import what it does."""
    from hil_sim.demo.cli import main

    return main


sys.exit(begun(load))
