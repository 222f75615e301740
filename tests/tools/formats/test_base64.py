# SPDX-License-Identifier: MIT
"""Rule: base64 is told wherever it stands in a text, with a command that gets the very bytes out of it."""

from __future__ import annotations

import base64
import gzip
import subprocess
import textwrap
from pathlib import Path

import pytest
from argus_tools.formats import open_log
from forms import ROBOT, SIPS, frames, hexdump_c, joined, xxd
from logs import run

TEXT = base64.encodebytes(ROBOT).decode()
ONE_LINE = base64.b64encode(ROBOT).decode()
PROSE = "The robot fell silent beside the door.\nWhat it sent, as I saved it:\n"
CANDUMP = "".join(f"({f.t:.6f}) can0 {f.can_id:03X}#{f.data.hex().upper()}\n" for f in frames())
TEXTS: dict[str, str] = {
    "alone": TEXT,
    "in one line": ONE_LINE,
    "in lines of 64": "\n".join(textwrap.wrap(ONE_LINE, 64)) + "\n",
    "in lines of 75": "\n".join(textwrap.wrap(ONE_LINE, 75)) + "\n",
    "a line for each packet": "".join(base64.b64encode(sip).decode() + "\n" for sip in SIPS),
    "CRLF": TEXT.replace("\n", "\r\n"),
    "a mark before it": "\ufeff" + PROSE + TEXT,
    "below prose": PROSE + "\n" + TEXT,
    "close to prose": PROSE + TEXT + "Thanks to all.\n",
    "a word above": "Capture:\nHere\nagain\n" + TEXT,
    "below much prose": PROSE * 150 + "\n" + TEXT + "\n" + PROSE,
    "in a mail": (
        "MIME-Version: 1.0\nContent-Type: application/octet-stream\nContent-Transfer-Encoding: base64\n\n"
        + TEXT
        + "\n--b1--\n"
    ),
    "between marks": "-----BEGIN LOG-----\n" + TEXT + "-----END LOG-----\n",
    "as uuencode -m writes it": "begin-base64 644 drive.bin\n" + TEXT + "====\n",
    "quoted": "".join(f"> {line}\n" for line in TEXT.splitlines()) + "Yes.\n",
    "indented": PROSE + textwrap.indent(TEXT, "    "),
    "behind times": "".join(
        f"[06:38:{n:02}.123] RX: {base64.b64encode(sip).decode()}\n" for n, sip in enumerate(SIPS)
    ),
    "as values": "".join(f'  - data: "{base64.b64encode(sip).decode()}"\n' for sip in SIPS),
    "in an address": "data:application/octet-stream;base64," + ONE_LINE + "\n",
    "of the web": base64.urlsafe_b64encode(ROBOT).decode() + "\n",
    "of the web, in lines below prose": (
        PROSE + "\n".join(textwrap.wrap(base64.urlsafe_b64encode(ROBOT).decode(), 76)) + "\n"
    ),
    "without its filling": ONE_LINE.rstrip("=") + "\n",
}


def told(path: Path) -> str:
    """The command that argus-log names."""
    done = run("decode", path)
    message = done.stderr.decode()
    assert (done.returncode, done.stdout, message.count("\n")) == (2, b"", 1), message
    assert "looks like base64 of a robot's link" in message
    return message.rpartition("; ")[2].strip()


@pytest.mark.parametrize("is_zipped", [False, True])
@pytest.mark.parametrize("name", TEXTS)
def test_the_command_gets_the_bytes_out(name: str, is_zipped: bool, tmp_path: Path) -> None:
    path = tmp_path / ("it's mine.txt.gz" if is_zipped else "it's mine.txt")
    data = TEXTS[name].encode()
    path.write_bytes(gzip.compress(data) if is_zipped else data)
    subprocess.run(told(path), shell=True, cwd=tmp_path, check=False, stderr=subprocess.DEVNULL)
    assert ROBOT in (tmp_path / "drive.bin").read_bytes()
    assert len((tmp_path / "drive.bin").read_bytes()) <= len(ROBOT) + 12


def test_a_cut_end_costs_no_more_than_itself(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(PROSE + TEXT[:-30])
    subprocess.run(told(path), shell=True, cwd=tmp_path, check=False, stderr=subprocess.DEVNULL)
    assert (tmp_path / "drive.bin").read_bytes().startswith(ROBOT[:-30])


def test_a_long_one_is_taken_up_to_its_end(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(PROSE + base64.encodebytes(ROBOT * 300).decode())
    subprocess.run(told(path), shell=True, cwd=tmp_path, check=True)
    assert (tmp_path / "drive.bin").read_bytes() == ROBOT * 300


@pytest.mark.parametrize("log", [gzip.compress(ROBOT), CANDUMP.encode()])
def test_a_log_of_another_form_in_base64(log: bytes, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(PROSE + "\n" + base64.encodebytes(log).decode())
    subprocess.run(told(path), shell=True, cwd=tmp_path, check=True)
    assert joined(list(open_log(str(tmp_path / "drive.bin"))), "r2c") == ROBOT


@pytest.mark.parametrize(
    "text", [hexdump_c(ROBOT), xxd(ROBOT), ROBOT.hex(), "".join(f"{s.hex()}\n" for s in SIPS)]
)
def test_hexadecimal_digits_are_none(text: str, tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text(text)
    assert joined(list(open_log(str(tmp_path / "a.txt"))), "r2c") == ROBOT


@pytest.mark.parametrize(
    "words", ["sonar\n" * 200, "Abcd1234\n" * 200, PROSE * 100, "A" * 60000, "====\n" * 99]
)
def test_words_that_only_look_so(words: str, tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text(words)
    done = run("decode", tmp_path / "a.txt")
    assert (done.returncode, b"base64" in done.stderr) == (2, False)
