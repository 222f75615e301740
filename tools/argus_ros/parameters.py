# SPDX-License-Identifier: MIT
"""The parameters of both nodes with default and meaning, and what --help says; nothing here needs ROS."""

from __future__ import annotations

from typing import Any, Final

Table = dict[str, tuple[Any, str]]

REPAIR: Final[Table] = {
    "dead": ("withhold", "what is published of a sonar that is not trusted: withhold, invalid (NaN), cover"),
    "no_echo": ("rep117", "what stands for nothing seen: rep117 (+inf), or max (the greatest range)"),
    "trust": ("named", "which sonars are trusted: named (all without the name of a fault), or healthy only"),
}
ARGUS: Final[Table] = {
    **REPAIR,
    "control": (
        "",
        "argusd's control socket, unix:PATH or tcp:HOST:PORT; empty: ARGUS_CONTROL, or that of its unit",
    ),
    "token_file": ("", "file whose first line is the token of a tcp: control socket"),
    "period_ms": (100, "time between two states of argusd, and so of odometry and battery"),
    "cloud_age_s": (0.5, "an echo older than this is not in the cloud"),
    "diagnostics_s": (1.0, "time between two diagnoses; a change of a sonar is told at once"),
    "odom_frame_id": ("odom", "frame of the odometry"),
    "base_link_frame_id": ("base_link", "frame of the robot"),
    "sonar_frame_prefix": ("sonar_", "the frame of sonar N is this and N"),
    "sonar_z_m": (0.0, "height of the sonars above the robot's frame"),
    "publish_tf": (True, "whether /tf and /tf_static carry the frames of robot and sonars"),
    "guard": ("", "HOST:PORT of argusd's guard, which takes cmd_vel; empty: cmd_vel is not taken"),
    "cmd_vel_timeout_s": (0.5, "without a cmd_vel for so long the robot is stopped"),
    "max_speed_m_s": (0.75, "cmd_vel is bounded to this"),
    "max_turn_rad_s": (1.5, "cmd_vel is bounded to this"),
    "autostart": (True, "configure and activate at start; false: another node does it"),
}
RANGE_GUARD: Final[Table] = {
    **REPAIR,
    "robot": ("p3dx-sh", "whose sonars these are: a word of the setting robot (argusd --list-config)"),
    "topics": ([f"sonar/range_{k}" for k in range(16)], "the driver's topics of sensor_msgs/Range"),
    "sonars": ([-1], "the sonar of the robot whose place each of them has; [-1]: in the order of the topics"),
    "odometry": ("pose", "the driver's topic of nav_msgs/Odometry"),
    "suffix": ("/guarded", "what is added to a topic for the repaired one"),
    "cloud": ("sonar/cloud_guarded", "topic of the echoes of trusted sonars as sensor_msgs/PointCloud2"),
    "cloud_age_s": (0.5, "an echo older than this is not in the cloud"),
    "base_frame": ("base_link", "frame of the cloud"),
    "settings": ([""], "settings of the fault manager, as suspect_readings=5"),
    "diagnostics_s": (1.0, "time between two diagnoses; a change of a sonar is told at once"),
    "autostart": (True, "configure and activate at start; false: another node does it"),
}


def listed(table: Table) -> str:
    """Return the parameters as --help lists them.

    >>> print(listed({"dead": ("withhold", "what is said"), "sonars": ([0, 1, 2], "which")}))
      dead:=withhold                what is said
      sonars:=[0, ...]              which
    """
    lines = []
    for name, (default, meaning) in table.items():
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
