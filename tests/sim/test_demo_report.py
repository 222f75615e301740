# SPDX-License-Identifier: MIT
"""Rule: the report says what was injected beside what was diagnosed, and never hides a rule that failed."""

from __future__ import annotations

import re

from demo_drive import CLOCK_S, OPEN_S, made_up, named, verdict_on

from hil_sim.demo import report
from hil_sim.demo.judge import Verdict, of_type


def row(text: str, sonar: int) -> list[str]:
    """The cells of a sonar's row in the first table."""
    line = next(one for one in text.splitlines() if one.startswith(f"  {sonar} "))
    return re.split(r"\s{2,}", line.strip())


def test_a_good_drive() -> None:
    truth, events = made_up()
    verdict = verdict_on(truth, events)
    text = report.text(verdict)
    came = [f"{fault['t_s'] - OPEN_S:.2f} s" for fault in of_type(truth, "fault")]
    found = [f"{one['t'] - CLOCK_S - OPEN_S:.2f} s" for one in named(events, "SONAR_DISABLED")]
    assert row(text, 3)[:3] == ["3", "off", came[0]]
    assert row(text, 3)[4:6] == ["off", found[0]]
    assert row(text, 6)[:3] == ["6", "wrong", came[1]]
    assert row(text, 6)[4:6] == ["wrong", found[1]]
    assert text.splitlines()[-1] == "  PASSED"
    assert "FAIL" not in text


def test_every_figure_of_the_journey_is_there() -> None:
    verdict = verdict_on(*made_up())
    text, journey = report.text(verdict), verdict.journey
    assert journey is not None
    for figure in (
        f"{journey.time_s:.1f} s of robot time",
        "3.25 m",
        f"{journey.standstills} standstills",
        f"{journey.sweeps} sweeps, {journey.steps} steps",
        f"{journey.energy_j['idle x 0.5']:.0f} J at idle x 0.5",
        f"{journey.energy_j['idle x 2']:.0f} J at idle x 2",
        f"{journey.closest_mm:.0f} mm between body and solid",
        "-20 deg from",
    ):
        assert figure in text, figure


def test_what_failed_is_marked_and_named_again_in_the_last_line() -> None:
    truth, events = made_up()
    events.remove(named(events, "SONAR_DISABLED")[1])
    truth.append({"type": "collision", "t_s": 30.0, "x_mm": 900.0, "y_mm": 0.0})
    text = report.text(verdict_on(truth, events))
    assert row(text, 6)[4] == "not found"
    failed = [line for line in text.splitlines() if line.startswith("  FAIL ")]
    assert len(failed) == 2
    assert text.splitlines()[-1] == "  FAILED: nothing hit, diagnosis equals injection"


def test_a_healthy_sonar_that_was_disabled_has_a_line_of_its_own() -> None:
    truth, events = made_up()
    at = named(events, "GOAL_REACHED")[0]["t"] - 1
    event = {"t": at, "event": "SONAR_DISABLED", "name": "sonar/front/02", "value": 4}
    events.insert(len(events) - 1, event)
    line = f"  2: healthy, yet DISABLED as wrong at {at - CLOCK_S - OPEN_S:.2f} s"
    assert line in report.text(verdict_on(truth, events)).splitlines()


def test_no_line_ends_in_spaces_and_colour_changes_no_word() -> None:
    verdict = verdict_on(*made_up())
    plain, painted = report.text(verdict), report.text(verdict, colour=True)
    assert all(line == line.rstrip() for line in plain.splitlines())
    assert "\033[" not in plain
    assert "\033[" in painted
    assert re.sub(r"\033\[\d+m", "", painted) == plain


def test_a_drive_that_never_began_has_a_report_too() -> None:
    whole = verdict_on(*made_up())
    text = report.text(Verdict(whole.rules, whole.findings, None))
    assert "Journey" not in text
    assert "Verdict" in text


def test_a_late_host_is_told_whatever_the_verdict() -> None:
    truth, events = made_up()
    assert "the host was late" not in report.text(verdict_on(truth, events))
    truth.append({"type": "late", "t_s": 30.0, "late_ms": 120.4})
    truth.append({"type": "late", "t_s": 31.0, "late_ms": 562.0})
    verdict = verdict_on(truth, events)
    assert verdict.passed
    late, last = report.text(verdict).splitlines()[-2:]
    assert late.startswith("  the host was late with 2 turns of the emulator, at most 562 ms")
    assert last == "  PASSED"
    assert verdict.as_record()["host"] == {"late_turns": 2, "late_max_ms": 562.0}
