# SPDX-License-Identifier: MIT
"""The report of a drive as text: injected beside diagnosed, the journey in figures, the verdict rule by rule."""

from __future__ import annotations

from collections.abc import Sequence

from hil_sim.demo.judge import Finding, Journey, Moment, Verdict

_RESET, _BOLD, _GOOD, _BAD, _DIM = "\033[0m", "\033[1m", "\033[32m", "\033[31m", "\033[2m"
_NEVER = "-"


def _paint(text: str, code: str, colour: bool) -> str:
    return f"{code}{text}{_RESET}" if colour else text


def _at(moment: Moment | None, start_s: float) -> str:
    return _NEVER if moment is None else f"{moment.t_s - start_s:.2f} s"


def _columns(rows: Sequence[Sequence[str]]) -> list[str]:
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return [
        "  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in rows
    ]


def _finding_row(one: Finding, start_s: float) -> list[str]:
    first = _NEVER if one.first_off_s is None else f"{one.first_off_s - start_s:.2f} s"
    latency = _NEVER if one.latency_s is None else f"{one.latency_s:.2f} s"
    left = _NEVER if one.way_left_mm is None else f"{one.way_left_mm / 1000:.2f} m"
    found = one.diagnosed_kind or "not found"
    fault = one.fault
    return [
        str(fault.sonar),
        fault.kind,
        _at(one.injected, start_s),
        first,
        found,
        _at(one.diagnosed, start_s),
        latency,
        left,
    ]


def _findings(verdict: Verdict, start_s: float) -> list[str]:
    head = ["sonar", "injected", "at", "first wrong reading", "diagnosed", "at", "latency", "way left then"]
    lines = _columns([head, *(_finding_row(one, start_s) for one in verdict.findings)])
    for t_s, sonar, kind in verdict.false_disables:
        lines.append(f"  {sonar}: healthy, yet DISABLED as {kind} at {t_s - start_s:.2f} s")
    return lines


def _degrees(rotations: Sequence[int]) -> str:
    return " ".join(f"{angle:+d}" for angle in rotations) or "none"


def _plan_lines(journey: Journey) -> list[str]:
    plans = [
        f"{_degrees(plan.rotations_deg)} deg from {plan.t_s - journey.start_s:.1f} s"
        for plan in journey.plans
    ]
    return ["; then ".join(plans) or "none needed"]


def _journey(journey: Journey) -> list[str]:
    energy = "; ".join(f"{joule:.0f} J at {name}" for name, joule in journey.energy_j.items())
    closest = _NEVER
    if journey.closest is not None and journey.closest_mm is not None:
        at = journey.closest
        where = f"at {_at(at, journey.start_s)}, x {at.x_mm:.0f} y {at.y_mm:.0f} mm"
        closest = f"{journey.closest_mm:.0f} mm between body and solid, {where}"
    rows = [
        ["time", f"{journey.time_s:.1f} s of robot time, from the opened session to the goal"],
        ["way", f"{journey.way_mm / 1000:.2f} m"],
        [
            "stops",
            f"{journey.standstills} standstills, of them {journey.stop_commands} by a STOP that argusd sent",
        ],
        ["rotations planned", *_plan_lines(journey)],
        ["rotations made", f"{journey.turns} turns, {journey.turned_deg:.0f} deg in all"],
        ["failure mode", f"{journey.sweeps} sweeps, {journey.steps} steps"],
        ["energy", energy],
        ["closest approach", closest],
    ]
    return _columns(rows)


def _host_line(late_ms: Sequence[float]) -> str:
    turns = f"{len(late_ms)} turn{'s' * (len(late_ms) > 1)} of the emulator"
    return f"the host was late with {turns}, at most {max(late_ms):.0f} ms: what fails may be its doing, not Argus's"


def _rules(verdict: Verdict, colour: bool) -> list[str]:
    width = max(len(rule.name) for rule in verdict.rules)
    marks = {True: _paint("ok  ", _GOOD, colour), False: _paint("FAIL", _BAD, colour)}
    return [f"  {marks[rule.holds]} {rule.name.ljust(width)}  {rule.detail}" for rule in verdict.rules]


def _end(verdict: Verdict, colour: bool) -> list[str]:
    """Return the lines that say whether it passed, and whether the host was late meanwhile."""
    late = [_paint(_host_line(verdict.host_late_ms), _BAD, colour)] if verdict.host_late_ms else []
    failed = [rule.name for rule in verdict.rules if not rule.holds]
    last = "PASSED" if not failed else "FAILED: " + ", ".join(failed)
    return ["  " + line for line in (*late, _paint(last, _BOLD + (_BAD if failed else _GOOD), colour))]


def text(verdict: Verdict, *, colour: bool = False) -> str:
    """Return the report, lines ending without spaces; times count from the opened session."""
    journey = verdict.journey
    start_s = journey.start_s if journey else 0.0
    lines = [_paint("Injected and diagnosed", _BOLD, colour) + " (robot time since the session opened)"]
    lines += _findings(verdict, start_s)
    if journey is not None:
        lines += ["", _paint("Journey", _BOLD, colour), *_journey(journey)]
    lines += ["", _paint("Verdict", _BOLD, colour), *_rules(verdict, colour)]
    lines += _end(verdict, colour)
    return "\n".join(lines)
