# SPDX-License-Identifier: MIT
"""The parameters of both nodes: default, meaning, what holds, when it is read, what --help says. Needs no ROS."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any, Final

from hil_sim.tables.robot import robot_table

Check = Callable[[Any], str]
"""What to give instead of a value; empty for one that holds."""


class Read(Enum):
    """When a parameter is read: at each use, when the node is configured, or once at its start."""

    LIVE = "live"
    CONFIGURE = "configure"
    START = "start"


@dataclass(frozen=True)
class Parameter:
    """One parameter. `low` and `high`: bounds of a number; `choices`: of a word; `check`: what else must hold."""

    default: Any
    meaning: str
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    check: Check | None = None
    read: Read = Read.CONFIGURE

    def wanted(self) -> str:
        """Return what may be given, in words; empty where anything may.

        >>> Parameter(0.5, "", 0.1, 10.0).wanted(), Parameter("a", "", choices=("a", "b")).wanted()
        ('0.1 to 10', 'a or b')
        """
        if self.low is not None and self.high is not None:
            return f"{self.low:g} to {self.high:g}"
        return " or ".join(self.choices)

    def why_not(self, value: Any) -> str:
        """Return what to give instead of a value of the right type; empty for one that holds.

        >>> Parameter(0.5, "", 0.1, 10.0).why_not(math.nan)
        'give 0.1 to 10'
        """
        if self.low is not None and self.high is not None:
            holds = math.isfinite(value) and self.low <= value <= self.high
        else:
            holds = not self.choices or value in self.choices
        if not holds:
            return f"give {self.wanted()}"
        return self.check(value) if self.check is not None else ""


Table = dict[str, Parameter]
_FRAME: Final = re.compile(r"[^\s/]\S*")
_NAME: Final = re.compile(r"[~/]?[A-Za-z_]\w*(/[A-Za-z_]\w*)*")
AUTO: Final = "auto"


def _frame(value: str) -> str:
    return "" if _FRAME.fullmatch(value) else "give a frame without blanks and without a slash in front"


def _frame_or_none(value: str) -> str:
    return _frame(value) if value else ""


def _name(value: str) -> str:
    return "" if _NAME.fullmatch(value) else f"'{value}' is no name of a topic"


def _names(values: list[str]) -> str:
    if len(set(values)) != len(values):
        return "give each topic once"
    return next(filter(None, map(_name, values)), "" if values else "give at least one topic")


def _suffix(value: str) -> str:
    if not value:
        return "it is empty: repaired readings may not go where the driver's go"
    return "" if _NAME.fullmatch(f"topic{value}") else f"'{value}' makes no name of a topic"


def host_and_port(value: str) -> tuple[str, int] | None:
    """Return the parts of HOST:PORT; None when it is none.

    >>> host_and_port("127.0.0.1:8101"), host_and_port("8101")
    (('127.0.0.1', 8101), None)
    """
    host, _, port = value.rpartition(":")
    holds = bool(host) and port.isascii() and port.isdigit() and 0 < int(port) < 65536
    return (host.strip("[]"), int(port)) if holds else None


def _guard(value: str) -> str:
    return "" if not value or host_and_port(value) else "give HOST:PORT"


def _control(value: str) -> str:
    return "" if not value or value.startswith(("unix:", "tcp:")) else "give unix:PATH or tcp:HOST:PORT"


def _robot(value: str) -> str:
    from hil_sim.errors import SimError
    from hil_sim.tables.robot import robot_table

    try:
        robot_table(value)
    except SimError as error:
        return str(error)
    return ""


def _settings(values: list[str]) -> str:
    from argus_tools.chunks import LogError

    from hil_sim.core.library import setting_value

    for key, _, text in (text.partition("=") for text in values if text):
        try:
            setting_value(key, text)
        except (LogError, ValueError) as error:
            return str(error)
    return ""


_COMMON: Final[Table] = {
    "dead": Parameter(
        "withhold",
        "what is published of a sonar that is not trusted: withhold, invalid (NaN), cover",
        choices=("withhold", "invalid", "cover"),
        read=Read.LIVE,
    ),
    "no_echo": Parameter(
        "rep117",
        "what stands for nothing seen: rep117 (+inf), or max (the greatest range)",
        choices=("rep117", "max"),
        read=Read.LIVE,
    ),
    "trust": Parameter(
        "named",
        "which sonars are trusted: named (all without the name of a fault), or healthy only",
        choices=("named", "healthy"),
        read=Read.LIVE,
    ),
    "cloud_age_s": Parameter(0.5, "an echo older than this is not in the cloud", 0.05, 10.0, read=Read.LIVE),
    "diagnostics_s": Parameter(
        1.0, "time between two diagnoses; a change of a sonar is published at once", 0.1, 60.0, read=Read.LIVE
    ),
    "frame_prefix": Parameter(
        AUTO,
        "what stands before each frame; auto: in a namespace its name and a slash, else nothing",
        check=_frame_or_none,
    ),
    "autostart": Parameter(
        True, "configure and activate at start; false: another node does it", read=Read.START
    ),
}
ARGUS: Final[Table] = {
    **_COMMON,
    "control": Parameter(
        "",
        "argusd's control socket, unix:PATH or tcp:HOST:PORT; empty: ARGUS_CONTROL, or that of its unit "
        "(/run/argus/control, in a namespace /run/argus/NAMESPACE/control)",
        check=_control,
    ),
    "robot": Parameter(
        "",
        "whose sonars these are: a known robot's subclass, or the file of a ring, as argusd's --ring; empty: as the "
        "robot announces itself",
        check=lambda value: _robot(value) if value else "",
    ),
    "token_file": Parameter("", "file whose first line is the token of a tcp: control socket"),
    "period_ms": Parameter(
        100, "time between two states of argusd, and so of odometry and battery", 50, 1000
    ),
    "odom_frame_id": Parameter("odom", "frame of the odometry", check=_frame),
    "base_link_frame_id": Parameter("base_link", "frame of the robot", check=_frame),
    "sonar_frame_prefix": Parameter("sonar_", "the frame of sonar N is this and N", check=_frame),
    "sonar_z_m": Parameter(0.0, "height of the sonars above the robot's frame", -10.0, 10.0),
    "publish_tf": Parameter(True, "whether /tf and /tf_static carry the frames of robot and sonars"),
    "guard": Parameter(
        "", "HOST:PORT of argusd's guard, which takes cmd_vel; empty: cmd_vel is not taken", check=_guard
    ),
    "cmd_vel_timeout_s": Parameter(
        0.5, "without a cmd_vel for so long the robot is stopped", 0.1, 10.0, read=Read.LIVE
    ),
    "max_speed_m_s": Parameter(0.75, "the speed of cmd_vel is bounded to this", 0.0, 5.0, read=Read.LIVE),
    "max_turn_rad_s": Parameter(1.5, "the turn of cmd_vel is bounded to this", 0.0, 10.0, read=Read.LIVE),
}
RANGE_GUARD: Final[Table] = {
    **_COMMON,
    "robot": Parameter(
        "p3dx-sh", "whose sonars these are: a known robot's subclass, or the file of a ring", check=_robot
    ),
    "topics": Parameter(
        [f"sonar/range_{k}" for k in range(robot_table().sonars)],
        "the driver's topics of sensor_msgs/Range",
        check=_names,
    ),
    "sonars": Parameter(
        [-1], "the sonar of the robot whose place each of them has; [-1]: in the order of the topics"
    ),
    "odometry": Parameter("pose", "the driver's topic of nav_msgs/Odometry", check=_name),
    "suffix": Parameter("/guarded", "what is added to a topic for the repaired one", check=_suffix),
    "cloud": Parameter(
        "sonar/cloud_guarded",
        "topic of the echoes of trusted sonars as sensor_msgs/PointCloud2",
        check=_name,
    ),
    "base_frame": Parameter("base_link", "frame of the cloud", check=_frame),
    "settings": Parameter([""], "settings of the fault manager, as suspect_readings=5", check=_settings),
}


def listed(table: Table) -> str:
    """Return the parameters as --help lists them.

    >>> print(listed({"dead": Parameter("withhold", "what is said"), "sonars": Parameter([0, 1, 2], "which")}))
      dead:=withhold                what is said
      sonars:=[0, ...]              which
    """
    lines = []
    for name, parameter in table.items():
        default, meaning = parameter.default, parameter.meaning
        if parameter.low is not None:
            meaning = f"{meaning}; {parameter.wanted()}"
        shown = f"[{default[0]}, ...]" if isinstance(default, list) and len(default) > 1 else default
        text = str(shown).lower() if isinstance(shown, bool) else str(shown).replace("['']", "[]")
        lines.append(f"  {f'{name}:={text}':<28}  {meaning}")
    return "\n".join(lines)


_OPTIONS: Final = """\
options:
  -h, --help                    show this help message and exit
  --ros-args ARGUMENTS          what follows is for ROS: -p NAME:=VALUE, --params-file FILE, -r FROM:=TO
