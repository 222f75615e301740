# SPDX-License-Identifier: MIT
"""Rule: bytes of the protocol reference and of recorded sessions are read and written back unchanged; damage
costs no intact packet and invents none."""

from __future__ import annotations

import doctest
import json
import random
from pathlib import Path

import pytest

import hil_sim.arcos
import hil_sim.arcos.framing
import hil_sim.tables
from hil_sim.arcos import (
    ARGUMENT,
    COMMAND,
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
    checksum,
    decode,
    frame,
)

CAPTURES = sorted((Path(__file__).parents[1] / "data" / "captures").glob("*.jsonl"))

GOLDEN_COMMANDS = [
    (Command(COMMAND["PULSE"]), "FA FB 03 00 00 00"),
    (Command(COMMAND["OPEN"]), "FA FB 03 01 00 01"),
    (Command.integer(COMMAND["OPEN"], 1), "FA FB 06 01 3B 01 00 02 3B"),
    (Command.integer(COMMAND["CLOSE"], 1), "FA FB 06 02 3B 01 00 03 3B"),
    (Command.integer(COMMAND["ENABLE"], 0), "FA FB 06 04 3B 00 00 04 3B"),
    (Command.integer(COMMAND["SETA"], -300), "FA FB 06 05 1B 2C 01 31 1C"),
    (Command.integer(COMMAND["SETV"], 750), "FA FB 06 06 3B EE 02 F4 3D"),
    (Command(COMMAND["SETO"]), "FA FB 03 07 00 07"),
    (Command(COMMAND["SETO"], b"\x3b"), "FA FB 04 07 3B 07 3B"),
    (Command.integer(COMMAND["MOVE"], -500), "FA FB 06 08 1B F4 01 FC 1C"),
    (Command.integer(COMMAND["ROTATE"], -20), "FA FB 06 09 1B 14 00 1D 1B"),
    (Command.integer(COMMAND["VEL"], 300), "FA FB 06 0B 3B 2C 01 37 3C"),
    (Command.integer(COMMAND["HEAD"], 90), "FA FB 06 0C 3B 5A 00 66 3B"),
    (Command.integer(COMMAND["DHEAD"], -90), "FA FB 06 0D 1B 5A 00 67 1B"),
    (Command.integer(COMMAND["SONAR"], 5), "FA FB 06 1C 3B 05 00 21 3B"),
    (Command(COMMAND["STOP"]), "FA FB 03 1D 00 1D"),
    (Command.integer(COMMAND["HOSTBAUD"], 2), "FA FB 06 32 3B 02 00 34 3B"),
    (Command(COMMAND["E_STOP"]), "FA FB 03 37 00 37"),
    (
        Command.string(COMMAND["POLLING"], bytes(range(1, 9))),
        "FA FB 0D 03 2B 08 01 02 03 04 05 06 07 08 17 33",
    ),
    (
        Command.string(COMMAND["POLLING"], bytes(range(1, 9)), nul=True),
        "FA FB 0E 03 2B 08 01 02 03 04 05 06 07 08 00 1F 3B",
    ),
    (Command.pair(COMMAND["VEL2"], 5, -3), "FA FB 06 20 3B FD 05 1D 40"),
    (Command.pair(COMMAND["VEL2"], -5, 3), "FA FB 06 20 1B FD 04 1D 1F"),
    (Command(COMMAND["RESET"]), "FA FB 03 FD 00 FD"),
]

