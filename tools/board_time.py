#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Instructions that each call of the fault manager takes at most on Cortex-M4, and whether it decides there as here.

Missions are driven in virtual time, their calls recorded, and played back on this machine and on the MPS2 board in
QEMU, which counts instructions. Both must send the same packets, say the same events and leave the same record.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import re
import struct
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

from hil_sim.scenario.scenario import load_scenario
from hil_sim.sil import Mission, Sil
from hil_sim.world.movers import Door, Person

ROOT: Final = Path(__file__).resolve().parents[1]
DOCUMENT: Final = ROOT / "docs/flash.md"
BEGIN, END = "<!-- board_time -->", "<!-- end of board_time -->"
HOST: Final = ROOT / "build/release-board"
BOARD_SONARS: Final = 16
"""That the boards' images manage: a record has room for those of its build, so this machine plays with as many."""
GROWTH: Final = 1.05
SIP_AIM: Final = 840_000
"""5 ms at 168 MHz, an instruction a cycle."""
SEEDS: Final = (1, 2, 3, 4, 5)
PAIRS: Final = ("off:3,wrong:6", "off:2,wrong:5", "wrong:4,off:1")
EPILOG: Final = """examples:
  .venv/bin/python tools/board_time.py              measure, and print the table
  .venv/bin/python tools/board_time.py --write      ... and put it into docs/flash.md
  .venv/bin/python tools/board_time.py --check      fail when a row has grown by more than 5 %, or a SIP is too long
  .venv/bin/python tools/board_time.py --same       play five seeds and three pairs of faults, compare decisions

It needs the builds release and mps2-an386 (tools/dev build release, tools/dev firmware --board mps2-an386).
exit codes: 0 all well, 1 decisions differ or a row has grown, 2 wrong arguments or no build"""


class Failed(Exception):
    """Something does not agree, or is not there; the message says what."""


class Tape:
    """The fault manager of a mission, whose calls are noted."""

    def __init__(self, core: Any, calls: list[bytes]) -> None:
        self._core = core
        self._calls = calls

    def __getattr__(self, name: str) -> Any:
        return getattr(self._core, name)

    def receive(self, now_ms: int, data: bytes) -> None:
        """Take bytes."""
        self._calls.append(struct.pack("<cIH", b"R", now_ms, len(data)) + data)
        self._core.receive(now_ms, data)

    def process(self, now_ms: int) -> int:
        """Let time pass."""
        self._calls.append(struct.pack("<cIH", b"P", now_ms, 0))
        wait_ms: int = self._core.process(now_ms)
        return wait_ms


class Taped(Sil):
    """A mission whose calls are noted; it starts at the origin of its world."""

    def _build_core(self) -> Any:
        self.calls: list[bytes] = []
        return Tape(super()._build_core(), self.calls)

    def tape(self) -> bytes:
        """Return the tape of the mission so far."""
        mission = self.mission
        lines = [f"set baud {mission.baud}", *(f"set {key} {value}" for key, value in mission.config.items())]
        lines += [f"point {x:.0f} {y:.0f}" for x, y in mission.course]
        return ("\n".join(lines) + "\ncalls\n").encode() + b"".join(self.calls)


def demo(seed: int, pair: str, **config: str) -> Mission:
    """Return the drive of the demonstration, with faults as `tools/dev demo --fail` has them."""
    scenario = load_scenario(ROOT / "hil_sim/scenarios/open-office.yaml")
    faults = []
    for number, part in enumerate(pair.split(",")):
        scale = ":scale=0.5" if part.startswith("wrong") else ""
        faults.append(f"{part}@travelled>{600 + 800 * number}{scale}")
    return Mission(
        scenario.world,
        tuple(scenario.course),
        seed=seed,
        faults=tuple(faults),
        sonar={"crosstalk": 0.0},
        config=config,
        limit_s=150.0,
    )


