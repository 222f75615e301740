# SPDX-License-Identifier: MIT
"""Rule: argus-flash-check says of a board what is not as it should be, and of a line without one why."""

from __future__ import annotations

import contextlib
import json
import os
import pty
import threading
import time
import tty
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any, Final
from unittest import mock

import pytest
import serial
from argus_tools import flash_check
from argus_tools.flash_check import main
from serial.tools import list_ports

START: Final = {
    "t": 0.0,
    "event": "START",
    "board": "stm32f405",
    "version": "0.1.0",
    "config": "5f15a1a5",
    "settings": "built",
    "reset": "order",
    "pc": "00000000",
    "lr": "00000000",
    "cause": "00000000",
    "invariant": 0,
}
LINK: Final = {"t": 2.5, "event": "LINK_UP"}
STATUS: Final = {
    "t": 3.0,
    "event": "STATUS",
    "online": False,
    "stack_left": 1200,
    "lines_lost": 0,
    "robot": "",
    "sips": 0,
}


def told(*lines: dict[str, Any]) -> bytes:
    """Return the bytes of LINES."""
    return b"".join(json.dumps(line).encode() + b"\n" for line in lines)


@contextlib.contextmanager
def board(answer: bytes, before: bytes = b"", hangs_up: bool = False, queued: bytes = b"") -> Iterator[str]:
    """Play a board that goes on with BEFORE, and ANSWER when it is ordered to restart.

    QUEUED comes when the line is opened, before any order.
    """
    inside, outside = pty.openpty()
    tty.setraw(outside)
    opened = serial.serial_for_url

    def open_with_queue(url: str, **options: Any) -> Any:
        port = opened(url, **options)
        os.write(inside, queued)
        while port.in_waiting < len(queued):
            time.sleep(0.01)
        return port

    def play() -> None:
        heard = b""
        with contextlib.suppress(OSError):
            while b"restart\n" not in heard:
                heard += os.read(inside, 256)
            os.write(inside, before + answer)
            if hangs_up:
                os.close(outside)
                os.close(inside)

    thread = threading.Thread(target=play, daemon=True)
    thread.start()
    try:
        with mock.patch.object(serial, "serial_for_url", open_with_queue):
            yield os.ttyname(outside)
    finally:
        with contextlib.suppress(OSError):
            os.close(inside)
        with contextlib.suppress(OSError):
            os.close(outside)


def test_a_board_that_is_all_right(capsys: pytest.CaptureFixture[str]) -> None:
    before = b'{"t":9.0,"event":"STATUS","lines_lost":7,"stack_le'  # of the life before
    with board(b"\n" + told(START, LINK, STATUS), before) as device:  # a board ends that line first
        wanted = ["--board", "stm32f405", "--firmware", "0.1.0", "--config", "5f15a1a5"]
        assert main([device, *wanted, "--wait", "5"]) == 0
    out = capsys.readouterr().out
    assert "FAIL" not in out
    assert out.endswith("all is well\n")
    assert out.count("ok ") == 9


@pytest.mark.parametrize(
    ("line", "change", "options", "said"),
    [
        ("start", {}, ["--board", "mps2-an386"], "FAIL board     stm32f405, not mps2-an386"),
        ("start", {}, ["--firmware", "0.2.0"], "FAIL version   0.1.0, not 0.2.0"),
        ("start", {}, ["--config", "deadbeef"], "FAIL config    5f15a1a5, not deadbeef"),
        ("start", {"settings": "refused"}, [], "FAIL settings  refused"),
        ("start", {"settings": "damaged"}, [], "FAIL settings  damaged"),
        ("start", {"reset": "watchdog", "pc": "0000abcd"}, [], "FAIL reset     watchdog, pc 0000abcd"),
        ("start", {"reset": "fault"}, [], "FAIL reset     fault"),
        ("start", {"invariant": 3}, [], "FAIL invariant 3"),
        ("status", {"stack_left": 255}, [], "FAIL stack     255 bytes"),
        ("status", {"stack_left": "much"}, [], "FAIL stack     much bytes"),
        ("status", {"lines_lost": 4}, [], "FAIL lines     4 lost"),
        ("status", {}, ["--robot", "--wait", "1"], "FAIL status    none within 1 s"),
    ],
)
def test_what_is_wrong_is_named(
    line: str, change: dict[str, Any], options: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    start = START | change if line == "start" else START
    status = STATUS | change if line == "status" else STATUS
    with board(told(start, LINK, status)) as device:
        assert main([device, "--wait", "3", *options]) == 1
    out = capsys.readouterr().out
    assert said in out
    assert out.count("FAIL") == 1


def test_a_robot_that_answers_is_named(capsys: pytest.CaptureFixture[str]) -> None:
    online = STATUS | {"online": True, "robot": "Ada", "sips": 12}
    with board(told(START, LINK, STATUS, online)) as device:
        assert main([device, "--robot", "--wait", "5"]) == 0
    assert "ok   robot     Ada, 12 packets" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("before", "said"),
    [
        (b"", "nothing came"),
        (b"\xfa\xfb\x03\x00\x00\x00" * 3, "the board's other UART"),
        (told(STATUS), "press its reset button"),
        (b"\x80\xffgarbage", "is the baud rate right?"),
        (b"[" * 3000 + b"\n", "is the baud rate right?"),
        (b'{"event": 7}\n[1]\n"START"\n', "press its reset button"),
    ],
)
def test_a_line_without_a_board(before: bytes, said: str, capsys: pytest.CaptureFixture[str]) -> None:
    with board(b"", before) as device:
        assert main([device, "--wait", "1"]) == 3
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1


