# SPDX-License-Identifier: MIT
"""The emulator's exception tree: one line each for the user, and an exit code."""

from __future__ import annotations


class SimError(Exception):
    """Anything the user can put right; `str()` is one line naming what is wrong and what to do."""

    exit_code = 2

    def __str__(self) -> str:
        """Return the line; what cannot be printed, for example a line break in a wrong name, is escaped."""
        text = super().__str__()
        return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)


class LinkError(SimError):
    """A device or socket that cannot be opened or was lost for good."""

    exit_code = 1


class InputError(Exception):
    """A file that cannot be read, or an argument that cannot be obeyed: one line for the user, exit code 2."""


_PACKAGES = {
    "rosbags": "rosbags",
    "can": "python-can",
    "isotp": "can-isotp",
    "mcap": "mcap",
    "matplotlib": "matplotlib",
}


def missing_package(error: ModuleNotFoundError) -> str:
    """Return the line for who lacks a package that not every installation has; of another one it is our fault."""
    top = (error.name or "").partition(".")[0]
    if top not in _PACKAGES:
        raise error
    return f"this needs the Python package {_PACKAGES[top]}, which is not installed: pip install {_PACKAGES[top]}"
