# SPDX-License-Identifier: MIT
"""`argus-sim bench drive-by` and `argus-sim bench ablate`: the evidence of a manager that only listens."""

from __future__ import annotations

import argparse
import fnmatch
import functools
import json
import os
import shlex
import sys
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from hil_sim.bench import ablate as ablation
from hil_sim.bench import likelihoods as counting
from hil_sim.bench import plan, pool, variants
from hil_sim.bench.arguments import EXIT_FAILED, Parser, jobs, kinds, say, seeds
from hil_sim.bench.drive import SPEED_MM_S, record_to
from hil_sim.bench.passive import Verdict
from hil_sim.bench.progress import Progress
from hil_sim.bench.report_passive import summarise, table
from hil_sim.bench.stream import missing, stream_path
from hil_sim.bench.work import core_digest
from hil_sim.core.library import library
from hil_sim.errors import SimError
from hil_sim.start import EXIT_INTERRUPTED
from hil_sim.tables.robot import robot_table
from hil_sim.world.physics import parse_physics

_WORLDS: Final = "office,lab,corridor,smooth,hall,gen-*"
_SLOWEST_MM_S: Final = 50
_FASTEST_MM_S: Final = robot_table().motion["vel_max_mm_s"]
_KINDS: Final = (*plan.FAULTS, "free")
_DRIVE_BY: Final = """\
examples:
  argus-sim bench drive-by --seeds 1-4 --streams streams/tune
  argus-sim bench drive-by --split judge --kinds free --seeds 1-8 --streams streams/judge --json judge.json
  argus-sim bench drive-by --worlds office --seeds 1 --kinds off,wrong --physics rough-day

The emulated robot follows its course by the truth at 200 mm/s while the fault manager only listens (active = off,
profile argus). A stream is recorded once; with --streams it is kept, and only replayed the next time.
Found in time: within the bound of its kind (10 or 30 s) from the first reading that shows it.

exit codes: 0 done, 1 a mission failed, 2 wrong argument or file, 130 interrupted; the same again goes on
"""
_ABLATE: Final = """\
examples:
  argus-sim bench ablate --seeds 1-2 --streams streams/tune --out ablation
  argus-sim bench ablate --only stuck,'others*' --kinds off,wrong --seeds 1
  argus-sim bench ablate --constants --only 'ARGUS_LATE_*' --streams streams/tune

For each rule in hil_sim/bench/rules.toml a fault manager is built without it and judged on the same streams as the
whole. A rule earns its place when without it fewer faults are found in time than chance explains, or more false
names or false disables come. --constants takes each hand-set number halved and doubled instead: hours.
How to read the table: docs/diagnosis.md.

exit codes: 0 done, 1 a mission failed, 2 wrong argument or file, 130 interrupted
"""
_LIKELIHOODS: Final = """\
examples:
  argus-sim bench likelihoods --streams streams/tune                   print what is measured
  argus-sim bench likelihoods --streams streams/tune --write           and make it the table; then tools/gen_tables.py
  argus-sim bench likelihoods --check --worlds office --seeds 1 --kinds slow,wrong

How often each verdict on a ping comes together with each verdict on the ping as a hypothesis maps it: of healthy
sonars, of those that the hypothesis holds for, and of those with another fault. The logarithms of these shares are what
the evidence adds up (docs/evidence.md, Hypotheses). A fault manager that counts is built for it: that needs a
checkout and a C compiler. --write writes nothing when a mission failed.

exit codes: 0 done, 1 a mission failed or --check found a difference, 2 wrong argument or file, 130 interrupted
"""


def speed(text: str) -> float:
    """Return a speed that the robot can drive, mm/s."""
    if not text.isdigit() or not _SLOWEST_MM_S <= int(text) <= _FASTEST_MM_S:
        raise argparse.ArgumentTypeError(
            f"'{text}' is no speed; write {_SLOWEST_MM_S} to {_FASTEST_MM_S}, in mm/s"
        )
    return float(text)


