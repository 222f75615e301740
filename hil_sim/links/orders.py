# SPDX-License-Identifier: MIT
"""Orders to a running emulator, a line each on standard input: break a sonar, mend it, watch; each is answered."""

from __future__ import annotations

import json
import os
import re
import select
from typing import Any, Final

from hil_sim.errors import SimError
from hil_sim.faults.execute import FaultSet
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import SonarFault
from hil_sim.robot.robot import Robot

_LINE_MAX: Final = 1024
_BREAK: Final = re.compile(r"break\s+(\S+)")
_MEND: Final = re.compile(r"mend\s+(all|\d{1,2})")


class Orders:
    """Reads orders from a file descriptor, obeys them at once, and answers with a JSON object a line.

    An answer that is not taken is dropped: the robot waits for no reader. After the order `watch` a line
    also tells each time that another sonar is broken, or one no longer is: faults begin and end by themselves, too.
    """

    def __init__(self, robot: Robot, faults: FaultSet, source: int, answers: int) -> None:
        self._robot = robot
        self._faults = faults
        self._source = source
        self._answers = answers
        self._rest = b""
        self._watched = False
        self._told: dict[str, str] = {}
        self.ended = False
        """No orders can be given any more."""

    def obey(self) -> None:
        """Obey all that has arrived; never waits."""
        while not self.ended and select.select([self._source], [], [], 0)[0]:
            data = os.read(self._source, 4096)
            self.ended = not data
            *lines, rest = (self._rest + data).split(b"\n")
            for line in lines:
                self._answer(line)
            if len(rest) > _LINE_MAX:
                self._answer(rest)
                rest = b""
            self._rest = rest
        if self._watched and self._broken() != self._told:
            self._say({"t_s": self._now_s})

    @property
    def _now_s(self) -> float:
        return round(self._robot.now_ms / 1000, 3)

    def _broken(self) -> dict[str, str]:
        """Return what is broken now."""
        return {
            str(number): fault.kind
            for number in range(self._robot.table.sonars)
            if (fault := self._faults.active(number)) is not None
        }

    def _say(self, message: dict[str, Any]) -> None:
        """Write a line with what is broken, unless nobody takes it."""
        broken = self._broken()
        if select.select([], [self._answers], [], 0)[1]:
            os.write(self._answers, json.dumps(message | {"broken": broken}).encode() + b"\n")
            self._told = broken

    def _answer(self, line: bytes) -> None:
        text = line.decode("utf-8", "replace").strip()
        answer: dict[str, Any] = {"order": text[:_LINE_MAX], "t_s": self._now_s}
        try:
            self._do(text)
            answer["ok"] = True
        except SimError as error:
            answer |= {"ok": False, "say": str(error)}
        self._say(answer)

    def _do(self, text: str) -> None:
        if len(text) > _LINE_MAX:
            raise SimError(f"an order has at most {_LINE_MAX} bytes")
        if found := _BREAK.fullmatch(text):
            fault = parse_fault(found[1], self._robot.table)
            if not isinstance(fault, SonarFault):
                raise SimError(f"fault '{found[1]}': orders break sonars only")
            if fault.start is None and fault.end is None:  # else they would pile up, all hidden by the last
                for number in fault.sonars:
                    self._faults.mend(number)
            self._faults.inject(fault)
        elif found := _MEND.fullmatch(text):
            self._mend(found[1])
        elif text == "watch":
            self._watched = True
        else:
            raise SimError(f"'{text[:40]}' is no order; write 'break off:3', 'mend 3', 'mend all' or 'watch'")

    def _mend(self, target: str) -> None:
        sonars = self._robot.table.sonars
        if target != "all" and int(target) >= sonars:
            raise SimError(f"no sonar {target}; name 0 to {sonars - 1}, or all")
        for number in range(sonars) if target == "all" else (int(target),):
            self._faults.mend(number)