def test_a_board_that_refuses_to_restart(capsys: pytest.CaptureFixture[str]) -> None:
    refusal = {"event": "ORDER", "what": "restart", "text": "not while it moves"}
    with board(told(refusal)) as device:
        assert main([device, "--wait", "3"]) == 3
    assert "not while it moves" in capsys.readouterr().err


def test_a_board_that_stops_after_its_start(capsys: pytest.CaptureFixture[str]) -> None:
    with board(told(START)) as device:
        assert main([device, "--wait", "1"]) == 1
    out = capsys.readouterr().out
    assert "FAIL link      not up within 1 s" in out
    assert "FAIL status    none within 1 s" in out


def test_a_line_that_goes_away(capsys: pytest.CaptureFixture[str]) -> None:
    with board(told(START), hangs_up=True) as device:
        assert main([device, "--wait", "3"]) in (1, 3)
    assert "Traceback" not in capsys.readouterr().err


def test_what_came_before_the_order_is_no_answer(capsys: pytest.CaptureFixture[str]) -> None:
    refusal = {"event": "ORDER", "what": "restart", "text": "not while it moves"}
    for old in (told(START | {"version": "0.0.9"}, LINK), told(refusal), told(STATUS)[:-20]):
        with board(told(START, LINK, STATUS), queued=old) as device:
            assert main([device, "--firmware", "0.1.0", "--wait", "5"]) == 0, old
        assert "FAIL" not in capsys.readouterr().out


def test_the_line_is_ours_alone(capsys: pytest.CaptureFixture[str]) -> None:
    with board(told(START, LINK, STATUS)) as device, serial.Serial(device, exclusive=True):
        assert main([device, "--wait", "1"]) == 3
    assert "lock" in capsys.readouterr().err


def test_an_interruption_has_its_exit_code(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(console: object, args: object) -> Iterator[None]:
        raise KeyboardInterrupt

    monkeypatch.setattr(flash_check, "looks", interrupted)
    with board(b"") as device:
        assert main([device]) == 130
    assert capsys.readouterr().err == "argus-flash-check: interrupted\n"
    assert "130 interrupted" in flash_check.EPILOG


def test_a_device_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["/dev/no-such-device"]) == 3
    assert main(["gopher://x"]) == 3
    told = capsys.readouterr().err
    assert "Traceback" not in told
    assert told.startswith("argus-flash-check: /dev/no-such-device: No such file or directory; ")


@pytest.mark.parametrize("ports", [[], ["/dev/ttyUSB3"], ["/dev/ttyUSB3", "/dev/ttyACM0"]])
def test_without_a_device_the_ports_that_are_here_are_named(
    ports: list[str], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    found = [SimpleNamespace(device=name) for name in ports]
    monkeypatch.setattr(list_ports, "comports", lambda: found)
    with pytest.raises(SystemExit):
        main([])
    told = capsys.readouterr().err
    assert all(name in told for name in ports)
    assert ("no serial port" in told) == (not ports)


@pytest.mark.parametrize(
    "wrong", [[], ["a", "b"], ["a", "--baud", "fast"], ["a", "--wait", "0"], ["a", "--stack", "-1"]]
)
def test_wrong_arguments(wrong: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(wrong)
    assert left.value.code == 2
    assert capsys.readouterr().err.count("\n") == 1
