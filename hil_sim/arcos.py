# SPDX-License-Identifier: MIT
"""ARCOS packets as typed values: framing, checksum, resynchronisation, and every packet in both directions.

>>> frame(Command.integer(COMMAND["VEL"], -300).data).hex(" ")
'fa fb 06 0b 1b 2c 01 37 1c'
>>> packets = Unframer().feed(bytes.fromhex("57 4d fa fb 06 0b 1b 2c 01 37 1c"))
>>> Command.decode(packets[0]).value
-300
"""

from __future__ import annotations

import operator
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Final, Self, TypeAlias

from hil_sim.errors import SimError
from hil_sim.tables import load, section

COMMAND: Final = section("arcos", "command")
TYPE: Final = section("arcos", "type")
ARGUMENT: Final = section("arcos", "argument")
FLAG: Final = section("arcos", "flags")
FRAME: Final = section("arcos", "frame")
TIMING: Final = section("arcos", "timing")
SIP: Final = section("arcos", "sip")
DEFAULT: Final = section("arcos", "default")
HOSTBAUD: Final = section("arcos", "hostbaud")
BUMPSTALL: Final = section("arcos", "bumpstall")
BAUD: Final = section("arcos", "baud")
MOTION: Final = section("robots/p3dx-sh", "motion")
SONAR_CYCLE_MS: Final[int] = load("robots/p3dx-sh")["sonar"]["cycle_ms"]

BAUD_OF_CODE: Final = {code: BAUD[name] for name, code in HOSTBAUD.items()}

_HEADER: Final = bytes((FRAME["HEADER0"], FRAME["HEADER1"]))
_COUNT_MIN: Final = FRAME["COUNT_MIN"]
_COUNT_MAX: Final = FRAME["COUNT_MAX"]
_OVERHEAD: Final = FRAME["OVERHEAD"]
_QUIET_MS: Final = FRAME["RESYNC_QUIET_MS"]
_EXTRA_MS: Final = FRAME["RESYNC_EXTRA_MS"]
_CONFIG_COUNT_MAX: Final = FRAME["RESYNC_CONFIG_COUNT_MAX"]
_OTHER_COUNT_MAX: Final = FRAME["RESYNC_OTHER_COUNT_MAX"]
_SIP_TAIL_MAX: Final = FRAME["RESYNC_SIP_TAIL_MAX"]
_PACKET_MIN: Final = _COUNT_MIN + _OVERHEAD
_SIP_TYPES: Final = (TYPE["SIP_STATIONARY"], TYPE["SIP_MOVING"])
_SONAR_COUNT_AT: Final = SIP["OFFSET_SONAR_COUNT"]
_BARE_SIP: Final = SIP["OFFSET_SONAR"] + 2  # header to sonar count, and the checksum


class PacketError(SimError):
    """Data that is no packet of the type asked for, or a value that no packet can carry."""


def checksum(data: bytes | bytearray) -> int:
    """Return the 16-bit checksum over the data bytes (header and COUNT excluded).

    >>> hex(checksum(bytes([0x0B, 0x3B, 0x2C, 0x01])))
    '0x373c'
    """
    even = len(data) & ~1
    total = ((sum(data[0:even:2]) << 8) + sum(data[1:even:2])) & 0xFFFF
    if len(data) & 1:
        total ^= data[-1]
    return total


def frame(data: bytes) -> bytes:
    """Return `data` (command or type byte first) as it goes over the wire."""
    count = len(data) + 2
    if not _COUNT_MIN <= count <= _COUNT_MAX:
        raise PacketError(f"{len(data)} data bytes: a packet holds {_COUNT_MIN - 2} to {_COUNT_MAX - 2}")
    return _HEADER + bytes((count,)) + data + checksum(data).to_bytes(2, "big")


@dataclass
class UnframerCounters:
    """What an `Unframer` has met; the counts only grow."""

    packets: int = 0
    bad_checksum: int = 0
    bad_count: int = 0
    junk_bytes: int = 0
    rescued: int = 0
    timed_out: int = 0


