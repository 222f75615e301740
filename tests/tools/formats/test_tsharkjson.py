# SPDX-License-Identifier: MIT
"""Rule: frames that tshark prints as JSON are read if their bytes are among it; what has none is told by its name."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from argus_tools.formats.tcp import Connection
from forms import CLIENT, COMMANDS, ROBOT, SIPS, START_S, frames, joined, read
from logs import run

Layers = dict[str, Any]
# A frame as it was captured, and its time.
Packet = tuple[float, bytes]


def can_packets() -> list[Packet]:
    return [(f.t, struct.pack(">IB3x", f.can_id, len(f.data)) + f.data) for f in frames()]


def tcp_packets() -> list[Packet]:
    connection = Connection()
    out = [(START_S, data) for data in connection.opening()]
    for n, (command, sip) in enumerate(zip(COMMANDS, SIPS, strict=True)):
        out += [(START_S + 0.1 * n, data) for data in connection.frames("c2r", command)]
        out += [(START_S + 0.1 * n, data) for data in connection.frames("r2c", sip)]
    return out


def can_layers(data: bytes, hexadecimal: bool = False) -> Layers:
    can_id = int.from_bytes(data[:4], "big")
    shown = f"0x{can_id:08x}" if hexadecimal else str(can_id)
    return {
        "can": {"can.id": shown, "can.flags.xtd": "0", "can.flags.rtr": "0", "can.len": str(data[4])},
        "data": {"data.data": data[8:].hex(":"), "data.len": str(data[4])},
    }


def tcp_layers(data: bytes) -> Layers:
    source, target, sequence, _, offset, flags = struct.unpack_from(">HHIIBB", data, 34)
    fields: Layers = {
        "tcp.srcport": str(source), "tcp.dstport": str(target), "tcp.seq": "1", "tcp.seq_raw": str(sequence),
        "tcp.flags": f"0x{flags:04x}", "tcp.flags_tree": {"tcp.flags.push": "1"},
    }  # fmt: skip
    if payload := data[34 + (offset >> 4) * 4 :]:
        fields["tcp.payload"] = payload.hex(":")
    address = [".".join(map(str, data[at : at + 4])) for at in (26, 30)]
    return {"ip": {"ip.src": address[0], "ip.dst": address[1]}, "tcp": fields}


def frame_layer(t: float) -> Layers:
    return {"frame": {"frame.time": "Nov 25, 2026 07:03:04.251102000 UTC", "frame.time_epoch": f"{t:.9f}"}}


def record(layers: Layers) -> Layers:
    return {"_index": "packets-2026-11-25", "_type": "doc", "_score": None, "_source": {"layers": layers}}


def ek(layers: Layers) -> Layers:
    return {
        layer: {f"{layer}_{name.replace('.', '_')}": value for name, value in fields.items()}
        for layer, fields in layers.items()
    }


def ek_lines(t: float, layers: Layers) -> str:
    return (
        json.dumps({"index": {"_index": "packets-2026-11-25", "_type": "doc"}})
        + "\n"
        + json.dumps({"timestamp": f"{t * 1000:.0f}", "layers": layers})
        + "\n"
    )


def raw(data: bytes) -> Layers:
    return {"frame_raw": [data.hex(), 0, len(data), 0, 1]}


Print = Callable[[list[tuple[float, bytes, Layers]]], str]
PRINTS: dict[str, Print] = {
    "-T json": lambda all_of: json.dumps([record({**frame_layer(t), **x}) for t, _, x in all_of], indent=2),
    "-T json in one line": lambda all_of: json.dumps([record({**frame_layer(t), **x}) for t, _, x in all_of]),
    "-T json, through jq -c": lambda all_of: "".join(
        json.dumps(record({**frame_layer(t), **x})) + "\n" for t, _, x in all_of
    ),
    "-T json -x": lambda all_of: json.dumps(
        [record({**raw(data), **frame_layer(t), **x}) for t, data, x in all_of], indent=2
    ),
    "-T jsonraw": lambda all_of: json.dumps([record(raw(data)) for _, data, _ in all_of], indent=2),
    "-T json -e": lambda all_of: json.dumps(
        [
            record({name: [v] for fields in (*frame_layer(t).values(), *x.values()) for name, v in fields.items()})
            for t, _, x in all_of
        ]
    ),
    "-T ek": lambda all_of: "".join(ek_lines(t, ek({**frame_layer(t), **x})) for t, _, x in all_of),
    "-T ek -x": lambda all_of: "".join(
        ek_lines(t, {"frame_raw": data.hex(), **ek({**frame_layer(t), **x})}) for t, data, x in all_of
    ),
    "below what it says of itself": lambda all_of: (
        "Running as user \"root\" and group \"root\".\n"
        + json.dumps([record({**frame_layer(t), **x}) for t, _, x in all_of], indent=2)
    ),
}  # fmt: skip
KINDS: dict[str, tuple[list[Packet], Callable[[bytes], Layers]]] = {
    "CAN": (can_packets(), can_layers),
    "CAN, ids in hexadecimal": (can_packets(), lambda data: can_layers(data, True)),
    "TCP": (tcp_packets(), tcp_layers),
}


def printed(kind: str, how: str) -> str:
    packets, layers = KINDS[kind]
    return PRINTS[how]([(t, data, layers(data)) for t, data in packets])


@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("how", PRINTS)
@pytest.mark.parametrize("kind", KINDS)
def test_every_way_to_print_them(kind: str, how: str, end: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.json", printed(kind, how).replace("\n", end))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r"), log.damage) == (ROBOT, CLIENT, [])
    assert log.format.name == "tshark-json"
    times = [chunk.t for chunk in chunks if chunk.dir == "r2c"]
    if how == "-T jsonraw":
        assert set(times) == {None}
    else:
        assert times == pytest.approx([START_S + 0.1 * n for n in range(12)], abs=0.02)


@pytest.mark.parametrize("how", ["-T json", "-T ek", "-T json -x"])
@pytest.mark.parametrize("kind", ["CAN", "TCP"])
def test_a_cut_end_is_told(kind: str, how: str, tmp_path: Path) -> None:
    log = read(tmp_path / "a.json", printed(kind, how)[:-90])
    assert joined(list(log), "r2c").startswith(b"".join(SIPS[:11]))
    assert log.damage[0].place == f"frame {len(KINDS[kind][0])}"


@pytest.mark.parametrize("how", ["-T json", "-T ek", "-T json -x"])
def test_the_same_through_a_pipe(how: str, tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(printed("TCP", how))
    whole = run("decode", tmp_path / "a.json")
    piped = run("decode", "-", stdin=printed("TCP", how).encode())
    assert (whole.returncode, piped.stdout) == (0, whole.stdout)


def without_bytes(kind: str) -> list[Layers]:
    packets, layers = KINDS[kind]
    out = [layers(data) for _, data in packets]
    for fields in (fields for one in out for fields in one.values()):
        fields.pop("data.data", None)
        fields.pop("tcp.payload", None)
    return out


@pytest.mark.parametrize("kind", ["CAN", "TCP"])
@pytest.mark.parametrize("how", ["json", "ek"])
def test_what_has_no_bytes_is_told(kind: str, how: str, tmp_path: Path) -> None:
    layers = without_bytes(kind)
    text = json.dumps(list(map(record, layers)), indent=2)
    if how == "ek":
        text = "".join(ek_lines(START_S, ek(one)) for one in layers)
    (tmp_path / "a.json").write_text(text)
    done = run("decode", tmp_path / "a.json")
    message = done.stderr.decode()
    assert (done.returncode, done.stdout, message.count("\n")) == (2, b"", 1)
    assert "looks like what tshark prints as JSON, without the bytes" in message
    assert "-T json -x" in message


@pytest.mark.parametrize(
    "broken",
    [
        '"can.id": "many"', '"can.id": ""', '"can.id": {}', '"can.id": [[[]]]', '"data.data": "0g"',
        '"can.len": "x"', '"can.id": "99999999999"', '"frame_raw": 7', '"frame_raw": ["zz"]',
        '"tcp.srcport": "1", "tcp.payload": "fa"',
    ],
)  # fmt: skip
def test_a_frame_that_is_none_costs_itself_alone(broken: str, tmp_path: Path) -> None:
    lines = printed("CAN", "-T json, through jq -c").splitlines(keepends=True)
    wrong = '{"_index": "packets-1", "_source": {"layers": {"x": {%s}}}}\n' % broken  # noqa: UP031
    log = read(tmp_path / "a.json", "".join([*lines[:1], wrong, *lines[1:], '{"_source": 3}\n']))
    chunks = list(log)
    assert (joined(chunks, "r2c"), joined(chunks, "c2r")) == (ROBOT, CLIENT)


NAMED = {
    "-V": (
        "Frame 1: 16 bytes on wire (128 bits), 16 bytes captured (128 bits) on interface can0, id 0\n"
        "    Frame Number: 1\nController Area Network, ID: 1600 (0x640), Length: 8\n"
        "Data (8 bytes)\n    Data: 06fafb03000000cc\n    [Length: 8]\n\n",
        "what tshark -V prints",
        "-V -x",
    ),
    "-T pdml": ('<?xml version="1.0"?>\n<?xml-stylesheet?>\n<pdml version="0">\n<packet>\n', "pdml", "-x"),
    "-T psml": ('<?xml version="1.0"?>\n<psml version="0">\n<structure>\n', "psml", "-x"),
    "Docker's own": (
        '{"log":"(1.0) can0 648#06FAFB03000000\\n","stream":"stdout","time":"2026-11-25T06:38:47Z"}\n',
        "as Docker keeps it",
        "jq -j .log",
    ),
    "journalctl -o json": (
        '{"MESSAGE":"(1.0) can0 648#06FAFB03000000","_PID":"1"}\n', "the journal as JSON", "jq -r .MESSAGE"
    ),
    "journalctl -o json, of another order": (
        '{"__CURSOR":"s=1","_PID":"1","MESSAGE":"x"}\n', "the journal as JSON", "jq -r .MESSAGE"
    ),
    "journalctl -o export": (
        "__CURSOR=s=2b\n__REALTIME_TIMESTAMP=1795577927479113\nMESSAGE=(1.0) can0 648#06FAFB03000000\n\n",
        "export format",
        "sed -n",
    ),
}  # fmt: skip


@pytest.mark.parametrize("count", [1, 200])
@pytest.mark.parametrize("name", NAMED)
def test_what_is_not_read_is_told_with_the_remedy(name: str, count: int, tmp_path: Path) -> None:
    text, what, remedy = NAMED[name]
    (tmp_path / "a.txt").write_text(text * count)
    done = run("decode", tmp_path / "a.txt")
    message = done.stderr.decode()
    assert (done.returncode, done.stdout, message.count("\n")) == (2, b"", 1)
    assert what in message
    assert remedy in message
