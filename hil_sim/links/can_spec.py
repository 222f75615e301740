# SPDX-License-Identifier: MIT
"""The text form of a robot's end of a CAN link: IFACE[,key=value...], as argusd has it for its end."""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from typing import Any, Final

from hil_sim.errors import SimError

ROBOTS_MAX: Final = 8
TO_ROBOT_ID: Final = 0x640
TO_HOST_ID: Final = 0x648
PADDING: Final = 0xCC
STACKS: Final = ("auto", "kernel", "user")
ID_MAX: Final = 0x7FF

_LIMIT: Final = {"robot": ROBOTS_MAX - 1, "tx": ID_MAX, "rx": ID_MAX, "pad": 255, "stmin": 127, "bs": 255}
_FORM: Final = "vcan0,robot=0,tx=0x648,rx=0x640,pad=0xCC,stmin=0,bs=0,fd"


@dataclass(frozen=True)
class CanSpec:
    """The robot's end of a connection; `tx_id` is what the robot sends with, `pad` is None for no padding."""

    interface: str
    robot: int = 0
    tx_id: int = TO_HOST_ID
    rx_id: int = TO_ROBOT_ID
    pad: int | None = PADDING
    stmin: int = 0
    bs: int = 0
    fd: bool = False
    stack: str = "auto"

    def of_robot(self, index: int) -> CanSpec:
        """The connection of the robot `index` places further on: number and ids count up."""
        result = replace(self, robot=self.robot + index, tx_id=self.tx_id + index, rx_id=self.rx_id + index)
        if result.robot >= ROBOTS_MAX or max(result.tx_id, result.rx_id) > ID_MAX:
            raise SimError(
                f"--can {self.interface},robot={self.robot}: no number left for robot {index + 1}; begin lower"
            )
        return result

    @property
    def for_client(self) -> str:
        """What the client at the other end writes after `can:`."""
        words = [self.interface]
        if self.robot:
            words.append(f"robot={self.robot}")
        if self.rx_id != TO_ROBOT_ID + self.robot:
            words.append(f"tx=0x{self.rx_id:03X}")
        if self.tx_id != TO_HOST_ID + self.robot:
            words.append(f"rx=0x{self.tx_id:03X}")
        return ",".join([*words, *(["fd"] if self.fd else [])])


def _number(word: str, text: str) -> int:
    limit = _LIMIT[word]
    value = int(text, 0) if re.fullmatch(r"0[xX][0-9a-fA-F]{1,6}|0|[1-9]\d{0,5}", text) else limit + 1
    if value > limit:
        raise SimError(f"{word}={text}: give a number from 0 to {limit}")
    return value


def _option(word: str) -> tuple[str, Any]:
    """Return the field that an option sets, and to what."""
    key, _, value = word.partition("=")
    if word == "fd":
        return "fd", True
    if word == "pad=none":
        return "pad", None
    if key in _LIMIT:
        return f"{key}_id" if key in ("tx", "rx") else key, _number(key, value)
    if key != "stack":
        raise SimError(f"'{word}' is no option; write {_FORM}")
    if value not in STACKS:
        raise SimError(f"stack={value}: there are {', '.join(STACKS)}")
    return "stack", value


def parse_spec(text: str) -> CanSpec:
    """Read IFACE[,robot=K][,tx=ID][,rx=ID][,pad=BYTE|none][,stmin=MS][,bs=N][,fd][,stack=auto|kernel|user]."""
    interface, *words = text.split(",")
    if not re.fullmatch(r"[^\s/:]{1,15}", interface):
        raise SimError(f"'{interface}' cannot be the name of an interface; write {_FORM}")
    given: dict[str, Any] = dict(_option(word) for word in words)
    robot = given.get("robot", 0)
    spec = CanSpec(interface, **{"tx_id": TO_HOST_ID + robot, "rx_id": TO_ROBOT_ID + robot} | given)
    if spec.tx_id == spec.rx_id:
        raise SimError(f"tx and rx are both 0x{spec.tx_id:03X}; the two directions need two ids")
    return spec
