# SPDX-License-Identifier: MIT
"""Rule: what argusd only prints has arrived, or it says in one line why it has not."""

from __future__ import annotations

import subprocess

import pytest
from harness import ARGUSD

LISTS = ("--help", "--version", "--list-config", "--list-events", "--example-config")
INTERNAL = 5


@pytest.mark.parametrize("option", LISTS)
def test_a_list_that_the_output_does_not_take_is_told(option: str) -> None:
    command = ["sh", "-c", 'exec "$@" >/dev/full', "sh", str(ARGUSD), option]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stderr) == (INTERNAL, "argusd: standard output: No space left on device\n")
