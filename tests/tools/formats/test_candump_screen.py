# SPDX-License-Identifier: MIT
"""Rule: whatever candump prints on the screen, with whichever options, is read like what -L writes; losses are told."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest
from argus_tools.formats import LogError, open_log
from forms import CLIENT, ROBOT, START_S, CanFrame, frames, joined, read


def body(frame: CanFrame) -> str:
    return f"  can0  {frame.can_id:3X}   [{len(frame.data)}]  {frame.data.hex(' ').upper()}"


def absolute(frame: CanFrame) -> str:
    return f" ({frame.t:.6f})"


def date(frame: CanFrame) -> str:
    return f" ({datetime.fromtimestamp(frame.t, UTC):%Y-%m-%d %H:%M:%S.%f})"


def zero(frame: CanFrame) -> str:
    return f" ({frame.t - START_S:010.6f})"


def deltas() -> list[str]:
    times = [START_S, *(frame.t for frame in frames())]
    return [f" ({b - a:010.6f})" for a, b in itertools.pairwise(times)]


def bits(frame: CanFrame) -> str:
    return (
        f"  can0  {frame.can_id:3X}   [{len(frame.data)}]  {' '.join(f'{byte:08b}' for byte in frame.data)}"
    )


def swapped(frame: CanFrame) -> str:
    return f"  can0  {frame.can_id:3X}   [{len(frame.data)}]  " + frame.data[::-1].hex("`").upper()


def ascii_behind(frame: CanFrame) -> str:
    return body(frame) + "   '" + "".join(chr(b) if 32 <= b < 127 else "." for b in frame.data) + "'"


def marked(frame: CanFrame) -> str:
    return f"  can0  RX - -  {frame.can_id:3X}   [{len(frame.data)}]  {frame.data.hex(' ').upper()}"


def coloured(frame: CanFrame) -> str:
    return f"\x1b[31m  can0  {frame.can_id:3X}   [8]  {frame.data.hex(' ').upper()}\x1b[0m"


VIEWS: dict[str, Callable[[CanFrame], str]] = {
    "plain": body,
    "-ta": lambda f: absolute(f) + body(f),
    "-ta, nanoseconds": lambda f: f" ({f.t:.9f})" + body(f),
    "-tA": lambda f: date(f) + body(f),
    "-tz": lambda f: zero(f) + body(f),
    "-a": ascii_behind,
    "-i": bits,
    "-S": swapped,
    "-x": marked,
    "-c": coloured,
    "-8": lambda f: body(f).replace("[8]", "{F}"),
    "lower case": lambda f: body(f).lower(),
    "another bus's width": lambda f: body(f).replace("can0  ", "can-robot   "),
    "carriage returns": lambda f: body(f) + "\r",
}


@pytest.mark.parametrize("view", VIEWS)
def test_every_view_is_read(view: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", "".join(VIEWS[view](frame) + "\n" for frame in frames()))
    chunks = list(log)
    assert (log.format.name, log.damage) == ("candump", [])
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == (ROBOT, CLIENT)


def test_times_of_each_view(tmp_path: Path) -> None:
    expected = {
        "-ta": START_S, "-tA": START_S, "-tz": 0.0, "-td": 0.0,
    }  # fmt: skip
    texts = {name: [VIEWS[name](frame) for frame in frames()] for name in expected if name != "-td"}
    texts["-td"] = [delta + body(frame) for delta, frame in zip(deltas(), frames(), strict=True)]
    reference = list(read(tmp_path / "l.log", "".join(log_line(frame) for frame in frames())))
    for name, start in expected.items():
        chunks = list(read(tmp_path / "a.txt", "\n".join(texts[name]) + "\n"))
        found = [chunk.t for chunk in chunks]
        assert found == pytest.approx([c.t - START_S + start for c in reference if c.t], abs=1e-5), name
    assert {chunk.t for chunk in read(tmp_path / "a.txt", "\n".join(map(body, frames())))} == {None}


def test_zero_based_times_go_on_when_candump_was_begun_again(tmp_path: Path) -> None:
    run = "".join(zero(frame) + body(frame) + "\n" for frame in frames())
    times = [chunk.t for chunk in read(tmp_path / "a.txt", run * 2)]
    assert times == sorted(times, key=lambda t: t or 0.0)


def log_line(frame: CanFrame) -> str:
    return f"({frame.t:.6f}) can0 {frame.can_id:03X}#{frame.data.hex().upper()}\n"


@pytest.mark.parametrize(
    "before",
    [
        "# drive of Monday\n", "# one\n#\n# two\n\n", "\n\n", "\ufeff", "# " + "x" * 200 + "\n",
        "#!/usr/bin/candump -L\r\n\r\n",
    ],
)  # fmt: skip
@pytest.mark.parametrize("make", [log_line, lambda frame: body(frame) + "\n"])
def test_comments_before_the_first_line_are_fine(
    before: str, make: Callable[[CanFrame], str], tmp_path: Path
) -> None:
    log = read(tmp_path / "a.log", before + "".join(make(frame) for frame in frames()))
    assert joined(list(log), "r2c") == ROBOT
    assert log.damage == []


@pytest.mark.parametrize(
    "noise",
    [
        "  can0  123   [8]  remote request",
        "  can0  20000004   [8]  00 04 00 00 00 00 00 00   ERRORFRAME\n\tbus-off",
        "  can0  18DA4806   [3]  02 61 62", "  can0  500   [0]", "  can0  101  [64]  " + bytes(64).hex(" "),
        "# a comment",
    ],
)  # fmt: skip
def test_other_traffic_is_passed_over(noise: str, tmp_path: Path) -> None:
    text = "".join(f"{noise}\n{body(frame)}\n" for frame in frames())
    log = read(tmp_path / "a.txt", text)
    assert (joined(list(log), "r2c"), log.damage) == (ROBOT, [])


@pytest.mark.parametrize(
    ("line", "part"),
    [
        ("$ candump can0", "no line of candump"),
        ("DROPCOUNT: dropped 3 CAN frames on 'can0' socket (total drops 3)", "no line of candump"),
        ("  can0  648   [8]  06 FA FB 03 00", "has not the 8 bytes"),
        ("  can0  648   [8]  06 FA FB 03 00 00 00 C", "has not the 8 bytes"),
        ("  can0  648   [8]  06 FA FB 03 00 00 00 XX", "has not the 8 bytes"),
        ("  can0  648   [2]  06 FA FB", "has not the 2 bytes"),
    ],
)
def test_what_is_lost_is_told_by_its_line(line: str, part: str, tmp_path: Path) -> None:
    texts = [body(frame) for frame in frames()]
    log = read(tmp_path / "a.txt", "\n".join([*texts, line, *texts]) + "\n")
    assert joined(list(log), "r2c") == ROBOT * 2
    assert [(entry.place, part in entry.what) for entry in log.damage] == [(f"line {len(texts) + 1}", True)]


def test_a_bus_without_a_robot_is_told_with_its_ids(tmp_path: Path) -> None:
    log = read(tmp_path / "a.txt", "  can0  123   [1]  00\n  can0  7FF   [1]  00\n")
    with pytest.raises(LogError, match=r"0x640 to 0x64F; there are 0x123, 0x7FF"):
        list(log)


def test_another_robot_than_that_asked_for_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("".join(body(frame) + "\n" for frame in frames()))
    with pytest.raises(LogError, match="no frame of robot 5; give --robot 0"):
        list(open_log(str(tmp_path / "a.txt"), robot=5))
