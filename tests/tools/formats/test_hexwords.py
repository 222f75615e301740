# SPDX-License-Identifier: MIT
"""Rule: bytes of a link that stand among other words are read, each once and in order; text that only looks like bytes
is not taken for a log."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.formats import find_format, hexwords, open_log
from forms import CLIENT, COMMANDS, ROBOT, SIPS, joined, rows, shown


def each(form: str) -> str:
    """A line for each SIP; H stands for its bytes with spaces, U for the same in capitals, X for digits alone."""
    return "".join(
        form.replace("H", sip.hex(" ")).replace("U", sip.hex(" ").upper()).replace("X", sip.hex()) + "\n"
        for sip in SIPS
    )


def hexyl(data: bytes) -> str:
    lines = [
        f"│{at:08x}│ {part[:8].hex(' '):<23} ┊ {part[8:].hex(' '):<23} │{shown(part[:8])}┊{shown(part[8:])}│"
        for at, part in rows(data)
    ]
    return (
        "\n".join(["┌────────┬─────────────┬────────┐", *lines, "└────────┴─────────────┴────────┘"]) + "\n"
    )


FORMS = {
    "journal": each("Nov 25 17:00:01 host robot[12]: rx H"),
    "logcat": each("11-25 17:00:01.250  1234  1250 D UsbSerial: RX X"),
    "mqtt": each("argus/raw X"),
    "tshark -T fields": each("1795577927.479113000\t8101\tX"),
    "Termite": "".join(f"[0x{byte:02x}]" for byte in ROBOT),
    "brackets": "".join(f"[{byte:02X}]" for byte in ROBOT),
    "angles": "".join("".join(f"<{byte:02X}>" for byte in sip) + "\n" for sip in SIPS),
    "a byte in a line": "".join(f"uart-1: {byte:02X}\n" for byte in ROBOT),
    "logic analyser": "name,type,start_time,duration,data\n"
    + "".join(f'"Serial","data",{n * 0.001:.9f},0.00104,0x{byte:02X}\n' for n, byte in enumerate(ROBOT)),
    "Python": "".join(f"{sip!r}\n" for sip in SIPS),
    "Python with times": "".join(f"{n / 10:.3f} read {sip!r}\n" for n, sip in enumerate(SIPS)),
    "numbers": "".join(f"{list(sip)}\n" for sip in SIPS),
    "hexyl": hexyl(ROBOT),
}


@pytest.mark.parametrize("name", FORMS)
def test_every_way_gives_its_bytes(name: str, tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(FORMS[name], encoding="utf-8")
    log = open_log(str(path))
    chunks = list(log)
    assert (log.format.name, log.damage) == ("hexwords", [])
    assert joined(chunks, "r2c") == ROBOT
    assert joined(chunks, "c2r") == b""


def test_lines_of_both_directions_are_told_apart_by_their_packets(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    pairs = zip(SIPS, COMMANDS, strict=True)
    path.write_text("".join(f"Device --> {sip.hex(' ')}\nHost --> {told.hex(' ')}\n" for sip, told in pairs))
    chunks = list(open_log(str(path)))
    assert joined(chunks, "r2c") == ROBOT
    assert joined(chunks, "c2r") == CLIENT


def test_the_direction_that_is_given_holds(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(FORMS["journal"])
    assert joined(open_log(str(path), direction="c2r"), "c2r") == ROBOT


@pytest.mark.parametrize(
    "text",
    [
        "The robot of 12 34 56 78 was seen at ab cd.\n" * 40,
        "commit deadbeefcafe fa fb 03\n" * 40,  # one header, and no packet that is whole
        "".join(f"[{n}, {n + 1}, {n + 2}]\n" for n in range(200)),
        "b'hello' b'world'\n" * 20,
        "".join(f"2026-11-25 17:00:{n:02} fa fb {n:02x}\n" for n in range(60)),
    ],
)
def test_words_are_no_bytes(text: str) -> None:
    assert find_format(text.encode()).name != "hexwords"


def test_a_damaged_line_costs_its_packet_alone(tmp_path: Path) -> None:
    lines = FORMS["journal"].splitlines(keepends=True)
    lines[4] = lines[4].replace("fa fb", "fa f")
    path = tmp_path / "a.txt"
    path.write_text("".join(lines))
    data = joined(open_log(str(path)), "r2c")
    assert SIPS[4] not in data
    assert all(sip in data for n, sip in enumerate(SIPS) if n != 4)


LONG = ROBOT * (1 + 100_000 // len(ROBOT))


@pytest.mark.tour(4, 8)
@pytest.mark.parametrize("count", [1, 8, 20], ids=lambda n: f"{n} times")
@pytest.mark.parametrize("way", ["literal", "numbers", "brackets", "prefixed brackets"])
def test_a_long_line_is_read_whole(way: str, count: int, tmp_path: Path) -> None:
    data = LONG[: count * 5_000]
    text = {
        "literal": f"read {data!r} all\n",
        "numbers": f"12.250 {list(data)}\n",
        "brackets": "rx: " + "".join(f"[{byte:02x}]" for byte in data) + "\n",
        "prefixed brackets": "rx: " + "".join(f"[0x{byte:02x}]" for byte in data) + "\n",
    }[way]
    path = tmp_path / "a.txt"
    path.write_text(text * 2)
    log = open_log(str(path))
    assert joined(log, "r2c") == data * 2
    assert (log.format.name, log.damage) == ("hexwords", [])


@pytest.mark.parametrize("opening", ["b'", "["])
def test_what_does_not_end_is_damage(opening: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hexwords, "CARRIED_MOST", 1 << 15)
    first = f"{SIPS[0]!r}\n" if opening == "b'" else f"{list(SIPS[0])}\n"
    path = tmp_path / "a.txt"
    for length in (100, 20_000, 100_000):
        path.write_text(first * 3 + opening + "1, " * length + "\n" + first)
        log = open_log(str(path))
        assert joined(log, "r2c") == SIPS[0] * 4
        assert [damage.place for damage in log.damage] == ["line 4"], length


@pytest.mark.parametrize(
    ("form", "odd"), [(repr, "b'\\x0g'"), (repr, "b'\xe9'"), (lambda sip: str(list(sip)), "[250, 256]")]
)
def test_one_that_is_odd_costs_no_other(form: Callable[[bytes], str], odd: str, tmp_path: Path) -> None:
    lines = [f"{form(sip)}\n" for sip in SIPS]
    lines[3] = f"{odd} {form(SIPS[3])} {odd}\n"
    path = tmp_path / "a.txt"
    path.write_text("".join(lines))
    log = open_log(str(path))
    assert joined(log, "r2c") == ROBOT
    assert [damage.place for damage in log.damage] == ["line 4"]


def test_an_apostrophe_is_no_damage(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    path.write_text(FORMS["Python"] + "Bob's robot\n[12] of [3]\n")
    log = open_log(str(path))
    assert joined(log, "r2c") == ROBOT
    assert log.damage == []
