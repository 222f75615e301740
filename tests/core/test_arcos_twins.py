# SPDX-License-Identifier: MIT
"""Rule: the firmware and hil_sim.arcos take the same packets out of the same bytes at the same moment, read the
same fields from them, whatever the bytes and however they arrive, and build the same bytes."""

from __future__ import annotations

import ctypes
import json
import os
import random
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from hil_sim.arcos import (
    COMMAND,
    FRAME,
    TYPE,
    Command,
    ConfigPac,
    EncoderPac,
    GyroPac,
    IoPac,
    OtherPacket,
    PacketError,
    SimStat,
    Sip,
    SyncReply,
    Unframer,
    frame,
)

ROOT = Path(__file__).resolve().parents[2]
CAPTURES = sorted((ROOT / "tests/data/captures").glob("*.jsonl"))
SOURCES = ["arcos/frame.c", "arcos/sip.c", "arcos/configpac.c", "arcos/command.c"]
SEED = int(os.environ.get("ARGUS_SEED", "20240501"))
FEW_PACKETS, PACKETS = 15_000, 100_000
PAUSES_MS = (0, 0, 0, 1, 5, 20, 29, 30, 31, 60, 101, 140, 250, 400)
NAME_MAX = 32


class Twin:
    """The firmware's side, behind the shim."""

    def __init__(self, library: Path) -> None:
        self._lib = ctypes.CDLL(str(library))
        for name in ("stream", "sip", "config", "strings", "frame", "integer", "string"):
            getattr(self._lib, f"twins_{name}").restype = ctypes.c_size_t
        self._out = ctypes.create_string_buffer(1 << 17)
        self._ints = (ctypes.c_int32 * 256)()
        self._text = ctypes.create_string_buffer(5 * NAME_MAX)
        self._counters = (ctypes.c_uint32 * 5)()

    def stream(
        self, data: bytes, ends: list[int], times_ms: list[int]
    ) -> tuple[list[tuple[int, bytes]], tuple[int, ...]]:
        """Return (read, data) of every packet, and the counters."""
        reads = len(ends)
        array = ctypes.c_uint32 * reads
        size = ctypes.c_size_t(len(self._out))
        times = array(*(t & 0xFFFFFFFF for t in times_ms))
        used = self._lib.twins_stream(
            data, array(*ends), times, ctypes.c_size_t(reads), self._out, size, self._counters
        )
        raw, at, found = self._out.raw[:used], 0, []
        while at < used:
            end = at + 3 + raw[at + 2]
            found.append((raw[at] | raw[at + 1] << 8, raw[at + 3 : end]))
            at = end
        return found, tuple(self._counters)

    def sip(self, data: bytes) -> list[int] | None:
        """Return the fields of a SIP, or None."""
        used = self._lib.twins_sip(data, ctypes.c_uint8(len(data)), self._ints)
        return self._ints[:used] or None

    def config(self, data: bytes) -> tuple[list[int], list[bytes]] | None:
        """Return the fields and strings of a CONFIGpac, or None."""
        used = self._lib.twins_config(data, ctypes.c_uint8(len(data)), self._ints, self._text)
        return (self._ints[:used], self._strings(5)) if used else None

    def identity(self, data: bytes) -> list[bytes] | None:
        """Return the three strings of a SYNC2 reply, or None."""
        whole = self._lib.twins_strings(data, ctypes.c_uint8(len(data)), self._text)
        return self._strings(3) if whole == 3 else None

    def frame(self, data: bytes) -> bytes:
        """Return the packet, or nothing."""
        return self._built(self._lib.twins_frame(data, ctypes.c_size_t(len(data)), *self._room()))

    def integer(self, command: int, argument: int) -> bytes:
        """Return the command's packet."""
        return self._built(
            self._lib.twins_integer(ctypes.c_uint8(command), ctypes.c_int32(argument), *self._room())
        )

    def string(self, command: int, text: bytes) -> bytes:
        """Return the command's packet."""
        size = ctypes.c_size_t(len(text))
        return self._built(self._lib.twins_string(ctypes.c_uint8(command), text, size, *self._room()))

    def _room(self) -> tuple[ctypes.Array[ctypes.c_char], ctypes.c_size_t]:
        return self._out, ctypes.c_size_t(FRAME["SEND_TOTAL_MAX"])

    def _built(self, length: int) -> bytes:
        return self._out.raw[:length]

    def _strings(self, count: int) -> list[bytes]:
        raw = self._text.raw
        return [raw[k * NAME_MAX : (k + 1) * NAME_MAX].split(b"\0", 1)[0] for k in range(count)]


