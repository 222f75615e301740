# SPDX-License-Identifier: MIT
"""Commands, client to robot, in each form that clients send."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

from hil_sim.arcos.fields import PacketError
from hil_sim.arcos.numbers import ARGUMENT, FRAME


@dataclass(frozen=True)
class Command:
    """One command: its number and the bytes after it, readable in each form that clients send."""

    number: int
    argument: bytes = b""

    @classmethod
    def none(cls, number: int) -> Self:
        """A command without argument."""
        return cls(number)

    @classmethod
    def integer(cls, number: int, value: int) -> Self:
        """A command with a signed integer; the sign travels as the argument's type."""
        if not -32767 <= value <= 32767:
            raise PacketError(f"command {number}: {value} is outside -32767..32767")
        kind = ARGUMENT["NEGATIVE"] if value < 0 else ARGUMENT["POSITIVE"]
        return cls(number, bytes((kind,)) + abs(value).to_bytes(2, "little"))

    @classmethod
    def string(cls, number: int, text: bytes, nul: bool = False) -> Self:
        """A command with a string; `nul` adds the uncounted NUL that some clients send."""
        if len(text) > FRAME["STRING_MAX"] - 10:
            raise PacketError(f"command {number}: a string of {len(text)} bytes is too long")
        return cls(number, bytes((ARGUMENT["STRING"], len(text))) + text + (b"\0" if nul else b""))

    @classmethod
    def pair(cls, number: int, high: int, low: int) -> Self:
        """A command whose 16-bit argument is two signed bytes (VEL2: left wheel high, right wheel low)."""
        word = (high & 0xFF) << 8 | (low & 0xFF)
        if word == 0x8000:
            # Its two's complement has no magnitude that fits; the raw word reads the same.
            return cls(number, bytes((ARGUMENT["POSITIVE"],)) + word.to_bytes(2, "little"))
        return cls.integer(number, word - 0x10000 if word > 0x8000 else word)

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read a packet's data; any bytes are a command."""
        if not data:
            raise PacketError("a command has at least one byte")
        return cls(data[0], data[1:])

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        return bytes((self.number,)) + self.argument

    @property
    def value(self) -> int:
        """The integer argument; bytes that are missing count as 0."""
        magnitude = int.from_bytes(self.argument[1:3], "little")
        return -magnitude if self.argument[:1] == bytes((ARGUMENT["NEGATIVE"],)) else magnitude

    @property
    def bytes_pair(self) -> tuple[int, int]:
        """The argument as two signed bytes, (high, low), right for both ways in which clients encode them."""
        word = self.value & 0xFFFF
        high, low = word >> 8, word & 0xFF
        return (high - 256 if high > 127 else high), (low - 256 if low > 127 else low)

    @property
    def text(self) -> bytes:
        """The string argument: as many bytes as its length says and the packet holds."""
        if self.argument[:1] != bytes((ARGUMENT["STRING"],)) or len(self.argument) < 2:
            return b""
        return self.argument[2 : 2 + self.argument[1]]
