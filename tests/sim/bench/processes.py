# SPDX-License-Identifier: MIT
"""What a program prints in processes that hash otherwise."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence


def outputs(program: str, arguments: Sequence[str]) -> set[str]:
    """Return what a Python program prints with two seeds of its hashes; one text when they do not matter."""
    return {
        subprocess.run(
            [sys.executable, "-c", program, *arguments],
            env=dict(os.environ) | {"PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("1", "2")
    }
