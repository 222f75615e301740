# SPDX-License-Identifier: MIT
"""Rule: what is not read is answered in one line: what it looks like, what was expected, and the command that helps."""

from __future__ import annotations

import base64
import gzip
import io
import quopri
import random
import sqlite3
import subprocess
import tarfile
from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.chunks import copy
from argus_tools.formats import Chunk, LogError, ReadOptions, find_format, formats, forms, open_log
from forms import ROBOT, hexdump_c, joined, od, xxd
from logs import CAPTURES, run, sip

SEVEN = bytes(byte & 0x7F for byte in ROBOT)
OD_A = "0000000   z   {   6   2 nul nul soh stx  sp   P   3   D  ff  cr\n" * 3
OD_F = "0000000     3.65899e-40  -2.5961484e+36   2.3510613e-38\n0000014   8.6289866e+14    5.587976e-08\n"
OTHERS: dict[str, tuple[bytes, str, str]] = {
    "mf4": (b"MDF     4.11    ", "MDF measurement", "candump -L"),
    "rosbag": (b"#ROSBAG V1.2\n", "ROS bag of a version before 2.0", "rosbag fix"),
    "zip": (b"PK\x03\x04rest", "ZIP", "unzip -p"),
    "xz": (b"\xfd7zXZ\0\0\4", "xz", "xz -dc"),
    "zstd": (b"\x28\xb5\x2f\xfd\0\0", "zstd", "zstd -dc"),
    "bzip2": (b"BZh91AY&SY", "bzip2", "bzip2 -dc"),
    "elf": (b"\x7fELF\2\1\1", "a program", "give the log"),
    "png": (b"\x89PNG\r\n\x1a\n", "a picture", "give the log"),
    "html": (b"<!DOCTYPE html>\n<html>", "web page", "save the file itself"),
    "snoop": (b"snoop\0\0\0\0\0\0\2", "snoop", "editcap"),
    "modified pcap": (b"\x34\xcd\xb2\xa1\2\0\4\0", "modified", "editcap"),
    "tcpdump": (
        b"06:38:47.479113 IP 127.0.0.1.50000 > 127.0.0.1.8101: Flags [P.], length 6\n",
        "tcpdump",
        "-w robot.pcap",
    ),
    "tcpdump -x": (b"06:38:47 IP a > b\n\t0x0000:  4500 003a 0001\n", "tcpdump -x", "-w robot.pcap"),
    "tshark": (
        b"    1 0.000000000              \xe2\x86\x92              CAN 32 ID: 1608\n",
        "tshark",
        "-w can0.pcapng",
    ),
    "strace": (b'read(3, "\\372\\373\\3\\0\\0\\0", 32) = 6\n', "strace", "argusd --record"),
    "slcan": (b"t64080606FAFB03000000\rt64880606FAFB03000000\r", "slcan", "candump -L"),
    "Intel HEX": (b":10000000FAFB0300000000\n:00000001FF\n", "Intel HEX", "objcopy"),
    "S-records": (b"S1130000FAFB03000000\nS9030000FC\n", "S-records", "objcopy"),
    "od -a": (OD_A.encode(), "od -a", "od -v -t x1"),
    "od -t f4": (OD_F.encode(), "no bytes", "od -v -t x1"),
    "gzip in gzip": (gzip.compress(gzip.compress(ROBOT)), "gzip file in a gzip file", "gzip -dc"),
    "follow stream, ASCII": (b"\n====\nFollow: tcp,ascii\nFilter: x\n...2..\n", "follow stream", "tcp,hex,0"),
    "follow stream, YAML": (b"peers:\n  - peer: 0\n    host: 127.0.0.1\n", "follow stream", "tcp,hex,0"),
    "question marks": (bytes(b if b < 128 else 63 for b in ROBOT), "question marks", "save as binary"),
    "no zeros": (ROBOT.replace(b"\0", b""), "without its zeros", "save as binary"),
    "quoted-printable": (quopri.encodestring(ROBOT), "quoted-printable", "quopri -d"),
    "argus-log decode": (
        b"           t    offset  dir  type         content\n",
        "argus-log decode",
        "made from",
    ),
    "base64": (base64.encodebytes(ROBOT), "base64", "base64 -d"),
    "netmon": (b"GMBU\0\2\1\0", "Network Monitor", "editcap"),
    "tshark -T fields": (
        b"".join(b"1795577927.479113000\t%d\t%s\n" % (n, ROBOT.hex().encode()) for n in (8101, 46292)),
        "tshark -T fields",
        "give the capture",
    ),
    "seven bits": (SEVEN, "highest bit", "8 data bits"),
}


