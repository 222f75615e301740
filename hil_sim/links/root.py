# SPDX-License-Identifier: MIT
"""How a command that only root may run is to be typed on this machine."""

from __future__ import annotations

import os
import shutil


def as_root(command: str) -> str:
    """Return COMMAND with sudo where one needs it and has it, or as `su` takes it."""
    if os.geteuid() == 0:
        return command
    if shutil.which("sudo"):
        return " && ".join(f"sudo {part}" for part in command.split(" && "))
    return f"su -c '{command}'"