"""
ARGUS_USAGE: Final = f"""\
usage: argus-ros [--ros-args ARGUMENTS]

The node of a robot that argusd minds: a topic for each sonar, cloud, diagnoses, odometry, battery and frames
from argusd's control socket; cmd_vel goes to its guard.

{_OPTIONS}
parameters with their defaults:
{listed(ARGUS)}

examples:
  argusd --link serial:/dev/ttyUSB0@9600 --control unix:/tmp/argus.sock --guard tcp:127.0.0.1:8101
  argus-ros --ros-args -p control:=unix:/tmp/argus.sock
  argus-ros --ros-args -p control:=unix:/tmp/argus.sock -p guard:=127.0.0.1:8101
  argus-ros --ros-args --params-file argus.yaml
  ros2 service call /sonar/recheck std_srvs/srv/Trigger
"""
RANGE_GUARD_USAGE: Final = f"""\
usage: argus-range-guard [--ros-args ARGUMENTS]

Takes the sensor_msgs/Range topics and the odometry of any driver, runs the fault manager on them,
and publishes each repaired as TOPIC/guarded, with /diagnostics and a cloud of trusted echoes.

{_OPTIONS}
parameters with their defaults:
{listed(RANGE_GUARD)}

examples:
  argus-range-guard
  argus-range-guard --ros-args -p dead:=cover -p no_echo:=max
  argus-range-guard --ros-args -p "topics:=[front_left, front_right]" -p "sonars:=[2, 5]" -p odometry:=odom
  argus-range-guard --ros-args --params-file range_guard.yaml
"""
