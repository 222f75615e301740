# SPDX-License-Identifier: MIT
"""stats, convert, diff and plot say what is in a log, whatever its format, and leave nothing out silently."""

from __future__ import annotations

import errno
import gzip
import json
import math
import os
import re
import struct
import subprocess
import sys
import xml.etree.ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zstandard
from argus_tools.formats import LogError
from argus_tools.log import plot
from argus_tools.log.common import binary_output
from argus_tools.log.plot import POINTS_MAX, Series
from argus_tools.log.spans import DEAD, SUSPECT, Happening, Span, spans
from logs import CAPTURES, capture_bytes, command, decode, jsonl, run, sip
from matplotlib.backends.backend_agg import FigureCanvasAgg
from mcap.reader import make_reader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from hil_sim.tables import load

RAM = CAPTURES / "d_ram.jsonl"
SAMPLE = Path(__file__).resolve().parents[3] / "docs" / "samples" / "two-failing-sonars.rec.gz"


def stats(path: Path, *arguments: str) -> dict[str, Any]:
    done = run("stats", "--json", path, *arguments)
    assert done.returncode == 0
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_stats_count_what_the_readme_counts() -> None:
    found = stats(RAM)
    count = {"c2r": 0, "r2c": 0}
    for kind in found["types"]:
        count[kind["dir"]] += kind["count"]
    assert count == {"c2r": 65, "r2c": 238}
    assert found["bytes"] == {d: len(capture_bytes(RAM, d)) for d in ("c2r", "r2c")}
    assert found["damage"] == {}


def test_stats_of_damage() -> None:
    found = stats(CAPTURES / "p10_badck.jsonl")
    assert found["damage"] == {"c2r": {"packets": 1, "bad_checksum": 1, "bytes": 21}}


def test_stats_of_a_sonar_and_of_gaps(tmp_path: Path) -> None:
    path = tmp_path / "a.jsonl"
    times = [0.0, 0.1, 0.2, 0.3, 1.3, 1.4]
    readings = [1000, 5000, 1400, 5000, 400, 5000]
    path.write_bytes(jsonl((t, "r2c", sip(sonars=((3, mm),))) for t, mm in zip(times, readings, strict=True)))
    found = stats(path)
    assert found["sip_gaps"]["first"] == [[0.3, pytest.approx(1.0)]]
    sonar = found["sonar"]["3"]
    assert (sonar["readings"], sonar["dropout_share"], sonar["min_mm"], sonar["max_mm"]) == (
        6,
        0.5,
        400,
        1400,
    )
    assert sonar["refresh_s"] == pytest.approx(0.28)
    assert sonar["histogram_mm"]["counts"][:3] == [1, 0, 2]
    kind = next(k for k in found["types"] if k["type"] == "SIP")
    assert (kind["longest_s"], kind["longest_at"]) == (pytest.approx(1.0), 0.3)


def test_stats_in_words_name_every_sonar() -> None:
    text = run("stats", RAM).stdout.decode()
    assert "SIP" in text
    assert all(f"\n{number:>5} " in text for number in range(16))


@pytest.mark.parametrize("ending", ["jsonl", "log", "pcap", "pcapng", "rec", "jsonl.gz"])
def test_convert_keeps_every_packet(tmp_path: Path, ending: str) -> None:
    made = tmp_path / f"log.{ending}"
    assert run("convert", CAPTURES / "p10_badck.jsonl", made).returncode == 0
    assert run("diff", CAPTURES / "p10_badck.jsonl", made).returncode == 0
    assert run("diff", made, RAM).returncode == 1


def test_convert_to_bin_gives_the_bytes(tmp_path: Path) -> None:
    made = tmp_path / "robot.bin"
    assert run("convert", RAM, made).returncode == 2
    assert not made.exists()
    assert run("convert", RAM, made, "--dir", "r2c").returncode == 0
    assert made.read_bytes() == capture_bytes(RAM, "r2c")
    sent, got = decode(RAM, "--dir", "r2c"), decode(made)
    assert [{**row, "t": None} for row in sent] == got


