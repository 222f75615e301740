# SPDX-License-Identifier: MIT
"""The ROS 2 messages of an MCAP of Argus: their definitions, a log's line as bytes (CDR, little-endian), a SIP back."""

from __future__ import annotations

import struct
from typing import Any, Final

SIP: Final = "argus_msgs/msg/Sip"
TRANSFORMS: Final = "tf2_msgs/msg/TFMessage"
CLOUD: Final = "sensor_msgs/msg/PointCloud2"
LOG: Final = "rcl_interfaces/msg/Log"

_RULE: Final = "=" * 80
_TIME: Final = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n")
_HEADER: Final = ("std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n")


def _definition(own: str, *others: tuple[str, str]) -> str:
    return own + "".join(f"{_RULE}\nMSG: {name}\n{text}" for name, text in others)


DEFINITIONS: Final = {
    SIP: _definition(
        "# A server information packet, in units for people. Of each sonar that was read: its number, its range.\n"
        "builtin_interfaces/Time stamp\nfloat64 x_mm\nfloat64 y_mm\nfloat64 heading_deg\nfloat64 battery_v\n"
        "int16 vel_left_mm_s\nint16 vel_right_mm_s\nuint16 flags\nuint8 bumpers_front\nuint8 bumpers_rear\n"
        "bool stall_left\nbool stall_right\nbool moving\nbool motors\nuint8[] sonar\nuint16[] range_mm\n",
        _TIME,
    ),
    TRANSFORMS: _definition(
        "geometry_msgs/TransformStamped[] transforms\n",
        (
            "geometry_msgs/TransformStamped",
            "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n",
        ),
        (
            "geometry_msgs/Transform",
            "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n",
        ),
        ("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"),
        ("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"),
        _HEADER,
        _TIME,
    ),
    CLOUD: _definition(
        "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\n"
        "bool is_bigendian\nuint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
        ("sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"),
        _HEADER,
        _TIME,
    ),
    LOG: _definition(
        "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\n"
        "uint32 line\n",
        _TIME,
    ),
}
INFO, ERROR = 20, 40  # levels of rcl_interfaces/msg/Log
FRAME_ROBOT, FRAME_WORLD = "base_link", "odom"
LITTLE_ENDIAN: Final = b"\0\1\0\0"
MESSAGE: Final = 5
_RECORD_HEAD: Final = struct.Struct("<BQHIQQ")
SIZE_AFTER: Final = 9
_NANO: Final = 1_000_000_000

STATE: Final = (
    ("battery_v", "<f8"), ("vel_left_mm_s", "<i2"), ("vel_right_mm_s", "<i2"), ("flags", "<u2"),
    ("bumpers_front", "u1"), ("bumpers_rear", "u1"), ("stall_left", "u1"), ("stall_right", "u1"),
    ("moving", "u1"), ("motors", "u1"),
)  # fmt: skip
_SIP_HEAD: Final = struct.Struct("<4xiIddddhhHBB????I")


def log_record(channel: int, t_ns: int, level: int, name: str, message: str, line: int) -> bytes:
    """Return the record of one rcl_interfaces/msg/Log."""
    data = bytearray(struct.pack("<iIB", t_ns // _NANO, t_ns % _NANO, level))
    for text in (name, message, name, ""):
        raw = text.encode() + b"\0"
        data += b"\0" * (-len(data) % 4) + struct.pack("<I", len(raw)) + raw
    data += b"\0" * (-len(data) % 4) + struct.pack("<I", line)
    body = LITTLE_ENDIAN + bytes(data)
    return (
        _RECORD_HEAD.pack(MESSAGE, _RECORD_HEAD.size - SIZE_AFTER + len(body), channel, 0, t_ns, t_ns) + body
    )


def read_sip(data: bytes) -> dict[str, Any]:
    """Return the fields of an argus_msgs/msg/Sip."""
    names = ("x_mm", "y_mm", "heading_deg", *(name for name, _ in STATE))
    _, _, *values, count = _SIP_HEAD.unpack_from(data)
    at = _SIP_HEAD.size
    sonar = data[at : at + count]
    at += count
    at += -at % 4 + 4
    ranges = struct.unpack_from(f"<{count}H", data, at)
    return {**dict(zip(names, values, strict=True)), "sonar": list(sonar), "range_mm": list(ranges)}
