# SPDX-License-Identifier: MIT
"""Rule: what CAN analysers save is read; a line or row that is none is told, and what is behind it is read."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import can
import pytest
from argus_tools.formats import Log, LogError, open_log
from forms import CLIENT, ROBOT, START_S, CanFrame, frames, joined


def written(path: Path) -> Path:
    """The session as python-can's own writers write it, chosen by the file's name."""
    with can.Logger(str(path)) as logger:
        for frame in frames():
            logger.on_message_received(
                can.Message(
                    timestamp=frame.t,
                    arbitration_id=frame.can_id,
                    is_extended_id=False,
                    data=frame.data,
                    channel=0,
                )
            )
    return path


def check(log: Log, name: str, damage: int = 0) -> None:
    chunks = list(log)
    assert log.format.name == name
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == (ROBOT, CLIENT)
    assert len(log.damage) == damage, log.damage
    if chunks[0].t is not None:
        times = [chunk.t - chunks[0].t for chunk in chunks if chunk.dir == "r2c" and chunk.t is not None]
        assert times == pytest.approx([0.1 * n for n in range(len(times))], abs=2e-3)


@pytest.mark.parametrize(
    ("suffix", "name"),
    [
        ("asc", "asc"),
        ("blf", "blf"),
        ("trc", "trc"),
        ("csv", "can-csv"),
        ("log", "candump"),
        ("txt", "can-lines"),
    ],
)
def test_the_files_of_python_can(suffix: str, name: str, tmp_path: Path) -> None:
    check(open_log(str(written(tmp_path / f"a.{suffix}"))), name)


def hexed(frame: CanFrame, separator: str = " ") -> str:
    return frame.data.hex(separator).upper()


def lines(form: Callable[[int, CanFrame], str], head: str = "", end: str = "\n") -> str:
    return head + "".join(form(n, frame) + end for n, frame in enumerate(frames(), start=1))


def before(n: int) -> float:
    """The time of the frame before the one with this number, counted from 1."""
    return frames()[n - 2].t if n > 1 else START_S


def ms(frame: CanFrame) -> float:
    return (frame.t - START_S) * 1000


TRC_11 = ";$FILEVERSION=1.1\n;$STARTTIME=45987.2769384156\n;\n;   Message Number\n;---+--   ----+----\n"
TRC_13 = ";$FILEVERSION=1.3\n;$STARTTIME=45987.2769384156\n;\n"
TRC_20 = ";$FILEVERSION=2.0\n;$STARTTIME=45987.2769384156\n;$COLUMNS=N,O,T,I,d,l,D\n;\n"
TRC_21 = ";$FILEVERSION=2.1\n;$STARTTIME=45987.2769384156\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n;\n"
TRC_12 = TRC_13.replace("1.3", "1.2")
KVASER = "Time,Channel,ID,Flags,DLC,Data0,Data1,Data2,Data3,Data4,Data5,Data6,Data7,Counter,AbsTime\n"
ASC = "date Wed Nov 25 06:38:47.479 am 2026\nbase hex  timestamps absolute\n"
TEXTS = {
    "trc 1.0": (
        "trc",
        lines(lambda n, f: f"{n:>6}) {ms(f):7.0f} {f.can_id:04X} 8 {hexed(f)}", "; CAN activities\n"),
    ),
    "trc 1.1": (
        "trc",
        lines(lambda n, f: f"{n:>6}) {ms(f):10.1f}  Rx    {f.can_id:04X}  8  {hexed(f)}", TRC_11),
    ),
    "trc 1.3": (
        "trc",
        lines(lambda n, f: f"{n:>6}) {ms(f):10.1f} 1  Rx    {f.can_id:04X} -  8  {hexed(f)}", TRC_13),
    ),
    "trc 1.2": (
        "trc",
        lines(lambda n, f: f"{n:>6}) {ms(f):10.1f} 1  Rx        {f.can_id:04X}  8  {hexed(f)} ", TRC_12),
    ),
    "trc 1.2, carriage returns and a remote frame": (
        "trc",
        lines(lambda n, f: f"{n:>6}) {ms(f):10.1f} 1  Tx        {f.can_id:04X}  8  {hexed(f)}\r", TRC_12)
        + "   999)      999.9 1  Rx        0123  8  RTR\r\n",
    ),
    "trc 2.0": (
        "trc",
        lines(lambda n, f: f"{n:>7} {ms(f):13.3f} DT     {f.can_id:04X} Rx 8  {hexed(f)}", TRC_20),
    ),
    "trc 2.1": (
        "trc",
        lines(lambda n, f: f"{n:>7} {ms(f):13.3f} DT 1      {f.can_id:04X} Rx -  8    {hexed(f)}", TRC_21),
    ),
    "trc, carriage returns": (
        "trc",
        lines(lambda n, f: f"{n:>6}) {ms(f):10.1f}  Rx    {f.can_id:04X}  8  {hexed(f)}\r", TRC_11),
    ),
    "asc": (
        "asc",
        lines(
            lambda n, f: f"{f.t - START_S:9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}",
            ASC + "internal events logged\n",
        ),
    ),
    "asc, more behind the data": (
        "asc",
        lines(
            lambda n, f: (
                f"{f.t - START_S:9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}  Length = 100 BitCount = 9"
            ),
            ASC + "no internal events logged\n// version 9.0.0\n",
        ),
    ),
    "asc, decimal": (
        "asc",
        lines(
            lambda n, f: (
                f"{f.t - START_S:9.6f} 1  {f.can_id}             Rx   d 8 {' '.join(map(str, f.data))}"
            ),
            ASC.replace("hex", "dec") + "internal events logged\n",
        ),
    ),
    "asc, trigger block": (
        "asc",
        lines(
            lambda n, f: f"{f.t - START_S:9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}",
            ASC
            + "internal events logged\nBegin Triggerblock Wed Nov 25 06:38:47.479 am 2026\n"
            + "   0.000000 Start of measurement\n",
        )
        + "End TriggerBlock\n",
    ),
    "asc, without a header": (
        "asc",
        lines(lambda n, f: f"{f.t - START_S:9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}"),
    ),
    "asc, decimal without a header": (
        "asc",
        lines(
            lambda n, f: (
                f"{f.t - START_S:9.6f} 1  {f.can_id}             Rx   d 8 {' '.join(map(str, f.data))}"
            )
        ),
    ),
    "asc, a header without what is logged": (
        "asc",
        lines(lambda n, f: f"{f.t - START_S:9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}", ASC),
    ),
    "asc, a mark and one line of header": (
        "asc",
        lines(
            lambda n, f: f"{f.t - START_S:9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}",
            "\ufeff" + ASC.splitlines(keepends=True)[0],
        ),
    ),
    "asc, CAN FD without a header": (
        "asc",
        lines(
            lambda n, f: (
                f"{f.t - START_S:9.6f} CANFD   1 Rx        {f.can_id:X}                 0 0 8  8 {hexed(f)} "
                "0 0 0 0 0 0 0 0"
            )
        ),
    ),
    **{
        f"asc, relative, {name}": (
            "asc",
            lines(
                lambda n, f: f"{f.t - before(n):9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}",
                ASC.replace("absolute", "relative") + head,
            ),
        )
        for name, head in {
            "plain": "",
            "with what is logged": "no internal events logged\n",
            "behind a start": "no internal events logged\n   0.000000 Start of measurement\n",
        }.items()
    },
    "asc, relative, other frames between": (
        "asc",
        lines(
            lambda n, f: (
                f"{(f.t - before(n)) / 2:9.6f} 1  123             Rx   d 1 00\n"
                f"{(f.t - before(n)) / 2:9.6f} 1  {f.can_id:X}             Rx   d 8 {hexed(f)}"
            ),
            ASC.replace("absolute", "relative"),
        ),
    ),
    "asc, relative, decimal": (
        "asc",
        lines(
            lambda n, f: (
                f"{f.t - before(n):9.6f} 1  {f.can_id}             Rx   d 8 {' '.join(map(str, f.data))}"
            ),
            ASC.replace("absolute", "relative").replace("hex", "dec"),
        ),
    ),
    "Kvaser, decimal": (
        "can-csv",
        lines(
            lambda n, f: f"{ms(f) / 1000:.6f},0,{f.can_id},0,8,{','.join(map(str, f.data))},{n},2026-11-25",
            KVASER,
        ),
    ),
    "Kvaser, hexadecimal": (
        "can-csv",
        lines(lambda n, f: f"{ms(f) / 1000:.6f},0,{f.can_id:X},0,8,{hexed(f, ',')},{n},2026-11-25", KVASER),
    ),
    "decimal ids by the heading": (
        "can-csv",
        lines(lambda n, f: f"{ms(f) / 1000:.6f};{f.can_id};{hexed(f)}", "Time;ID (dec);Data\n"),
    ),
    "decimal ids by themselves": (
        "can-csv",
        lines(lambda n, f: f"{ms(f) / 1000:.6f};{f.can_id};{hexed(f)}", "Time;ID;Data\n"),
    ),
    "decimal ids and single hexadecimal bytes": (
        "can-csv",
        lines(
            lambda n, f: f"{ms(f) / 1000:.6f},{f.can_id},{hexed(f, ',')}", "Time,ID,D0,D1,D2,D3,D4,D5,D6,D7\n"
        ),
    ),
    "Vehicle Spy": (
        "can-csv",
        lines(
            lambda n, f: f"{n},{f.t:.6f},0.0,0,F,F,x,HS CAN,,{f.can_id:X},F,F,{hexed(f, ',')},,,",
            "Line,Abs Time(Sec),Rel Time (Sec),Status,Er,Tx,Description,Network,Node,Arb ID,Remote,Xtd,"
            "B1,B2,B3,B4,B5,B6,B7,B8,Value,Trigger,Signals\n",
        ),
    ),
    "SavvyCAN": (
        "can-csv",
        lines(
            lambda n, f: f"{ms(f) * 1000:.0f},{f.can_id:08X},false,Rx,0,8,{hexed(f, ',')},",
            "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n",
        ),
    ),
    "SavvyCAN's generic": (
        "can-csv",
        lines(lambda n, f: f"0x{f.can_id:X},{hexed(f, ',')}", "ID,D0,D1,D2,D3,D4,D5,D6,D7\n"),
    ),
    "PCAN": (
        "can-csv",
        lines(
            lambda n, f: f"{n};{ms(f):.3f};Data;{f.can_id:04X}h;Rx;8;{hexed(f)}",
            "Message Number;Time Offset (ms);Type;ID (hex);Dir;Length;Data (hex)\n",
        ),
    ),
    "PCAN, headings in a comment": (
        "can-csv",
        lines(
            lambda n, f: f"{n},{ms(f):.3f},1,Rx,{f.can_id:04X},8,{hexed(f)}",
            ";$FILEVERSION=none\n;Number,Time Offset (ms),Bus,Type,ID (hex),Length,Data\n",
        ).replace(";$FILEVERSION=none\n", ""),
    ),
    "Cabana": (
        "can-csv",
        lines(lambda n, f: f"{ms(f) / 1000:.6f},{hex(f.can_id)},0,{f.data.hex()}", "time,addr,bus,data\n"),
    ),
    "CL2000": (
        "can-csv",
        lines(
            lambda n, f: f"{ms(f) / 1000:.6f};0;{f.can_id:x};{f.data.hex()}",
            "# Logger\nTimestamp;Type;ID;Data\n",
        ),
    ),
    "tabs": (
        "can-csv",
        lines(
            lambda n, f: f"{ms(f) / 1000:.6f}\t{f.can_id:X}\t8\t{hexed(f)}",
            "Time (s)\tCAN ID\tDLC\tData Bytes\n",
        ),
    ),
    "quoted": (
        "can-csv",
        lines(
            lambda n, f: f'"{ms(f):.3f}","0x{f.can_id:X}","8","{hexed(f)}"', '"Time [ms]","ID","DLC","Data"\n'
        ),
    ),
    "data in cells without headings": (
        "can-csv",
        lines(lambda n, f: f"{ms(f) / 1000:.6f},{f.can_id:X},8,{hexed(f, ',')}", "Time,ID,Length,Data\n"),
    ),
    "BUSMASTER": (
        "can-lines",
        lines(
            lambda n, f: f"06:38:{47 + ms(f) / 1000:07.4f} Rx 1 0x{f.can_id:X} s 8 {hexed(f)} ".replace(
                ".", ":", 1
            ),
            "***BUSMASTER Ver 3.2.2***\n***PROTOCOL CAN***\n",
        ),
    ),
    "CRTD": (
        "can-lines",
        lines(lambda n, f: f"{f.t:.6f} 1R11 {f.can_id:03X} {hexed(f)}", "0.000 CXX started\n"),
    ),
}


@pytest.mark.parametrize("name", TEXTS)
def test_every_analysers_text(name: str, tmp_path: Path) -> None:
    form, text = TEXTS[name]
    (tmp_path / "a.txt").write_text(text, newline="")
    check(open_log(str(tmp_path / "a.txt")), form)


@pytest.mark.parametrize(
    "name",
    [
        "trc 1.1",
        "trc 1.2",
        "trc 2.1",
        "asc",
        "asc, without a header",
        "Kvaser, decimal",
        "SavvyCAN",
        "PCAN",
        "Cabana",
        "BUSMASTER",
        "CRTD",
    ],
)
@pytest.mark.parametrize("at", [0.3, 0.7])
def test_a_line_that_is_none_costs_nothing_behind_it(name: str, at: float, tmp_path: Path) -> None:
    form, text = TEXTS[name]
    parts = text.splitlines(keepends=True)
    # A copy of a good line whose id is spoilt.
    cut = int(len(parts) * at)
    spoilt = re.sub(r"64(?=[08])|,160(?=[08])", "6Z", parts[cut])
    path = tmp_path / "a.txt"
    path.write_text("".join([*parts[:cut], spoilt, *parts[cut:]]))
    log = open_log(str(path))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == (ROBOT, CLIENT)
    if form != "asc":
        assert [entry.place for entry in log.damage] == [f"line {cut + 1}"]


@pytest.mark.parametrize("seed", range(20))
def test_a_cut_blf_gives_what_is_before_the_cut(seed: int, tmp_path: Path) -> None:
    data = written(tmp_path / "a.blf").read_bytes()
    end = 200 + (len(data) - 200) * seed // 20
    (tmp_path / "b.blf").write_bytes(data[:end])
    log = open_log(str(tmp_path / "b.blf"))
    try:
        chunks = list(log)
    except LogError as error:
        if "BLF" not in str(error):
            raise
        return
    assert ROBOT.startswith(joined(chunks, "r2c")[:-60])
    assert log.damage or not chunks


def test_a_log_of_another_bus_is_told_with_its_ids(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("Time,ID,Data\n0.1,123,00\n")
    with pytest.raises(LogError, match=r"no CAN frame is of a robot's link.*there are 0x123"):
        list(open_log(str(tmp_path / "a.csv")))


@pytest.mark.parametrize(
    ("extended", "shown"),
    [("true", "0x00000640 (29 bits)"), ("false", "0x123"), ("true", "0x18DA4806 (29 bits)")],
)
def test_a_long_id_is_shown_as_one(extended: str, shown: str, tmp_path: Path) -> None:
    number = shown.partition(" ")[0].removeprefix("0x")
    (tmp_path / "a.csv").write_text(f"Time,ID,Extended,Data\n0.1,{number},{extended},00\n")
    with pytest.raises(LogError) as caught:
        list(open_log(str(tmp_path / "a.csv")))
    assert str(caught.value).endswith(f"whose ids of 11 bits are 0x640 to 0x64F; there are {shown}")


@pytest.mark.parametrize("version", ["0.9", "1.4", "3.0"])
def test_another_version_of_trc_is_told_with_the_remedy(version: str, tmp_path: Path) -> None:
    (tmp_path / "a.trc").write_text(f";$FILEVERSION={version}\n 1) 1.0 1 Rx 0648 8 00 00\n")
    with pytest.raises(LogError, match=rf"version {version}, which is not read; .* 1\.2, .*PEAK-Converter"):
        list(open_log(str(tmp_path / "a.trc")))


def trc(head: str, form: str) -> str:
    return head + "".join(
        form.format(n=n, ms=ms(f), id=f"{f.can_id:04X}", data=hexed(f)) + "\n"
        for n, f in enumerate(frames(), start=1)
    )


TRC_LINES = {
    "1.0": "{n:>6}) {ms:7.0f} {id} 8 {data}",
    "1.1": "{n:>6}) {ms:10.1f}  Rx    {id}  8  {data}",
    "1.2": "{n:>6}) {ms:10.1f} 1  Rx        {id}  8  {data}",
    "1.3": "{n:>6}) {ms:10.1f} 1  Rx        {id} -  8  {data}",
    "2.0": "{n:>7} {ms:13.3f} DT     {id} Rx 8  {data}",
    "2.1": "{n:>7} {ms:13.3f} DT 1      {id} Rx -  8    {data}",
}


@pytest.mark.parametrize("version", TRC_LINES)
def test_a_trace_without_a_header_is_known_by_its_lines(version: str, tmp_path: Path) -> None:
    path = tmp_path / "a.trc"
    path.write_text(trc("", TRC_LINES[version]))
    check(open_log(str(path)), "trc")


@pytest.mark.parametrize("above", ["\n\n", "robot seven\n", "2026-11-25 06:38:47\n", "# a\n// b\n", "; c\n"])
@pytest.mark.parametrize("version", ["1.1", "2.1"])
def test_what_stands_above_a_header_is_passed_over(version: str, above: str, tmp_path: Path) -> None:
    head = {"1.1": TRC_11, "2.1": TRC_21}[version]
    path = tmp_path / "a.trc"
    path.write_text(trc(above + head, TRC_LINES[version]))
    check(open_log(str(path)), "trc")
    asc = lines(lambda n, f: f"{f.t - START_S:9.6f} 1  {f.can_id:X}  Rx   d 8 {hexed(f)}", above + ASC)
    path.write_text(asc)
    check(open_log(str(path)), "asc")


def test_a_header_that_cannot_be_read_stops_nothing(tmp_path: Path) -> None:
    path = tmp_path / "a.trc"
    path.write_text(trc(";$FILEVERSION=1.1\n;$STARTTIME=today\n", TRC_LINES["1.1"]))
    check(open_log(str(path)), "trc")


@pytest.mark.parametrize("head", [ASC, ASC + "internal events logged\n", ""])
def test_names_instead_of_ids_are_told(head: str, tmp_path: Path) -> None:
    path = tmp_path / "a.asc"
    named = "   0.000000 1  ArcosTx             Rx   d 8 06 FA FB 03 00 00 00 CC\n"
    path.write_text((head or "base hex\n") + named)
    with pytest.raises(LogError, match="name instead of its id"):
        list(open_log(str(path)))
    rest = lines(lambda n, f: f"{f.t - START_S:9.6f} 1  {f.can_id:X}  Rx   d 8 {hexed(f)}")
    path.write_text(head + named + rest)
    check(open_log(str(path)), "asc", damage=1)
