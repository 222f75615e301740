# SPDX-License-Identifier: MIT
"""Rule: what the bridge shows has an age: when argusd ends, hangs or loses its robot, the ring is offline within 2 s,
and the beams are gone."""

from __future__ import annotations

import contextlib
import json
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from argus_tools.control import ControlError
from argus_tools.foxglove import BEAMS, RING
from argus_tools.foxglove_bridge import Translator, follow

STATE = {
    "event": "STATUS",
    "subclass": "p3dx-sh",
    "state": "IsNormal",
    "mode": "IDLE",
    "mission": "none",
    "active": False,
    "online": True,
    "health": ["HEALTHY"] * 16,
    "kind": [""] * 16,
    "plan_deg": [],
    "battery_dv": 120,
    **dict.fromkeys(
        ("x_mm", "y_mm", "heading_cdeg", "vel_left_mm_s", "vel_right_mm_s", "bumpers_front", "bumpers_rear"),
        0,
    ),
    "flags": 0,
}
READINGS = {"readings": {"t": 1.0, "sip": 1, "mm": [1000] * 16, "age_ms": [10] * 16}}


class Daemon:
    """Answers as argusd does, reports a robot, then does as it is told: hang up, or hold its tongue."""

    def __init__(self, path: Path, then: str) -> None:
        self.then = then
        self.silent_s = 0.0
        self.ended = threading.Event()
        self.sock = socket.socket(socket.AF_UNIX)
        self.sock.bind(str(path))
        self.sock.listen()
        self.thread = threading.Thread(target=self._run, daemon=True)
        self.thread.start()

    def _run(self) -> None:
        near, _ = self.sock.accept()
        with near, contextlib.suppress(OSError):
            if self.then == "no greeting":
                self.silent_s = time.monotonic()
                self.ended.wait(120)
                return
            near.sendall(b'{"control":1,"argus":"0","auth":"none"}\n')
            request = json.loads(near.makefile().readline())
            lines = [{"re": request["id"], "ok": True}, STATE, READINGS]
            near.sendall("".join(json.dumps(line) + "\n" for line in lines).encode())
            self.silent_s = time.monotonic()
            if self.then == "hang":
                self.ended.wait(120)

    def close(self) -> None:
        self.ended.set()
        self.sock.close()
        self.thread.join(60)


@pytest.fixture
def put() -> list[tuple[float, str, dict[str, Any]]]:
    return []


@pytest.fixture
def daemon(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[tuple[Daemon, str]]:
    made = Daemon(tmp_path / "s", request.param)
    yield made, f"unix:{tmp_path / 's'}"
    made.close()


def assert_offline(messages: list[tuple[float, str, dict[str, Any]]], since_s: float) -> None:
    last = {topic: (at_s, message) for at_s, topic, message in messages}
    at_s, ring = last[RING]
    assert (ring["online"], ring["trusted"]) == (False, 0)
    assert at_s - since_s < 2.5  # 2 s are the rule; a busy host takes some of its own
    beams = last[BEAMS][1]
    assert (beams["entities"], [d["type"] for d in beams["deletions"]]) == ([], [1])


@pytest.mark.parametrize("daemon", ["close", "hang", "no greeting"], indirect=True)
def test_an_argusd_that_ends_or_hangs_is_offline(
    daemon: tuple[Daemon, str], put: list[tuple[float, str, dict[str, Any]]]
) -> None:
    argusd, place = daemon
    with pytest.raises((ControlError, TimeoutError)):
        follow(place, None, lambda topic, _, __, message: put.append((time.monotonic(), topic, message)), 100)
    assert_offline(put, argusd.silent_s)
    if argusd.then != "no greeting":
        assert any(topic == RING and message["online"] for _, topic, message in put)


def test_an_argusd_that_is_not_there_is_offline(
    tmp_path: Path, put: list[tuple[float, str, dict[str, Any]]]
) -> None:
    begin_s = time.monotonic()
    with pytest.raises(ControlError):
        follow(f"unix:{tmp_path}/none", None, lambda t, _, __, m: put.append((time.monotonic(), t, m)), 100)
    assert_offline(put, begin_s)


def test_beams_go_with_the_robot(put: list[tuple[float, str, dict[str, Any]]]) -> None:
    translator = Translator(lambda topic, _, t_ns, message: put.append((t_ns / 1e9, topic, message)))
    for message in (STATE, READINGS, {**STATE, "online": False}):
        translator.take(message, 1)
    beams = [message for _, topic, message in put if topic == BEAMS]
    assert [len(b["entities"]) for b in beams] == [16, 0]
    assert len(beams[1]["deletions"]) == 1