GOLDEN_PACKETS = [
    (
        SyncReply(b"P3DX_0001", b"Pioneer", b"p3dx-sh"),
        "FA FB 1D 02 50 33 44 58 5F 30 30 30 31 00 50 69 6F 6E 65 65 72 00 70 33 64 78 2D 73 68 00 4B 53",
    ),
    (
        Sip(battery=128, battery_x10=128, flags=6, sonars=((0, 5000), (8, 1234))),
        "FA FB 28 32 00 00 00 00 00 00 00 00 00 00 80 00 00 00 00 06 00 00 02 00 88 13 08 D2 04 00 00 00"
        " FF 00 80 00 00 00 00 00 00 1F 95",
    ),
    (
        Sip(
            type=0x33, x=1500, y=0xFF06, th=1024, left_vel=300, right_vel=300, battery=127,
            battery_x10=127, flags=7,
            sonars=((2, 812), (3, 790), (10, 5000), (11, 5000), (4, 805), (12, 5000)),
        ),
        "FA FB 34 33 DC 05 06 FF 00 04 2C 01 2C 01 7F 00 00 00 00 07 00 00 06 02 2C 03 03 16 03 0A 88 13"
        " 0B 88 13 04 25 03 0C 88 13 00 00 00 FF 00 7F 00 00 00 00 00 00 97 59",
    ),
    (
        ConfigPac(),
        "FA FB 77 20 50 69 6F 6E 65 65 72 00 70 33 64 78 2D 73 68 00 50 33 44 58 30 30 30 31 00 00"
        " 68 01 DC 05 2C 01 D0 07 F4 01 50 33 44 58 5F 30 30 30 31 00 64 00 00 00 00 01 00 01 73 00"
        " BA 40 D0 07 00 C8 00 64 00 EE 02 32 00 64 00 EE 02 64 00 64 00 28 00 14 00 00 00 2C 01 2C"
        " 01 28 00 1E 00 00 00 00 00 00 28 02 00 00 00 00 00 80 00 6E 00 32 2E 36 00 00 00 00 00 00"
        " 4C 38",
    ),
]  # fmt: skip


@pytest.mark.parametrize(("command", "wire"), GOLDEN_COMMANDS, ids=lambda v: str(v)[:24])
def test_commands_match_the_reference_bytes(command: Command, wire: str) -> None:
    assert frame(command.data) == bytes.fromhex(wire)
    assert Unframer().feed(bytes.fromhex(wire)) == [command.data]
    assert Command.decode(command.data) == command


@pytest.mark.parametrize(("packet", "wire"), GOLDEN_PACKETS, ids=lambda v: str(v)[:12])
def test_packets_match_the_reference_bytes(packet: Sip | ConfigPac | SyncReply, wire: str) -> None:
    assert frame(packet.data) == bytes.fromhex(wire)
    assert decode(packet.data) == packet


def test_vel2_reads_both_encodings_and_every_pair_survives() -> None:
    for argument in ("3b03fb", "1bfd04"):
        assert Command(COMMAND["VEL2"], bytes.fromhex(argument)).bytes_pair == (-5, 3)
    for high in range(-128, 128):
        for low in (-128, -127, -1, 0, 1, 127):
            assert Command.pair(COMMAND["VEL2"], high, low).bytes_pair == (high, low)


def test_arguments_cut_short_read_as_zero() -> None:
    assert Command(7, b"\x3b").value == 0
    assert Command(7).value == 0
    assert Command(11, b"\x1b\x05").value == -5
    assert Command(3, b"\x2b\x08\x01\x02").text == b"\x01\x02"
    assert Command(3, b"\x2b").text == b""


# Packets from the client and from the robot in each recording, as its README says.
RECORDED = {
    "a_idle": (54, 216), "c_commands": (253, 941), "d_ram": (65, 238), "m_p3dx": (6, 32),
    "m_powerbot": (6, 32), "m_seekur": (6, 32), "p10_badck": (7, 25),
}  # fmt: skip


def rebuilt(command: Command) -> Command:
    """The command made anew out of what was read from it."""
    nul = command.argument[2:].endswith(b"\0") and len(command.argument) == len(command.text) + 3
    if not command.argument:
        return Command.none(command.number)
    if command.argument[0] == ARGUMENT["STRING"]:
        return Command.string(command.number, command.text, nul=nul)
    if len(command.argument) == 3:
        return Command.integer(command.number, command.value)
    return command  # a simulator command: raw bytes


