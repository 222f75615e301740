# SPDX-License-Identifier: MIT
"""Measures how fast simulator, logs and core are, each as a ratio of two things measured in turn in one run.

Of each pair the median of some rounds is taken, in processor time. Peers are measured where they are to be had: ir-sim
by the Python that has it (--irsim), log2asc of can-utils where it is in PATH.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import importlib.metadata
import json
import os
import platform
import resource
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from operator import truediv
from pathlib import Path
from typing import Any, Final

from argus_tools.formats import Chunk, ReadOptions, formats
from argus_tools.log.cli import main as argus_log

from hil_sim.arcos import TYPE
from hil_sim.bench.journey import mission_of, parse_id
from hil_sim.bench.journey_track import run_case
from hil_sim.core.library import Core, setting_value
from hil_sim.sil import Mission, Packet, Sil
from hil_sim.tables.robot import robot_table
from hil_sim.world.movers import Door, Person

UNIT: Final = "robot seconds a second"
ROUND: Final = ((2300.0, 1000.0), (-500.0, 500.0), (2300.0, -800.0), (0.0, 0.0))
PEOPLE: Final = (Person(((-900.0, -1100.0), (4000.0, -1100.0))), Door((500.0, -1600.0), width=950, open=80))
FAULTS: Final = ("off:3@60s", "wrong:9@20s:scale=0.7", "slow:12@30s", "intermittent:15@40s:p=0.3")
JOURNEYS: Final = tuple(
    f"argus/tune/{row}/{world}/7" for row in ("rooms", "rooms+one") for world in ("office", "lab", "gen-room")
)
_PROFILES: Final = ("argus", "paper")
_SIPS: Final = (TYPE["SIP_STATIONARY"], TYPE["SIP_MOVING"])
ROOT: Final = Path(__file__).resolve().parents[2]
FLEETS: Final = ((100, 300), (1_000, 60), (10_000, 20))
"""Managers in one process, and for how long, s."""
IRSIM: Final = """
import math, sys, time, irsim, yaml
lidar = {"name": "lidar2d", "range_min": 0.1, "range_max": 5.0, "angle_range": 2 * math.pi, "number": 16}
walls = [[x, y] for x, y in ((0, 0), (10, 0), (10, 8), (0, 8), (0, 0))]
world = {
    "world": {"height": 8, "width": 10, "step_time": 0.1, "sample_time": 0.1, "control_mode": "auto"},
    "robot": [{"kinematics": {"name": "diff"}, "shape": {"name": "circle", "radius": 0.25}, "state": [2, 2, 0],
               "goal": [8, 6, 0], "behavior": {"name": "dash"}, "sensors": [lidar]}],
    "obstacle": [{"shape": {"name": "linestring", "vertices": walls}, "state": [0, 0, 0]}]
    + [{"shape": {"name": "rectangle", "length": 1, "width": 0.4}, "state": [3.0 + k, 7.0 - k, k]} for k in range(4)],
}
yaml.safe_dump(world, open("world.yaml", "w"))
env = irsim.make("world.yaml", display=False, disable_all_plot=True, log_level="ERROR")
steps = int(sys.argv[1])
for _ in range(20):
    env.step()
begin = time.process_time()
for _ in range(steps):
    env.step()
print(steps * 0.1 / (time.process_time() - begin))
"""
EPILOG: Final = """examples:
  tools/dev bench performance
  .venv/bin/python tests/bench/performance.py --irsim /tmp/irsim/bin/python --json docs/figures/performance.json

