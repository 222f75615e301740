# SPDX-License-Identifier: MIT
"""The programs of the emulator, each of which is imported when it runs."""

from __future__ import annotations

from hil_sim.start import begun

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from hil_sim.start import Main


def argus_sim(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-sim`."""

    def load() -> Main:
        from hil_sim.cli.main import main

        return main

    return begun(load, arguments)


def argus_conformance(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-conformance`."""

    def load() -> Main:
        from hil_sim.conformance.cli import main

        return main

    return begun(load, arguments)
