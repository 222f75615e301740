# SPDX-License-Identifier: MIT
"""`argus-sim bench diagnosis`: how well the fault manager diagnoses, in thousands of seeded missions."""

from __future__ import annotations

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from hil_sim.arguments import offer
from hil_sim.bench import cli_passive, journey_cli, lasers, plan, pool, quick, recorded_cli
from hil_sim.bench.arguments import (
    EXIT_FAILED,
    EXIT_USAGE,
    Parser,
    jobs,
    kinds,
    listed,
    say,
    seeds,
)
from hil_sim.bench.figures import summarise
from hil_sim.bench.judge import RECORD_FORMAT
from hil_sim.bench.runner import fixed_core, keep
from hil_sim.bench.show import timeline
from hil_sim.bench.store import RESULTS, Store
from hil_sim.bench.work import run_case, world_files
from hil_sim.errors import InputError, SimError
from hil_sim.start import EXIT_INTERRUPTED

PROG: Final = "argus-sim bench diagnosis"
_PROFILES: Final = "paper,argus"
_WHAT: Final = ("worlds", "seeds", "profiles", "kinds", "every", "sensitivity", "split")
"""What --one and --quick leave no choice of."""
_EXAMPLES: Final = """\
examples:
  argus-sim bench diagnosis --worlds office --seeds 1-20 --profiles argus --kinds off,wrong --out /tmp/x
  argus-sim bench diagnosis --worlds 'gen-*' --seeds 1-100 --out results --resume
  argus-sim bench diagnosis --worlds 'maps/*.map' --seeds 1-50 --out results
  argus-sim bench diagnosis --one argus/tune/office/7/wrong-scale0.5
  argus-sim bench diagnosis --profiles argus,argus:suspect_readings=5 --out trade     settings side by side
  argus-sim bench diagnosis --scheduler tcp://10.0.0.1:8786 --out results             on a Dask cluster
  argus-sim bench diagnosis --quick                                                   the small one of the tests

Writes results.jsonl (a line per mission), diagnosis.json, diagnosis.csv, diagnosis.md and pictures into --out.
How everything is measured: docs/diagnosis.md.

exit codes: 0 all missions ran (and with --quick, all is within the bounds),
            1 a mission failed, a bound is broken or no scheduler answers, 2 wrong argument or file,
            130 interrupted; go on with --resume
"""


def parser() -> argparse.ArgumentParser:
    """Return the argument parser of the bench."""
    result = Parser(
        prog=PROG,
        description="Run seeded missions with and without sonar faults and judge what the fault manager makes of them.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    what = result.add_argument_group("what is run")
    what.add_argument(
        "--worlds",
        action="append",
        metavar="GLOB",
        help="names of our worlds or of generated ones, or .map and .yaml files (default: office,lab,gen-*)",
    )
    what.add_argument("--seeds", type=seeds, metavar="A-B", help="seeds (default 1-10)")
    what.add_argument(
        "--profiles",
        type=listed,
        metavar="P,P",
        help=f"profiles, each with settings if wanted: argus:step_mm=100 (default {_PROFILES})",
    )
    what.add_argument("--kinds", type=kinds, metavar="K,K", help=f"of {','.join(plan.KINDS)} (default: all)")
    what.add_argument(
        "--every", action="store_true", help="every severity of a kind for each seed, not the next one"
    )
    what.add_argument("--sensitivity", action="store_true", help="again with other noise and other crosstalk")
    what.add_argument(
        "--split",
        choices=tuple(plan.SPLITS),
        default="tune",
        help="tune (default) to choose settings with, judge to publish: no mission is in both",
    )
    what.add_argument("--one", metavar="ID", help="run one mission and print its time line")
    what.add_argument(
        "--quick", action="store_true", help="a small fixed bench against checked-in bounds, a minute"
    )
    how = result.add_argument_group("how")
    how.add_argument(
        "--jobs", type=jobs, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)"
    )
    how.add_argument("--scheduler", metavar="ADDRESS", help="a Dask scheduler whose workers run the missions")
    how.add_argument("--out", type=Path, metavar="DIR", help="where results go (default: bench-diagnosis)")
    how.add_argument("--resume", action="store_true", help="go on with what is in --out")
    how.add_argument("--fresh", action="store_true", help="replace what is in --out")
    how.add_argument("--no-plots", action="store_true", help="write no pictures")
    return result


def run_cases(cases: Sequence[plan.Case], store: Store, arguments: argparse.Namespace, core: str) -> bool:
    """Run the cases that have no result yet, by the fault manager with this digest; False when interrupted."""
    todo = [case.id for case in cases if not store.done(case.id)]
    if arguments.scheduler and todo:
        records = pool.run_cluster(todo, arguments.scheduler, world_files(list(cases)), core)
    else:
        records = pool.run_here(todo, min(arguments.jobs, len(todo)))
    return keep(records, store, len(cases), len(todo))