@pytest.mark.parametrize("path", CAPTURES, ids=lambda p: p.stem)
def test_every_recorded_packet_decodes_and_encodes_to_the_same_bytes(path: Path) -> None:
    unframers = {"c2r": Unframer(), "r2c": Unframer()}
    raw = {"c2r": b"", "r2c": b""}
    again = {"c2r": b"", "r2c": b""}
    packets = {"c2r": 0, "r2c": 0}
    for line in path.read_text().splitlines():
        record = json.loads(line)
        way = record["dir"]
        if way == "ev":
            continue
        raw[way] += bytes.fromhex(record["hex"])
        for data in unframers[way].feed(bytes.fromhex(record["hex"]), record["t"] * 1000):
            packets[way] += 1
            packet = decode(data) if way == "r2c" else rebuilt(Command.decode(data))
            assert not isinstance(packet, OtherPacket), f"{path.name} at t={record['t']}: {data.hex()}"
            assert packet.data == data, f"{path.name} at t={record['t']}"
            again[way] += frame(packet.data)
    assert (packets["c2r"], packets["r2c"]) == RECORDED[path.stem]
    damaged = path.stem == "p10_badck"
    assert again["r2c"] == raw["r2c"]
    assert (again["c2r"] == raw["c2r"]) is not damaged
    assert unframers["c2r"].counters.bad_checksum == (1 if damaged else 0)
    assert unframers["r2c"].counters.junk_bytes == 0


def test_stalls_of_the_recorded_ram() -> None:
    stream = Unframer()
    stalled = 0
    for line in (CAPTURES[0].parent / "d_ram.jsonl").read_text().splitlines():
        record = json.loads(line)
        if record["dir"] == "r2c":
            for data in stream.feed(bytes.fromhex(record["hex"])):
                packet = decode(data)
                stalled += isinstance(packet, Sip) and packet.left_stalled and packet.right_stalled
    assert stalled == 61


def test_sip_of_every_cut_decodes_and_round_trips() -> None:
    whole = Sip(sonars=((1, 2), (3, 4)), lat_vel=-5, temperature=-7, charge_percent=80, rest=b"xyz").data
    for end in range(26, len(whole) + 1):
        assert Sip.decode(whole[:end]).data == whole[:end], f"cut at {end}"
    for end in range(1, 26):
        with pytest.raises(PacketError):
            Sip.decode(whole[:end])


def test_config_of_every_cut_decodes_and_round_trips() -> None:
    whole = ConfigPac(
        lat_vel_top=1, lat_acc_top=2, lat_vel_max=3, lat_acc=4, lat_decel=5, charge_threshold=6
    ).data
    for end in range(1, len(whole) + 1):
        assert ConfigPac.decode(whole[:end]).data == whole[:end], f"cut at {end}"


@pytest.mark.parametrize(
    "packet",
    [
        EncoderPac(-5, 7),
        IoPac(b"\x01\x02\x03\x04", b"\x05", (1, 2, 1023)),
        SimStat(flags=2, x_mm=-1000, th_deg=-90, first=b"a", rest=b"r"),
        GyroPac(((512, 30), (600, 31))),
        OtherPacket(0xB0, b"\xfa\xfb\x03"),
    ],
    ids=lambda p: type(p).__name__,
)
def test_other_packets_round_trip(packet: EncoderPac | IoPac | SimStat | GyroPac | OtherPacket) -> None:
    assert decode(packet.data) == packet


def test_no_data_makes_decode_do_worse_than_refuse() -> None:
    rng = random.Random(7)
    for case in range(20_000):
        data = bytes((rng.choice((0x32, 0x33, 0x20, 0x90, 0xF0, 0x98, 0x62, 2, 0x30)),)) + rng.randbytes(
            rng.randrange(60)
        )
        try:
            packet = decode(data)
        except PacketError:
            continue
        assert packet.data == data, f"case {case}"


def test_frame_refuses_what_no_count_can_say() -> None:
    for size in (0, 254):
        with pytest.raises(PacketError):
            frame(bytes(size))
    assert len(frame(bytes(253))) == 258


