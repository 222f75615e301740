# SPDX-License-Identifier: MIT
"""The programs for ROS 2, each of which is imported when it runs."""

from __future__ import annotations

from hil_sim.start import begun

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence

    from hil_sim.start import Main


def argus_ros(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-ros`."""

    def load() -> Main:
        from argus_ros.cli import argus_ros as main

        return main

    return begun(load, arguments)


def range_guard(arguments: Sequence[str] | None = None) -> int:
    """Run `argus-range-guard`."""

    def load() -> Main:
        from argus_ros.cli import range_guard as main

        return main

    return begun(load, arguments)
