# SPDX-License-Identifier: MIT
"""Rule: a capture of a CAN interface, cooked or not, gives what a candump of it gives; other link types are named."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from argus_tools.formats import Log, LogError, open_log
from forms import CLIENT, ROBOT, frames, joined, pcap, pcapng
from logs import run

CAN, COOKED, COOKED2, EXPORTED = 227, 113, 276, 252
LONG, REMOTE, ERROR = 1 << 31, 1 << 30, 1 << 29
Packets = list[tuple[float, bytes]]


def can(can_id: int, data: bytes, order: str = ">", fd: bool = False) -> bytes:
    return struct.pack(order + "IBBxx", can_id, len(data), 4 * fd) + data


def plain() -> Packets:
    return [(frame.t, can(frame.can_id, frame.data)) for frame in frames()]


def cooked(order: str, protocol: int = 0x000C) -> Packets:
    head = struct.pack(">HHH8sH", 1, 280, 0, bytes(8), protocol)
    return [(frame.t, head + can(frame.can_id, frame.data, order)) for frame in frames()]


def cooked2(order: str, index: int = 3) -> Packets:
    head = struct.pack(">HHIHBB8s", 0x000C, 0, index, 280, 1, 0, bytes(8))
    return [(frame.t, head + can(frame.can_id, frame.data, order)) for frame in frames()]


def exported(order: str, name: bytes = b"can-hostendian", before: bytes = b"") -> Packets:
    """As Wireshark saves what it read from a candump log: tags, then the frame, filled up to eight bytes of data."""
    tags = before + struct.pack(">HH", 12, 16) + name.ljust(16, b"\0") + bytes(4)
    return [(frame.t, tags + can(frame.can_id, frame.data, order).ljust(16, b"\0")) for frame in frames()]


CAPTURES = {
    "pcap": pcap(CAN, plain()),
    "pcap, big-endian file": pcap(CAN, plain(), ">"),
    "pcap, nanoseconds": pcap(CAN, plain(), "<", nanoseconds=True),
    "pcap, ids in the host's order": pcap(CAN, [(f.t, can(f.can_id, f.data, "<")) for f in frames()]),
    "pcap, padded frames": pcap(CAN, [(t, data + bytes(8)) for t, data in plain()]),
    "pcapng": pcapng(CAN, plain()),
    "cooked": pcap(COOKED, cooked(">")),
    "cooked, host's order": pcap(COOKED, cooked("<")),
    "cooked, FD protocol": pcap(COOKED, cooked(">", 0x000D)),
    "cooked, pcapng": pcapng(COOKED, cooked("<"), b"any"),
    "cooked 2": pcap(COOKED2, cooked2(">")),
    "cooked 2, host's order": pcap(COOKED2, cooked2("<")),
    "exported": pcap(EXPORTED, exported("<")),
    "exported, pcapng": pcapng(EXPORTED, exported("<")),
    "exported, FD": pcap(EXPORTED, exported("<", b"canfd")),
    "exported, big-endian id": pcap(EXPORTED, exported(">", b"can-bigendian")),
    "exported by a big-endian host": pcap(EXPORTED, exported(">")),
    "exported, other tags first": pcap(EXPORTED, exported("<", before=struct.pack(">HH4s", 32, 4, b"abcd"))),
}


def read(path: Path, data: bytes) -> Log:
    path.write_bytes(data)
    return open_log(str(path))


@pytest.mark.parametrize("name", CAPTURES)
def test_every_capture_of_a_can_bus_is_read(name: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.pcap", CAPTURES[name])
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r"), log.damage) == (ROBOT, CLIENT, [])


def test_it_is_what_a_candump_of_the_same_bus_gives(tmp_path: Path) -> None:
    lines = "".join(f"({f.t:.6f}) can0 {f.can_id:03X}#{f.data.hex().upper()}\n" for f in frames())
    (tmp_path / "a.log").write_text(lines)
    assert list(read(tmp_path / "a.pcap", CAPTURES["pcap"])) == list(open_log(str(tmp_path / "a.log")))


@pytest.mark.parametrize(
    "other",
    [
        can(0x123, bytes(8)), can(LONG | 0x648, b"\x02ab"), can(REMOTE | 0x648, b""), can(ERROR | 0x04, bytes(8)),
        can(0x64F + 1, b"\x02ab"), can(0x123, bytes(64), fd=True),
    ],
)  # fmt: skip
def test_other_traffic_is_passed_over(other: bytes, tmp_path: Path) -> None:
    mixed = [packet for pair in plain() for packet in (pair, (pair[0], other))]
    log = read(tmp_path / "a.pcap", pcap(CAN, mixed))
    assert (joined(list(log), "r2c"), log.damage) == (ROBOT, [])


def test_frames_of_can_fd(tmp_path: Path) -> None:
    data = ROBOT[:52]
    framed = (b"\0" + bytes((len(data),)) + data).ljust(64, b"\xcc")
    log = read(tmp_path / "a.pcap", pcap(CAN, [(1.0, can(0x648, framed, fd=True))]))
    assert joined(list(log), "r2c") == data


def test_interfaces_of_a_pcapng_are_not_mixed(tmp_path: Path) -> None:
    first, second = pcapng(CAN, plain()), pcapng(CAN, plain(), b"can1")
    log = read(tmp_path / "a.pcapng", first + second)
    assert joined(list(log), "r2c") == ROBOT
    assert ["interface can1 is left out" in entry.what for entry in log.damage] == [True]


@pytest.mark.parametrize("cut", [1, 7, 9, 15])
def test_a_frame_that_was_cut_is_told(cut: int, tmp_path: Path) -> None:
    packets = plain()
    packets.append((packets[-1][0], packets[0][1][:cut]))
    log = read(tmp_path / "a.pcap", pcap(CAN, packets))
    assert joined(list(log), "r2c").startswith(ROBOT)
    assert log.damage[0].place == f"frame {len(packets)}"
    assert "header" in log.damage[0].what or f"{cut - 8} of a CAN frame's 8 bytes" in log.damage[0].what


@pytest.mark.parametrize("tags", [b"", bytes(4), struct.pack(">HH", 12, 99) + b"can-hostendian"])
def test_exported_pdus_that_are_no_can_are_refused(tags: bytes, tmp_path: Path) -> None:
    log = read(
        tmp_path / "a.pcap", pcap(EXPORTED, [(1.0, tags), *[(t, d) for t, d in exported("<", b"http")]])
    )
    with pytest.raises(LogError, match="PDUs that Wireshark exported, link type 252"):
        list(log)


def test_an_exported_bus_without_a_robot_is_told_by_its_id(tmp_path: Path) -> None:
    packet = exported("<")[0][1][:24] + can(0x123, bytes(8), "<")
    log = read(tmp_path / "a.pcap", pcap(EXPORTED, [(1.0, packet)]))
    with pytest.raises(LogError, match=r"0x640 to 0x64F; there are 0x123"):
        list(log)


def test_a_bus_without_a_robot_is_told(tmp_path: Path) -> None:
    log = read(tmp_path / "a.pcap", pcap(CAN, [(1.0, can(0x123, bytes(8)))]))
    with pytest.raises(LogError, match=r"0x640 to 0x64F; there are 0x123"):
        list(log)


@pytest.mark.parametrize(
    ("link", "name"),
    [
        (220, "USB frames (usbmon)"), (189, "USB frames (usbmon)"), (249, "USB frames (USBPcap)"), (105, "802.11"),
        (127, "radiotap"), (187, "Bluetooth"), (190, "CAN20B"), (147, "a user's own type"), (65000, "does not know"),
    ],
)  # fmt: skip
@pytest.mark.parametrize("make", [pcap, pcapng])
def test_other_link_types_are_named_with_the_remedy(
    link: int, name: str, make: Callable[[int, Packets], bytes], tmp_path: Path
) -> None:
    path = tmp_path / "a.pcap"
    path.write_bytes(make(link, [(1.0, b"\xfa\xfb" * 20)] * 3))
    done = run("decode", path)
    message = done.stderr.decode()
    assert (done.returncode, done.stdout, message.count("\n")) == (2, b"", 1)
    assert name in message
    assert f"link type {link}, which is not read" in message
    assert "tcpdump -i" in message or "argusd --record" in message


def test_a_file_of_two_kinds_gives_the_one_that_is_read(tmp_path: Path) -> None:
    log = read(tmp_path / "a.pcapng", pcapng(220, [(1.0, bytes(64))]) + pcapng(CAN, plain()))
    assert joined(list(log), "r2c") == ROBOT
    assert [entry.what for entry in log.damage] == ["USB frames (usbmon), link type 220, are passed over"]
