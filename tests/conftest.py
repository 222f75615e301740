# SPDX-License-Identifier: MIT
"""What all tests rely on: marks, generated examples that repeat (HYPOTHESIS_PROFILE=default roams), and Ctrl-C."""

from __future__ import annotations

import gc
import os
import signal
from collections import defaultdict

import pytest
from hypothesis import settings


def pytest_configure(config: pytest.Config) -> None:
    """Make the marks known that any test may carry."""
    config.addinivalue_line("markers", "soak: computes for long; tools/dev test --quick leaves it out")
    config.addinivalue_line(
        "markers", "tour(few, many): a few of its cases say it; up to MANY are soak, the rest wide"
    )
    config.addinivalue_line("markers", "wide: a sweep that takes minutes of CPU; tools/dev soak runs it")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark the cases of a tour but a few, so that the choice by marks sees it; both kinds are spread over all."""
    tours = defaultdict[tuple[str, tuple[int, ...]], list[pytest.Item]](list)
    for item in items:
        if mark := item.get_closest_marker("tour"):
            tours[item.nodeid.partition("[")[0], mark.args].append(item)
    for (_, counts), cases in tours.items():
        few, many = (
            {part * len(cases) // count for part in range(count)} for count in (counts[0], counts[-1])
        )
        for number, case in enumerate(cases):
            if number not in few:
                case.add_marker(
                    pytest.mark.wide if len(counts) > 1 and number not in many else pytest.mark.soak
                )


def pytest_collection_finish() -> None:
    """Spare the collector of garbage what stays until the end: thousands of tests."""
    gc.collect()
    gc.freeze()


settings.register_profile("repeatable", derandomize=True, print_blob=True)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))

# A shell starts what it puts in the background with SIGINT ignored, and every program started from here would inherit
# that: those that are ended by Ctrl-C would go on for ever.
if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
