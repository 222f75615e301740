# SPDX-License-Identifier: MIT
"""Rule: every number of the evidence is a row of one table, with its unit, its source and what a trial shows."""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
AWARENESS = ROOT / "firmware/awareness"
sys.path.insert(0, str(ROOT / "tools"))

import gen_docs  # noqa: E402

# A define whose text begins with a number, a bracket or a sign before one; an initialiser that holds a number beside 0 and 1.
DEFINE = re.compile(r"^#define \w+[ \t\\\n]+[-(~]*\d.*$", re.MULTILINE)
INITIALISER = re.compile(r"^(?:static )?const [^;({]*= \{[^;]*;", re.MULTILINE)
SOURCES = {"measured", "reasoned", "size"}
UNITS = {
    *("mm", "ms", "s", "m", "mm/s", "cdeg", "degrees", "cnat", "%", "permille", "-", "/8", "times", "SIPs"),
    *("pings", "sectors", "firings", "hypotheses", "arrays", "episodes", "readings", "sonars", "echoes"),
    *("gaps", "measures", "segments"),
}


def elsewhere(text: str) -> list[str]:
    """Return the numbers that stand in a define or in a table of constants."""
    code = re.sub(r"//[^\n]*", "", text)
    tables = [
        t for t in INITIALISER.findall(code) if re.search(r"(?<![\w.])(?![01]\b)\d", t.split("=", 1)[1])
    ]
    return [found.strip() for found in (*DEFINE.findall(code), *tables)]


def test_no_number_stands_elsewhere() -> None:
    found = {
        path.name: numbers
        for path in sorted(AWARENESS.glob("*.[ch]"))
        if path.name not in {"numbers.h", "gen_likelihoods.h"}
        and (numbers := elsewhere(path.read_text(encoding="utf-8")))
    }
    assert found == {}


def test_a_number_elsewhere_is_found() -> None:
    assert elsewhere("#define FAR_MM 300 // mm\n")
    assert elsewhere("#define FAR_MM \\\n    300\n")
    assert elsewhere("#define LOW (-3)\n")
    assert elsewhere("static const odds_t odds[2] = {\n    [A] = {60, 0},\n};\n")
    assert not elsewhere("#define A_H\n// 300\nstatic const int8_t none[2] = {0, 0};\n")


def test_each_row_is_whole() -> None:
    rows = gen_docs.rows("awareness/numbers.h", "ARGUS_NUMBER_TABLE")
    names = [row[0] for row in rows]
    assert len(names) == len(set(names)) > 80
    for name, value, unit, source, what, trial in rows:
        assert value.isdecimal(), name
        assert unit in UNITS, (name, unit)
        assert source in SOURCES, (name, source)
        assert what, name
        assert trial, name
        assert source != "measured" or trial != "not ablated" or name == "PLACE_CDEG", name


def test_each_number_is_used() -> None:
    texts = "".join(
        path.read_text(encoding="utf-8")
        for path in sorted((ROOT / "firmware").rglob("*.[ch]"))
        if path.name != "numbers.h"
    )
    rows = gen_docs.rows("awareness/numbers.h", "ARGUS_NUMBER_TABLE")
    assert [row[0] for row in rows if not re.search(rf"\bARGUS_{row[0]}\b", texts)] == []
