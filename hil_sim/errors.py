# SPDX-License-Identifier: MIT
"""The emulator's exception tree: one line each for the user, and an exit code."""

from __future__ import annotations


class SimError(Exception):
    """Anything the user can put right; `str()` is one line naming what is wrong and what to do."""

    exit_code = 2


class LinkError(SimError):
    """A device or socket that cannot be opened or was lost for good."""

    exit_code = 1
