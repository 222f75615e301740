# SPDX-License-Identifier: MIT
"""The records of an MCAP for many SIPs at a time, by numpy: ROS 2 messages in CDR, little-endian."""

from __future__ import annotations

from functools import cache
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from argus_tools.ros2_messages import (
    CLOUD,
    FRAME_ROBOT,
    FRAME_WORLD,
    LITTLE_ENDIAN,
    MESSAGE,
    SIP,
    SIZE_AFTER,
    STATE,
    TRANSFORMS,
)

Array = NDArray[Any]
_FLOAT32: Final = 7
_NANO: Final = 1_000_000_000
# Of a record: its mark, its length, channel, number, and two times.
_RECORD: Final = [
    ("op", "u1"),
    ("size", "<u8"),
    ("channel", "<u2"),
    ("n", "<u4"),
    ("t", "<u8"),
    ("sent", "<u8"),
]


class _Cdr:
    """Builds a structured type, padded as CDR wants it, and the bytes that are the same in every message."""

    def __init__(self) -> None:
        self.fields: list[tuple[Any, ...]] = [*_RECORD, ("cdr", "V4")]
        self.constants: dict[str, Any] = {"op": MESSAGE, "n": 0, "cdr": np.void(LITTLE_ENDIAN)}
        self._at = 0

    def put(self, name: str, code: str, count: int = 1, value: Any = None) -> None:
        """Append a field; `value` is the same in every message."""
        size = np.dtype(code).itemsize
        if gap := -self._at % min(size, 8):
            self._raw(b"\0" * gap)
        self.fields.append((name, code) if count == 1 else (name, code, (count,)))
        if value is not None:
            self.constants[name] = value
        self._at += size * count

    def text(self, value: str) -> None:
        """Append a string that is the same in every message."""
        raw = value.encode() + b"\0"
        self.put(f"length_{len(self.fields)}", "<u4", value=len(raw))
        self._raw(raw)

    def _raw(self, raw: bytes) -> None:
        name = f"_{len(self.fields)}"
        self.fields.append((name, f"V{len(raw)}"))
        self.constants[name] = np.void(raw)
        self._at += len(raw)

    def blank(self) -> Array:
        """Return one message with the constants set."""
        made = np.zeros(1, np.dtype(self.fields))
        for name, value in self.constants.items():
            made[name] = value
        made["size"] = made.dtype.itemsize - SIZE_AFTER
        return made


def _stamped(cdr: _Cdr) -> None:
    cdr.put("sec", "<i4")
    cdr.put("nanosec", "<u4")


@cache
def _sip(readings: int) -> Array:
    cdr = _Cdr()
    _stamped(cdr)
    for name in ("x_mm", "y_mm", "heading_deg"):
        cdr.put(name, "<f8")
    for name, code in STATE:
        cdr.put(name, code)
    for name, code in (("sonar", "u1"), ("range_mm", "<u2")):
        cdr.put(f"{name}_count", "<u4", value=readings)
        if readings:
            cdr.put(name, code, readings)
    return cdr.blank()


@cache
def _transforms(_: int) -> Array:
    cdr = _Cdr()
    cdr.put("count", "<u4", value=1)
    _stamped(cdr)
    cdr.text(FRAME_WORLD)
    cdr.text(FRAME_ROBOT)
    for name in ("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw"):
        cdr.put(name, "<f8")
    return cdr.blank()


@cache
def _cloud(readings: int) -> Array:
    cdr = _Cdr()
    _stamped(cdr)
    cdr.text(FRAME_ROBOT)
    cdr.put("height", "<u4", value=1)
    cdr.put("width", "<u4", value=readings)
    cdr.put("fields", "<u4", value=3)
    for n, name in enumerate("xyz"):
        cdr.text(name)
        cdr.put(f"{name}_offset", "<u4", value=4 * n)
        cdr.put(f"{name}_type", "u1", value=_FLOAT32)
        cdr.put(f"{name}_count", "<u4", value=1)
    cdr.put("is_bigendian", "u1", value=0)
    cdr.put("point_step", "<u4", value=12)
    cdr.put("row_step", "<u4", value=12 * readings)
    cdr.put("data_count", "<u4", value=12 * readings)
    if readings:
        cdr.put("points", "<f4", 3 * readings)
    cdr.put("is_dense", "u1", value=0)
    return cdr.blank()


def filled(kind: str, channel: int, t_ns: Array, readings: int, columns: dict[str, Array]) -> Array:
    """Return the records of many messages of one kind, a row each, with so many readings in each."""
    blank = {SIP: _sip, TRANSFORMS: _transforms, CLOUD: _cloud}[kind](readings)
    made = np.repeat(blank, len(t_ns))
    made["channel"] = channel
    made["t"] = made["sent"] = t_ns
    made["sec"], made["nanosec"] = t_ns // _NANO, t_ns % _NANO
    for name, values in columns.items():
        made[name] = values
    return made