def refusal(path: Path) -> str:
    """What argus-log says of a file that it does not read: one line, no output, code 2."""
    done = run("decode", path)
    message = done.stderr.decode()
    assert (done.returncode, done.stdout, message.count("\n")) == (2, b"", 1), message
    return message


@pytest.mark.parametrize("name", OTHERS)
def test_each_is_told_by_its_name_with_the_remedy(name: str, tmp_path: Path) -> None:
    data, what, remedy = OTHERS[name]
    path = tmp_path / "a file.log"
    path.write_bytes(data)
    message = refusal(path)
    assert f"{path}: looks like " in message
    assert "expected a log of a robot's link" in message
    assert what in message
    assert remedy in message


def test_an_sqlite_database_and_a_tar_archive(tmp_path: Path) -> None:
    with sqlite3.connect(tmp_path / "a.db") as database:
        database.execute("create table messages (ts real)")
    assert "can.logconvert" in refusal(tmp_path / "a.db")
    with tarfile.open(tmp_path / "a.tar", "w") as archive:
        archive.add(CAPTURES / "m_p3dx.jsonl", "a.jsonl")
    assert "tar -xOf" in refusal(tmp_path / "a.tar")


@pytest.mark.parametrize("is_zipped", [False, True])
@pytest.mark.parametrize("encode", [base64.encodebytes, quopri.encodestring])
def test_the_remedy_can_be_pasted(encode: Callable[[bytes], bytes], is_zipped: bool, tmp_path: Path) -> None:
    path = tmp_path / ("it's mine.txt.gz" if is_zipped else "it's mine.txt")
    path.write_bytes(gzip.compress(encode(ROBOT)) if is_zipped else encode(ROBOT))
    command = refusal(path).rpartition("; ")[2].strip()
    subprocess.run(command, shell=True, cwd=tmp_path, check=True)
    assert (tmp_path / "drive.bin").read_bytes() == ROBOT


RECODED = {
    "UTF-8 of Latin-1": (ROBOT.decode("latin-1").encode(), True),
    "UTF-8 of code page 437": (ROBOT.decode("cp437").encode(), True),
    "UTF-8 of Mac": (ROBOT.decode("mac_roman").encode(), False),
    "UTF-8 with a mark": (b"\xef\xbb\xbf" + ROBOT.decode("latin-1").encode(), True),
    "UTF-16": (ROBOT.decode("latin-1").encode("utf-16"), True),
    "UTF-16 without a mark": (ROBOT.decode("latin-1").encode("utf-16-le"), True),
    "UTF-16, big-endian without a mark": (ROBOT.decode("latin-1").encode("utf-16-be"), True),
    "UTF-16, big-endian": (b"\xfe\xff" + ROBOT.decode("latin-1").encode("utf-16-be"), True),
    "UTF-8 with what could not be read": (ROBOT.decode("utf-8", "replace").encode(), False),
    "UTF-8 of Latin-1, ends of lines changed": (
        ROBOT.replace(b"\0", b"\r\n").decode("latin-1").encode(),
        False,
    ),
}