def _cases(arguments: argparse.Namespace) -> list[plan.Case]:
    profiles = arguments.profiles or listed(_PROFILES)
    for profile in profiles:
        plan.check_profile(profile)
    return plan.make_cases(
        profiles,
        arguments.split,
        plan.find_worlds(arguments.worlds or ["office", "lab", "gen-*"]),
        arguments.seeds or range(1, 11),
        arguments.kinds or list(plan.KINDS),
        every=arguments.every,
        sensitivity=arguments.sensitivity,
    )


def _run(arguments: argparse.Namespace, cases: Sequence[plan.Case], out: Path) -> list[dict[str, Any]] | None:
    """Run the cases and write the report; return their records, None when it was interrupted."""
    from hil_sim.bench.report import write_report

    with fixed_core() as digest:
        meta = {"core": digest, "format": RECORD_FORMAT, "split": cases[0].split, "missions": len(cases)}
        with Store(out, meta, resume=arguments.resume, fresh=arguments.fresh) as store:
            if not run_cases(cases, store, arguments, digest):
                say(
                    f"interrupted; {len(store.records)} missions are in {out / RESULTS}, the same with --resume goes on"
                )
                return None
            wanted = {case.id for case in cases}
            records = [record for name, record in store.records.items() if name in wanted]
    print(write_report(out, records, meta, plots=not arguments.no_plots), end="")
    return records


def _bench(arguments: argparse.Namespace) -> int:
    records = _run(arguments, _cases(arguments), arguments.out or Path("bench-diagnosis"))
    return EXIT_INTERRUPTED if records is None else _failures(records)


def _quick(arguments: argparse.Namespace) -> int:
    """The fixed bench against its bounds; without --out it leaves nothing."""
    bounds = quick.load_bounds()
    with tempfile.TemporaryDirectory(prefix="argus-bench-") as folder:
        records = _run(arguments, quick.cases(), arguments.out or Path(folder))
    if records is None:
        return EXIT_INTERRUPTED
    code = _failures(records)
    broken = quick.broken(summarise(records), bounds)
    for line in broken:
        say(line)
    if broken:
        say(f"{len(broken)} of the bounds in {quick.BOUNDS.name} broken")
    return EXIT_FAILED if broken else code


def _failures(records: Sequence[dict[str, Any]]) -> int:
    failed = [record for record in records if record["error"] is not None]
    for record in failed[:5]:
        say(f"{record['id']}: {record['error']}")
    if failed:
        say(f"{len(failed)} missions failed; --one ID shows one, --resume runs them again")
    return EXIT_FAILED if failed else 0


def _one(text: str) -> int:
    case = plan.parse_id(text)
    record, outcome = run_case(case)
    print(timeline(record, outcome), end="")
    print(json.dumps(record), flush=True)
    return 0


def _check(options: argparse.ArgumentParser, arguments: argparse.Namespace) -> None:
    """Refuse arguments that another one makes void."""
    fixed = [name for name in ("one", "quick") if getattr(arguments, name)]
    given = [name for name in _WHAT if getattr(arguments, name) != options.get_default(name)]
    others = given or fixed[1:]
    if fixed and others:
        options.error(f"--{fixed[0]} has its own missions; leave --{others[0]} out")
    if arguments.resume and arguments.fresh:
        options.error("--resume goes on with what --fresh throws away; give one of them")


def main(argv: Sequence[str]) -> int:
    """Run `argus-sim bench ARGV`; return the exit code."""
    names = {
        "diagnosis": _diagnosis,
        "journey": journey_cli.journey,
        "drive-by": cli_passive.drive_by,
        "ablate": cli_passive.ablate,
        "likelihoods": cli_passive.likelihoods,
        "laser": lasers.main,
        "recorded": recorded_cli.recorded,
    }
    if not argv or argv[0] not in names:
        if argv and argv[0] in ("-h", "--help"):
            print(f"usage: argus-sim bench {{{','.join(names)}}} ...; see {PROG} --help")
            return 0
        which = (
            f"no bench '{argv[0]}'{offer(argv[0], names)}"
            if argv
            else f"bench: name one of {', '.join(names)}"
        )
        say(f"{which}; see {PROG} --help")
        return EXIT_USAGE
    try:
        return names[argv[0]](argv[1:])
    except SimError as error:
        say(str(error))
        return error.exit_code
    except InputError as error:
        say(str(error))
        return EXIT_USAGE
    except BrokenPipeError:
        # Nobody reads our output; the interpreter would complain once more while it closes it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _diagnosis(argv: Sequence[str]) -> int:
    options = parser()
    arguments = options.parse_args(argv)
    _check(options, arguments)
    if arguments.one:
        return _one(arguments.one)
    return _quick(arguments) if arguments.quick else _bench(arguments)