def test_convert_refuses_what_it_cannot_do(tmp_path: Path) -> None:
    copy = tmp_path / "a.jsonl"
    copy.write_bytes(RAM.read_bytes())
    for arguments in ([copy, copy], [copy, tmp_path / "a.xyz"], [copy, tmp_path / "no" / "a.csv"]):
        done = run("convert", *arguments)
        assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)
    assert copy.read_bytes() == RAM.read_bytes()


def messages_of(path: Path) -> dict[str, list[tuple[int, Any]]]:
    """Every message of an MCAP by its topic, read by the definitions that the file has, with its time in ns."""
    found: dict[str, list[tuple[int, Any]]] = {}
    with Reader(path) as reader:
        stores = {}
        for connection in reader.connections:
            stores[connection.id] = get_typestore(Stores.EMPTY)
            stores[connection.id].register(get_types_from_msg(connection.msgdef.data, connection.msgtype))
        for connection, t_ns, raw in reader.messages():
            message = stores[connection.id].deserialize_cdr(raw, connection.msgtype)
            found.setdefault(connection.topic, []).append((t_ns, message))
    return found


def test_mcap_has_sips_places_points_and_events(tmp_path: Path) -> None:
    made = tmp_path / "a.mcap"
    assert run("convert", RAM, made).returncode == 0
    sips = decode(RAM, "--type", "SIP")
    found = messages_of(made)
    assert {topic: len(messages) for topic, messages in found.items()} == {
        "/sip": len(sips),
        "/tf": len(sips),
        "/sonar/points": len(sips),
        "/events": 303 - len(sips),
    }
    poses = {pose["number"]: pose for pose in load("robots/p3dx-sh")["sonar"]["pose"]}
    for row, (at, sip_), (_, tf), (_, cloud) in zip(
        sips, found["/sip"], found["/tf"], found["/sonar/points"], strict=True
    ):
        assert at == round(row["t"] * 1e9) == sip_.stamp.sec * 10**9 + sip_.stamp.nanosec
        readings = {str(n): mm for n, mm in zip(sip_.sonar.tolist(), sip_.range_mm.tolist(), strict=True)}
        assert readings == row["sonar"]
        for name in (
            "x_mm",
            "y_mm",
            "heading_deg",
            "vel_left_mm_s",
            "battery_v",
            "flags",
            "motors",
            "moving",
        ):
            assert getattr(sip_, name) == row[name], name
        place = tf.transforms[0].transform
        assert place.translation.x == pytest.approx(row["x_mm"] / 1000, abs=1e-5)
        turned = math.degrees(2 * math.atan2(place.rotation.z, place.rotation.w))
        assert (turned - row["heading_deg"] + 180) % 360 == pytest.approx(180, abs=1e-3)
        points = np.frombuffer(cloud.data.tobytes(), "<f4").reshape(-1, 3)
        assert [field.name for field in cloud.fields] == ["x", "y", "z"]
        assert cloud.width * cloud.point_step == cloud.row_step == len(cloud.data)
        for (number, mm), (x, y, _) in zip(row["sonar"].items(), points, strict=True):
            if mm >= 5000:
                assert math.isnan(x)
                continue
            pose = poses[int(number)]
            heading = math.radians(pose["heading_deg"])
            assert x == pytest.approx((pose["x_mm"] + mm * math.cos(heading)) / 1000, abs=1e-4)
            assert y == pytest.approx((pose["y_mm"] + mm * math.sin(heading)) / 1000, abs=1e-4)


@pytest.mark.tour(2)
@pytest.mark.parametrize("path", sorted(CAPTURES.glob("*.jsonl")), ids=lambda path: path.stem)
def test_every_packet_is_in_the_mcap_and_both_readers_agree(path: Path, tmp_path: Path) -> None:
    made = tmp_path / "a.mcap"
    assert run("convert", path, made).returncode == 0
    found = messages_of(made)
    assert len(found.get("/sip", [])) + len(found.get("/events", [])) == len(decode(path))
    times: dict[str, list[int]] = {}
    with made.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            assert schema is not None
            assert (schema.encoding, channel.message_encoding) == ("ros2msg", "cdr")
            times.setdefault(channel.topic, []).append(message.log_time)
    assert times == {topic: [at for at, _ in messages] for topic, messages in found.items()}
    for at, event in found.get("/events", []):
        assert event.stamp.sec * 10**9 + event.stamp.nanosec == at
        assert event.level in (20, 40)