@pytest.fixture(scope="module")
def twin(tmp_path_factory: pytest.TempPathFactory) -> Twin:
    """Compile the firmware's ARCOS part and the shim into a library, undefined behaviour watched."""
    library = tmp_path_factory.mktemp("twins") / "twins.so"
    sources = [ROOT / "tests/core/twins.c", *(ROOT / "firmware" / name for name in SOURCES)]
    flags = [
        "-std=c11",
        "-O1",
        "-g",
        "-Wall",
        "-Wextra",
        "-Werror",
        "-fPIC",
        "-shared",
        "-fsanitize=undefined",
    ]
    subprocess.run(
        ["gcc", *flags, "-I", ROOT / "firmware", "-I", ROOT / "firmware/include", "-o", library, *sources],
        check=True,
        timeout=600,
    )
    return Twin(library)


@pytest.fixture
def _no_undefined_behaviour(capfd: pytest.CaptureFixture[str]) -> object:
    """Fail when the sanitizer has said something."""
    yield
    said = capfd.readouterr().err
    assert "runtime error" not in said, said


# ---- the Python side, in the firmware's terms


def sip_fields(data: bytes) -> list[int] | None:
    """What the firmware should read from a SIP."""
    if data[0] not in (TYPE["SIP_STATIONARY"], TYPE["SIP_MOVING"]):
        return None
    try:
        sip = Sip.decode(data)
    except PacketError:
        return None
    fields = [
        sip.type == TYPE["SIP_MOVING"], sip.x, sip.y, sip.th, sip.left_vel, sip.right_vel, sip.battery,
        sip.left_stalled, sip.right_stalled, sip.front_bumpers, sip.rear_bumpers, sip.flags,
    ]  # fmt: skip
    for value in (sip.battery_x10, sip.rotvel, sip.fault_flags):
        fields += [value is not None, value or 0]
    for number, range_mm in sip.sonars:
        fields += [number, range_mm]
    return [int(field) for field in fields]


def shown(text: bytes | None) -> bytes:
    """A string as the firmware keeps it."""
    return bytes(c if 0x20 <= c < 0x7F else ord("?") for c in text or b"")[: NAME_MAX - 1]


def config_fields(data: bytes) -> tuple[list[int], list[bytes]] | None:
    """What the firmware should keep of a CONFIGpac."""
    if data[0] != TYPE["CONFIGPAC"]:
        return None
    c = ConfigPac.decode(data)
    if c.serial_number is None:
        return None
    values = [
        c.sonar_cycle_ms, bool(c.rear_sonar), c.low_battery_dv, c.watchdog_ms, c.rot_vel_max, c.trans_vel_max,
        c.trans_acc, c.trans_decel, c.front_bumps, c.rear_bumps,
    ]  # fmt: skip
    strings = (c.robot_type, c.subtype, c.serial_number, c.name, c.version)
    return [int(value or 0) for value in values], [shown(text) for text in strings]


def identity(data: bytes) -> list[bytes] | None:
    """What the firmware should read from a SYNC2 reply."""
    try:
        reply = SyncReply.decode(data)
    except PacketError:
        return None
    return [shown(text) for text in (reply.name, reply.robot_class, reply.subclass)]


def compare_fields(twin: Twin, data: bytes) -> None:
    """Both sides read the data as a SIP, as a CONFIGpac and as an identity."""
    assert twin.sip(data) == sip_fields(data), f"seed {SEED}: SIP {data.hex()}"
    assert twin.config(data) == config_fields(data), f"seed {SEED}: CONFIGpac {data.hex()}"
    assert twin.identity(data) == identity(data), f"seed {SEED}: identity {data.hex()}"


# ---- bytes


def recorded() -> list[bytes]:
    """Every different packet of the captures."""
    found: dict[bytes, None] = {}
    for path in CAPTURES:
        unframers = {"c2r": Unframer(), "r2c": Unframer()}
        for line in path.read_text().splitlines():
            record = json.loads(line)
            if record["dir"] in unframers:
                for data in unframers[record["dir"]].feed(bytes.fromhex(record["hex"])):
                    found[frame(data)] = None
    return list(found)