@pytest.mark.parametrize("is_zipped", [False, True])
@pytest.mark.parametrize("name", RECODED)
def test_recoded_bytes_are_told_and_what_gets_them_back(name: str, is_zipped: bool, tmp_path: Path) -> None:
    data, is_whole = RECODED[name]
    path = tmp_path / "a.log"
    path.write_bytes(gzip.compress(data) if is_zipped else data)
    message = refusal(path)
    assert "saved as UTF-" in message
    assert "record as binary" in message
    assert ("iconv" in message) == is_whole
    if is_whole:
        command = next(part for part in message.split("; ") if "iconv" in part).partition(" gets ")[0]
        subprocess.run(command, shell=True, cwd=tmp_path, check=True)
        assert ROBOT in (tmp_path / "drive.bin").read_bytes()


@pytest.mark.parametrize("name", ["bin", "record", "pcap", "pcapng", "blf"])
def test_bytes_that_a_text_transfer_changed_are_told(name: str, tmp_path: Path) -> None:
    sips = [sip(x=n, th=10 * n, sonars=((1, 0x0A0A), (2, 2570 + n))) for n in range(40)]
    data = b"".join(sips)
    if name != "bin":
        form, out = formats().get(name), io.BytesIO()
        if form is None or form.writer is None:
            data = b"LOGG" + data
        else:
            copy(
                [Chunk(float(n), "r2c", part, 0) for n, part in enumerate(sips)],
                form.writer(out, ReadOptions()),
            )
            data = out.getvalue()
    path = tmp_path / "a b.bin"
    path.write_bytes(data.replace(b"\n", b"\r\n"))
    log = open_log(str(path))
    assert "recoded by a text transfer (LF became CRLF): undone" in log.damage[0].what
    undone = [] if name == "blf" else list(log)  # of the BLF there is only the mark
    path.write_bytes(data)
    plain = open_log(str(path))
    assert not any("text transfer" in entry.what for entry in plain.damage)
    assert undone == ([] if name == "blf" else list(plain))
    assert name == "blf" or b"".join(chunk.data for chunk in undone) == b"".join(sips)


