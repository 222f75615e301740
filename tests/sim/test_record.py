# SPDX-License-Identifier: MIT
"""Rule: a recording stays readable whatever is cut off or broken in it, its times are steady, and its recorder
counts what the disk did not take and touches nobody else's file."""

from __future__ import annotations

import errno
import itertools
import os
import random
import re
from pathlib import Path

import pytest

from hil_sim.cli.main import main
from hil_sim.errors import SimError
from hil_sim.record.recording import (
    KEPT,
    MAGIC,
    MAX_BYTES,
    PAYLOAD_MAX,
    SYNC,
    VERSION,
    Decoder,
    Kind,
    Record,
    Recorder,
    Timeline,
    encode,
    encode_clock,
    encode_start,
    is_recording,
)

WALL = 1_700_000_000_000_000


def decode(data: bytes, piece: int = 1 << 20) -> tuple[list[Record], Decoder]:
    decoder = Decoder()
    records = [record for at in range(0, len(data), piece) for record in decoder.feed(data[at : at + piece])]
    return records + list(decoder.finish()), decoder


def sample(count: int = 20) -> list[bytes]:
    rng = random.Random(1)
    out = [encode_start("test", 0, WALL)[:-29], encode_clock(0, WALL)]
    for i in range(count):
        payload = bytes((i,)) + rng.randbytes(rng.randrange(60)) + b"\xa5\xc3" * rng.randrange(3)
        out.append(encode(rng.choice((Kind.FROM_ROBOT, Kind.TO_ROBOT)), i * 50_000, payload))
    return out


def test_the_bytes_of_a_record() -> None:
    assert (
        encode(Kind.TO_ROBOT, (1 << 32) + 0x01020304, b"\xfa\xfb").hex() == "a5c302020004030201fafb8c831c39"
    )


def test_spec_quotes_the_kinds_and_the_limits() -> None:
    text = (Path(__file__).resolve().parents[2] / "SPEC.md").read_text(encoding="utf-8")
    section = text.split("\n## Recording\n")[1].split("\n## ")[0]
    rows = re.findall(r"^\| (\d+) \| ([A-Z_]+) \|", section, re.M)
    assert {name: int(number) for number, name in rows} == {kind.name: kind.value for kind in Kind}
    assert f"at most {PAYLOAD_MAX}" in section
    assert f"sync `{SYNC.hex(' ').upper()}`" in section
    assert f"`{MAGIC.decode()}`, version {VERSION}," in section
    assert f"{MAX_BYTES // 1_000_000} MB" in section
    assert f"FILE.{KEPT} is the last" in section
    header = (Path(__file__).resolve().parents[2] / "hal/include/hal/recorder.h").read_text(encoding="utf-8")
    for kind in Kind:
        assert f"HAL_RECORD_{kind.name} = {kind.value}" in header
    assert f"#define HAL_RECORD_VERSION {VERSION}\n" in header
    assert f"#define HAL_RECORDER_KEPT {KEPT} " in header


def test_records_come_back_in_pieces_of_any_size() -> None:
    parts = sample()
    whole, _ = decode(b"".join(parts))
    assert len(whole) == len(parts)
    assert [encode(r.kind, r.time_us, r.payload) for r in whole] == parts
    for piece in (1, 2, 3, 7, 64, 4096):
        records, decoder = decode(b"".join(parts), piece)
        assert records == whole, piece
        assert decoder.gaps == []


def test_cut_at_every_byte_at_the_end() -> None:
    parts = sample()
    data = b"".join(parts)
    ends = [sum(map(len, parts[: k + 1])) for k in range(len(parts))]
    for cut in range(len(data) + 1):
        records, decoder = decode(data[:cut])
        kept = sum(end <= cut for end in ends)
        assert len(records) == kept, cut
        torn = cut - ([0, *ends][kept])
        assert [(g.length, g.at_end) for g in decoder.gaps] == ([(torn, True)] if torn else []), cut


def test_cut_at_every_byte_and_gone_on_with() -> None:
    parts = sample(8)
    data, after = b"".join(parts), encode_start("test", 5, WALL) + encode(Kind.TO_ROBOT, 9, b"more")
    ends = [0]
    for part in parts:
        ends.append(ends[-1] + len(part))
    for cut in range(len(data) + 1):
        records, _ = decode(data[:cut] + after, 37)
        assert len(records) == sum(end <= cut for end in ends[1:]) + 3, cut
        assert records[-1].payload == b"more"
        assert is_recording(data[:cut] + after), cut
        assert is_recording(bytes(cut) + after), cut


def test_a_flipped_byte_costs_one_record() -> None:
    parts = sample()
    data = b"".join(parts)
    ends = list(itertools.accumulate(map(len, parts)))
    for at in range(len(data)):
        broken = bytearray(data)
        broken[at] ^= 0xFF
        records, decoder = decode(bytes(broken))
        (hit,) = (part for part, end in zip(parts, ends, strict=True) if end - len(part) <= at < end)
        assert len(records) == len(parts) - 1, at
        assert sum(gap.length for gap in decoder.gaps) == len(hit), at


@pytest.mark.parametrize("seed", range(20))
def test_noise_neither_hides_nor_makes_records(seed: int) -> None:
    rng = random.Random(seed)
    parts = sample()
    data, noise = b"", 0
    for part in parts:
        junk = rng.randbytes(rng.randrange(300)).replace(b"\xa5", b"\x5a")
        noise += len(junk)
        data += junk + part
    records, decoder = decode(data, rng.randrange(1, 500))
    assert [encode(r.kind, r.time_us, r.payload) for r in records] == parts
    assert sum(gap.length for gap in decoder.gaps) == noise


