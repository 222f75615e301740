# SPDX-License-Identifier: MIT
"""Values as ROS messages: ranges, a cloud of echoes, diagnostics, odometry, battery, frames."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from typing import Any, Final

from argus_tools.rings.intake import Limits
from argus_tools.rings.motion import Motion
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Quaternion, TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import BatteryState, PointCloud2, PointField, Range
from std_msgs.msg import Header

from argus_ros.repair import Verdict
from hil_sim.tables.robot import Mount

OK, WARN, ERROR, STALE = range(4)
ARRAY_SONARS: Final = 8
ARRAYS: Final = ("front", "rear", "upper_front", "upper_rear")
_POINT: Final = struct.Struct("<fffBxxx")
_ACCURATE, _UNKNOWN = 1e-3, 1e6
_FAILURE_LEVEL: Final = {"IsNormal": OK, "IsMinor": WARN, "IsMajor": ERROR, "IsCatastrophic": ERROR}


def header(stamp: Any, frame: str) -> Any:
    """Return a header."""
    return Header(stamp=stamp, frame_id=frame)


def quaternion(yaw_rad: float) -> Any:
    """Return a turn about the vertical axis."""
    return Quaternion(x=0.0, y=0.0, z=math.sin(yaw_rad / 2), w=math.cos(yaw_rad / 2))


def range_message(stamp: Any, frame: str, value_m: float, limits: Limits, view_rad: float) -> Any:
    """Return one reading."""
    return Range(
        header=header(stamp, frame),
        radiation_type=Range.ULTRASOUND,
        field_of_view=view_rad,
        min_range=limits.least_m,
        max_range=limits.greatest_m,
        range=value_m,
    )


def repaired(message: Any, stamp: Any, value_m: float) -> Any:
    """Return a copy of a reading with another time and value; fields that a newer sensor_msgs adds are kept."""
    made = copy(message)
    made.header = header(stamp, message.header.frame_id)
    made.range = value_m
    return made


def cloud(stamp: Any, frame: str, echoes: Iterable[tuple[int, float]], mounts: Sequence[Mount]) -> Any:
    """Return the echoes, (sonar, m), as points at the ends of the sonars' axes, with the sonar of each."""
    points = []
    for number, range_m in echoes:
        mount = mounts[number]
        turned = math.radians(mount.heading_deg)
        x = mount.x_mm / 1000 + range_m * math.cos(turned)
        y = mount.y_mm / 1000 + range_m * math.sin(turned)
        points.append(_POINT.pack(x, y, 0.0, number))
    fields = [
        PointField(name=name, offset=4 * place, datatype=PointField.FLOAT32, count=1)
        for place, name in enumerate("xyz")
    ]
    fields.append(PointField(name="sensor_id", offset=12, datatype=PointField.UINT8, count=1))
    return PointCloud2(
        header=header(stamp, frame),
        height=1,
        width=len(points),
        fields=fields,
        is_bigendian=False,
        point_step=_POINT.size,
        row_step=_POINT.size * len(points),
        data=b"".join(points),
        is_dense=True,
    )


def odometry(stamp: Any, frame: str, child: str, motion: Motion) -> Any:
    """Return where the robot is; what a wheeled robot cannot know has a great variance."""
    message = Odometry(header=header(stamp, frame), child_frame_id=child)
    message.pose.pose.position.x, message.pose.pose.position.y = motion.x_m, motion.y_m
    message.pose.pose.orientation = quaternion(motion.heading_rad)
    message.twist.twist.linear.x = motion.speed_m_s
    message.twist.twist.angular.z = motion.turn_rad_s
    for field in (message.pose, message.twist):
        for axis in range(6):
            field.covariance[7 * axis] = _ACCURATE if axis in (0, 1, 5) else _UNKNOWN
    return message


def battery(stamp: Any, frame: str, volts: float) -> Any:
    """Return the battery: its voltage is all that is known."""
    return BatteryState(
        header=header(stamp, frame),
        voltage=volts,
        temperature=math.nan,
        current=math.nan,
        charge=math.nan,
        capacity=math.nan,
        design_capacity=math.nan,
        percentage=math.nan,
        power_supply_technology=BatteryState.POWER_SUPPLY_TECHNOLOGY_UNKNOWN,
        present=True,
    )


