# SPDX-License-Identifier: MIT
"""`argus-sim bench recorded`: what is found on drives that others have recorded, by sonars made of their laser."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any, Final

from hil_sim.bench import plan
from hil_sim.bench.arguments import EXIT_FAILED, Parser, jobs, kinds, say, seeds
from hil_sim.bench.passive import Verdict
from hil_sim.bench.report_passive import summarise, table
from hil_sim.bench.semi_real import Drive, Run, drive_files, faults_of, read_drive, way_mm
from hil_sim.bench.work import core_digest
from hil_sim.errors import SimError
from hil_sim.start import EXIT_INTERRUPTED

_KINDS: Final = (*plan.FAULTS, "free")
_SHORTEST_MM: Final = 3000.0
_SKIPPED: Final = "skipped: no recordings are given (--bags DIR)"
_EXAMPLES: Final = """\
examples:
  argus-sim bench recorded --bags drives --seeds 1-2
  argus-sim bench recorded --bags drives --kinds free,off --json recorded.json

Real odometry and a real laser: bags of ROS 1 and 2, MCAP files, logs of CARMEN (FLASER), tables and JSON lines (.csv,
.tsv, .jsonl) with columns for time, pose and 33 beams or more, in DIR and below. Sonars of a P3-DX are cast into each
scan; noise, silence and short echoes are drawn as physics = recorded has them, some things stand below the laser's
plane, and faults are put in. The fault manager only listens. docs/diagnosis.md has the rules.

exit codes: 0 done, or skipped as no DIR is given; 1 a recording holds no drive, 2 wrong argument, 130 interrupted
"""


@dataclass(frozen=True)
class _Job:
    drive: Drive
    fault: str
    seed: int


def _run(job: _Job) -> Verdict:
    return Run(job.drive, job.fault, job.seed).go()


def _parser() -> argparse.ArgumentParser:
    result = Parser(
        prog="argus-sim bench recorded",
        description="Judge a fault manager that only listens on recorded drives, their sonars made of the laser.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = result.add_argument
    add("--bags", type=Path, metavar="DIR", help="where the recordings are (default: none, which is skipped)")
    add("--seeds", type=seeds, default=range(1, 2), metavar="A-B", help="seeds (default 1)")
    add("--kinds", type=kinds, metavar="K,K", help=f"of {','.join(_KINDS)} (default: all)")
    add("--seconds", type=float, default=300.0, metavar="S", help="of each drive at the most (default 300)")
    add("--json", type=Path, metavar="FILE", help="write the figures there too")
    add("--jobs", type=jobs, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)")
    return result


def _drives(arguments: argparse.Namespace) -> tuple[list[Drive], int]:
    """The drives of a folder, and how many recordings held none."""
    found, failed = [], 0
    for path in drive_files(arguments.bags):
        try:
            drive = read_drive(path, arguments.seconds)
        except SimError as error:
            say(f"{path.name}: left out: {error}")
            failed += 1
            continue
        if way_mm(drive) < _SHORTEST_MM:
            say(f"{path.name}: left out: it drives {way_mm(drive) / 1000:.1f} m, less than 3")
            continue
        found.append(drive)
    return found, failed


def _judge(work: Sequence[_Job], processes: int) -> list[Verdict]:
    if min(processes, len(work)) <= 1:
        return [_run(job) for job in work]
    with ProcessPoolExecutor(processes, get_context("spawn")) as pool:
        return list(pool.map(_run, work))


def _heading(drives: Sequence[Drive]) -> str:
    way_m = sum(map(way_mm, drives)) / 1000
    seconds = sum(drive.end_ms for drive in drives) / 1000
    return f"{len(drives)} recorded drives, {way_m:.0f} m in {seconds:.0f} s; physics recorded.\n\n"


def recorded(argv: Sequence[str]) -> int:
    """Run `argus-sim bench recorded ARGV`; return the exit code."""
    options = _parser()
    arguments = options.parse_args(argv)
    if arguments.bags is None:
        print(_SKIPPED)
        return 0
    if arguments.kinds and "pair" in arguments.kinds:
        options.error("pair: a recorded drive has one fault at most; leave it out")
    if not arguments.seconds > 0:
        options.error("--seconds must be above 0")
    drives, failed = _drives(arguments)
    if not drives:
        raise SimError(f"{arguments.bags}: no recording of 3 m or more with odometry and a laser in it")
    try:
        figures = summarise(_judge(_work(arguments, drives), arguments.jobs))
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED
    print(_heading(drives) + table(figures), end="")
    if arguments.json:
        _write(
            arguments.json, {"core": core_digest(), "physics": "recorded", "drives": len(drives)} | figures
        )
    return EXIT_FAILED if failed else 0


def _work(arguments: argparse.Namespace, drives: Sequence[Drive]) -> list[_Job]:
    wanted = arguments.kinds or list(_KINDS)
    return [job for seed in arguments.seeds for drive in drives for job in _jobs_of(drive, seed, wanted)]


def _jobs_of(drive: Drive, seed: int, wanted: Sequence[str]) -> list[_Job]:
    return [_Job(drive, text, seed) for text in faults_of(drive, wanted, seed, plan.FAULTS)]


def _write(path: Path, figures: dict[str, Any]) -> None:
    try:
        path.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise SimError(f"{path}: cannot write ({error.strerror}); name another file") from error