def test_times_are_steady_over_wraps_clock_steps_and_restarts() -> None:
    timeline = Timeline()

    def at(kind: int, mono_us: int, payload: bytes = b"") -> float | None:
        return timeline.at(Record(kind, mono_us & 0xFFFFFFFF, payload, 0))

    def clock(mono_us: int, wall_us: int) -> float | None:
        record = encode_clock(mono_us, wall_us)
        return at(Kind.CLOCK, mono_us, record[9:-4])

    assert at(Kind.TO_ROBOT, 5) is None
    start = (3 << 32) - 1_000_000
    assert clock(start, WALL) == WALL / 1e6
    assert at(Kind.TO_ROBOT, start + 1_500_000) == WALL / 1e6 + 1.5  # the low 32 bits have wrapped
    assert at(Kind.TO_ROBOT, start + 1_400_000) == pytest.approx(WALL / 1e6 + 1.4)  # a little back
    assert clock(start + 2_000_000, WALL + 3_600_000_000) == pytest.approx(WALL / 1e6 + 2)  # set by an hour
    assert clock(start + (1 << 34), WALL) == pytest.approx(WALL / 1e6 + (1 << 34) / 1e6)  # hours of silence
    assert clock(7, WALL + 9_000_000) == WALL / 1e6 + 9  # started again, its header lost
    at(Kind.HEADER, 0)
    assert clock(start, WALL + 60_000_000) == WALL / 1e6 + 60


def payloads(path: Path) -> list[bytes]:
    records, decoder = decode(path.read_bytes())
    assert decoder.gaps == []
    assert records[0].kind == Kind.HEADER
    assert records[1].kind == Kind.CLOCK
    return [record.payload for record in records if record.kind in (Kind.FROM_ROBOT, Kind.TO_ROBOT)]


def test_recorder_appends_and_rotates(tmp_path: Path) -> None:
    path = tmp_path / "a.rec"
    said: list[str] = []
    numbers = [i.to_bytes(4, "little") * 10 for i in range(400)]
    for part in (numbers[:200], numbers[200:]):
        recorder = Recorder(path, "test", said.append, max_bytes=4000)
        for data in part:
            recorder.note(Kind.FROM_ROBOT, data)
        recorder.close()
        recorder.close()
    assert said == []
    files = [path, *(tmp_path / f"a.rec.{k}" for k in range(1, 5))]
    assert sorted(tmp_path.iterdir()) == sorted(files)
    assert all(file.stat().st_size <= 4000 for file in files)
    kept = [data for file in reversed(files) for data in payloads(file)]
    assert kept == numbers[-len(kept) :]
    assert len(kept) > 200


def test_a_full_disk_is_said_once_and_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "a.rec"
    said: list[str] = []
    recorder = Recorder(path, "test", said.append)
    real, left = os.write, 100

    def write(fd: int, data: bytes) -> int:
        nonlocal left
        if left <= 0:
            raise OSError(errno.ENOSPC, "No space left on device")
        part = data[:left]
        left -= len(part)
        return real(fd, part)

    monkeypatch.setattr("hil_sim.record.recording.os.write", write)
    for i in range(50):
        recorder.note(Kind.TO_ROBOT, bytes((i,)) * 20)
    left = 1 << 30
    recorder.note(Kind.TO_ROBOT, b"again")
    lost = recorder.lost
    recorder.close()
    assert len(said) == 1
    assert "No space left on device; going on without" in said[0]
    records, decoder = decode(path.read_bytes())
    assert decoder.gaps == []
    kept = sum(len(r.payload) for r in records if r.kind == Kind.TO_ROBOT)
    assert 0 < lost < 50 * 20
    assert kept + lost == 50 * 20 + len(b"again")
    assert [int.from_bytes(r.payload, "little") for r in records if r.kind == Kind.LOST] == [lost]


def test_what_is_no_recording_is_not_touched(tmp_path: Path) -> None:
    letter = tmp_path / "letter"
    letter.write_text("dear mother")
    with pytest.raises(SimError, match="exists and is no recording; name another file"):
        Recorder(letter, "test", print)
    assert letter.read_text() == "dear mother"
    with pytest.raises(SimError, match="No such file"):
        Recorder(tmp_path / "no" / "folder", "test", print)
    with pytest.raises(SimError, match="no regular file"):
        Recorder("/dev/null", "test", print)
    zeros = tmp_path / "zeros"
    zeros.write_bytes(bytes(50))
    Recorder(zeros, "test", print).close()
    assert len(decode(zeros.read_bytes())[0]) == 2
    recorder = Recorder(tmp_path / "a", "test", print)
    with pytest.raises(SimError, match=r"process [0-9]+ records there"):
        Recorder(tmp_path / "a", "test", print)
    recorder.close()


def test_wrong_arguments_of_the_emulator(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    letter = tmp_path / "letter"
    letter.write_text("dear mother")
    assert main(["--tcp", "0", "--record", str(letter), "--duration", "0.1"]) == 2
    assert "exists and is no recording" in capsys.readouterr().err
    with pytest.raises(SystemExit, match="2"):
        main(["--record", "a", "--record-max", "0"])
    assert "give megabytes, 1 to 100000" in capsys.readouterr().err


def test_one_file_for_each_robot(tmp_path: Path) -> None:
    assert (
        main(["--tcp", "0", "--robots", "2", "--record", str(tmp_path / "a.rec"), "--duration", "0.1"]) == 0
    )
    for name in ("a.rec", "a-2.rec"):
        assert payloads(tmp_path / name) == []
