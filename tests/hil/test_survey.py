# SPDX-License-Identifier: MIT
"""Rule: `argusd --survey` names each broken sonar and no healthy one; where it may not turn it stays and says why."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree

import pytest
from harness import Bench, run_argusd
from worlds import hall

OK, MISSION, USAGE, FAULTS = 0, 1, 2, 7
SURVEY_S = 600.0


def survey(bench: Bench, *more: str) -> tuple[int, dict[int, dict[str, object]], str]:
    """The exit code, the row of each sonar, and what stood on standard error."""
    link = f"serial:{bench.port}@9600"
    told = run_argusd("--link", link, "--survey", "--active", "--json", *more, timeout_s=SURVEY_S)
    rows = [json.loads(line) for line in told.stdout.splitlines()]
    return told.returncode, {row["sonar"]: row for row in rows}, told.stderr


def sonar_proves(faults: Sequence[str]) -> bool:
    """Whether the others contradict it on nearly every bearing; one that looks aside is right by chance at times."""
    return not any("angle" in fault or fault.startswith("silent") for fault in faults)


@pytest.mark.long
@pytest.mark.parametrize(
    ("faults", "broken"),
    [
        ([], {}),
        (["off:3", "off:8"], {3: ("off",), 8: ("off",)}),
        (["stuck:5"], {5: ("stuck",)}),
        (["wrong:2:offset=400"], {2: ("wrong",)}),
        (["wrong:9:angle=40"], {9: ("wrong",)}),
        (["silent:6"], {6: ("silent", "")}),
    ],
    ids=["healthy", "two dead", "stuck", "offset", "aside", "silent"],
)
def test_each_broken_sonar_is_named(
    bench: Bench, faults: Sequence[str], broken: dict[int, tuple[str, ...]], tmp_path: Path
) -> None:
    sim = bench.sim("lab", *faults)
    picture = tmp_path / "ring.svg"
    code, rows, errors = survey(bench, "--picture", str(picture))
    assert code == (FAULTS if broken else OK), errors
    found = {number: row for number, row in rows.items() if row["fault"]}
    assert set(found) == set(broken), found
    for number, kinds in broken.items():
        assert found[number]["kind"] in kinds, found[number]
        if sonar_proves(faults):
            assert str(found[number]["verdict"]).startswith("broken: "), found[number]
    assert len(rows) == 16
    drawn = [text for element in ElementTree.parse(picture).iter() if (text := element.text)]
    for number, row in rows.items():
        assert f"{number}: {row['verdict']}, {row['sure']}" in drawn
    start, end = sim.of("state")[0], sim.now
    assert abs(end["x_mm"] - start["x_mm"]) < 50
    assert abs(end["y_mm"] - start["y_mm"]) < 50
    assert max(abs(state["w_deg_s"]) for state in sim.of("state")) > 10


@pytest.mark.parametrize(
    ("arguments", "why"),
    [
        (["--subclass", "foo"], "its body is not known"),
        (["--fault", "bumper:3@0s-1000s"], "a bumper is pressed"),
    ],
    ids=["unknown body", "bumper"],
)
def test_where_it_may_not_turn_it_says_why_and_does_not(
    bench: Bench, arguments: list[str], why: str, tmp_path: Path
) -> None:
    sim = bench.sim("lab", extra=arguments)
    code, rows, errors = survey(bench, "--picture", str(tmp_path / "ring.svg"))
    assert (code, rows) == (MISSION, {})
    assert not (tmp_path / "ring.svg").exists()
    assert why in errors
    assert max(abs(state["w_deg_s"]) for state in sim.of("state")) < 1


def test_what_contradicts_a_survey_is_refused_before_the_robot_is_spoken_to(bench: Bench) -> None:
    link = f"serial:{bench.port}@9600"
    for words, why in (
        (("--survey",), "add --active"),
        (("--survey", "--active", "--passive"), "contradict"),
        (("--survey", "--active", "--goal", "1000,0"), "leave out --course and --goal"),
        (("--survey", "--active", "--picture", "ring.png"), "ends in .svg"),
        (("--picture", "ring.svg"), "add --survey"),
    ):
        told = run_argusd("--link", link, *words)
        assert told.returncode == USAGE
        assert why in told.stderr


def test_something_within_the_swing_circle_keeps_it_from_turning(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall(boxes=[{"centre": [0, 300], "size": [600, 100]}])))
    code, rows, errors = survey(bench)
    assert code == MISSION, errors
    assert "(S7)" in errors, errors
    assert max(abs(state["w_deg_s"]) for state in sim.of("state")) < 15, rows
