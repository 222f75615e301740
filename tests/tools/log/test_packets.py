# SPDX-License-Identifier: MIT
"""The log reader finds exactly the packets that the robot's parser finds, says where the rest is, and names them."""

from __future__ import annotations

import itertools
import random
import re
from collections.abc import Callable

import pytest
from argus_tools.chunks import Direction
from argus_tools.formats import Chunk, open_log
from argus_tools.log.packets import Row, packets
from logs import CAPTURES, capture_bytes, command, sip

from hil_sim.arcos import Sip, Unframer, frame

FILES = sorted(path.stem for path in CAPTURES.glob("*.jsonl"))


def scan(data: bytes, pieces: int = 1, seed: int = 0) -> list[Row]:
    """Scan bytes from a robot that come in so many pieces."""
    cuts = sorted(random.Random(seed).randrange(len(data) + 1) for _ in range(pieces - 1))
    edges = [0, *cuts, len(data)]
    chunks = [Chunk(None, "r2c", data[a:b], a) for a, b in itertools.pairwise(edges)]
    return list(packets(chunks))


Sent = tuple[Direction, bytes]


def names(*sent: Sent) -> list[str]:
    return [row.type for row in packets(Chunk(None, direction, data, 0) for direction, data in sent)]


def readme_counts() -> dict[str, tuple[int, int]]:
    counts = {}
    for line in (CAPTURES / "README.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) == 6 and re.match(r"\d+( each)?$", cells[3]):
            for name in cells[1].split(", "):
                counts[name] = (int(cells[3].split()[0]), int(cells[4].split()[0]))
    return counts


@pytest.mark.parametrize("name", FILES)
def test_captures_decode_as_their_readme_counts(name: str) -> None:
    good = [row.dir for row in packets(open_log(str(CAPTURES / f"{name}.jsonl"))) if row.ok]
    assert (good.count("c2r"), good.count("r2c")) == readme_counts()[name]


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("direction", ["c2r", "r2c"])
def test_rows_give_back_the_bytes_of_the_capture(name: str, direction: str) -> None:
    path = CAPTURES / f"{name}.jsonl"
    rows = [row for row in packets(open_log(str(path))) if row.dir == direction]
    whole = capture_bytes(path, direction)
    assert b"".join(row.wire for row in rows) == whole
    assert all(whole[row.offset :].startswith(row.wire) for row in rows)


def test_only_one_capture_is_damaged() -> None:
    damaged = {
        name for name in FILES if any(not r.ok for r in packets(open_log(str(CAPTURES / f"{name}.jsonl"))))
    }
    assert damaged == {"p10_badck"}


def stream(count: int, seed: int) -> list[bytes]:
    rng = random.Random(seed)
    return [
        sip(
            type=rng.choice((0x32, 0x33)),
            x=rng.randrange(65536),
            th=rng.randrange(-2048, 2049),
            flags=1,
            sonars=tuple((n, rng.randrange(200, 5001)) for n in rng.sample(range(16), rng.randrange(4))),
        )
        for _ in range(count)
    ]


DAMAGE: dict[str, Callable[[random.Random, bytes], bytes]] = {
    "any byte flipped": lambda rng, p: bytes(
        b ^ (rng.randrange(1, 256) if i == at else 0)
        for at in [rng.randrange(len(p))]
        for i, b in enumerate(p)
    ),
    "a byte deleted": lambda rng, p: (lambda at: p[:at] + p[at + 1 :])(rng.randrange(len(p))),
    "stray FA before": lambda rng, p: b"\xfa" + p,
    "stray FA FB before": lambda rng, p: b"\xfa\xfb" + p,
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damage_never_takes_an_intact_packet_with_it(kind: str) -> None:
    rng = random.Random(kind)
    whole = stream(1000, 5)
    hit = [DAMAGE[kind](rng, p) if n % 10 == 5 else p for n, p in enumerate(whole)]
    rows = scan(b"".join(hit))
    found = [row.wire for row in rows if row.ok]
    intact = [p for n, p in enumerate(whole) if n % 10 != 5 or kind.startswith("stray")]
    assert found == intact
    assert any(not row.ok for row in rows)


def test_a_wrong_length_byte_costs_at_most_its_own_packet() -> None:
    rng = random.Random(6)
    whole = stream(1000, 6)
    hit = [p[:2] + bytes((rng.randrange(256),)) + p[3:] if n % 10 == 5 else p for n, p in enumerate(whole)]
    found = [row.wire for row in scan(b"".join(hit)) if row.ok]
    intact = [p for n, p in enumerate(whole) if n % 10 != 5]
    lost = sum(p not in set(found) for p in intact)
    bogus = sum(p not in set(whole) for p in found)
    assert lost <= 1
    assert bogus <= 1


def mutated(seed: int) -> bytes:
    rng = random.Random(seed)
    data = bytearray(b"".join(stream(4, seed)) + command("VEL", 300) + frame(bytes((0x20, *b"ab\0cd\0"))))
    for _ in range(rng.randrange(4)):
        at = rng.randrange(len(data))
        action = rng.randrange(4)
        if action == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif action == 1:
            del data[at]
        elif action == 2:
            data[at:at] = rng.choice((b"\xfa", b"\xfa\xfb", rng.randbytes(5)))
        else:
            data[at : at + 3] = b"\xfa\xfb" + bytes((rng.randrange(256),))
    return bytes(data)


@pytest.mark.parametrize("first", range(0, 2000, 500))
def test_agrees_with_the_emulators_parser_on_mutated_streams(first: int) -> None:
    for seed in range(first, first + 500):
        data = mutated(seed)
        unframer = Unframer()
        expected = unframer.feed(data) + unframer.poll(1e9)
        rows = scan(data)
        assert [row.data for row in rows if row.ok] == expected, f"seed {seed}"
        assert b"".join(row.wire for row in rows) == data, f"seed {seed}"
        assert all(data[r.offset :].startswith(r.wire) for r in rows), f"seed {seed}"


@pytest.mark.parametrize("seed", range(40))
def test_how_the_bytes_arrive_does_not_matter(seed: int) -> None:
    data = b"".join(stream(30, seed)) + b"junk" + b"".join(stream(3, seed + 1))
    whole = [(row.offset, row.wire, row.ok) for row in scan(data) if row.ok]
    assert [(row.offset, row.wire, row.ok) for row in scan(data, 40, seed) if row.ok] == whole


def test_damage_says_what_is_wrong_and_where() -> None:
    bad = bytearray(command("SONAR", 0))
    bad[-1] ^= 0xFF
    rows = list(packets([Chunk(1.0, "c2r", command("VEL", 5) + bytes(bad) + b"xyz" + command("STOP"), 0)]))
    assert [(row.type, row.ok, row.offset) for row in rows] == [
        ("VEL", True, 0),
        ("SONAR", False, 9),
        ("JUNK", False, 18),
        ("STOP", True, 21),
    ]
    assert "checksum" in rows[1].error
    assert "3 bytes" in rows[2].error


def test_a_packet_cut_at_the_end_is_damage() -> None:
    rows = scan(sip() + sip()[:20])
    assert [row.ok for row in rows] == [True, False]
    assert "20 of" in rows[1].error


def test_much_junk_is_reported_in_parts() -> None:
    rows = scan(sip() + bytes(300_000) + sip())
    assert rows[0].ok
    assert rows[-1].ok
    assert all(len(row.data) <= 1 << 17 for row in rows)
    assert sum(len(row.wire) for row in rows) == 2 * len(sip()) + 300_000


def test_syncs_become_pulse_open_close_when_the_handshake_ends() -> None:
    shake: list[Sent] = [("c2r", command(f"SYNC{n}")) for n in range(3)]
    rest: list[Sent] = [("c2r", command(name)) for name in ("OPEN", "PULSE", "VEL", "PULSE", "CLOSE")]
    again: list[Sent] = [
        *shake,
        ("c2r", command("OPEN")),
        ("c2r", command("PULSE")),
        ("c2r", command("STOP")),
    ]
    expected = ["SYNC0", "SYNC1", "SYNC2", "OPEN"]
    assert names(*shake, *rest, *again) == [
        *expected,
        "PULSE",
        "VEL",
        "PULSE",
        "CLOSE",
        *expected,
        "PULSE",
        "STOP",
    ]


@pytest.mark.parametrize("first", ["PULSE", "OPEN", "CLOSE"])
def test_a_log_that_starts_mid_session_is_open(first: str) -> None:
    assert names(("r2c", sip()), ("c2r", command(first)), ("r2c", sip())) == ["SIP", first, "SIP"]
    assert names(("c2r", command(first)), ("r2c", sip())) == [first, "SIP"]
    assert names(("c2r", command(first)), ("c2r", command("VEL", 1)))[0] == first


def test_answers_settle_a_handshake_that_begins_in_an_open_log() -> None:
    sent: list[Sent] = [
        ("r2c", sip()),
        ("c2r", command("SYNC0")),
        ("r2c", command("SYNC0")),
        ("c2r", command("SYNC1")),
    ]
    assert names(*sent) == ["SIP", "SYNC0", "SYNC0", "SYNC1"]


def test_a_robot_that_never_answers_is_knocked_at_with_sync0() -> None:
    knock: Sent = ("c2r", command("SYNC0"))
    assert names(*[knock] * 40) == ["SYNC0"] * 40


def test_unknown_numbers_have_numbered_names() -> None:
    assert names(("r2c", frame(b"\x77")), ("c2r", frame(b"\x63"))) == ["TYPE_119", "CMD_99"]
    assert names(("r2c", frame(Sip(type=0x33).data)), ("r2c", frame(b"\xb0hi"))) == ["SIP", "SERAUXPAC"]


def test_damage_has_the_time_of_the_chunk_in_which_it_begins() -> None:
    good = frame(b"\x32" + bytes(10))
    bad = good[:-1] + bytes((good[-1] ^ 1,))
    chunks = [
        Chunk(10.0, "r2c", good, 0),
        Chunk(20.0, "r2c", bad, len(good)),
        Chunk(90.0, "r2c", good, 2 * len(good)),
    ]
    for at_once in (True, False):
        assert [(row.t, row.ok) for row in packets(chunks, at_once)] == [
            (10.0, True),
            (20.0, False),
            (90.0, True),
        ]
