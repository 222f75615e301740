# SPDX-License-Identifier: MIT
"""Rule: the ends of lines change nothing of what a text says: LF, CRLF, CR alone, or blank lines between."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.formats import open_log
from argus_tools.formats.text import LineFeeds, ends_in_returns, first_lines
from forms import ROBOT, SIPS, frames, hexdump_c, joined, od, xxd

TEXTS = {
    "hexdump": hexdump_c(ROBOT),
    "xxd": xxd(ROBOT),
    "od": od(ROBOT),
    "hextext": "".join(f"[12:00:{n % 60:02d}.250] {sip.hex(' ')}\n" for n, sip in enumerate(SIPS)),
    "hexwords": "".join(f"{sip!r}\n" for sip in SIPS),
    "numbers": "".join(f"{byte}\n" for byte in ROBOT),
    "jsonl": "".join(f'{{"t": {n}, "dir": "r2c", "hex": "{sip.hex()}"}}\n' for n, sip in enumerate(SIPS)),
    "candump": "".join(f"({f.t:.6f}) can0 {f.can_id:03X}#{f.data.hex().upper()}\n" for f in frames()),
    "screen": "".join(f"  can0  {f.can_id:03X}   [8]  {f.data.hex(' ').upper()}\n" for f in frames()),
    "can-csv": "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n"
    + "".join(f"{n},{f.can_id:08X},false,Rx,0,8,{f.data.hex(',')},\n" for n, f in enumerate(frames())),
    "asc": "base hex  timestamps absolute\ninternal events logged\n"
    + "".join(f"{n / 100:.6f} 1  {f.can_id:X}  Rx   d 8 {f.data.hex(' ')}\n" for n, f in enumerate(frames())),
    "trc": ";$FILEVERSION=1.1\n;\n"
    + "".join(
        f"{n:>6}) {n:.1f}  Rx  {f.can_id:04X}  8  {f.data.hex(' ')}\n" for n, f in enumerate(frames(), 1)
    ),
}
ENDS: dict[str, Callable[[str], str]] = {
    "LF": lambda text: text,
    "CRLF": lambda text: text.replace("\n", "\r\n"),
    "CR": lambda text: text.replace("\n", "\r"),
    "CR CRLF": lambda text: text.replace("\n", "\r\r\n"),
    "blank lines": lambda text: text.replace("\n", "\n\n"),
    "a comment, CR": lambda text: ("# hall 3\n" + text).replace("\n", "\r"),
    "many comments": lambda text: "# note\n" * 300 + text,
}


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("name", TEXTS)
def test_every_end_of_lines(name: str, end: str, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(ENDS[end](TEXTS[name]), newline="")
    log = open_log(str(path))
    assert joined(log, "r2c") == ROBOT
    assert not log.damage


@pytest.mark.parametrize("size", [1, 2, 3, 7])
def test_a_return_at_the_end_of_a_block_is_one_end_of_a_line(size: int) -> None:
    class Slow(io.BytesIO):
        def read1(self, _size: int | None = -1, /) -> bytes:
            return self.read(size)

    text = b"a\rb\r\nc\r\rd\r"
    assert LineFeeds(Slow(text)).read() == b"a\nb\nc\n\nd\n"  # type: ignore[arg-type]


def test_which_ends_are_returns_alone() -> None:
    assert ends_in_returns(b"a\rb\r")
    assert not ends_in_returns(b"a\r\nb\r\n")
    assert not ends_in_returns(b"a\r\r\nb\r\r\n")
    assert not ends_in_returns(b"progress\rdone\nb\n")


def test_the_first_lines_are_found_behind_any_comments() -> None:
    assert first_lines(b"# note\n" * 5000 + b"fa fb\n") == [b"fa fb"]
