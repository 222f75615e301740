# SPDX-License-Identifier: MIT
"""The exit codes of `argus-log`."""

from typing import Final

EXIT_READ, EXIT_DAMAGE, EXIT_UNUSABLE = 0, 1, 2
EXIT_CODES: Final = (
    "exit codes: 0 read, 1 damage found (with --strict; faults: also a fault found, unless --exit-zero), "
    "2 nothing usable, or a wrong argument"
)