def transform(stamp: Any, parent: str, child: str, x_m: float, y_m: float, z_m: float, yaw_rad: float) -> Any:
    """Return where one frame is in another."""
    message = TransformStamped(header=header(stamp, parent), child_frame_id=child)
    place = message.transform.translation
    place.x, place.y, place.z = x_m, y_m, z_m
    message.transform.rotation = quaternion(yaw_rad)
    return message


def sonar_name(number: int) -> str:
    """Return a sonar's name as in argusd's events.

    >>> sonar_name(11)
    'sonar/rear/11'
    """
    return f"sonar/{ARRAYS[number // ARRAY_SONARS]}/{number:02d}"


def sonar_level(verdict: Verdict, age_ms: int, stale_ms: int) -> int:
    """Return the level of a sonar: with the name of a fault ERROR, doubted WARN, not reporting STALE."""
    if verdict.kind or verdict.health in ("DISABLED", "PROBATION"):
        return ERROR
    if verdict.health == "ABSENT":
        return OK
    if age_ms < 0 or age_ms > stale_ms:
        return STALE
    return WARN if verdict.health == "SUSPECT" else OK


def status(level: int, name: str, message: str, hardware: str, values: Mapping[str, Any]) -> Any:
    """Return one diagnosis."""
    return DiagnosticStatus(
        level=bytes((level,)),
        name=name,
        message=message,
        hardware_id=hardware,
        values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
    )


def sonar_status(
    owner: str,
    number: int,
    verdict: Verdict,
    reading_mm: int,
    age_ms: int,
    hardware: str,
    more: Mapping[str, Any] | None = None,
    odd: str = "",
    stale_ms: int = 1000,
) -> Any:
    """Return the diagnosis of one sonar; `more`: keys besides; `odd`: why its messages are not used."""
    level = sonar_level(verdict, age_ms, stale_ms)
    words = f"{verdict.health} {verdict.kind}".strip() if level != STALE else "not reporting"
    if odd:
        level, words = ERROR, f"discarded: {odd}"
    values = {
        "health": verdict.health,
        "fault": verdict.kind or "none",
        "reading_mm": reading_mm,
        "age_ms": age_ms,
        **(more or {}),
    }
    return status(level, f"{owner}: {sonar_name(number)}", words, hardware, values)


def ring_status(
    owner: str,
    failure: str | None,
    verdicts: Sequence[Verdict],
    hardware: str,
    more: Mapping[str, Any],
    doubt: str = "",
) -> Any:
    """Return the diagnosis of the whole ring.

    `failure` None: nothing is judged; empty: that of the fault manager is of no use. `doubt`: why not all is judged.
    """
    present = [verdict for verdict in verdicts if verdict.health != "ABSENT"]
    out = [number for number, verdict in enumerate(verdicts) if verdict.kind]
    bad = len(out)
    words = f"{len(present) - bad} of {len(present)} sonars to be trusted"
    if failure is None:
        return status(STALE, f"{owner}: ring", doubt or "no robot", hardware, more)
    level = max(_FAILURE_LEVEL.get(failure, ERROR) if failure else OK, WARN if bad or doubt else OK)
    words = f"{words}; {doubt}" if doubt else words
    values = {"failure_state": failure or "unknown", "not_trusted": " ".join(map(str, out)) or "none", **more}
    return status(level, f"{owner}: ring", words, hardware, values)


def injected_words(kinds: Sequence[str]) -> str:
    """Return which sonars argusd itself makes fail, and how.

    >>> injected_words(["", "", "", "off", "", "stuck"]), injected_words(["", ""])
    ('3: off, 5: stuck', 'none')
    """
    return ", ".join(f"{number}: {kind}" for number, kind in enumerate(kinds) if kind) or "none"


def diagnostics(stamp: Any, statuses: Sequence[Any]) -> Any:
    """Return the array that /diagnostics carries."""
    return DiagnosticArray(header=header(stamp, ""), status=list(statuses))