def _sip_stream(rng: random.Random, count: int) -> list[bytes]:
    return [
        frame(
            Sip(
                x=rng.randrange(65536),
                y=rng.randrange(65536),
                sonars=tuple((rng.randrange(16), rng.randrange(5001)) for _ in range(rng.randrange(7))),
            ).data
        )
        for _ in range(count)
    ]


@pytest.mark.parametrize("damage", ["flip", "delete", "stray FA", "stray FA FB", "junk"])
def test_damage_costs_no_intact_packet_and_invents_none(damage: str) -> None:
    rng = random.Random(damage)
    good = _sip_stream(rng, 1500)
    stream, intact = bytearray(), []
    for k, packet in enumerate(good):
        if k % 10:
            intact.append(packet[3:-2])
        elif damage == "flip":
            where = rng.choice([k for k in range(len(packet)) if k != 2])
            packet = packet[:where] + bytes((packet[where] ^ rng.randrange(1, 256),)) + packet[where + 1 :]
        elif damage == "delete":
            where = rng.randrange(len(packet))
            packet = packet[:where] + packet[where + 1 :]
        else:
            intact.append(packet[3:-2])
            packet = {"stray FA": b"\xfa", "stray FA FB": b"\xfa\xfb", "junk": b"WMS2\r"}[damage] + packet
        stream += packet
    unframer = Unframer()
    found = []
    for k in range(0, len(stream), 7):
        found += unframer.feed(bytes(stream[k : k + 7]), k * 1.04)
    found += unframer.poll(1e9)
    kept = iter(found)
    assert all(packet in kept for packet in intact), "an intact packet is missing or out of order"
    assert len(found) - len(intact) <= len(good) // 10
    assert set(found) <= {packet[3:-2] for packet in good}, "a packet was invented"


def test_a_false_length_delays_by_the_quiet_time_only() -> None:
    packet = frame(Sip(sonars=((1, 2),)).data)
    unframer = Unframer()
    assert unframer.feed(b"\xfa\xfb\x40" + packet, 0) == []
    assert unframer.poll(29) == []
    assert unframer.poll(31) == [packet[3:-2]]
    assert unframer.counters.rescued == 1


def test_an_implausible_length_delays_nothing() -> None:
    packet = frame(Sip().data)
    unframer = Unframer()
    assert unframer.feed(b"\xfa\xfb\xff" + packet, 0) == [packet[3:-2]]


def test_a_long_packet_at_9600_baud_is_waited_for() -> None:
    packet = frame(bytes(range(100, 200)) * 2)
    unframer = Unframer()
    found = []
    for k in range(len(packet)):
        found += unframer.feed(packet[k : k + 1], k * 1.05)
    assert found == [packet[3:-2]]


def test_checksum_of_odd_and_even_data() -> None:
    assert checksum(b"") == 0
    assert checksum(b"\x55") == 0x55
    assert checksum(b"\xff\xff\x00\x01") == 0
    assert checksum(b"\x01\x02\x03") == 0x0101


def test_the_examples_in_the_docstrings_hold() -> None:
    for module, examples in ((hil_sim.arcos, 3), (hil_sim.arcos.framing, 1), (hil_sim.tables, 3)):
        result = doctest.testmod(module)
        assert result.attempted >= examples
        assert result.failed == 0


def test_a_sip_made_quickly_is_the_same_sip() -> None:
    values = {"x": 7, "sonars": ((3, 500),), "battery_x10": 121, "rotvel": -40}
    assert Sip.of(values) == Sip(**values)  # type: ignore[arg-type]
    assert Sip.of({}) == Sip()
    assert hash(Sip.of(values)) == hash(Sip(**values))  # type: ignore[arg-type]
    for hole in ("gripper", "digout", "fault_flags"):
        assert Sip.decode(Sip.of({hole: None}).data) == Sip.decode(Sip(**{hole: None}).data)  # type: ignore[arg-type]
    with pytest.raises(PacketError, match="rotvel = 40000"):
        _ = Sip.of({"rotvel": 40000}).data