def test_the_index_of_an_mcap_leads_to_each_message(tmp_path: Path) -> None:
    made = tmp_path / "a.mcap"
    assert run("convert", RAM, made).returncode == 0
    data = made.read_bytes()
    with made.open("rb") as file:
        summary = make_reader(file, validate_crcs=True).get_summary()
    assert summary is not None
    seen = 0
    for index in summary.chunk_indexes:
        assert index.compression == "zstd"
        start = index.chunk_start_offset
        packed = data[start + index.chunk_length - index.compressed_size : start + index.chunk_length]
        chunk = zstandard.decompress(packed, max_output_size=index.uncompressed_size)
        for channel, at in index.message_index_offsets.items():
            opcode, _, number, size = struct.unpack_from("<BQHI", data, at)
            assert (opcode, number) == (7, channel)
            for t_ns, place in struct.iter_unpack("<QQ", data[at + 15 : at + 15 + size]):
                mark, _, of, _, log_time, _ = struct.unpack_from("<BQHIQQ", chunk, place)
                assert (mark, of, log_time) == (5, channel, t_ns)
                seen += 1
    assert summary.statistics is not None
    assert seen == summary.statistics.message_count


def test_an_mcap_is_smaller_than_the_recording(tmp_path: Path) -> None:
    recording, made = tmp_path / "a.rec", tmp_path / "a.mcap"
    recording.write_bytes(gzip.decompress(SAMPLE.read_bytes()))
    assert run("convert", recording, made).returncode == 0
    assert made.stat().st_size < 1.5 * recording.stat().st_size


def test_diff_names_the_field_that_differs(tmp_path: Path) -> None:
    one, two = tmp_path / "one.jsonl", tmp_path / "two.jsonl"
    same = [(float(n), "r2c", sip(x=n)) for n in range(9)]
    one.write_bytes(
        jsonl([*same, (9.0, "r2c", sip(x=9, sonars=((3, 700),))), (10.0, "c2r", command("STOP"))])
    )
    two.write_bytes(jsonl([*same[:4], *same[5:], (9.0, "r2c", sip(x=9, sonars=((3, 710),)))]))
    lines = run("diff", one, two).stdout.decode().splitlines()
    assert len(lines) == 4
    assert lines[0].startswith("- ")
    assert "x      4" in lines[0]
    assert "sonar 3: 700 -> 710" in lines[1]
    assert "STOP" in lines[2]


def test_spans_from_events() -> None:
    said = [(1.0, "SONAR_SUSPECT"), (2.0, "SONAR_VERIFYING"), (3.0, "SONAR_DISABLED"), (7.0, "SONAR_HEALTHY")]
    found = spans([Happening(t, event, 3) for t, event in said] + [Happening(8.0, "SONAR_DEAD", 4)], 9.0)
    assert found == [Span(3, "suspect", 1.0, 3.0), Span(3, "dead", 3.0, 7.0), Span(4, "dead", 8.0, 9.0)]


def test_a_long_series_keeps_its_extremes() -> None:
    series = Series()
    for n in range(5 * POINTS_MAX):
        series.add(float(n), 100.0 if n == 17_777 else 5000.0 if n == 34_001 else 2000.0 + n % 7)
    assert len(series.t) <= 2 * POINTS_MAX
    assert list(series.t) == sorted(series.t)
    assert (min(series.value), max(series.value)) == (100.0, 5000.0)


