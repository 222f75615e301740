# SPDX-License-Identifier: MIT
"""Rule: the value of an event is printed with its unit, or as its name, by every program the same."""

from __future__ import annotations

import doctest
import re
import sys
from pathlib import Path

import pytest

import hil_sim.faults.values
from hil_sim.faults.values import OPERATIONS, UNITS, VALUES, value_words

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

import gen_docs  # noqa: E402

EVENTS = {row[1]: "".join(row[4:]) for row in gen_docs.rows("include/argus/argus.h", "ARGUS_EVENT_TABLE")}
BARE = 5


def test_the_examples() -> None:
    assert doctest.testmod(hil_sim.faults.values).failed == 0


def test_an_event_has_a_value_where_the_catalogue_gives_it_a_meaning() -> None:
    assert set(VALUES) == {name for name, meaning in EVENTS.items() if "value: " in meaning}


@pytest.mark.parametrize("name", sorted(VALUES))
def test_a_unit_that_the_catalogue_words_is_printed(name: str) -> None:
    words = EVENTS[name].partition("value: ")[2]
    shown = value_words(name, BARE)
    assert VALUES[name] in (*UNITS, "")
    if re.search(r"\bin (mm|ms)\b", words):
        assert shown == f" {BARE} {'mm' if ' mm' in words else 'ms'}"
    if "kind" in words:
        assert shown == " (garbage)"


def test_the_orders_are_those_of_the_core() -> None:
    text = (ROOT / "firmware/knowledge/words.c").read_text(encoding="utf-8")
    assert "\\0".join(OPERATIONS) + "\\0" in text


def test_argusd_has_the_same_units() -> None:
    text = (ROOT / "hal/linux/argusd/report.c").read_text(encoding="utf-8")
    units = dict(re.findall(r'\{"([^"]+)", \d+, "([^"]+)"\}', text))
    assert set(units) == set(UNITS) - {"fault kind"}
    for unit, shown in units.items():
        name = next(name for name, found in VALUES.items() if found == unit)
        assert value_words(name, BARE).endswith(f" {shown}")
