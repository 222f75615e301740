# SPDX-License-Identifier: MIT
"""Rule: argusctl says what became of a motion that it ordered: done, or ended by another, which is no success."""

from __future__ import annotations

import json
import socket
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from argus_tools.control import cli
from argus_tools.control.cli import EXIT_OK, EXIT_REFUSED, main, make_parser
from argus_tools.control.client import Refused
from argus_tools.control.script import Ask, Rest, Session, Step

Message = dict[str, Any]
GREETING = {"control": 1, "argus": "0.1.0", "auth": "none"}
STOP, MOVE, TURN, PASSIVE = 1, 4, 5, 6
HANGS = {"for_s": 1.0}
"""Nothing is streamed for so long."""


def operator(value: int) -> Message:
    return {"t": 1.0, "event": "OPERATOR", "level": 0, "name": "operator", "value": value}


def status(t: float, mode: str) -> Message:
    return {"t": t, "event": "STATUS", "mode": mode}


def argusd(
    folder: Path, before: list[Message], after: list[Message], refusals: Sequence[str] = (), **noted: str
) -> str:
    """One that obeys every order; it streams BEFORE ahead of its reply to the order, and AFTER behind it.

    The first orders are refused with REFUSALS.
    """
    path = folder / "s"
    listening = socket.socket(socket.AF_UNIX)
    listening.bind(str(path))
    listening.listen()

    def run() -> None:
        near, _ = listening.accept()
        with near, listening, near.makefile("rw", encoding="utf-8") as lines:

            def say(*messages: Message) -> None:
                for message in messages:
                    if message is HANGS:
                        lines.flush()
                        time.sleep(message["for_s"])
                    else:
                        lines.write(json.dumps(message) + "\n")
                lines.flush()

            say(GREETING)
            left = list(refusals)
            for line in lines:
                asked = json.loads(line)
                reply = {"re": asked["id"], "ok": True, "grant": "g"}
                if asked["do"] == "order" and left:
                    say({"re": asked["id"], "ok": False, "why": left.pop(0), "say": "not now"})
                elif asked["do"] == "order":
                    say(*before, reply | noted, *after)
                else:
                    say(reply)

    threading.Thread(target=run, daemon=True).start()
    return f"unix:{path}"


@pytest.fixture
def ordered(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> Callable[..., tuple[int, str]]:
    """Give an order to such an argusd; return the exit code and what is said on standard error."""

    def run(
        words: list[str], before: list[Message], after: list[Message], silent_s: float = 60.0
    ) -> tuple[int, str]:
        monkeypatch.setattr(cli, "_SILENT_S", silent_s)
        code = main(["--socket", argusd(tmp_path, before, after), *words])
        out, err = capsys.readouterr()
        assert out == ""
        return code, err

    return run


@pytest.mark.parametrize(("words", "own"), [(["turn", "90"], TURN), (["step", "ahead"], MOVE)])
def test_a_motion_that_is_done(ordered: Any, words: list[str], own: int) -> None:
    after = [operator(own), status(1.1, "TURNING"), status(1.2, "IDLE")]
    assert ordered(words, [], after) == (EXIT_OK, "")


@pytest.mark.parametrize(
    ("refusals", "code"),
    [(["checking"], EXIT_OK), (["checking"] * 3, EXIT_OK), (["refused"], EXIT_REFUSED)],
)
def test_stop_and_turn_waits_for_the_check_between(
    refusals: list[str], code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """What is refused because the sonars are checked is ordered again; whether it passes is in the refusal."""
    after = [operator(TURN), status(1.1, "CHECKING"), status(1.2, "IDLE")]
    place = argusd(tmp_path, [], after, refusals=refusals)
    assert main(["--socket", place, "turn", "40", "--force"]) == code
    _, err = capsys.readouterr()
    assert err == ("" if code == EXIT_OK else "argusctl: not now (refused)\n")


def test_a_live_robot_waits_for_the_check_too() -> None:
    refusals = ["checking", "checking", "refused"]
    steps = Session().by_hand("turn", {"deg": 40})

    def answer(step: Step) -> Step:
        if isinstance(step, Ask) and step.do == "order":
            return steps.throw(Refused(refusals.pop(0), "not now"))
        assert isinstance(step, Rest) or (isinstance(step, Ask) and step.do in ("watch", "take"))
        return steps.send({"grant": "g"})

    def carry_out() -> None:
        step = next(steps)
        while True:
            step = answer(step)

    with pytest.raises(Refused, match="not now"):
        carry_out()
    assert not refusals


@pytest.mark.parametrize("by", [STOP, PASSIVE])
@pytest.mark.parametrize(("words", "own"), [(["turn", "90"], TURN), (["step", "back"], MOVE)])
def test_a_motion_that_another_stops(ordered: Any, words: list[str], own: int, by: int) -> None:
    after = [status(1.1, "TURNING"), operator(by), status(1.2, "IDLE")]
    code, said = ordered(words, [operator(own)], after)
    assert code == EXIT_REFUSED
    assert said == "argusctl: another order stopped the robot before it was done (stopped)\n"


def test_a_motion_that_ends_because_another_takes_control(ordered: Any) -> None:
    after = [operator(TURN), {"lost": "control"}, operator(STOP), status(1.2, "IDLE")]
    code, said = ordered(["turn", "90"], [], after)
    assert code == EXIT_REFUSED
    assert said == "argusctl: another took control and stopped the robot before it was done (stopped)\n"


def test_what_was_before_the_order_is_of_no_matter(ordered: Any) -> None:
    before = [operator(STOP), status(0.1, "CHECKING"), status(0.2, "IDLE"), operator(TURN)]
    after = [status(1.1, "TURNING"), operator(STOP)]
    code, _ = ordered(["turn", "90"], before, after)
    assert code == EXIT_REFUSED, "it had not ended before it began"


@pytest.mark.parametrize(("words", "own"), [(["turn", "-90"], TURN), (["step", "ahead"], MOVE)])
def test_an_argusd_that_hangs_meanwhile_is_reported(ordered: Any, words: list[str], own: int) -> None:
    after = [operator(own), status(1.1, "TURNING"), HANGS, status(1.2, "IDLE")]
    code, said = ordered(words, [], after, silent_s=0.4)
    assert (code, said) == (EXIT_OK, "argusctl: argusd reports nothing\nargusctl: argusd reports again\n")


def test_help_tells_the_code() -> None:
    assert "1 argusd refuses, or another stopped the step or turn" in make_parser().format_help()


@pytest.mark.parametrize("words", [["goto", "2,0"], ["course", "5,0", "2,0"], ["active"]])
@pytest.mark.parametrize("noted", [{"say": "the goal is near; numbers are mm"}, {}])
def test_what_argusd_notes_of_an_order_is_printed(
    words: list[str], noted: dict[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["--socket", argusd(tmp_path, [], [], **noted), *words]) == EXIT_OK
    _, err = capsys.readouterr()
    assert err == (f"argusctl: {noted['say']}\n" if noted else "")
