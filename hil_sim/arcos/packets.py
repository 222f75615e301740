# SPDX-License-Identifier: MIT
"""The other packets of the robot, and the reading of any."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field
from typing import Any, ClassVar, Final, Self, TypeAlias

from hil_sim.arcos.configpac import ConfigPac
from hil_sim.arcos.fields import PacketError, take_string
from hil_sim.arcos.numbers import TYPE
from hil_sim.arcos.sip import Sip


@dataclass(frozen=True)
class SyncEcho:
    """The echo of SYNC0 or SYNC1."""

    number: int

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        return bytes((self.number,))


@dataclass(frozen=True)
class SyncReply:
    """The answer to SYNC2: who the robot is."""

    name: bytes
    robot_class: bytes
    subclass: bytes
    rest: bytes = b""

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        strings = (self.name, self.robot_class, self.subclass)
        return bytes((TYPE["SYNC2"],)) + b"".join(s + b"\0" for s in strings) + self.rest

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read a SYNC2 reply."""
        name, at = take_string(data, 1)
        robot_class, at = take_string(data, at)
        subclass, at = take_string(data, at)
        return cls(name, robot_class, subclass, data[at:])


@dataclass(frozen=True)
class EncoderPac:
    """The wheels' encoder counts."""

    left: int = 0
    right: int = 0
    rest: bytes = b""

    @property
    def data(self) -> bytes:
        """The data part of the packet; counts wrap at 32 bits as the hardware's do."""
        counts = struct.pack("<II", self.left & 0xFFFFFFFF, self.right & 0xFFFFFFFF)
        return bytes((TYPE["ENCODERPAC"],)) + counts + self.rest

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read an ENCODERpac."""
        if len(data) < 9:
            raise PacketError(f"an ENCODERpac has 9 data bytes, not {len(data)}")
        left, right = struct.unpack_from("<ii", data, 1)
        return cls(left, right, data[9:])


@dataclass(frozen=True)
class IoPac:
    """Digital and analog inputs and outputs; the counts inside the packet rule."""

    digital_in: bytes = b"\xff\xff\xff\xff"
    digital_out: bytes = b"\x00"
    analog: tuple[int, ...] = (0,) * 9
    rest: bytes = b""

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        return (
            bytes((TYPE["IOPAC"], len(self.digital_in))) + self.digital_in
            + bytes((len(self.digital_out),)) + self.digital_out
            + bytes((len(self.analog),)) + struct.pack(f"<{len(self.analog)}H", *self.analog) + self.rest
        )  # fmt: skip

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read an IOpac by its own counts."""
        try:
            n_in = data[1]
            n_out = data[2 + n_in]
            n_analog = data[3 + n_in + n_out]
            at = 4 + n_in + n_out
            analog = struct.unpack_from(f"<{n_analog}H", data, at)
        except (IndexError, struct.error) as error:
            raise PacketError(f"an IOpac of {len(data)} bytes is shorter than its counts say") from error
        return cls(data[2 : 2 + n_in], data[3 + n_in : 3 + n_in + n_out], analog, data[at + 2 * n_analog :])


@dataclass(frozen=True)
class SimStat:
    """The simulator's own report: the true pose, which a real robot does not know."""

    flags: int = 0
    interval_ms: int = 0
    real_interval_ms: int = 0
    last_interval_ms: int = 0
    x_mm: int = 0
    y_mm: int = 0
    z_mm: int = 0
    th_deg: int = 0
    first: bytes = b""
    second: bytes = b""
    rest: bytes = b""

    _BODY: ClassVar[struct.Struct] = struct.Struct("<IHHHiiii")
    _FIELDS: ClassVar[tuple[str, ...]] = (
        "flags", "interval_ms", "real_interval_ms", "last_interval_ms", "x_mm", "y_mm", "z_mm", "th_deg",
    )  # fmt: skip

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        body = self._BODY.pack(*(getattr(self, name) for name in self._FIELDS))
        return bytes((TYPE["SIMSTAT"],)) + self.first + b"\0" + self.second + b"\0" + body + self.rest

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read a SIMSTAT packet."""
        first, at = take_string(data, 1)
        second, at = take_string(data, at)
        if len(data) < at + cls._BODY.size:
            raise PacketError(f"a SIMSTAT of {len(data)} bytes ends before its pose")
        values = dict(zip(cls._FIELDS, cls._BODY.unpack_from(data, at), strict=True))
        return cls(**values, first=first, second=second, rest=data[at + cls._BODY.size :])


@dataclass(frozen=True)
class GyroPac:
    """Gyro samples: (rate 0 to 1023, temperature)."""

    samples: tuple[tuple[int, int], ...] = ()
    rest: bytes = b""

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        body = b"".join(struct.pack("<HB", rate, temperature) for rate, temperature in self.samples)
        return bytes((TYPE["GYROPAC"], len(self.samples))) + body + self.rest

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read a GYROpac."""
        if len(data) < 2 or len(data) < 2 + 3 * data[1]:
            raise PacketError(f"a GYROpac of {len(data)} bytes is shorter than its count says")
        end = 2 + 3 * data[1]
        return cls(tuple(struct.iter_unpack("<HB", data[2:end])), data[end:])