class Unframer:
    """Finds the packets in a byte stream, whatever is between or inside them (SPEC.md, Framing).

    After a rejected header the search goes on one byte further, so a damaged packet never takes an intact one
    with it. An incomplete packet that is doubtful gives way to a whole one inside it. `feed` and `poll`
    return data parts (command or type byte first). Times are ms of any clock that does not step back.
    """

    def __init__(self) -> None:
        self.counters = UnframerCounters()
        self._held = bytearray()
        self._broken_off = False
        self._since_ms = 0.0
        self._last_byte_ms = 0.0

    @property
    def pending(self) -> int:
        """Bytes held of a packet that is not complete."""
        return len(self._held)

    def clear(self) -> None:
        """Forget the bytes held."""
        self._advance(len(self._held))

    def feed(self, chunk: bytes, now_ms: float = 0.0) -> list[bytes]:
        """Take received bytes; return the data of each packet they complete."""
        found = self.poll(now_ms)
        at = 0
        while at < len(chunk):
            if not self._held:
                start = chunk.find(_HEADER[0], at)
                start = len(chunk) if start < 0 else start
                self.counters.junk_bytes += start - at
                at = start
                self._since_ms = now_ms
            self._last_byte_ms = now_ms
            # No more than the first packet lacks: what is decided may not depend on how the bytes arrive.
            at = self._append(chunk, at)
            at = self._append(chunk, at)
            found += self.poll(now_ms)
        return found

    def poll(self, now_ms: float) -> list[bytes]:
        """Let time pass without bytes; return the packets that are released by it."""
        found = []
        while data := self._next(now_ms):
            found.append(data)
        return found

    def _next(self, now_ms: float) -> bytes:
        if self._held and now_ms - self._last_byte_ms >= _QUIET_MS:
            self._broken_off = True
        while self._seek():
            if self._owed() == 0:
                if self._accept():
                    return self._take()
            elif self._is_doubtful() and (start := self._find_inside()):
                self.counters.rescued += 1
                self._skip(start)
                return self._take()
            elif self._is_overdue(now_ms):
                self.counters.timed_out += 1
                self._skip(1)
            else:
                break
        return b""

    def _append(self, chunk: bytes, at: int) -> int:
        taken = chunk[at : at + self._owed()]
        self._held += taken
        return at + len(taken)

    def _owed(self) -> int:
        held = self._held
        total = held[2] + _OVERHEAD if len(held) >= 3 else 3
        return max(0, total - len(held))

    def _advance(self, count: int) -> None:
        del self._held[:count]
        self._since_ms = self._last_byte_ms
        if not self._held:
            self._broken_off = False

    def _skip(self, count: int) -> None:
        self.counters.junk_bytes += count
        self._advance(count)

    def _seek(self) -> bool:
        """Go to the first byte that can start a packet; False when there is none."""
        held = self._held
        start = held.find(_HEADER)
        if start < 0:
            start = len(held) - (held[-1:] == _HEADER[:1])
        if start:
            self._skip(start)
        return bool(held)

    def _checksum_holds(self, start: int, end: int) -> bool:
        held = self._held
        return checksum(held[start + 3 : end - 2]) == held[end - 2] << 8 | held[end - 1]

    def _accept(self) -> bool:
        """Whether the complete packet at the front is good; the header of a bad one is skipped."""
        if self._held[2] < _COUNT_MIN:
            self.counters.bad_count += 1
        elif self._checksum_holds(0, self._held[2] + _OVERHEAD):
            return True
        else:
            self.counters.bad_checksum += 1
        self._skip(1)
        return False

    def _take(self) -> bytes:
        total = self._held[2] + _OVERHEAD
        data = bytes(self._held[3 : total - 2])
        self.counters.packets += 1
        self._broken_off = False
        self._advance(total)
        return data

    def _is_doubtful(self) -> bool:
        held = self._held
        if len(held) < _PACKET_MIN:
            return False
        count, kind = held[2], held[3]
        if kind in _SIP_TYPES:
            if len(held) <= _SONAR_COUNT_AT:
                return False
            tail = count + _OVERHEAD - _BARE_SIP - SIP["SONAR_BYTES"] * held[_SONAR_COUNT_AT]
            return not 0 <= tail <= _SIP_TAIL_MAX
        limit = _CONFIG_COUNT_MAX if kind == TYPE["CONFIGPAC"] else _OTHER_COUNT_MAX
        return self._broken_off or count > limit

    def _find_inside(self) -> int:
        """Return where a whole, good packet starts inside the first one, or 0."""
        held = self._held
        start = held.find(_HEADER, 1)
        while 0 < start <= len(held) - _PACKET_MIN:
            count = held[start + 2]
            end = start + count + _OVERHEAD
            if count >= _COUNT_MIN and end <= len(held) and self._checksum_holds(start, end):
                return start
            start = held.find(_HEADER, start + 1)
        return 0

    def _is_overdue(self, now_ms: float) -> bool:
        count = self._held[2] if len(self._held) >= 3 else 0
        wire_ms = count * TIMING["BITS_PER_BYTE"] * 1000 // BAUD["B9600"]
        return now_ms - self._last_byte_ms >= _QUIET_MS and now_ms - self._since_ms > wire_ms + _EXTRA_MS