def random_packet(rng: random.Random) -> bytes:
    """A packet that no capture holds."""
    sonars = tuple((rng.randrange(32), rng.randrange(65536)) for _ in range(rng.randrange(33)))
    x, y = rng.choice(((rng.randrange(65536), rng.randrange(65536)), (0xFBFA, 0x3203)))
    choices: tuple[Callable[[], bytes], ...] = (
        lambda: Sip(TYPE["SIP_MOVING"], x, y, rng.randrange(-2048, 2048), sonars=sonars).data,
        lambda: Sip(x=x, y=y, sonars=sonars[:6], lat_vel=0, temperature=1, charge_percent=2).data,
        lambda: ConfigPac(name=rng.randbytes(rng.randrange(40)).replace(b"\0", b"")).data,
        lambda: ConfigPac(name=b"N").data + rng.randbytes(rng.randrange(100)),
        lambda: EncoderPac(rng.randrange(1 << 31), -rng.randrange(1 << 31)).data,
        lambda: IoPac().data,
        lambda: SimStat(x_mm=rng.randrange(1 << 20)).data,
        lambda: GyroPac(((512, 30),) * rng.randrange(5)).data,
        lambda: OtherPacket(rng.choice((0x60, 0x96)), rng.randbytes(rng.randrange(252))).data,
        lambda: OtherPacket(TYPE["SERAUXPAC"], frame(Sip(sonars=sonars[:2]).data)).data,
        lambda: Command.integer(rng.randrange(256), rng.randrange(-32767, 32768)).data,
        lambda: rng.randbytes(1 + rng.randrange(253)),
    )
    return frame(rng.choice(choices)())


def false_length(rng: random.Random, packet: bytes) -> bytes:
    return packet[:2] + bytes((rng.randrange(256),)) + packet[3:]


def flipped(rng: random.Random, packet: bytes) -> bytes:
    at = rng.randrange(len(packet))
    return packet[:at] + bytes((packet[at] ^ (1 << rng.randrange(8)),)) + packet[at + 1 :]


def deleted(rng: random.Random, packet: bytes) -> bytes:
    at = rng.randrange(len(packet))
    return packet[:at] + packet[at + 1 :]


def inserted(rng: random.Random, packet: bytes) -> bytes:
    at = rng.randrange(len(packet))
    return packet[:at] + rng.choice((b"\xfa", b"\xfa\xfb", rng.randbytes(rng.randrange(1, 9)))) + packet[at:]


def cut(rng: random.Random, packet: bytes) -> bytes:
    return packet[: rng.randrange(len(packet))]


def reframed(rng: random.Random, packet: bytes) -> bytes:
    """Wrong inside, with a good checksum: what decoding is for."""
    data = rng.choice((flipped, flipped, deleted, inserted, cut))(rng, packet[3:-2])[:253]
    return frame(data or b"\x00")


def preceded(rng: random.Random, packet: bytes) -> bytes:
    stray = (b"\xfa", b"\xfa\xfb", b"WMS2\r", b"\xfa\xfb" + rng.randbytes(2), b"\xfa\xfb\xff\x32")
    return rng.choice(stray) + packet


def whole(_rng: random.Random, packet: bytes) -> bytes:
    return packet


MUTATIONS = (
    whole,
    whole,
    whole,
    reframed,
    reframed,
    reframed,
    flipped,
    deleted,
    inserted,
    cut,
    false_length,
    preceded,
)


@dataclass
class Stream:
    """Bytes and how they are read."""

    data: bytes
    ends: list[int]
    times_ms: list[int]

    @classmethod
    def random(cls, rng: random.Random, seeds: list[bytes], packets: int) -> Stream:
        """Mutated packets in reads of random size and time."""
        parts = []
        for _ in range(packets):
            packet = rng.choice(seeds) if rng.random() < 0.6 else random_packet(rng)
            parts.append(rng.choice(MUTATIONS)(rng, packet))
        data = b"".join(parts)
        longest = rng.choice((1, 7, 40, 40, 40, 300, 300, 300, 300, 300, 3000, 3000))
        pauses = rng.choice((PAUSES_MS, (0, 1), (10, 31)))
        ends: list[int] = []
        times_ms: list[int] = []
        now = 0
        while not ends or ends[-1] < len(data):
            now += rng.choice(pauses)
            ends.append(min(len(data), (ends[-1] if ends else 0) + rng.randrange(longest + 1)))
            times_ms.append(now)
        for _ in range(6):  # and then nothing: the time rules alone
            now += rng.choice(PAUSES_MS)
            ends.append(len(data))
            times_ms.append(now)
        return cls(data, ends, times_ms)

    def python(self) -> tuple[list[tuple[int, bytes]], tuple[int, ...]]:
        """What hil_sim.arcos finds."""
        unframer = Unframer()
        found, at = [], 0
        for read, (end, now) in enumerate(zip(self.ends, self.times_ms, strict=True)):
            found += [(read, data) for data in unframer.feed(self.data[at:end], now)]
            at = end
        c = unframer.counters
        return found, (c.packets, c.bad_checksum, c.bad_count, c.junk_bytes, c.timed_out)


