# SPDX-License-Identifier: MIT
"""The exit codes of `argus-log`."""

from typing import Final

from hil_sim.start import EXIT_INTERRUPTED

EXIT_READ, EXIT_DAMAGE, EXIT_UNUSABLE = 0, 1, 2
EXIT_CODES: Final = (
    "exit codes: 0 read, 1 damage found (with --strict; faults: also a fault found, unless --exit-zero), "
    f"2 nothing usable, or a wrong argument, {EXIT_INTERRUPTED} interrupted before its end"
)