def hostile(profile: str) -> Mission:
    """Return a drive that asks most of a SIP: all sonars in each, every kind of fault, people, a fast line."""
    people = (
        Person(((-900.0, -1100.0), (4000.0, -1100.0))),
        Person(((300.0, -800.0), (300.0, 1400.0)), pause=1),
    )
    faults = ("off:3@5s", "stuck:2@10s:value=400", "wrong:6@15s:scale=0.5", "garbage:4@20s", "slow:5@8s:n=5")
    return Mission(
        "office",
        ((2300.0, 1000.0), (-500.0, 500.0), (2300.0, -800.0), (0.0, 0.0)),
        seed=7,
        faults=(*faults, "intermittent:0@3s:p=0.3", "silent:9@30s"),
        movers=(*people, Door((500.0, -1600.0), width=950, open=80, period=10)),
        config={"profile": profile},
        limit_s=90.0,
        baud=115200,
        quirks="mobilesim",
    )


def far(profile: str) -> Mission:
    """Return a drive past posts to a goal far outside the map, one sonar dead: most of a search for a way."""
    return Mission(
        "posts",
        ((10000.0, 1000.0),),
        seed=24,
        faults=("off:2@10s",),
        config={"profile": profile},
        limit_s=90.0,
    )


@dataclasses.dataclass(frozen=True)
class Played:
    """What came of a tape: decisions, one line each, and instructions by call."""

    decisions: tuple[str, ...]
    instructions: dict[str, int]


def played(command: Sequence[str | Path], tape: Path) -> Played:
    """Play TAPE by COMMAND."""
    done = subprocess.run(
        [*map(str, command), str(tape)], capture_output=True, text=True, check=False, cwd=ROOT
    )
    lines = done.stdout.splitlines()
    if done.returncode or not lines:
        raise Failed(f"{command[-1]}: {(done.stderr or done.stdout).strip()[-200:] or 'it said nothing'}")
    split = [line.split() for line in lines]
    return Played(
        tuple(line for line in lines if not line.startswith("instructions ")),
        {words[1]: int(words[2]) for words in split if words[0] == "instructions"},
    )


def on_board(tape: Path) -> Played:
    """Play TAPE on the board, with instructions counted."""
    image = ROOT / "build/mps2-an386/replay.elf"
    options = "-icount shift=7,sleep=off"
    command: list[str | Path] = [
        "env",
        f"ARGUS_QEMU_OPTIONS={options}",
        ROOT / "tests/target/run",
        "mps2_an386",
        image,
    ]
    return played(command, tape)


def play(name: str, mission: Mission, folder: Path) -> Played:
    """Drive MISSION, play its tape here and on the board, and return what the board says of it."""
    sil = Taped(mission)
    outcome = sil.run()
    tape = folder / f"{name}.tape"
    tape.write_bytes(sil.tape())
    here, there = played([HOST / "replay"], tape), on_board(tape)
    if here.decisions != there.decisions:
        raise Failed(f"{name}: here {here.decisions}, on the board {there.decisions}")
    events = next(line for line in there.decisions if line.startswith("events "))
    if int(events.split()[1]) != len(outcome.events):
        raise Failed(f"{name}: {len(outcome.events)} events in the mission, but {events} of its tape")
    return there


def all_calls(rows: Sequence[Played]) -> dict[str, int]:
    """Return the most instructions of each call over ROWS."""
    names = rows[0].instructions
    return {name: max(row.instructions[name] for row in rows) for name in names if name != "nothing"}


def measure(folder: Path) -> dict[str, dict[str, int]]:
    """Return the most instructions of each call, by profile."""
    result = {}
    for profile in ("argus", "paper"):
        drives = [
            (f"demo-{profile}", demo(1, PAIRS[0], profile=profile)),
            (f"hostile-{profile}", hostile(profile)),
            (f"far-{profile}", far(profile)),
        ]
        result[profile] = all_calls([play(name, mission, folder) for name, mission in drives])
    return result


def compiler() -> str:
    """Return the version of the compiler that the figures hold for."""
    return subprocess.run(
        ["arm-none-eabi-gcc", "-dumpversion"], capture_output=True, text=True, check=True
    ).stdout.strip()


def table(figures: dict[str, dict[str, int]]) -> list[str]:
    """Return the table of the document."""
    lines = [
        f"arm-none-eabi-gcc {compiler()}, -O2, whole program:",
        "",
        "| call | argus | paper |",
        "|---|---:|---:|",
    ]
    for name, most in figures["argus"].items():
        lines.append(f"| {name} | {most} | {figures['paper'][name]} |")
    return lines