# ---- client to robot


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


# ---- robot to client


def _take_string(data: bytes, at: int) -> tuple[bytes, int]:
    end = data.find(b"\0", at)
    if end < 0:
        raise PacketError(f"a string that begins at data byte {at} has no end")
    return data[at:end], end + 1


def _unpack_tail(spec: Sequence[tuple[str, str]], data: bytes, at: int) -> tuple[dict[str, Any], int]:
    """Read fields until the data ends; one that does not fit whole, and all after it, are None."""
    values: dict[str, Any] = {name: None for name, _ in spec}
    for name, code in spec:
        if at >= len(data):
            break
        if code == "str":
            if data.find(b"\0", at) < 0:
                break
            values[name], at = _take_string(data, at)
            continue
        size = struct.calcsize("<" + code)
        if at + size > len(data):
            break
        values[name] = struct.unpack_from("<" + code, data, at)[0]
        at += size
    return values, at


def _pack_tail(spec: Sequence[tuple[str, str]], source: object) -> bytes:
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
        name, at = _take_string(data, 1)
        robot_class, at = _take_string(data, at)
        subclass, at = _take_string(data, at)
        return cls(name, robot_class, subclass, data[at:])


@dataclass(frozen=True)
class Sip:
    """The standard server information packet, in its raw units; fields a shorter variant lacks are None."""

    type: int = TYPE["SIP_STATIONARY"]
    x: int = 0
    y: int = 0
    th: int = 0
    left_vel: int = 0
    right_vel: int = 0
    battery: int = 0
    stall_left: int = 0
    stall_right: int = 0
    control: int = 0
    flags: int = 0
    compass: int = 0
    sonars: tuple[tuple[int, int], ...] = ()
    gripper: int | None = 0
    anport: int | None = 0
    analog: int | None = 0
    digin: int | None = 0xFF
    digout: int | None = 0
    battery_x10: int | None = 0
    charge_state: int | None = 0
    rotvel: int | None = 0
    fault_flags: int | None = 0
    lat_vel: int | None = None
    temperature: int | None = None
    charge_percent: int | None = None
    rest: bytes = b""

    _HEAD: ClassVar[struct.Struct] = struct.Struct("<BHHhhhBBBhHBB")
    _FIXED: ClassVar[tuple[str, ...]] = (
        "type", "x", "y", "th", "left_vel", "right_vel", "battery",
        "stall_left", "stall_right", "control", "flags", "compass",
    )  # fmt: skip
    _TAIL: ClassVar[tuple[tuple[str, str], ...]] = (
        ("gripper", "B"),
        ("anport", "B"),
        ("analog", "B"),
        ("digin", "B"),
        ("digout", "B"),
        ("battery_x10", "H"),
        ("charge_state", "B"),
        ("rotvel", "h"),
        ("fault_flags", "H"),
        ("lat_vel", "h"),
        ("temperature", "b"),
        ("charge_percent", "b"),
    )

    @classmethod
    def of(cls, values: dict[str, Any]) -> Self:
        """Return the packet with these fields, the rest as by default; several times faster than a call."""
        packet = object.__new__(cls)
        vars(packet).update(_SIP_DEFAULTS)
        vars(packet).update(values)
        return packet

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        fields = vars(self)
        head = self._HEAD.pack(*_sip_head(fields), len(self.sonars))
        flat = [value for pair in self.sonars for value in pair]
        sonars = struct.pack("<" + "BH" * len(self.sonars), *flat)
        return head + sonars + self._tail(fields) + self.rest

    def _tail(self, fields: dict[str, Any]) -> bytes:
        if self.lat_vel is None:
            # What a robot sends, in one go; anything else, and anything wrong, field by field.
            try:
                return _SIP_TAIL.pack(*_sip_tail(fields))
            except struct.error:
                pass
        return _pack_tail(self._TAIL, self)

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read a SIP of any variant that holds at least the fixed part and its sonar block."""
        if len(data) < cls._HEAD.size:
            raise PacketError(f"a SIP of {len(data)} bytes ends before its sonar count")
        head = cls._HEAD.unpack_from(data)
        count = head[-1]
        at = cls._HEAD.size
        if len(data) < at + 3 * count:
            raise PacketError(f"a SIP of {len(data)} bytes cannot hold {count} sonar readings")
        sonars = tuple(struct.iter_unpack("<BH", data[at : at + 3 * count]))
        values, at = _unpack_tail(cls._TAIL, data, at + 3 * count)
        values |= zip(cls._FIXED, head, strict=False)
        return cls(**values, sonars=sonars, rest=data[at:])

    @property
    def left_stalled(self) -> bool:
        """The left wheel is stalled."""
        return bool(self.stall_left & SIP["STALL_BIT"])

    @property
    def right_stalled(self) -> bool:
        """The right wheel is stalled."""
        return bool(self.stall_right & SIP["STALL_BIT"])

    @property
    def front_bumpers(self) -> int:
        """Bits 1 to 7: front segments from the left."""
        return self.stall_right & SIP["BUMPER_MASK"]

    @property
    def rear_bumpers(self) -> int:
        """Bits 1 to 7: rear segments from the right."""
        return self.stall_left & SIP["BUMPER_MASK"]


_SIP_DEFAULTS: Final = dict(vars(Sip()))
_SIP_USUAL: Final = [(name, code) for name, code in Sip._TAIL if _SIP_DEFAULTS[name] is not None]
_SIP_TAIL: Final = struct.Struct("<" + "".join(code for _, code in _SIP_USUAL))
_sip_head = operator.itemgetter(*Sip._FIXED)
_sip_tail = operator.itemgetter(*(name for name, _ in _SIP_USUAL))


@dataclass(frozen=True)
class ConfigPac:
    """The robot's configuration; fields that a shorter packet lacks are None."""

    robot_type: bytes | None = b"Pioneer"
    subtype: bytes | None = b"p3dx-sh"
    serial_number: bytes | None = b"P3DX0001"
    four_motors: int | None = 0
    rot_vel_top: int | None = MOTION["rotvel_top_deg_s"]
    trans_vel_top: int | None = MOTION["vel_top_mm_s"]
    rot_acc_top: int | None = MOTION["rotaccel_top_deg_s2"]
    trans_acc_top: int | None = MOTION["accel_top_mm_s2"]
    pwm_max: int | None = DEFAULT["PWMMAX"]
    name: bytes | None = b"P3DX_0001"
    sip_cycle_ms: int | None = TIMING["SIP_CYCLE_MS"]
    host_baud: int | None = DEFAULT["HOSTBAUD"]
    aux1_baud: int | None = 0
    gripper: int | None = 0
    front_sonar: int | None = 1
    rear_sonar: int | None = 1
    low_battery_dv: int | None = DEFAULT["LOWBATTERY_DV"]
    rev_count: int | None = DEFAULT["REVCOUNT"]
    watchdog_ms: int | None = TIMING["WATCHDOG_MS"]
    p2mpacs: int | None = 0
    stall_val: int | None = DEFAULT["STALLVAL"]
    stall_count_ms: int | None = DEFAULT["STALLCOUNT_MS"]
    joy_vel: int | None = DEFAULT["JOYVEL_MM_S"]
    joy_rvel: int | None = DEFAULT["JOYRVEL_DEG_S"]
    rot_vel_max: int | None = MOTION["rotvel_max_deg_s"]
    trans_vel_max: int | None = MOTION["vel_max_mm_s"]
    rot_acc: int | None = MOTION["rotaccel_deg_s2"]
    rot_decel: int | None = MOTION["rotdecel_deg_s2"]
    rot_kp: int | None = DEFAULT["ROTKP"]
    rot_kv: int | None = DEFAULT["ROTKV"]
    rot_ki: int | None = DEFAULT["ROTKI"]
    trans_acc: int | None = MOTION["accel_mm_s2"]
    trans_decel: int | None = MOTION["decel_mm_s2"]
    trans_kp: int | None = DEFAULT["TRANSKP"]
    trans_kv: int | None = DEFAULT["TRANSKV"]
    trans_ki: int | None = DEFAULT["TRANSKI"]
    front_bumps: int | None = 0
    rear_bumps: int | None = 0
    charger: int | None = 0
    sonar_cycle_ms: int | None = SONAR_CYCLE_MS
    auto_baud: int | None = DEFAULT["AUTOBAUD"]
    has_gyro: int | None = DEFAULT["HASGYRO"]
    drift_factor: int | None = 0
    aux2_baud: int | None = 0
    aux3_baud: int | None = 0
    ticks_mm: int | None = MOTION["ticks_per_mm"]
    shutdown_dv: int | None = DEFAULT["SHUTDOWN_DV"]
    version: bytes | None = b"2.6"
    gyro_cw: int | None = 0
    gyro_ccw: int | None = 0
    kinematics_delay_ms: int | None = 0
    lat_vel_top: int | None = None
    lat_acc_top: int | None = None
    lat_vel_max: int | None = None
    lat_acc: int | None = None
    lat_decel: int | None = None
    charge_threshold: int | None = None
    rest: bytes = b""

    _SPEC: ClassVar[tuple[tuple[str, str], ...]] = (
        ("robot_type", "str"), ("subtype", "str"), ("serial_number", "str"), ("four_motors", "B"),
        ("rot_vel_top", "H"), ("trans_vel_top", "H"), ("rot_acc_top", "H"), ("trans_acc_top", "H"),
        ("pwm_max", "H"), ("name", "str"), ("sip_cycle_ms", "B"), ("host_baud", "B"), ("aux1_baud", "B"),
        ("gripper", "H"), ("front_sonar", "H"), ("rear_sonar", "B"), ("low_battery_dv", "H"),
        ("rev_count", "H"), ("watchdog_ms", "H"), ("p2mpacs", "B"), ("stall_val", "H"),
        ("stall_count_ms", "H"), ("joy_vel", "H"), ("joy_rvel", "H"), ("rot_vel_max", "H"),
        ("trans_vel_max", "H"), ("rot_acc", "H"), ("rot_decel", "H"), ("rot_kp", "H"), ("rot_kv", "H"),
        ("rot_ki", "H"), ("trans_acc", "H"), ("trans_decel", "H"), ("trans_kp", "H"), ("trans_kv", "H"),
        ("trans_ki", "H"), ("front_bumps", "B"), ("rear_bumps", "B"), ("charger", "B"),
        ("sonar_cycle_ms", "B"), ("auto_baud", "B"), ("has_gyro", "B"), ("drift_factor", "h"),
        ("aux2_baud", "B"), ("aux3_baud", "B"), ("ticks_mm", "H"), ("shutdown_dv", "H"), ("version", "str"),
        ("gyro_cw", "H"), ("gyro_ccw", "H"), ("kinematics_delay_ms", "B"), ("lat_vel_top", "H"),
        ("lat_acc_top", "H"), ("lat_vel_max", "H"), ("lat_acc", "H"), ("lat_decel", "H"),
        ("charge_threshold", "H"),
    )  # fmt: skip

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        return bytes((TYPE["CONFIGPAC"],)) + _pack_tail(self._SPEC, self) + self.rest

    @classmethod
    def decode(cls, data: bytes) -> Self:
        """Read a CONFIGpac of any length."""
        values, at = _unpack_tail(cls._SPEC, data, 1)
        return cls(**values, rest=data[at:])


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
        first, at = _take_string(data, 1)
        second, at = _take_string(data, at)
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
class OtherPacket:
    """A packet whose inside is left as bytes (auxiliary serial data, play list, accessories)."""

    type: int
    body: bytes = field(default=b"")

    @property
    def data(self) -> bytes:
        """The data part of the packet."""
        return bytes((self.type,)) + self.body


Packet: TypeAlias = (
    SyncEcho | SyncReply | Sip | ConfigPac | EncoderPac | IoPac | SimStat | GyroPac | OtherPacket
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
}
