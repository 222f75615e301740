# SPDX-License-Identifier: MIT
"""Measures `argus-log decode --json` by format and number of readings, and beside it python-can with cantools."""

from __future__ import annotations

import contextlib
import json
import os
import random
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import cantools
from argus_tools.formats import Chunk, ReadOptions, formats, open_log
from argus_tools.log.cli import main as argus_log
from argus_tools.log.packets import packets
from can.io.canutils import CanutilsLogReader
from cantools.database import Database

from hil_sim.arcos import Sip, frame

SIPS = 40_000
ROUNDS = 3
SONARS, PER_SIP, CYCLE_S = 16, 5, 0.1
CAPTURES = Path(__file__).resolve().parents[1] / "data" / "captures"
BARS = {5: 150_000, 16: 100_000}
# One ISO-TP frame of the link: what a database of signals can say of it.
DBC = 'VERSION ""\nBU_: R\nBO_ 1608 Frame: 8 R\n' + "".join(
    f' SG_ B{n} : {8 * n}|8@1+ (1,0) [0|255] "" R\n' for n in range(8)
)


def made() -> list[bytes]:
    """SIPs as of a P3-DX that drives about: five readings each, in turn."""
    rng = random.Random(1)
    return [
        frame(
            Sip(
                type=0x33, x=3 * n & 0x7FFF, y=rng.randrange(50), th=rng.randrange(-2048, 2048), flags=7,
                left_vel=rng.randrange(300), right_vel=rng.randrange(300), battery=126, battery_x10=126,
                sonars=tuple(((PER_SIP * n + k) % SONARS, rng.randrange(150, 5001)) for k in range(PER_SIP)),
            ).data
        )
        for n in range(SIPS)
    ]  # fmt: skip


def recorded() -> list[bytes]:
    """The SIPs of the recorded sessions with 16 sonars, over and over."""
    names = ("a_idle", "c_commands", "d_ram")
    rows = [row for name in names for row in packets(open_log(str(CAPTURES / f"{name}.jsonl")))]
    sips = [row.wire for row in rows if row.ok and row.type == "SIP"]
    return (sips * (SIPS // len(sips) + 1))[:SIPS]


def write(path: Path, name: str, sips: list[bytes]) -> None:
    """Write a log of the SIPs."""
    make = formats()[name].writer
    assert make is not None
    with path.open("wb") as stream:
        writer = make(stream, ReadOptions(direction="r2c"))
        for n, data in enumerate(sips):
            writer.write(Chunk(round(CYCLE_S * n, 3), "r2c", data, 0))
        writer.close()


def best(action: Callable[[], int]) -> tuple[float, float]:
    """Return the best rates per s of wall and of processor time; the action says how much it did."""
    rates = []
    for _ in range(ROUNDS):
        wall, cpu = time.perf_counter(), time.process_time()
        done = action()
        rates.append((done / (time.perf_counter() - wall), done / (time.process_time() - cpu)))
    return max(rate for rate, _ in rates), max(rate for _, rate in rates)


def decode(path: Path) -> int:
    """Decode a log into nothing."""
    with open(os.devnull, "w") as nothing, contextlib.redirect_stdout(nothing):  # noqa: PTH123
        if argus_log(["decode", "--json", str(path)]):
            raise SystemExit("log_decode: decode failed")
    return SIPS


def peer(path: Path, database: Database) -> int:
    """Read a candump with python-can, decode each frame with cantools and print it as JSON."""
    with open(os.devnull, "w") as nothing:  # noqa: PTH123
        for message in CanutilsLogReader(str(path)):
            if message.arbitration_id == 0x648:
                signals = database.decode_message(message.arbitration_id, bytes(message.data))
                nothing.write(json.dumps([message.timestamp, signals]) + "\n")
    return SIPS


def report(folder: Path) -> Iterator[str]:
    """Yield the lines of the report as they are measured."""
    database = cantools.database.load_string(DBC, "dbc")
    assert isinstance(database, Database)
    for readings, sips in ((5, made()), (16, recorded())):
        yield f"{readings} readings in a SIP, {SIPS} SIPs, best of {ROUNDS}; bar {BARS[readings]} packets/s"
        for name in ("jsonl", "bin", "record", "pcap", "candump"):
            path = folder / f"{readings}.{name}"
            write(path, name, sips)
            wall, cpu = best(partial(decode, path))
            yield f"  argus-log decode --json, {name:8} {wall:9.0f} packets/s ({cpu:.0f} of processor time)"
        theirs, cpu = best(partial(peer, path, database))
        yield f"  python-can + cantools,   candump  {theirs:9.0f} packets/s ({cpu:.0f} of processor time)"
        yield f"  ratio on the same candump: {wall / theirs:.1f}"


def main() -> None:
    """Measure and print."""
    with tempfile.TemporaryDirectory() as folder:
        for line in report(Path(folder)):
            print(line, flush=True)


if __name__ == "__main__":
    main()