@pytest.mark.soak
@pytest.mark.usefixtures("_no_undefined_behaviour")
@pytest.mark.parametrize("least", [FEW_PACKETS, pytest.param(PACKETS, marks=pytest.mark.wide)])
def test_streams_give_the_same_packets_at_the_same_reads(twin: Twin, least: int) -> None:
    rng = random.Random(SEED)
    seeds = recorded()
    assert len(seeds) > 500
    made = accepted = 0
    while made < least:
        packets = rng.randrange(1, 30)
        made += packets
        stream = Stream.random(rng, seeds, packets)
        epoch = rng.choice((0, 2**32 - 200))  # the firmware's clock may wrap
        c_found, c_counters = twin.stream(stream.data, stream.ends, [t + epoch for t in stream.times_ms])
        found, counters = stream.python()
        if c_found != found or c_counters != counters:
            first = next((k for k, (a, b) in enumerate(zip(c_found, found, strict=False)) if a != b), None)
            pytest.fail(
                f"seed {SEED}, packets up to {made}, first difference at packet {first}:"
                f"\n C      {c_found[first] if first is not None else len(c_found)} {c_counters}"
                f"\n Python {found[first] if first is not None else len(found)} {counters}"
                f"\n bytes {stream.data.hex()}\n ends {stream.ends}\n times {stream.times_ms}"
            )
        for _, data in found:
            compare_fields(twin, data)
        accepted += len(found)
    print(f"seed {SEED}: {made} packets made, {accepted} accepted by both")
    assert accepted > least // 3


@pytest.mark.usefixtures("_no_undefined_behaviour")
def test_every_cut_of_a_packet_gives_the_same_fields(twin: Twin) -> None:
    rng = random.Random(SEED)
    sip = Sip(sonars=((0, 1), (31, 65535)), lat_vel=-5, temperature=-7, charge_percent=80, rest=b"xyz").data
    config = ConfigPac(lat_vel_top=1).data
    reply = SyncReply(b"n" * 40, b"\x01\xff ~", b"p3dx-sh").data
    for data in (sip, config, reply):
        for end in range(1, len(data) + 1):
            compare_fields(twin, data[:end])
            for at in range(end):
                compare_fields(twin, data[:at] + bytes((rng.randrange(256),)) + data[at + 1 : end])


@pytest.mark.usefixtures("_no_undefined_behaviour")
def test_what_is_built_is_the_same(twin: Twin) -> None:
    rng = random.Random(SEED)
    longest = FRAME["SEND_TOTAL_MAX"] - 5
    for case in range(20_000):
        data = rng.randbytes(1 + rng.randrange(longest))
        assert twin.frame(data) == frame(data), f"seed {SEED}, case {case}"
    for number in COMMAND.values():
        for value in (0, 1, -1, 255, 256, -256, 32767, -32767, rng.randrange(-32767, 32768)):
            expected = frame(Command.integer(number, value).data)
            assert twin.integer(number, value) == expected, f"command {number} {value}"
        text = rng.randbytes(rng.randrange(190))
        assert twin.string(number, text) == frame(Command.string(number, text).data), f"command {number}"
    assert twin.frame(bytes(longest + 1)) == b""


def test_the_comparison_sees_a_changed_bit(twin: Twin) -> None:
    sip = Sip(sonars=((3, 1234),)).data
    other = bytearray(sip)
    other[21] ^= 1  # the range
    assert twin.sip(sip) != sip_fields(bytes(other))
    stream = frame(sip)
    found, _ = twin.stream(stream, [len(stream)], [0])
    assert found == [(0, sip)]
