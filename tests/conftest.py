# SPDX-License-Identifier: MIT
"""What all tests rely on: generated examples that repeat (HYPOTHESIS_PROFILE=default roams), and Ctrl-C in programs."""

from __future__ import annotations

import os
import signal

import pytest
from hypothesis import settings


def pytest_configure(config: pytest.Config) -> None:
    """Make the marks known that any test may carry."""
    config.addinivalue_line("markers", "soak: computes for long; tools/dev test --quick leaves it out")
    config.addinivalue_line("markers", "wide: a sweep that takes minutes of CPU; tools/dev soak runs it")


settings.register_profile("repeatable", derandomize=True, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))

# A shell starts what it puts in the background with SIGINT ignored, and every program started from here would inherit
# that: those that are ended by Ctrl-C would go on for ever.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
