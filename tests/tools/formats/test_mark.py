# SPDX-License-Identifier: MIT
"""Rule: a byte order mark before a text, or before a line where two files were joined, changes nothing of what is read;
bytes that are no text keep theirs."""

from __future__ import annotations

import gzip
import io
from pathlib import Path

import can
import pytest
from argus_tools.formats import Chunk, Damage, ReadOptions, find_format, formats, open_log
from argus_tools.formats.text import BOM
from forms import ROBOT, SIPS, frames, hexdump_c, od, rows, xxd


def of_writer(name: str) -> bytes:
    stream = io.BytesIO()
    make = formats()[name].writer
    assert make is not None
    writer = make(stream, ReadOptions())
    for n, sip in enumerate(SIPS):
        writer.write(Chunk(5.0 + n / 10, "r2c", sip, 0))
    writer.close()
    return stream.getvalue()


def of_python_can(folder: Path, suffix: str) -> bytes:
    path = folder / f"written.{suffix}"
    with can.Logger(str(path)) as logger:
        for frame in frames():
            logger.on_message_received(
                can.Message(
                    timestamp=frame.t, arbitration_id=frame.can_id, is_extended_id=False, data=frame.data
                )
            )
    return path.read_bytes()


def tshark_x() -> str:
    return "\n".join("".join(f"{at:04x}  {part.hex(' ')}\n" for at, part in rows(sip)) for sip in SIPS)


SCREEN = "".join(f"  can0  {f.can_id:03X}   [{len(f.data)}]  {f.data.hex(' ').upper()}\n" for f in frames())
TEXTS = {
    "candump on the screen": SCREEN,
    "hexdump": hexdump_c(ROBOT),
    "tshark -x": tshark_x(),
    "numdump": od(ROBOT, "07o", 1, "5d"),
    "hexwords": "".join(f"Nov 25 17:00:01 host robot[12]: rx {sip.hex(' ')}\n" for sip in SIPS),
    "hextext": "".join(sip.hex(" ") + "\n" for sip in SIPS),
    "hextext on one line": ROBOT.hex(" ") * 100 + "\n",
    "quoted": "".join("> " + line for line in xxd(ROBOT).splitlines(keepends=True)),
}
WRITERS = sorted(n for n, form in formats().items() if form.writer and form.name in ("jsonl", "candump"))
SUFFIXES = ("asc", "trc", "csv", "log", "txt")
NAMES = [*TEXTS, *WRITERS, *SUFFIXES]


@pytest.fixture
def text(request: pytest.FixtureRequest, tmp_path: Path) -> bytes:
    name = str(request.param)
    if name in TEXTS:
        return TEXTS[name].encode()
    return of_writer(name) if name in WRITERS else of_python_can(tmp_path, name)


def read(path: Path, data: bytes, form: str | None = None) -> tuple[str, list[Chunk], list[Damage]]:
    path.write_bytes(data)
    log = open_log(str(path), form)
    return log.format.name, list(log), log.damage


@pytest.mark.tour(8, 16)
@pytest.mark.parametrize("text", NAMES, indirect=True)
@pytest.mark.parametrize("ends", [b"\n", b"\r\n"])
def test_a_mark_at_the_head_changes_nothing(text: bytes, ends: bytes, tmp_path: Path) -> None:
    data = text.replace(b"\r\n", b"\n").replace(b"\n", ends)
    plain = read(tmp_path / "log", data)
    assert len(plain[1]) > 0
    assert read(tmp_path / "log", BOM + data) == plain
    assert read(tmp_path / "log", gzip.compress(BOM + data)) == plain


@pytest.mark.parametrize("text", [name for name in NAMES if name != "quoted"], indirect=True)
def test_nor_where_the_form_is_given(text: bytes, tmp_path: Path) -> None:
    plain = read(tmp_path / "log", text)
    assert read(tmp_path / "log", BOM + text, plain[0]) == plain


@pytest.mark.tour(5)
@pytest.mark.parametrize("text", NAMES, indirect=True)
def test_nor_where_two_two_files_were_joined(text: bytes, tmp_path: Path) -> None:
    plain = read(tmp_path / "log", text + text)
    assert read(tmp_path / "log", BOM + text + BOM + text) == plain
    assert read(tmp_path / "log", text + BOM + text) == plain


@pytest.mark.parametrize("at", range(4))
def test_a_mark_across_the_blocks_of_a_file_is_one(at: int, tmp_path: Path) -> None:
    line = (SIPS[0].hex(" ") + "\n").encode()
    before = line * ((1 << 17) // len(line))
    before = b" " * ((1 << 17) - at - len(before)) + before
    name, chunks, damage = read(tmp_path / "log", before + BOM + line, "hextext")
    assert (name, damage) == ("hextext", [])
    assert b"".join(chunk.data for chunk in chunks).endswith(SIPS[0] * 2)


def test_raw_bytes_keep_theirs(tmp_path: Path) -> None:
    data = BOM + ROBOT + b"\n" + BOM + ROBOT
    _, chunks, _ = read(tmp_path / "log", data)
    assert b"".join(chunk.data for chunk in chunks) == data


def test_a_form_is_found_behind_it() -> None:
    assert find_format(BOM + of_writer("candump")).name == "candump"
