# SPDX-License-Identifier: MIT
"""stats, convert, diff and plot say what is in a log, whatever its format, and leave nothing out silently."""

from __future__ import annotations

import errno
import json
import os
import re
import struct
import subprocess
import sys
import xml.etree.ElementTree
from pathlib import Path
from typing import Any

import pytest
from argus_tools.formats import LogError
from argus_tools.log import plot
from argus_tools.log.common import binary_output
from argus_tools.log.plot import POINTS_MAX, Series
from argus_tools.log.spans import DEAD, SUSPECT, Happening, Span, spans
from logs import CAPTURES, capture_bytes, command, decode, jsonl, run, sip
from matplotlib.backends.backend_agg import FigureCanvasAgg
from mcap.reader import make_reader

from hil_sim.tables import load

RAM = CAPTURES / "d_ram.jsonl"


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


def test_mcap_has_poses_validity_odometry_and_events(tmp_path: Path) -> None:
    made = tmp_path / "a.mcap"
    assert run("convert", RAM, made).returncode == 0
    poses = {pose["number"]: pose for pose in load("robots/p3dx-sh")["sonar"]["pose"]}
    sips = decode(RAM, "--type", "SIP")
    with made.open("rb") as file:
        reader = make_reader(file)
        summary = reader.get_summary()
        assert summary is not None
        schemas = {schema.name: json.loads(schema.data) for schema in summary.schemas.values()}
        assert {"argus.SonarRange", "foxglove.PoseInFrame", "foxglove.Log"} <= set(schemas)
        messages = [
            (s.name, c.topic, m.log_time, json.loads(m.data)) for s, c, m in reader.iter_messages() if s
        ]
    for name, _, _, message in messages:
        assert set(message) <= set(schemas[name]["properties"])
    beams = [message["entities"] for _, topic, _, message in messages if topic == "/sonar/beams"]
    assert [len(entities) for entities in beams] == [len(row["sonar"]) for row in sips if row["sonar"]]
    ranges = [(at, message) for _, topic, at, message in messages if topic == "/sonar/03"]
    assert [message["range_mm"] for _, message in ranges] == [row["sonar"]["3"] for row in sips]
    assert [at for at, _ in ranges] == [round(row["t"] * 1e9) for row in sips]
    for _, message in ranges:
        assert message["valid"] == (100 <= message["range_mm"] < 5000)
        assert message["pose"]["position"]["x"] == poses[3]["x_mm"] / 1000
        assert message["field_of_view_rad"] == pytest.approx(0.5236, abs=1e-4)
    assert sum(topic == "/odometry" for _, topic, _, _ in messages) == len(sips)
    assert sum(topic == "/events" for _, topic, _, _ in messages) == 303 - len(sips)


def conflicts(value: Any, schema: dict[str, Any], where: str = "") -> list[str]:
    """Where a value is not what its schema, of the kinds used here, says."""
    kinds: dict[str, Any] = {
        "object": dict,
        "array": list,
        "string": str,
        "boolean": bool,
        "integer": int,
        "number": (int, float),
    }
    kind = kinds[schema["type"]]
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        return [f"{where}: {value!r} is no {schema['type']}"]
    if isinstance(value, list):
        item = schema.get("items")
        return [] if item is None else [c for one in value for c in conflicts(one, item, f"{where}[]")]
    if not isinstance(value, dict):
        return [] if value >= schema.get("minimum", value) else [f"{where}: {value!r} is too small"]
    known = schema["properties"]
    found = [f"{where}.{name}: not in the schema" for name in value if name not in known]
    for name in value.keys() & known.keys():
        found += conflicts(value[name], known[name], f"{where}.{name}")
    return found


# As its documentation gives them, docs.foxglove.dev/docs/sdk/schemas.
FOXGLOVE = {
    "foxglove.Log": {"timestamp", "level", "message", "name", "file", "line"},
    "foxglove.PoseInFrame": {"timestamp", "frame_id", "pose"},
    "foxglove.FrameTransform": {"timestamp", "parent_frame_id", "child_frame_id", "translation", "rotation"},
    "foxglove.SceneUpdate": {"deletions", "entities"},
}
OPTIONAL = {"range_m", "pose", "age_ms", "health", "fault"}


@pytest.mark.tour(2)
@pytest.mark.parametrize("path", sorted(CAPTURES.glob("*.jsonl")), ids=lambda path: path.stem)
def test_every_message_of_an_mcap_is_as_its_schema_says(path: Path, tmp_path: Path) -> None:
    made = tmp_path / "a.mcap"
    assert run("convert", path, made).returncode == 0
    seen = set()
    with made.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            assert schema is not None
            assert (schema.encoding, channel.message_encoding) == ("jsonschema", "json")
            rules, value = json.loads(schema.data), json.loads(message.data)
            assert conflicts(value, rules, channel.topic) == []
            assert rules["properties"].keys() - value.keys() <= OPTIONAL
            stamped = value["entities"][0] if schema.name == "foxglove.SceneUpdate" else value
            assert stamped["timestamp"] == dict(
                zip(("sec", "nsec"), divmod(message.log_time, 10**9), strict=True)
            )
            if schema.name.startswith("foxglove."):
                assert value.keys() == FOXGLOVE[schema.name]
            seen.add(schema.name)
    # One of the captures is of a robot without sonars.
    assert seen | {"foxglove.SceneUpdate"} >= FOXGLOVE.keys() | {"argus.RobotState"}


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