exit codes: 0 measured, 1 a program that is measured failed, 2 bad arguments"""


@dataclass(frozen=True)
class Row:
    """What was measured, the median of its rounds with least and greatest, and what it is the ratio of."""

    what: str
    values: tuple[float, ...]
    of: str

    @property
    def text(self) -> str:
        """The figure as a document shows it."""
        low, middle, high = min(self.values), statistics.median(self.values), max(self.values)
        if low == high:
            return _short(middle)
        return f"{_short(middle)} ({_short(low)} to {_short(high)})"


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")


def _short(value: float) -> str:
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def cpu_s(action: Callable[[], object]) -> float:
    """Return the processor time of an action, of programs that it runs, too."""
    before = time.process_time() + _children_s()
    action()
    return time.process_time() + _children_s() - before


def _children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def quiet(*arguments: str | Path) -> Callable[[], None]:
    """Return an action that runs argus-log into nothing."""

    def action() -> None:
        with (
            Path(os.devnull).open("w") as nothing,
            contextlib.redirect_stdout(nothing),
            contextlib.redirect_stderr(nothing),
        ):
            if argus_log([str(word) for word in arguments]) not in (0, 1):
                raise SystemExit(f"performance: argus-log {arguments[0]} failed")

    return action


def program(*command: str | Path) -> Callable[[], object]:
    """Return an action that runs a program into nothing."""
    return lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def ratios(rounds: int, of: Callable[[], object], to: Callable[[], object]) -> tuple[float, ...]:
    """Return how much more processor time one takes than the other, in turn."""
    found = []
    for _ in range(rounds):
        base = cpu_s(to)
        found.append(cpu_s(of) / base)
    return tuple(found)


# ---- the simulator ----------------------------------------------------------------------------------------------


def simulator(rounds: int, irsim: str | None) -> Iterator[Row]:
    """How much robot time a second of the processor makes, and what of it the bench leaves."""
    plain = Mission("office", ROUND * 4, limit_s=120.0)
    missions = {
        "no fault": plain,
        "four faults": Mission("office", ROUND * 4, limit_s=120.0, faults=FAULTS),
        "a person and a door": Mission("office", ROUND * 4, limit_s=120.0, movers=PEOPLE),
    }
    Sil(plain).run()
    for name, mission in missions.items():
        speeds = tuple(_speed(mission) for _ in range(rounds))
        yield Row(f"a mission in software, {name}", speeds, UNIT)
    if irsim is not None:
        found = [(_speed(plain), _irsim(irsim)) for _ in range(rounds)]
        theirs = "ir-sim 2.12, a robot with 16 beams at 10 Hz, four boxes"
        yield Row(theirs, tuple(b for _, b in found), UNIT)
        yield Row("a mission in software over ir-sim", tuple(a / b for a, b in found), "ratio")
    cases = [parse_id(name) for name in JOURNEYS]
    for case in cases:
        run_case(case)
    yield Row(
        "a mission alone over `bench journey` of it", ratios(rounds, _all_missions, _all_journeys), "ratio"
    )
    hours = sum(run_case(case)[1].t_s for case in cases) / 3600
    spent = tuple(cpu_s(_all_journeys) / 3600 / hours * 10_000 for _ in range(rounds))
    yield Row("10,000 clock hours of `bench journey`, with and without a fault", spent, "core hours")


def _speed(mission: Mission) -> float:
    sil = Sil(mission)
    spent_s = cpu_s(sil.run)
    return sil.now_ms / 1000 / spent_s


def _all_missions() -> None:
    for name in JOURNEYS:
        Sil(mission_of(parse_id(name))).run()


def _all_journeys() -> None:
    for name in JOURNEYS:
        run_case(parse_id(name))


def _irsim(python: str) -> float:
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [python, "-c", IRSIM, "600"], cwd=folder, capture_output=True, text=True, check=False,
            env=os.environ | {"MPLBACKEND": "Agg"},
        )  # fmt: skip
    if done.returncode:
        raise SystemExit(f"performance: ir-sim: {done.stderr.strip()[-300:]}")
    return float(done.stdout.split()[-1])


# ---- logs -------------------------------------------------------------------------------------------------------


def recording(seconds: float) -> list[Packet]:
    """Return what goes over the line in a drive with faults."""
    sil = Sil(Mission("office", ROUND * 15, limit_s=seconds, faults=FAULTS, stop_at_goal=False))
    sil.traffic = []
    sil.run()
    return sil.traffic


def write(path: Path, packets: Sequence[Packet]) -> Path:
    """Write a log in the format of its ending."""
    make = formats()[path.suffix[1:]].writer
    assert make is not None
    with path.open("wb") as stream:
        writer = make(stream, ReadOptions())
        for packet in packets:
            t_s = round(packet.t_ms / 1000, 3)
            writer.write(Chunk(t_s, "c2r" if packet.to_robot else "r2c", packet.data, 0))
        writer.close()
    return path


def logs(rounds: int, packets: Sequence[Packet], folder: Path) -> Iterator[Row]:
    """What commands of argus-log take of one log, over decoding it."""
    jsonl, candump, mcap = (
        write(folder / "a.jsonl", packets),
        write(folder / "a.candump", packets),
        folder / "a.mcap",
    )
    decode, convert = quiet("decode", "--json", jsonl), quiet("convert", jsonl, mcap)
    decode()
    yield Row("`convert` to MCAP over `decode --json`", ratios(rounds, convert, decode), "ratio")
    size = sum(len(packet.data) for packet in packets)
    yield Row("size of the MCAP over the log", (mcap.stat().st_size / jsonl.stat().st_size,), "ratio")
    yield Row("size of the MCAP over the packets alone", (mcap.stat().st_size / size,), "ratio")
    yield Row("`stats` over `decode --json`", ratios(rounds, quiet("stats", jsonl), decode), "ratio")
    yield Row(
        "`faults` over the core alone", ratios(rounds, quiet("faults", jsonl), lambda: _fed(packets)), "ratio"
    )
    if shutil.which("log2asc") is not None:
        theirs = program("log2asc", "-I", candump, "-O", folder / "a.asc", "can0")
        theirs()
        over = ratios(rounds, theirs, quiet("decode", "--json", candump))
        yield Row("log2asc of can-utils over `decode --json` of a candump", over, "ratio")
    python = sys.executable
    lean = tuple(cpu_s(program(Path(python).parent / "argus-log", "--help")) for _ in range(rounds))
    yield Row("`argus-log --help`", lean, "s")
    lean = tuple(cpu_s(program(python, "-c", "import argus")) for _ in range(rounds))
    yield Row("`import argus`", lean, "s")


def _opened(packets: Sequence[Packet], profile: str = "argus") -> tuple[Core, list[Packet]]:
    """Return a fault manager whose session is open, and what the robot says from then on."""
    core = Core(0, {"profile": setting_value("profile", profile)}, robot_table().ring)
    core.link_up(0)
    for at, packet in enumerate(packets):
        now_ms = int(packet.t_ms)
        core.process(now_ms)
        core.transmit()
        if not packet.to_robot:
            core.receive(now_ms, packet.data)
            core.process(now_ms)
            core.transmit()
        if core.is_open:
            rest = packets[at + 1 :]
            return core, [p for p in rest if not p.to_robot and p.data[3] in _SIPS]
    raise SystemExit("performance: the recording opens no session")


def _fed(packets: Sequence[Packet]) -> None:
    """All SIPs at once, as `faults` hands them over."""
    core, sips = _opened(packets)
    t_ms = struct.pack(f"={len(sips)}I", *(int(p.t_ms) for p in sips))
    data = [p.data[3:-2] for p in sips]
    lengths = struct.pack(f"={len(sips)}H", *map(len, data))
    done, now_ms = 0, int(sips[0].t_ms)
    while done < len(sips):
        fed = core.feed(now_ms, t_ms[4 * done :], lengths[2 * done :], b"".join(data[done:]))
        if not fed.taken:
            raise SystemExit("performance: the fault manager takes no SIP")
        done, now_ms = done + fed.taken, fed.now_ms


# ---- the core ---------------------------------------------------------------------------------------------------


def core(rounds: int, packets: Sequence[Packet]) -> Iterator[Row]:
    """What a SIP takes, by profile, each by two calls from Python."""
    count = len(_opened(packets)[1])
    times = {profile: [_spent_us(packets, profile) / count for _ in range(rounds)] for profile in _PROFILES}
    for profile, found in times.items():
        yield Row(f"a SIP, profile `{profile}`", tuple(found), "us")
    yield Row("a SIP, `argus` over `paper`", tuple(map(truediv, *times.values())), "ratio")


def _spent_us(packets: Sequence[Packet], profile: str) -> float:
    """How long the fault manager takes for all SIPs, each by two calls."""
    core, sips = _opened(packets, profile)

    def play() -> None:
        for packet in sips:
            core.receive(int(packet.t_ms), packet.data)
            core.process(int(packet.t_ms))

    return 1e6 * cpu_s(play)


def fleet(rounds: int) -> Iterator[Row]:
    """What many managers in one process take (examples/fleet)."""
    program_path = ROOT / "build/release/fleet"
    for robots, seconds in FLEETS:
        told = [
            subprocess.run(
                [program_path, str(robots), str(seconds)], check=True, capture_output=True, text=True
            ).stdout
            for _ in range(rounds)
        ]
        cores = tuple(float(text.split(" cores")[0].split()[-1]) * 1000 / robots for text in told)
        memory = told[0].split(" MB")[0].split()[-1]
        yield Row(f"1,000 robots at 10 Hz, of {robots:,} in one process ({memory} MB)", cores, "cores")


# ---- all --------------------------------------------------------------------------------------------------------


def measure(rounds: int, irsim: str | None, seconds: float) -> Iterator[Row]:
    """Yield all rows as they are measured."""
    yield from simulator(rounds, irsim)
    packets = recording(seconds)
    with tempfile.TemporaryDirectory() as folder:
        yield from logs(rounds, packets, Path(folder))
    yield from core(rounds, packets)
    yield from fleet(rounds)


def summary(rows: Sequence[Row], rounds: int) -> dict[str, Any]:
    """Return what goes into docs/figures."""
    version = importlib.metadata.version
    return {
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "command": "tools/dev bench performance",
        "host": f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.0f}, {rounds} rounds; Python "
        f"{platform.python_version()}, numpy {version('numpy')}",
        "rows": [
            {"what": row.what, "values": [*map(_rounded, row.values)], "text": row.text, "of": row.of}
            for row in rows
        ],
    }


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--rounds", type=int, default=5, help="how often each pair is measured (default: %(default)s)"
    )
    parser.add_argument(
        "--seconds", type=float, default=300.0, help="length of the log, s (default: %(default)s)"
    )
    parser.add_argument("--irsim", metavar="PYTHON", help="a Python that has ir-sim 2.12")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there, too")
    arguments = parser.parse_args()
    if arguments.rounds < 1 or not 10 <= arguments.seconds <= 36_000:
        parser.error("--rounds is at least 1, --seconds 10 to 36000")
    rows = []
    for row in measure(arguments.rounds, arguments.irsim, arguments.seconds):
        rows.append(row)
        print(f"  {row.what:68} {row.text:32} {row.of}", flush=True)
    if arguments.json is not None:
        arguments.json.write_text(json.dumps(summary(rows, arguments.rounds), indent=1) + "\n")


if __name__ == "__main__":
    main()