@dataclass(frozen=True)
class SimLaser:
    """A part of a scan of a simulated laser: ranges in mm from number `first` on, of `total`.

    place: what the odometry says of the robot, mm and degrees; None: the extended form, which has for each range what
    it was reflected by, 0 for anything plain, and at its end the number of the laser and flags.
    """

    total: int
    first: int
    ranges: tuple[int, ...]
    place: tuple[int, int, int] | None = None
    reflectance: tuple[int, ...] = ()
    rest: bytes = b""

    PLAIN_PLACE: ClassVar[struct.Struct] = struct.Struct("<hhh")
    COUNTS: ClassVar[struct.Struct] = struct.Struct("<HHB")

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        counts = self.COUNTS.pack(self.total, self.first, len(self.ranges))
        if self.place is not None:
            body = b"".join(mm.to_bytes(2, "little") for mm in self.ranges)
            return bytes((TYPE["SIMLASER"],)) + self.PLAIN_PLACE.pack(*self.place) + counts + body + self.rest
        pairs = zip(self.ranges, self.reflectance, strict=True)
        body = b"".join(struct.pack("<HBH", mm, reflected, 0) for mm, reflected in pairs)
        return bytes((TYPE["SIMLASER2"],)) + counts + body + self.rest

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read either form."""
        is_plain = data[0] == TYPE["SIMLASER"]
        at = 1 + (cls.PLAIN_PLACE.size if is_plain else 0)
        end = at + cls.COUNTS.size
        row = struct.Struct("<H" if is_plain else "<HBH")
        if len(data) < end or len(data) < end + data[end - 1] * row.size:
            raise PacketError(f"a part of a scan of {len(data)} bytes is shorter than its count says")
        total, first, count = cls.COUNTS.unpack_from(data, at)
        rows = list(row.iter_unpack(data[end : end + count * row.size]))
        ranges, rest = tuple(one[0] for one in rows), data[end + count * row.size :]
        if is_plain:
            return cls(total, first, ranges, cls.PLAIN_PLACE.unpack_from(data, 1), rest=rest)
        return cls(total, first, ranges, reflectance=tuple(one[1] for one in rows), rest=rest)


@dataclass(frozen=True)
class OtherPacket:
    """A packet whose inside is left as bytes (auxiliary serial data, play list, accessories)."""

    type: int
    body: bytes = field(default=b"")

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        return bytes((self.type,)) + self.body


Packet: TypeAlias = (
    SyncEcho | SyncReply | Sip | ConfigPac | EncoderPac | IoPac | SimStat | GyroPac | SimLaser | OtherPacket
)


def decode(data: bytes) -> Packet:
    """Read the data of a packet from the robot; `packet.data` gives the same bytes back.

    Raises PacketError when the data is too short for its type.
    """
    if not data:
        raise PacketError("a packet has at least one data byte")
    kind = data[0]
    if TYPE["SIP_FIRST"] <= kind <= TYPE["SIP_LAST"]:
        return Sip.decode(data)
    if kind in (TYPE["SYNC0"], TYPE["SYNC1"]) and len(data) == 1:
        return SyncEcho(kind)
    reader = _READERS.get(kind)
    return reader(data) if reader else OtherPacket(kind, data[1:])


_READERS: Final[dict[int, Any]] = {
    TYPE["SYNC2"]: SyncReply.decode,
    TYPE["CONFIGPAC"]: ConfigPac.decode,
    TYPE["ENCODERPAC"]: EncoderPac.decode,
    TYPE["IOPAC"]: IoPac.decode,
    TYPE["SIMSTAT"]: SimStat.decode,
    TYPE["GYROPAC"]: GyroPac.decode,
    TYPE["SIMLASER"]: SimLaser.decode,
    TYPE["SIMLASER2"]: SimLaser.decode,
}
