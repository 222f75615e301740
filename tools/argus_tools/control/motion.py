# SPDX-License-Identifier: MIT
"""When an order is over: motions by hand and courses, as the streams of state and events show it."""

from __future__ import annotations

import time
from typing import Final

from argus_tools.control.client import Message, Refused

RESTING: Final = ("IDLE", "WAITING", "OFFLINE", "CLOSED")
BY_HAND: Final = {"step": 4, "turn": 5}
"""Motions by hand, with what their event OPERATOR reports (argus_op_t)."""
STOPPING: Final = (1, 6)
"""What OPERATOR reports of stop and of passive."""
MOTION_S: Final = 60.0
CHECK_S: Final = 10.0
"""A check of the sonars, as after each stop, is waited for so long."""
RETRY_S: Final = 0.1


class Patience:
    """With a robot that checks its sonars, as after each stop: it refuses to move until that is over."""

    def __init__(self) -> None:
        self._until = time.monotonic() + CHECK_S

    def bears(self, refusal: Refused) -> bool:
        """Tell whether the order is worth another try."""
        return refusal.why == "checking" and time.monotonic() < self._until


class Motion:
    """Follows a motion by hand in what is streamed; what came before argusd told of the order is of no matter."""

    def __init__(self, order: str) -> None:
        self._own = BY_HAND[order]
        self._ordered = False
        self._began: float | None = None
        self._moved = False

    def _stopped(self, message: Message) -> bool:
        """Whether another stops it."""
        if message.get("event") != "OPERATOR":
            return False
        self._ordered = self._ordered or message["value"] == self._own
        return self._ordered and message["value"] in STOPPING

    def _rests(self, state: Message) -> bool:
        self._began = state["t"] if self._began is None else self._began
        self._moved = self._moved or state["mode"] not in RESTING
        waited = state["t"] - self._began
        return (state["mode"] in RESTING and (self._moved or waited > 1.0)) or waited > MOTION_S

    def is_over(self, message: Message) -> bool:
        """Take a message; tell whether the motion is over. Refused when another ended it."""
        if message.get("lost") == "control":
            raise Refused("stopped", "another took control and stopped the robot before it was done")
        if self._stopped(message):
            raise Refused("stopped", "another order stopped the robot before it was done")
        return self._ordered and message.get("event") == "STATUS" and self._rests(message)


class Course:
    """Follows a course of COUNT points that was ordered just now, until its goal or its end."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._running = False

    def is_over(self, message: Message) -> bool:
        """Take a message; tell whether the goal is reached. Refused when the course ended otherwise."""
        event, value = message.get("event"), message.get("value")
        if event == "MISSION_START":
            if self._running or value != self._count:
                raise Refused("stopped", "another course was ordered before it was done")
            self._running = True
        elif self._running and event == "OPERATOR" and value in STOPPING:
            raise Refused("stopped", "another order stopped the robot before it was done")
        elif self._running and event == "MISSION_FAILED":
            raise Refused("failed", f"the course was given up {value} mm from its goal")
        return self._running and event == "GOAL_REACHED"