def noted() -> tuple[str, dict[str, tuple[int, int]]]:
    """Return the compiler and the figures that the document holds."""
    text = DOCUMENT.read_text(encoding="utf-8")
    part = text[text.index(BEGIN) : text.index(END)]
    version = re.search(r"arm-none-eabi-gcc (\S+),", part)
    rows = re.findall(r"^\| (\w+) \| (\d+) \| (\d+) \|$", part, re.MULTILINE)
    return version[1] if version else "", {name: (int(a), int(b)) for name, a, b in rows}


def grown(figures: dict[str, dict[str, int]]) -> Iterator[str]:
    """Yield what has grown since the document was written."""
    _, before = noted()
    for number, profile in enumerate(("argus", "paper")):
        for name, most in figures[profile].items():
            limit = before.get(name, (0, 0))[number]
            if most > limit * GROWTH:
                yield f"{name}, {profile}: {most} instructions, {limit} before; if that is meant: --write"


def write(figures: dict[str, dict[str, int]]) -> None:
    """Put the table into the document."""
    text = DOCUMENT.read_text(encoding="utf-8")
    head, tail = text[: text.index(BEGIN) + len(BEGIN)], text[text.index(END) :]
    DOCUMENT.write_text(head + "\n" + "\n".join(table(figures)) + "\n" + tail, encoding="utf-8")


def check(figures: dict[str, dict[str, int]]) -> None:
    """Fail when a SIP takes too long, or something has grown where the compiler is the one of the document."""
    if (worst := max(figures[profile]["receive_sip"] for profile in figures)) > SIP_AIM:
        raise Failed(f"a SIP takes {worst} instructions; {SIP_AIM} are the most that it may")
    version, _ = noted()
    if version.split(".")[0] != compiler().split(".")[0]:
        print(f"the table of docs/flash.md is of gcc {version}, this is {compiler()}: growth is not judged")
        return
    if lines := list(grown(figures)):
        raise Failed("\n".join(lines))


def same(folder: Path, jobs: int) -> None:
    """Play the demonstration with all seeds and pairs."""
    drives = [
        (f"{pair.replace(':', '').replace(',', '-')}-{seed}", demo(seed, pair))
        for pair in PAIRS
        for seed in SEEDS
    ]
    with concurrent.futures.ProcessPoolExecutor(jobs) as pool:
        futures = {name: pool.submit(play, name, mission, folder) for name, mission in drives}
        for name, future in futures.items():
            print(f"{name}: the same; {', '.join(future.result().decisions)}", flush=True)


def run(args: argparse.Namespace) -> None:
    """Do what the command line says."""
    folder: Path = args.tapes
    folder.mkdir(parents=True, exist_ok=True)
    if args.same:
        same(folder, args.jobs)
        return
    figures = measure(folder)
    print("\n".join(table(figures)))
    worst = figures["argus"]["receive_sip"]
    told = f"a SIP, profile argus: at most {worst} instructions, {worst / 168e3:.1f} ms at 168 MHz and one a cycle"
    print(f"{told}; the aim, {SIP_AIM}, is {'met' if worst <= SIP_AIM else 'NOT met'}")
    if args.write:
        write(figures)
    if args.check:
        check(figures)


def build_host() -> None:
    """Build this machine's replay with the sonars of a board."""
    options = ("--preset", "release", "-B", HOST, f"-DARGUS_SONARS={BOARD_SONARS}")
    for command in (("cmake", *options), ("cmake", "--build", HOST, "--target", "replay", "-j", "2")):
        done = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False, cwd=ROOT)
        if done.returncode:
            raise Failed(f"{HOST}: {(done.stderr or done.stdout).strip()[-400:]}")


def main() -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--write", action="store_true", help="put the table into docs/flash.md")
    parser.add_argument("--check", action="store_true", help="fail when a row has grown by more than 5 %%")
    parser.add_argument("--same", action="store_true", help="compare decisions only, on 15 drives")
    parser.add_argument("--jobs", type=int, default=2, help="of --same at a time (default 2)")
    parser.add_argument("--tapes", type=Path, default=ROOT / "build/tapes", help="where tapes are left")
    args = parser.parse_args()
    needed = ROOT / "build/mps2-an386/replay.elf"
    if not needed.exists():
        print(f"board_time: {needed} is missing; see --help", file=sys.stderr)
        return 2
    try:
        build_host()
        run(args)
    except Failed as error:
        print(f"board_time: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
