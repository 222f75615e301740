# SPDX-License-Identifier: MIT
"""`argus-sim bench journey`: whether the robot gets there, how fast, and at what price."""

from __future__ import annotations

import argparse
import json
import os
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from hil_sim.bench import journey as journeys
from hil_sim.bench import plan, pool
from hil_sim.bench.arguments import EXIT_FAILED, Parser, jobs, listed, say, seeds
from hil_sim.bench.journey_report import write_report
from hil_sim.bench.journey_track import RECORD_FORMAT, failed, run_case, work
from hil_sim.bench.runner import fixed_core, keep
from hil_sim.bench.show import timeline
from hil_sim.bench.store import RESULTS, Store
from hil_sim.errors import SimError
from hil_sim.start import EXIT_INTERRUPTED

PROG: Final = "argus-sim bench journey"
QUICK_ROWS: Final = ("rooms", "rooms+one", "doors")
QUICK_WORLDS: Final = ("lab", "doors-1")
_EXAMPLES: Final = """\
examples:
  argus-sim bench journey --rows rooms,rooms+rough --seeds 1-2 --profiles argus --out /tmp/x
  argus-sim bench journey --rows rooms+one+start,doors+front --seeds 1-5 --out results
  argus-sim bench journey --rows rooms+mobilesim --worlds 'maps/*.map' --seeds 1-5 --out mine
  argus-sim bench journey --split judge --seeds 1-5 --out judge                the table that is published
  argus-sim bench journey --profiles argus,argus:caution=200 --rows rooms --out trade
  argus-sim bench journey --one argus/tune/rooms+rough/office/7 --out one      time line and picture
  argus-sim bench journey --quick                                              the small one of the tests

A row is where the robot drives and under which conditions, joined by +. Every mission is driven by each profile and by
the ideal: the same driver without diagnosis, on a robot without faults, on the same seed. Writes results.jsonl (a line
per mission), journey.json, journey.csv, journey.md and pictures into --out. How to read them: docs/journey.md.

exit codes: 0 all missions ran, 1 a mission failed, 2 wrong argument or file, 130 interrupted; go on with --resume
"""


def parser() -> argparse.ArgumentParser:
    """Return the argument parser of the bench."""
    result = Parser(
        prog=PROG,
        description="Drive seeded courses with and without diagnosis, and tell what it costs and what it saves.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    grounds, conditions = ", ".join(journeys.GROUND), ", ".join([*journeys.CONDITIONS, journeys.START])
    what = result.add_argument_group("what is run")
    what.add_argument(
        "--rows",
        type=listed,
        metavar="R,R",
        help=f"each one of {grounds}, with + and any of {conditions} (default: {','.join(journeys.DEFAULT_ROWS)})",
    )
    what.add_argument(
        "--worlds",
        action="append",
        metavar="GLOB",
        help="names or files of worlds for rows of rooms and maps",
    )
    what.add_argument("--seeds", type=seeds, metavar="A-B", help="seeds (default 1-5)")
    what.add_argument(
        "--profiles",
        type=listed,
        metavar="P,P",
        help="profiles, each with settings if wanted: argus:caution=200 (default argus,paper)",
    )
    what.add_argument(
        "--split",
        choices=tuple(plan.SPLITS),
        default="tune",
        help="tune (default) to choose settings with, judge to publish: no mission is in both",
    )
    what.add_argument(
        "--one", metavar="ID", help="run one mission and print its time line; with --out a picture"
    )
    what.add_argument("--quick", action="store_true", help="a small fixed selection, less than a minute")
    how = result.add_argument_group("how")
    how.add_argument(
        "--jobs", type=jobs, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)"
    )
    how.add_argument("--out", type=Path, metavar="DIR", help="where results go (default: bench-journey)")
    how.add_argument("--resume", action="store_true", help="go on with what is in --out")
    how.add_argument("--fresh", action="store_true", help="replace what is in --out")
    how.add_argument("--no-plots", action="store_true", help="write no pictures")
    return result


def _cases(arguments: argparse.Namespace) -> list[journeys.Case]:
    if arguments.quick:
        cases = journeys.make_cases(["argus"], arguments.split, QUICK_ROWS, range(1, 2))
        return [case for case in cases if case.world in QUICK_WORLDS]
    profiles = arguments.profiles or ["argus", "paper"]
    for profile in profiles:
        plan.check_profile(profile)
    return journeys.make_cases(
        profiles,
        arguments.split,
        arguments.rows or journeys.DEFAULT_ROWS,
        arguments.seeds or range(1, 6),
        plan.find_worlds(arguments.worlds) if arguments.worlds else (),
    )


def _run(arguments: argparse.Namespace, cases: Sequence[journeys.Case], out: Path) -> int:
    with fixed_core() as digest:
        meta = {"core": digest, "format": f"journey {RECORD_FORMAT}", "split": cases[0].split}
        with Store(out, meta, resume=arguments.resume, fresh=arguments.fresh) as store:
            todo = [case.id for case in cases if not store.done(case.id)]
            records = pool.run_here(todo, min(arguments.jobs, len(todo)), work, failed)
            if not keep(records, store, len(cases), len(todo)):
                say(
                    f"interrupted; {len(store.records)} missions are in {out / RESULTS}, "
                    "the same with --resume goes on"
                )
                return EXIT_INTERRUPTED
            found = [store.records[case.id] for case in cases]
    print(write_report(out, found, meta, plots=not arguments.no_plots), end="")
    return _failures(found)


def _failures(records: Sequence[dict[str, Any]]) -> int:
    wrong = [record for record in records if record["error"] is not None]
    for record in wrong[:5]:
        say(f"{record['id']}: {record['error']}")
    if wrong:
        say(f"{len(wrong)} missions failed; --one ID shows one, --resume runs them again")
    return EXIT_FAILED if wrong else 0


def _one(case: journeys.Case, arguments: argparse.Namespace) -> int:
    """The time line and the record of one mission; with --out its picture, too."""
    record, outcome = run_case(case)
    print(timeline(record, outcome), end="")
    print(json.dumps(record), flush=True)
    if arguments.out:
        from hil_sim.bench.journey_plots import draw

        try:
            arguments.out.mkdir(parents=True, exist_ok=True)
            draw(arguments.out, [record, run_case(case.ideal)[0]])
        except OSError as error:
            raise SimError(
                f"{arguments.out}: cannot draw there ({error.strerror}); name another --out"
            ) from error
    return 0


def _check(options: argparse.ArgumentParser, arguments: argparse.Namespace) -> None:
    """Refuse arguments that another one makes void."""
    fixed = [name for name in ("one", "quick") if getattr(arguments, name)]
    given = [name for name in ("rows", "worlds", "seeds", "profiles") if getattr(arguments, name) is not None]
    others = given or fixed[1:]
    if fixed and others:
        options.error(f"--{fixed[0]} has its own missions; leave --{others[0]} out")
    if arguments.resume and arguments.fresh:
        options.error("--resume goes on with what --fresh throws away; give one of them")


def journey(argv: Sequence[str]) -> int:
    """Run `argus-sim bench journey ARGV`; return the exit code."""
    options = parser()
    arguments = options.parse_args(argv)
    _check(options, arguments)
    if arguments.one:
        return _one(journeys.parse_id(arguments.one), arguments)
    with tempfile.TemporaryDirectory(prefix="argus-journey-") as folder:
        spare = Path(folder) if arguments.quick else Path("bench-journey")
        return _run(arguments, _cases(arguments), arguments.out or spare)
