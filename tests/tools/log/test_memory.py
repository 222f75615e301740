# SPDX-License-Identifier: MIT
"""Rule: no subcommand needs more memory for a longer log, nor for one that is nothing but damage."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import bags
import pytest
from forms import ROBOT, frames, hexdump_c
from logs import CAPTURES, ROOT
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

pytestmark = pytest.mark.soak

SHORT_BYTES, LONG_BYTES = 4 << 20, 16 << 20
GROWTH_KB = 12 << 10
# Prints the largest resident size of the command that its arguments are, in kB.
_PEAK = (
    "import resource, subprocess, sys; done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL);"
    "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, done.returncode)"
)


def peak_kb(*arguments: str | Path) -> int:
    """Run argus-log; return its largest resident size."""
    command = [sys.executable, "-m", "argus_tools.log.cli", *map(str, arguments)]
    environment = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}", "MALLOC_ARENA_MAX": "1"}
    done = subprocess.run(
        [sys.executable, "-c", _PEAK, *command], capture_output=True, text=True, env=environment, check=True
    )
    kilobytes, code = map(int, done.stdout.split())
    assert code < 2, done.stderr[-500:]
    return kilobytes


def session(path: Path, size: int) -> Path:
    """Write the recorded session over and over, as one long session."""
    records = [json.loads(line) for line in (CAPTURES / "d_ram.jsonl").read_text().splitlines()]
    records = [record for record in records if "hex" in record]
    written, shift = 0, 0.0
    with path.open("w") as file:
        while written < size:
            text = "".join(
                json.dumps({"t": round(r["t"] + shift, 6), "dir": r["dir"], "hex": r["hex"]}) + "\n"
                for r in records
            )
            written += file.write(text)
            shift += records[-1]["t"] + 0.1
    return path


@pytest.fixture(scope="module")
def logs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("logs")
    return session(folder / "short.jsonl", SHORT_BYTES), session(folder / "long.jsonl", LONG_BYTES)


@pytest.mark.tour(3, 3)
@pytest.mark.parametrize(
    "arguments",
    [
        "decode --json LOG", "stats LOG", "faults LOG", "diff LOG LOG", "plot LOG -o OUT.png --no-faults",
        "convert LOG OUT.rec", "plot LOG -o OUT.png --view path",
    ],
)  # fmt: skip
def test_a_longer_log_takes_no_more(arguments: str, logs: tuple[Path, Path], tmp_path: Path) -> None:
    short, long = (
        peak_kb(*arguments.replace("LOG", str(log)).replace("OUT", str(tmp_path / "out")).split())
        for log in logs
    )
    assert long - short < GROWTH_KB, f"{short} kB, then {long} kB"


def test_a_longer_log_takes_no_more_as_mcap(tmp_path: Path) -> None:
    # A message for each reading: 20 times the work of other formats, so these logs are smaller.
    peaks = [
        peak_kb("convert", session(tmp_path / "a.jsonl", size), tmp_path / "a.mcap")
        for size in (1 << 18, 1 << 20)
    ]
    assert peaks[1] - peaks[0] < GROWTH_KB, peaks


@pytest.mark.tour(2, 2)
@pytest.mark.parametrize("form", ["hexdump", "hextext", "screen", "csv"])
def test_a_longer_text_takes_no_more(form: str, tmp_path: Path) -> None:
    makes: dict[str, Callable[[int], str]] = {
        "hexdump": lambda n: hexdump_c(ROBOT * n),
        "hextext": lambda n: (ROBOT * n).hex(" "),
        "screen": lambda n: (
            "".join(f"  can0  {f.can_id:3X}   [8]  {f.data.hex(' ')}\n" for f in frames()) * n
        ),
        "csv": lambda n: "Bus,ID,Data\n" + "".join(f"0,{f.can_id:X},{f.data.hex()}\n" for f in frames()) * n,
    }
    path, peaks = tmp_path / "a.txt", []
    for times in (300, 1200):
        path.write_text(makes[form](times))
        peaks.append(peak_kb("decode", "--json", path))
    assert peaks[1] - peaks[0] < GROWTH_KB, peaks


def _torn_line(rng: random.Random) -> bytes:
    return b'{"t": 1, "dir": "r2c", "hex": "' + rng.randbytes(4).hex().encode() + b"\n"


def _bad_packet(rng: random.Random) -> bytes:
    return b'{"t": 1, "dir": "c2r", "hex": "fafb07' + rng.randbytes(7).hex().encode() + b'"}\n'


@pytest.mark.parametrize("make", [_torn_line, _bad_packet])
def test_a_log_of_nothing_but_damage_takes_no_more(
    make: Callable[[random.Random], bytes], tmp_path: Path
) -> None:
    rng = random.Random(4)
    good = next(line for line in (CAPTURES / "d_ram.jsonl").open("rb") if b'"r2c"' in line)
    block = b"".join(make(rng) for _ in range(1000))
    path, peaks = tmp_path / "a.jsonl", []
    for size in (1 << 20, 4 << 20):
        path.write_bytes(good + block * (size // len(block)))
        peaks.append(peak_kb("decode", "--json", path))
    assert peaks[1] - peaks[0] < GROWTH_KB, peaks


def long_bag(path: Path, rounds: int) -> Path:
    """Write the same pose and the same ranges over and over, at rest."""
    store = get_typestore(Stores.ROS1_NOETIC)
    types = store.types
    header = types["std_msgs/msg/Header"](0, types["builtin_interfaces/msg/Time"](1_700_000_000, 0), "odom")
    point, points = types["geometry_msgs/msg/Point32"], list(bags.points([1000.0] * 16))
    cloud = types["sensor_msgs/msg/PointCloud"](header, [point(x, y, 0.0) for x, y in points], [])
    raw = store.serialize_ros1(cloud, "sensor_msgs/msg/PointCloud")
    with Writer(path) as bag:
        topic = bag.add_connection("/sonar", "sensor_msgs/msg/PointCloud", typestore=store)
        for n in range(rounds):
            bag.write(topic, 1_700_000_000_000_000_000 + n * 100_000_000, raw)
    return path


def test_a_longer_bag_takes_little_more(tmp_path: Path) -> None:
    # Of each message the place in the bag is kept, as ROS 1 has no order by time.
    peaks = [peak_kb("decode", long_bag(tmp_path / f"{n}.bag", n)) for n in (10_000, 100_000)]
    assert peaks[1] - peaks[0] < GROWTH_KB, peaks
