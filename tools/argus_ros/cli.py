# SPDX-License-Identifier: MIT
"""The programs argus-ros and argus-range-guard: their --help, and a clear word where there is no ROS."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Final

from argus_ros.parameters import ARGUS_USAGE, RANGE_GUARD_USAGE
from hil_sim.arguments import meant
from hil_sim.output import EXIT_UNREAD, guarded

EXIT_USAGE: Final = 2


def _asked(usage: str, arguments: Sequence[str] | None) -> tuple[list[str], int | None]:
    """Return the arguments, and the exit code when all is said without ROS."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if "--help" in given or "-h" in given:
        print(usage, end="")
        return given, 0
    if given and given[0] != "--ros-args":
        print(
            f"unknown argument '{given[0]}': parameters come behind --ros-args"
            f"{meant(given[0], ['--help', '--ros-args']) or ';'} see --help",
            file=sys.stderr,
        )
        return given, EXIT_USAGE
    try:
        import rclpy
    except ImportError as error:
        how = "source a ROS 2 installation, or pip install 'argus-p3dx[ros]'"
        print(f"{error}: {how}", file=sys.stderr)
        return given, EXIT_USAGE
    del rclpy
    return given, None


def argus_ros(arguments: Sequence[str] | None = None) -> int:
    """Run the node of a robot that argusd minds."""
    return guarded("argus-ros", lambda: _argus_ros(arguments), EXIT_USAGE, EXIT_UNREAD)


def _argus_ros(arguments: Sequence[str] | None) -> int:
    given, code = _asked(ARGUS_USAGE, arguments)
    if code is not None:
        return code
    from argus_ros.argus_node import ArgusNode
    from argus_ros.base import run_node

    return run_node(ArgusNode, given)


def range_guard(arguments: Sequence[str] | None = None) -> int:
    """Run the node that repairs the ranges of any driver."""
    return guarded("argus-range-guard", lambda: _range_guard(arguments), EXIT_USAGE, EXIT_UNREAD)


def _range_guard(arguments: Sequence[str] | None) -> int:
    given, code = _asked(RANGE_GUARD_USAGE, arguments)
    if code is not None:
        return code
    from argus_ros.base import run_node
    from argus_ros.guard_node import RangeGuard

    return run_node(RangeGuard, given)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the program that the first argument names: python -m argus_ros.cli argus-ros."""
    programs = {"argus-ros": argus_ros, "argus-range-guard": range_guard}
    name, *rest = [*(sys.argv[1:] if arguments is None else arguments), ""]
    if name not in programs:
        print(f"'{name}' is no program: give {' or '.join(programs)}", file=sys.stderr)
        return EXIT_USAGE
    return programs[name](rest[:-1])


if __name__ == "__main__":
    sys.exit(main())
