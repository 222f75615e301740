# SPDX-License-Identifier: MIT
"""Rule: a table of CAN frames is read in CAN FD, too, and in whatever a spreadsheet of another country made of it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.formats import Log, open_log
from forms import (
    CLIENT,
    COMMANDS,
    ID_FROM_ROBOT,
    ID_TO_ROBOT,
    ROBOT,
    SIPS,
    START_S,
    CanFrame,
    frames,
    joined,
    read,
)

Row = Callable[[int, CanFrame], str]
HEADINGS = "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8"


def fd_frames() -> list[CanFrame]:
    """The session in frames of CAN FD: a message in each, with its length in a second byte where it is long."""
    out = []
    for n, pair in enumerate(zip(SIPS, COMMANDS, strict=True)):
        for data, can_id in zip(pair, (ID_FROM_ROBOT, ID_TO_ROBOT), strict=True):
            head = bytes((len(data),)) if len(data) < 8 else bytes((0, len(data)))
            body = head + data
            size = next(size for size in (8, 12, 16, 20, 24, 32, 48, 64) if size >= len(body))
            out.append(CanFrame(round(START_S + 0.1 * n, 6), can_id, body.ljust(size, b"\xcc")))
    return out


CODES = {8: 8, 12: 9, 16: 10, 20: 11, 24: 12, 32: 13, 48: 14, 64: 15}


def cells(frame: CanFrame, least: int = 0) -> str:
    return ",".join([*(f"{byte:02X}" for byte in frame.data), *[""] * (least - len(frame.data))])


FD: dict[str, tuple[str, Row]] = {
    "SavvyCAN, headings of eight": (
        HEADINGS,
        lambda n, f: f"{f.t * 1e6:.0f},{f.can_id:08X},false,Rx,0,{len(f.data)},{cells(f)},",
    ),
    "SavvyCAN, without Dir": (
        HEADINGS.replace("Dir,", ""),
        lambda n, f: f"{f.t * 1e6:.0f},{f.can_id:08X},false,0,{len(f.data)},{cells(f)},",
    ),
    "SavvyCAN, headings of all": (
        HEADINGS + "".join(f",D{n}" for n in range(9, 65)),
        lambda n, f: f"{f.t * 1e6:.0f},{f.can_id:08X},false,Rx,0,{len(f.data)},{cells(f, 64)}",
    ),
    "BRS and ESI before the bytes": (
        HEADINGS.replace("D1", "FDF,BRS,ESI,D1"),
        lambda n, f: f"{f.t * 1e6:.0f},{f.can_id:08X},false,Rx,0,{len(f.data)},1,1,0,{cells(f)}",
    ),
    "bytes in one cell": (
        "Time,ID,BRS,ESI,Length,Data",
        lambda n, f: f"{f.t:.6f},{f.can_id:X},1,0,{len(f.data)},{f.data.hex(' ')}",
    ),
    "a code for the length": (
        "Time,ID,DLC,Data",
        lambda n, f: f"{f.t:.6f},{f.can_id:X},{CODES[len(f.data)]},{f.data.hex(' ')}",
    ),
    "a code of one letter": (
        "Time,ID,DLC,Data",
        lambda n, f: f"{f.t:.6f},{f.can_id:X},{CODES[len(f.data)]:X},{f.data.hex()}",
    ),
    "a code, bytes apart": (
        "Time,ID,DLC," + ",".join(f"B{n}" for n in range(8)),
        lambda n, f: f"{f.t:.6f},{f.can_id:X},{CODES[len(f.data)]},{cells(f)}",
    ),
}


def table(headings: str, row: Row, of: list[CanFrame], end: str = "\n") -> str:
    return end.join([headings, *(row(n, frame) for n, frame in enumerate(of)), ""])


def check(text: str, path: Path) -> None:
    check_log(read(path, text))


def check_log(log: Log) -> None:
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r"), log.damage) == (ROBOT, CLIENT, [])
    assert log.format.name == "can-csv"
    times = [chunk.t for chunk in chunks if chunk.dir == "r2c" and chunk.t is not None]
    assert [t - times[0] for t in times] == pytest.approx([0.1 * n for n in range(12)], abs=2e-3)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("name", FD)
def test_rows_of_can_fd(name: str, end: str, tmp_path: Path) -> None:
    check(table(*FD[name], fd_frames(), end), tmp_path / "a.csv")


def test_rows_of_both_kinds(tmp_path: Path) -> None:
    headings, row = FD["SavvyCAN, headings of eight"]
    both = fd_frames()[:10] + frames()[-7 * (len(frames()) // 12) :]
    log = read(tmp_path / "a.csv", table(headings, row, both))
    chunks = list(log)
    assert joined(chunks, "r2c").startswith(b"".join(SIPS[:5]))
    assert joined(chunks, "r2c").endswith(SIPS[-1])
    assert log.damage == []


def test_a_row_of_can_fd_that_is_cut_is_told(tmp_path: Path) -> None:
    headings, row = FD["SavvyCAN, headings of eight"]
    text = table(headings, row, fd_frames()).rstrip("\n,")
    log = read(tmp_path / "a.csv", text[:-6])
    assert joined(list(log), "r2c") == ROBOT
    assert [entry.place for entry in log.damage] == [f"line {len(fd_frames()) + 1}"]


def comma(number: float, digits: int = 6) -> str:
    return f"{number:.{digits}f}".replace(".", ",")


def thousands(number: float) -> str:
    return f"{number:,.3f}".replace(",", "_").replace(".", ",").replace("_", ".")


def excel(frame: CanFrame) -> str:
    """Leading zeros are lost."""
    return ";".join(f"{byte:X}" for byte in frame.data)


GERMAN: dict[str, tuple[str, Row]] = {
    "PCAN": (
        "Nachrichtennummer;Zeit (ms);Typ;CAN-ID (hex);Richtung;Länge;Daten (hex)",
        lambda n, f: f"{n};{comma((f.t - START_S) * 1000, 3)};Data;{f.can_id:04X}h;Rx;8;{f.data.hex(' ')}",
    ),
    "PCAN with English headings": (
        "Message Number;Time Offset (ms);Type;ID (hex);Dir;Length;Data (hex)",
        lambda n, f: f"{n};{comma((f.t - START_S) * 1000, 3)};Data;{f.can_id:04X};Rx;8;{f.data.hex(' ')}",
    ),
    "SavvyCAN through a spreadsheet": (
        HEADINGS.replace(",", ";"),
        lambda n, f: f"{f.t * 1e6:.0f};{f.can_id:X};FALSCH;Rx;0;8;{excel(f)}",
    ),
    "seconds": ("Zeit;ID;Daten", lambda n, f: f"{comma(f.t)};{f.can_id:X};{f.data.hex(' ')}"),
    "seconds with points between thousands": (
        "Zeitstempel;Kennung;Nutzdaten",
        lambda n, f: f"{thousands(f.t)};{f.can_id:X};{f.data.hex()}",
    ),
    "a column of a unit": (
        "Zeit [ms];CAN ID;DLC;Daten",
        lambda n, f: f"{comma((f.t - START_S) * 1000)};0x{f.can_id:X};8;{f.data.hex(' ')}",
    ),
    "quoted": (
        '"Zeit";"ID";"Datenlänge";"Daten"',
        lambda n, f: f'"{comma(f.t)}";"{f.can_id:X}";"8";"{f.data.hex(" ")}"',
    ),
    "quoted, parted by commas": (
        "Time,ID,Data",
        lambda n, f: f'"{comma(f.t)}",{f.can_id:X},{f.data.hex(" ")}',
    ),
    "commas for both": ("Time,ID,Data", lambda n, f: f"{comma(f.t)},{f.can_id:X},{f.data.hex(' ')}"),
    "commas for both, bytes apart": (
        "Time,ID,LEN," + ",".join(f"D{n}" for n in range(8)),
        lambda n, f: f"{comma(f.t)},{f.can_id:X},8,{cells(f)}",
    ),
    "tabs": ("Zeit\tID\tLänge\tDaten", lambda n, f: f"{comma(f.t)}\t{f.can_id:X}\t8\t{f.data.hex(' ')}"),
    "ids in decimal numbers": (
        "Zeit;ID (dez);Länge;Daten (hex)",
        lambda n, f: f"{comma(f.t)};{f.can_id};8;{f.data.hex(' ')}",
    ),
    "the time of day": (
        "Zeit;ID;Daten",
        lambda n, f: f"25.11.2026 06:38:{comma(10 + f.t - START_S)};{f.can_id:X};{f.data.hex(' ')}",
    ),
    "below what Excel writes": (
        "sep=;\nZeit;ID;Daten",
        lambda n, f: f"{comma(f.t)};{f.can_id:X};{f.data.hex(' ')}",
    ),
}


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("name", GERMAN)
def test_decimal_commas_and_semicolons(name: str, end: str, tmp_path: Path) -> None:
    check(table(*GERMAN[name], frames(), end), tmp_path / "a.csv")


@pytest.mark.parametrize("encoding", ["latin-1", "cp437", "utf-8-sig"])
def test_headings_of_any_code_page(encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(table(*GERMAN["PCAN"], frames()).encode(encoding))
    check_log(open_log(str(path)))


def test_a_spreadsheet_s_exponent_is_no_time_in_seconds(tmp_path: Path) -> None:
    text = table("Time Stamp;ID;Data", lambda n, f: f"1,79558E+15;{f.can_id:X};{f.data.hex(' ')}", frames())
    assert {chunk.t for chunk in read(tmp_path / "a.csv", text)} == {1795580000.0}