def _parser(name: str, description: str, examples: str) -> Parser:
    result = Parser(
        prog=f"argus-sim bench {name}",
        description=description,
        epilog=examples,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    add = result.add_argument
    add(
        "--split",
        choices=tuple(plan.SPLITS),
        default="tune",
        help="tune (default) to choose by, judge to publish",
    )
    add("--worlds", action="append", metavar="GLOB", help=f"names or files of worlds (default: {_WORLDS})")
    add("--seeds", type=seeds, default=range(1, 3), metavar="A-B", help="seeds (default 1-2)")
    add("--kinds", type=kinds, metavar="K,K", help=f"of {','.join(_KINDS)} (default: all)")
    add("--physics", default="", metavar="P", help="as for argus-sim (default: as the world says)")
    add("--people", action="store_true", help="people walk about in every mission, beside faults too")
    add("--speed", type=speed, default=SPEED_MM_S, metavar="MM_S", help="of the robot (default 200)")
    add("--streams", type=Path, metavar="DIR", help="where recordings are kept (default: nowhere)")
    add("--jobs", type=jobs, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)")
    return result


def _ids(arguments: argparse.Namespace) -> list[str]:
    wanted = arguments.kinds or list(_KINDS)
    if "pair" in wanted:
        raise SimError("pair: a drive-by has one fault at most; leave it out")
    if arguments.physics:
        parse_physics(arguments.physics)
    worlds = plan.find_worlds(arguments.worlds or [_WORLDS])
    return [case.id for case in plan.make_cases(["argus"], arguments.split, worlds, arguments.seeds, wanted)]


def _conditions(arguments: argparse.Namespace) -> str:
    """The folder of streams that are not of the usual conditions."""
    parts = [arguments.physics.replace(",", "+")] if arguments.physics else []
    parts += ["people"] if arguments.people else []
    parts += [f"{arguments.speed:g}mm_s"] if arguments.speed != SPEED_MM_S else []
    return "+".join(parts)


@contextmanager
def _recorded(arguments: argparse.Namespace) -> Iterator[tuple[list[Path], bool]]:
    """Record what is missing; yield the streams, and whether all of them are there."""
    ids = _ids(arguments)
    with tempfile.TemporaryDirectory(prefix="argus-streams-") as spare:
        folder = arguments.streams or Path(spare)
        folder = folder / _conditions(arguments)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise SimError(
                f"{folder}: cannot keep streams ({error.strerror}); name another --streams"
            ) from error
        _record(missing(folder, ids), len(ids), folder, arguments)
        paths = [stream_path(folder, name) for name in ids]
        there = [path for path in paths if path.exists()]
        if not there:
            raise SimError("no mission could be recorded")
        yield there, len(there) == len(paths)


def _record(todo: Sequence[str], total: int, folder: Path, arguments: argparse.Namespace) -> None:
    if not todo:
        return
    progress = Progress(total, total - len(todo), sys.stderr)
    work = functools.partial(
        record_to,
        folder=str(folder),
        physics=arguments.physics,
        people=arguments.people,
        speed_mm_s=arguments.speed,
    )
    for record in pool.run_here(todo, min(arguments.jobs, len(todo)), work):
        progress.add(record)
        if record["error"]:
            say(f"{record['id']}: {record['error']}")
    progress.close()


def _write(path: Path, value: Any) -> None:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        text = value if isinstance(value, str) else json.dumps(value, indent=2) + "\n"
        path.write_text(text, encoding="utf-8")
    except OSError as error:
        raise SimError(f"{path}: cannot write ({error.strerror}); name another file") from error


def drive_by(argv: Sequence[str]) -> int:
    """Run `argus-sim bench drive-by ARGV`; return the exit code."""
    options = _parser(
        "drive-by", "Judge a fault manager that only listens while the robot drives by.", _DRIVE_BY
    )
    options.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    arguments = options.parse_args(argv)
    try:
        with _recorded(arguments) as (paths, whole):
            verdicts = ablation.judge_all(paths, Path(str(library()._name)))
    except KeyboardInterrupt:
        return _interrupted()
    figures = summarise(verdicts)
    print(table(figures), end="")
    if arguments.json:
        origin = {"split": arguments.split, "physics": arguments.physics, "core": core_digest()}
        _write(arguments.json, origin | figures)
    return 0 if whole else EXIT_FAILED


def _interrupted() -> int:
    say("interrupted; with --streams the same again goes on")
    return EXIT_INTERRUPTED


def chosen(arguments: argparse.Namespace) -> list[variants.Variant]:
    """Return what is to be taken out; SimError when --only names nothing."""
    table_of = variants.constants() if arguments.constants else variants.rules()
    if not arguments.only:
        return list(table_of.values())
    found: dict[str, variants.Variant] = {}
    for pattern in arguments.only.split(","):
        # A constant is named without what is done to it.
        names = [name for name in table_of if fnmatch.fnmatchcase(name.split("/")[0].split("*")[0], pattern)]
        if not names:
            raise SimError(
                f"--only {pattern}: matches nothing; there are {', '.join(list(table_of)[:8])}, ..."
            )
        found |= {name: table_of[name] for name in names}
    return list(found.values())


def ablate_parser() -> Parser:
    """Return the argument parser of the ablation."""
    options = _parser("ablate", "Say what each rule of the evidence is worth, by taking it out.", _ABLATE)
    options.add_argument("--only", metavar="GLOB,GLOB", help="these rules (or constants) only")
    options.add_argument("--constants", action="store_true", help="each hand-set constant, not each rule")
    options.add_argument("--out", type=Path, metavar="DIR", help="write ablation.md and ablation.json there")
    return options


def ablate(argv: Sequence[str]) -> int:
    """Run `argus-sim bench ablate ARGV`; return the exit code."""
    arguments = ablate_parser().parse_args(argv)
    out = chosen(arguments)
    try:
        with _recorded(arguments) as (paths, whole):
            verdicts, worths = ablation.ablate(paths, out, arguments.jobs, _progress(len(out)))
    except KeyboardInterrupt:
        return _interrupted()
    text = _heading(verdicts) + "\n" + ablation.table(worths)
    print(text, end="")
    if arguments.out:
        _write(arguments.out / "ablation.md", text)
        _write(arguments.out / "ablation.json", ablation.to_json(worths))
    return 0 if whole else EXIT_FAILED


def _progress(total: int) -> ablation.Tell:
    done = iter(range(1, total + 1))

    def tell(worth: ablation.Worth) -> None:
        say(
            f"{next(done)}/{total} {worth.name}: {worth.lost} lost, {worth.won} won, {worth.names:+d} false names"
        )

    return tell


def _heading(verdicts: Iterable[Verdict]) -> str:
    verdicts = list(verdicts)
    faults = [finding for verdict in verdicts for finding in verdict.findings]
    hours = sum(verdict.hours for verdict in verdicts)
    names = sum(len(verdict.names) for verdict in verdicts)
    constants, lines = variants.hand_set()
    return (
        f"The whole: {sum(f.in_time for f in faults)} of {len(faults)} found in time, "
        f"{sum(f.latency_s is not None for f in faults)} ever, {names} false names and "
        f"{sum(len(verdict.disables) for verdict in verdicts)} false disables in {hours:.1f} clock hours; "
        f"{constants} constants, {lines} lines.\n"
    )


def _differs(tally: counting.Tally, known: counting.Tally) -> bool:
    """Say where the counts do not bear out those of the table; return whether there is such a place."""
    found = counting.differences(tally, known)
    for difference in found:
        say(difference)
    return bool(found)


def command_of(arguments: argparse.Namespace) -> str:
    """Return the command that counts the same anywhere: without what is of this machine alone."""
    words = ["argus-sim", "bench", "likelihoods"]
    words += ["--split", arguments.split] if arguments.split != "tune" else []
    for world in arguments.worlds or []:
        words += ["--worlds", ",".join(Path(name).name for name in world.split(","))]
    seen = arguments.seeds
    words += ["--seeds", f"{seen[0]}-{seen[-1]}", "--kinds", ",".join(arguments.kinds)]
    words += ["--physics", arguments.physics] if arguments.physics else []
    words += ["--people"] if arguments.people else []
    words += ["--speed", f"{arguments.speed:g}"] if arguments.speed != SPEED_MM_S else []
    return shlex.join(words)


def _give(tally: counting.Tally, arguments: argparse.Namespace) -> None:
    """Write the table, with the command that makes it, or print it."""
    text = counting.to_toml(tally, command_of(arguments))
    if arguments.write:
        _write(counting.FILE, text)
    else:
        print(text, end="")


def likelihoods(argv: Sequence[str]) -> int:
    """Run `argus-sim bench likelihoods ARGV`; return the exit code."""
    options = _parser(
        "likelihoods", "Count the verdicts that the tables of likelihoods are made of.", _LIKELIHOODS
    )
    options.set_defaults(kinds=list(_KINDS))
    what = options.add_mutually_exclusive_group()
    what.add_argument("--write", action="store_true", help="write hil_sim/tables/likelihoods.toml")
    what.add_argument("--check", action="store_true", help="compare with it; exit 1 if it is not borne out")
    arguments = options.parse_args(argv)
    variants.must_build()
    known = counting.from_toml(counting.FILE.read_text(encoding="utf-8")) if arguments.check else None
    try:
        with _recorded(arguments) as (paths, whole):
            if arguments.write and not whole:
                say(f"a mission failed: {counting.FILE.name} stays as it is")
                return EXIT_FAILED
            tally = counting.observe(paths)
    except KeyboardInterrupt:
        return _interrupted()
    if known is None:
        _give(tally, arguments)
    elif _differs(tally, known):
        return EXIT_FAILED
    return 0 if whole else EXIT_FAILED
