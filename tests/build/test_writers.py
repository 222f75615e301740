# SPDX-License-Identifier: MIT
"""Rule: a fact of firmware/ has one writer."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# An assignment, also a compound one, an increment, or an address that somebody else could write through.
ASSIGNED = r"(?:->|\.){field}\s*(?:[-+*/|&^]|<<|>>)?=(?!=)|(?<!&)&(?!&)\s*[\w.\[\]>-]*(?:->|\.){field}\b"


def writers(field: str) -> set[str]:
    pattern = re.compile(ASSIGNED.format(field=field))
    found = set()
    for path in sorted((ROOT / "firmware").rglob("*.[ch]")):
        if any(pattern.search(line.split("//")[0]) for line in path.read_text(encoding="utf-8").splitlines()):
            found.add(path.relative_to(ROOT / "firmware").as_posix())
    return found


def test_health_c_alone_writes_the_health_of_a_sonar() -> None:
    # A wheel's is another thing.
    assert writers("health") - {"analysis/wheel.c"} == {"knowledge/health.c"}


def test_health_c_alone_writes_the_kind_of_a_fault() -> None:
    # The kind of a motion is another thing, and so is that of a wheel.
    assert writers("kind") - {"adjustment/motion.c", "analysis/wheel.c"} == {"knowledge/health.c"}


def test_algorithm_1_alone_writes_what_it_counts() -> None:
    for field in ("verified", "held", "difference_mm"):
        assert writers(field) - {"analysis/verify.c"} == {"paper/algorithm1.c"}, field
