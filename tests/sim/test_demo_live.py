# SPDX-License-Identifier: MIT
"""Rule: whatever is watched, each event worth telling is told exactly once, in order, and the screen shows the
newest state."""

from __future__ import annotations

import io
import re
from itertools import pairwise

import pytest
from demo_drive import OPEN_S, Record, made_up, named, robot_s
from rich.console import Console

from hil_sim.demo import live
from hil_sim.demo.runner import Recording

QUIET = {"STATUS", "SONAR_HEALTHY", "STOPPED", "SONAR_WITNESS", "PLAN_ROTATION"}


@pytest.fixture(autouse=True)
def capable_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whatever terminal the tests themselves run on."""
    monkeypatch.setenv("TERM", "xterm-256color")


def watched(shown: live.View, chunks: int) -> Recording:
    """Feed a whole drive in equal parts of time; show after each, twice, as a busy loop would."""
    truth, events = made_up()
    recording = Recording(opened_s=OPEN_S)
    end_s = truth[-1]["t_s"]
    for chunk in range(1, chunks + 1):
        until_s = end_s * chunk / chunks
        recording.truth = [one for one in truth if one.get("t_s", 0.0) <= until_s]
        recording.events = [one for one in events if robot_s(one) <= until_s + 1e-6]
        recording.robot_s = until_s
        shown.show(recording)
        shown.show(recording)
    shown.close()
    assert len(recording.events) == len(events)
    return recording


def told(events: list[Record]) -> list[Record]:
    return [event for event in events if event["event"] not in QUIET]


@pytest.mark.parametrize("chunks", [1, 7, 150])
def test_lines_tell_each_event_once_and_in_order(chunks: int, capsys: pytest.CaptureFixture[str]) -> None:
    recording = watched(live.Lines(), chunks)
    lines = capsys.readouterr().out.splitlines()
    names = [match[1] for line in lines if (match := re.search(r"\d s  \S+ +\S+ +([A-Z_]{4,})( |$)", line))]
    assert names == [event["event"] for event in told(recording.events)]
    assert sum("INJECTED: sonar 3 off" in line for line in lines) == 1
    assert sum("INJECTED: sonar 6 wrong" in line for line in lines) == 1


def test_lines_name_the_kind_of_a_fault(capsys: pytest.CaptureFixture[str]) -> None:
    watched(live.Lines(), 3)
    lines = [line for line in capsys.readouterr().out.splitlines() if "SONAR_DISABLED" in line]
    assert [line.split()[-1] for line in lines] == ["(off)", "(wrong)"]
    assert all(" ERROR " in line for line in lines)


def test_lines_report_progress_every_few_seconds_not_oftener(capsys: pytest.CaptureFixture[str]) -> None:
    recording = watched(live.Lines(), 200)
    lines = [line for line in capsys.readouterr().out.splitlines() if " goal " in line]
    times = [float(line.split()[0]) for line in lines]
    gaps = [after - before for before, after in pairwise(times)]
    assert min(gaps) >= live.STATUS_EVERY_S
    assert max(gaps) < live.STATUS_EVERY_S + 1
    assert len(times) > recording.journey_s / (live.STATUS_EVERY_S + 1)
    assert "plan -20" in lines[-1]
    assert "1803!" in lines[-1]
    assert "1803!" not in lines[0]


def screen() -> tuple[live.Screen, Console]:
    console = Console(record=True, force_terminal=True, width=110, height=40, file=io.StringIO())
    return live.Screen(console), console


def test_screen_shows_the_newest_state() -> None:
    shown, console = screen()
    recording = watched(shown, 9)
    drawing = Console(record=True, width=110, file=io.StringIO())
    drawing.print(shown._picture(recording))
    text = drawing.export_text()
    status = named(recording.events, "STATUS")[-1]
    assert f"goal  {status['goal_mm'] / 1000:.2f} m" in text
    assert "plan (deg): -20" in text
    assert "DISABLED (off)" in text
    assert "DISABLED (wrong)" in text
    assert "GOAL_REACHED" in text
    assert "Ctrl-C" in text
    for sonar in range(16):
        assert str(1800 + sonar) in text, sonar
    assert max(len(line) for line in text.splitlines()) <= 110
    assert console.file.getvalue()  # type: ignore[attr-defined]


def test_screen_logs_each_event_once() -> None:
    shown, _ = screen()
    watched(shown, 40)
    log = [text.plain for text in shown._log]
    assert len(log) == len(set(log)) <= 8
    assert "GOAL_REACHED" in log[-1]


def test_screen_renders_before_anything_has_arrived() -> None:
    shown, _ = screen()
    shown.show(Recording())
    shown.close()
    text = Console(record=True, width=110, file=io.StringIO())
    text.print(shown._picture(Recording()))
    assert "starting" in text.export_text()


def test_screen_gives_the_terminal_back() -> None:
    shown, console = screen()
    watched(shown, 2)
    assert "\033[?25l" in console.file.getvalue()  # type: ignore[attr-defined]
    assert console.file.getvalue().rindex("\033[?25h") > console.file.getvalue().rindex("\033[?25l")  # type: ignore[attr-defined]


def test_a_pipe_gets_lines_even_when_a_screen_is_wanted(capsys: pytest.CaptureFixture[str]) -> None:
    assert isinstance(live.view(True), live.Lines)
    assert isinstance(live.view(False), live.Lines)
    capsys.readouterr()


def test_unknown_events_levels_and_kinds_do_no_harm() -> None:
    event: Record = {"t": 1.0, "event": "SONAR_DISABLED", "name": "sonar/front/01", "level": 9, "value": 77}
    assert live.event_line(event).split() == ["1.00", "s", "STALE", "sonar/front/01", "SONAR_DISABLED", "(?)"]
    assert "NEW_EVENT" in live.event_line({"t": 1.0, "event": "NEW_EVENT"})