def test_text_with_carriage_returns_is_none_of_it(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_bytes(hexdump_c(ROBOT).replace("\n", "\r\n").encode())
    assert open_log(str(tmp_path / "a.txt")).damage == []


@pytest.mark.parametrize(
    "text", [hexdump_c(ROBOT), "(1.0) can0 648#02AB\n" * 20, '{"t": 1, "dir": "r2c", "hex": "fafb"}\n' * 9]
)
@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_text_of_utf_16_is_told(text: str, encoding: str, tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_bytes(text.encode(encoding))
    assert "-t UTF-8" in refusal(tmp_path / "a.txt")


def test_a_real_capture_is_never_taken_for_another_form() -> None:
    for path in CAPTURES.glob("*.jsonl"):
        assert open_log(str(path)).format.name == "jsonl"
        for direction in ("r2c", "c2r"):
            data = b"".join(chunk.data for chunk in open_log(str(path)) if chunk.dir == direction)
            for start in range(0, min(len(data), 2000), 37):
                assert find_format(data[start:]).name == "bin", (path.name, direction, start)


def test_speeds_that_look_like_a_recoded_header_are_none(tmp_path: Path) -> None:
    path = tmp_path / "a.bin"
    path.write_bytes(b"".join(sip(x=n, left_vel=250, right_vel=251) for n in range(50)))
    assert open_log(str(path)).format.name == "bin"


@pytest.mark.parametrize(
    "name", ["candump", "hexdump", "xxd", "od", "hextext", "asc", "trc", "csv", "python-can"]
)
def test_zeros_that_a_power_cut_left_are_told_and_the_rest_is_read(name: str, tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.write_bytes(SEEDS[name])
    good = open_log(str(path))
    expected = joined(list(good), "r2c") + joined(list(open_log(str(path))), "c2r")
    path.write_bytes(SEEDS[name] + bytes(5000) + b"\n")
    log = open_log(str(path))
    assert log.format.name == good.format.name
    chunks = list(log)
    assert joined(chunks, "r2c") + joined(chunks, "c2r") == expected
    assert log.damage or name == "asc"


def test_names_are_unique_and_unread_forms_cannot_be_chosen() -> None:
    names = [form.name for form in forms()]
    assert len(names) == len(set(names))
    assert set(formats()) == {form.name for form in forms() if form.is_read}
    assert run("decode", "--format", "zip", CAPTURES / "a_idle.jsonl").returncode == 2


SEEDS: dict[str, bytes] = {
    "candump": b"".join(b"   can0  648   [8]  06 FA FB 03 00 00 00 CC\n" for _ in range(30)),
    "hexdump": hexdump_c(ROBOT).encode(),
    "xxd": xxd(ROBOT).encode(),
    "od": od(ROBOT, "07o", 2, "06o").encode(),
    "hextext": b"".join(b"[06:38:47.5] RX: FA FB 03 00 00 00\n" for _ in range(30)),
    "asc": b"date Wed Nov 25 06:38:47 am 2026\nbase hex  timestamps absolute\n"
    + b" 0.1 1 648 Rx d 3 02 FA FB\n" * 20,
    "trc": b";$FILEVERSION=1.1\n;$STARTTIME=1\n" + b" 1) 10.1 Rx 0648 3 02 FA FB\n" * 20,
    "blf": b"LOGG" + bytes(200),
    "csv": b"Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2\n" + b"100,00000648,false,Rx,0,2,01,FA\n" * 20,
    "python-can": b"Timestamp: 1.0 ID: 648 S Rx DL: 2 01 fa Channel: 0\n" * 20,
    "journal": b"Nov 25 06:38:47 hall candump[1]: (1.0) can0 648#06FAFB03000000CC\n" * 30,
    "ticket": b"It fell silent beside the door.\n" * 70 + b"(1.0) can0 648#06FAFB03000000CC\n" * 30,
    "tshark-json": b'{"timestamp":"1","layers":{"can":{"can_can_id":"1608"},'
    b'"data":{"data_data_data":"06:fa:fb:03:00:00:00"}}}\n' * 20,
    "base64": b"The capture:\n" + base64.encodebytes(ROBOT),
    "utf8": ROBOT.decode("latin-1").encode(),
}


@pytest.mark.tour(66, 132)
@pytest.mark.parametrize("name", SEEDS)
@pytest.mark.parametrize("seed", range(60))
def test_random_damage_of_any_form_is_no_crash(name: str, seed: int, tmp_path: Path) -> None:
    rng = random.Random(f"{name} {seed}")
    data = bytearray(SEEDS[name])
    for _ in range(rng.randrange(1, 12)):
        at = rng.randrange(len(data))
        action = rng.randrange(4)
        if action == 0:
            data[at] = rng.randrange(256)
        elif action == 1:
            del data[at : at + rng.randrange(1, 40)]
        elif action == 2:
            data[at:at] = rng.randbytes(rng.randrange(1, 40))
        else:
            data[at:at] = rng.choice((b"\n", b"*\n", b"#", b"\0", b"\xff" * 9, b"9" * 30, b"-", b","))
        data = data or bytearray(b"x")
    path = tmp_path / "a.log"
    path.write_bytes(data)
    try:
        for chunk in open_log(str(path)):
            assert isinstance(chunk.data, bytes)
    except LogError as error:
        if len(str(error).splitlines()) != 1:
            raise


@pytest.mark.parametrize("name", SEEDS)
def test_the_same_through_a_pipe(name: str, tmp_path: Path) -> None:
    path = tmp_path / "a.log"
    path.write_bytes(SEEDS[name])
    whole, piped = run("decode", "--json", path), run("decode", "--json", "-", stdin=SEEDS[name])
    assert (piped.returncode, piped.stdout) == (whole.returncode, whole.stdout)