@pytest.mark.soak
@pytest.mark.parametrize("view", ["ranges", "path", "ring"])
@pytest.mark.parametrize("ending", ["png", "svg"])
def test_pictures_are_drawn(tmp_path: Path, view: str, ending: str) -> None:
    made = tmp_path / f"a.{ending}"
    done = run("plot", RAM, "-o", made, "--view", view)
    assert done.returncode == 0, done.stderr
    data = made.read_bytes()
    if ending == "svg":
        assert xml.etree.ElementTree.fromstring(data).tag.endswith("svg")
    else:
        width, height = struct.unpack(">II", data[16:24])
        assert data.startswith(b"\x89PNG")
        assert min(width, height) > 500


@pytest.mark.tour(2)
@pytest.mark.parametrize("range_mm", [0, 400, 1300, 4900, 5000])
def test_no_label_of_the_ring_lies_on_another_or_on_an_arc(range_mm: int) -> None:
    held = {3: SUSPECT, 12: DEAD}
    last = {number: (0.0, range_mm + number) for number in plot.POSES}
    figure = plot._draw_ring("drive.rec", 1795590244.5, 59.9, last, held)
    canvas: Any = FigureCanvasAgg(figure)
    renderer = canvas.get_renderer()
    figure.draw_without_rendering()
    (axes,) = figure.axes
    boxes = [text.get_window_extent(renderer) for text in axes.texts]
    assert len(boxes) == len(plot.POSES)
    arcs = [axes.transData.transform(line.get_xydata()) for line in axes.lines]
    for at, box in enumerate(boxes):
        assert not [other for other in boxes[at + 1 :] if box.overlaps(other)], axes.texts[at].get_text()
        assert not [point for arc in arcs for point in arc if box.contains(*point)], axes.texts[at].get_text()


def test_times_on_pictures_are_those_that_people_read() -> None:
    assert "2026-11-25 07:04:04 UTC" in plot.ring_title("a.rec", 1795590244.5, 59.9)
    assert "UTC" not in plot.ring_title("a.rec", 59.9, 59.9)


@pytest.mark.soak
def test_pictures_that_cannot_be_drawn(tmp_path: Path) -> None:
    for arguments in (
        ["-o", "a.gif"],
        ["-o", tmp_path / "a.png", "--sonar", "40"],
        ["-o", tmp_path / "n" / "a.png"],
    ):
        done = run("plot", RAM, "--no-faults", *arguments)
        assert (done.returncode, len(done.stderr.splitlines())) == (2, 1)


def test_each_command_has_help_with_examples() -> None:
    for name in ("decode", "stats", "plot", "convert", "diff"):
        text = run(name, "--help").stdout.decode()
        assert "examples:" in text
        assert "exit codes:" in text


@pytest.mark.parametrize("command", [["stats"], ["decode"], ["faults"], ["faults", "--events"], ["--help"]])
def test_where_only_ascii_can_be_printed(tmp_path: Path, command: list[str]) -> None:
    """Under LANG=C a name with other letters and the bars of a histogram come out as ASCII."""
    log = tmp_path / "Café.jsonl"
    log.write_bytes(RAM.read_bytes())
    environment = {"PATH": os.environ["PATH"], "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"}
    words = [
        sys.executable,
        "-m",
        "argus_tools.log.cli",
        *command,
        *([] if command == ["--help"] else [str(log)]),
    ]
    done = subprocess.run(words, env=environment, capture_output=True, check=False, timeout=600)
    assert done.returncode == 0, done.stderr
    assert done.stdout.isascii()
    assert b"Traceback" not in done.stderr


@pytest.mark.parametrize("name", ["a.png", "a.svg", "a.mcap", "a.jsonl.gz"])
def test_a_full_disk_is_told_by_the_output_and_leaves_no_part_of_it(name: str, tmp_path: Path) -> None:
    path = tmp_path / name

    def fill() -> None:
        with binary_output(str(path)) as stream:
            stream.write(b"half")
            raise OSError(errno.ENOSPC, "No space left on device")

    with pytest.raises(LogError, match=f"{re.escape(str(path))}: cannot be written: No space left"):
        fill()
    assert not path.exists()


def test_what_cannot_be_opened_for_writing_is_left_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "folder.png"
    path.mkdir()
    with pytest.raises(LogError, match="cannot be written"), binary_output(str(path)):
        pass
    assert path.is_dir()
