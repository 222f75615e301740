# SPDX-License-Identifier: MIT
"""Strings and fields of packets, and what is wrong with them."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any

from hil_sim.errors import SimError


class PacketError(SimError):
    """Data that is no packet of the type asked for, or a value that no packet can carry."""


def take_string(data: bytes, at: int) -> tuple[bytes, int]:
    """Return the string at `at`, without its NUL, and where the next field begins; PacketError without a NUL."""
    end = data.find(b"\0", at)
    if end < 0:
        raise PacketError(f"a string that begins at data byte {at} has no end")
    return data[at:end], end + 1


def unpack_tail(spec: Sequence[tuple[str, str]], data: bytes, at: int) -> tuple[dict[str, Any], int]:
    """Read fields until the data ends; one that does not fit whole, and all after it, are None."""
    values: dict[str, Any] = {name: None for name, _ in spec}
    for name, code in spec:
        if at >= len(data):
            break
        if code == "str":
            if data.find(b"\0", at) < 0:
                break
            values[name], at = take_string(data, at)
            continue
        size = struct.calcsize("<" + code)
        if at + size > len(data):
            break
        values[name] = struct.unpack_from("<" + code, data, at)[0]
        at += size
    return values, at


def pack_tail(spec: Sequence[tuple[str, str]], source: object) -> bytes:
    """Write fields up to the first that is None."""
    out = bytearray()
    for name, code in spec:
        value = getattr(source, name)
        if value is None:
            break
        try:
            out += value + b"\0" if code == "str" else struct.pack("<" + code, value)
        except struct.error as error:
            raise PacketError(f"{type(source).__name__}.{name} = {value}: {error}") from error
    return bytes(out)
