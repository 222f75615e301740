# SPDX-License-Identifier: MIT
"""The programs around Argus, each of which is imported when it runs."""

from __future__ import annotations

from hil_sim.start import begun

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from hil_sim.start import Main


def argusd(arguments: Sequence[str] | None = None) -> int:
    """Run `argusd`."""

    def load() -> Main:
        from argus_tools.bundled import main

        return main

    return begun(load, arguments)


def argus_log(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-log`."""

    def load() -> Main:
        from argus_tools.log.cli import main

        return main

    return begun(load, arguments)


def argus_monitor(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-monitor`."""

    def load() -> Main:
        from argus_tools.monitor.cli import main

        return main

    return begun(load, arguments)


def argusctl(arguments: Sequence[str] | None = None) -> int:
    """Run `argusctl`."""

    def load() -> Main:
        from argus_tools.control.cli import main

        return main

    return begun(load, arguments)


def argus_foxglove(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-foxglove`."""

    def load() -> Main:
        from argus_tools.foxglove_bridge import main

        return main

    return begun(load, arguments)


def argus_flash_check(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-flash-check`."""

    def load() -> Main:
        from argus_tools.flash_check import main

        return main

    return begun(load, arguments)
