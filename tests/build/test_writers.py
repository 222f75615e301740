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
    # The kind of a motion is another thing, and so are that of a wheel and that of a finding, which is no state.
    others = {"adjustment/motion.c", "analysis/wheel.c", "awareness/finding.c"}
    assert writers("kind") - others == {"knowledge/health.c"}


def test_algorithm_1_alone_writes_what_it_counts() -> None:
    for field in ("verified", "held", "difference_mm"):
        assert writers(field) - {"analysis/verify.c"} == {"paper/algorithm1.c"}, field


def test_base_c_alone_writes_the_heading_to_return_to() -> None:
    assert writers("taken") == {"adjustment/base.c"}


def test_looked_c_alone_writes_what_is_remembered_of_looks() -> None:
    for field in ("check_ms", "lost_ms", "settling", "tried", "unheard_said", "cleared", "slow_withdrawn"):
        assert writers(field) == {"analysis/looked.c"}, field


def test_one_finding_of_a_sonar_is_asked_for() -> None:
    """The engines of the evidence meet in awareness/finding.c: who judges asks that, and none of them."""
    engines = r"argus_(?:common_(?:convicts|doubts|excuses)|extremes_(?:convicts|keeps_out)|evidence_(?:names|convicts|holds))\("
    found = {
        path.relative_to(ROOT / "firmware").as_posix()
        for path in sorted((ROOT / "firmware").glob("[bs]*/*.c"))
        if re.search(engines, path.read_text(encoding="utf-8"))
    }
    assert found == set()


def test_the_travel_is_written_by_its_modes_and_by_journey_c_for_all_others() -> None:
    for field in ("jog_mm", "arriving", "stopped_short", "unsaid", "heeded_ms", "beside_sip"):
        assert writers(field) <= {"behaviour/travel.c", "supervisor/journey.c"}, field
    changed = re.compile(
        r"argus_task_(?:set|restart|refuse|return|choose|escape|keep|progress|is_hopeless)\("
    )
    found = {
        path.name
        for path in sorted((ROOT / "firmware").glob("[bs]*/*.c"))
        if changed.search(path.read_text(encoding="utf-8"))
    }
    assert found == {"travel.c", "journey.c"}


FUNCTION = re.compile(r"^(?!typedef|#|//|\s)[\w *]*?\b(\w+)\(([^;{}]*?)\)\s*\{", re.MULTILINE)
MAY_WRITE_ALL = 86
"""Functions that may write the whole state. What reads all and writes its own part alone is preferred."""


def test_few_functions_may_write_the_whole_state() -> None:
    found = [
        name
        for path in sorted((ROOT / "firmware").glob("*/*.c"))
        for name, parameters in FUNCTION.findall(path.read_text(encoding="utf-8"))
        if re.search(r"(?<!const )\bargus_t \*", parameters)
    ]
    assert 40 < len(found) <= MAY_WRITE_ALL


def test_behaviour_writes_no_whole_state() -> None:
    """What a mode or a reflex wants is found by reading; supervisor/ alone carries it out."""
    found = [
        path.name
        for path in sorted((ROOT / "firmware/behaviour").glob("*.[ch]"))
        if path.name != "core.h" and re.search(r"(?<!const )\bargus_t \*", path.read_text(encoding="utf-8"))
    ]
    assert found == []
