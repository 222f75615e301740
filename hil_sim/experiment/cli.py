# SPDX-License-Identifier: MIT
"""The command line of `argus-sim experiment`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Final

from hil_sim.bench.arguments import EXIT_USAGE, Parser, jobs, listed, say, seeds
from hil_sim.errors import InputError, SimError
from hil_sim.experiment import doc, journey, study_tables
from hil_sim.experiment.cases import ARRAYS, HEALTHY, POLICIES, WORLDS, parse_dead
from hil_sim.experiment.stage import Stage
from hil_sim.program import NO_ARGUSD, find_argusd
from hil_sim.world.physics import SETS

PROG: Final = "argus-sim experiment"
_EXAMPLES: Final = """\
examples:
  argus-sim experiment table1                           an object on each bearing, STOP at 250 mm
  argus-sim experiment table1 --pty                     the same with argusd on a pseudo-terminal, in real time
  argus-sim experiment fig9 --out /tmp/x                rotations for all 62 sets of dead sonars, and the picture
  argus-sim experiment journey --masks one,front --worlds lab,office --seeds 1-2 --out /tmp/x
  argus-sim experiment journey --out study --resume     the whole study, 19,800 journeys; interrupt it as you like
  argus-sim experiment journey --results docs/samples/journeys.csv.gz    tables and pictures of results that are there
  argus-sim experiment journey --one adaptive/judge/office/3/1+2/plain
  argus-sim experiment firing                           how often living sonars are heard when others are dead
  argus-sim experiment wheel                            wheels that are short by 1, 5 and 10 %, named and countered
  argus-sim experiment all --results docs/samples/journeys.csv.gz --doc docs/experiments.md

What each of them shows, and what came of it: docs/experiments.md.

exit codes: 0 done, 1 a journey failed to run, 2 wrong argument or file, 130 interrupted; go on with --resume
"""

Parts = dict[str, str]


def parser() -> argparse.ArgumentParser:
    """Return the argument parser."""
    result = Parser(
        prog=PROG,
        description="Do the experiments of the paper again, and the study of journeys that it lacks.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    result.add_argument("what", choices=(*PARTS, "all"), help="which experiment; all: every one of them")
    result.add_argument(
        "--out",
        type=Path,
        default=Path("experiment"),
        metavar="DIR",
        help="where pictures and results go (default: experiment)",
    )
    result.add_argument(
        "--doc",
        type=Path,
        metavar="FILE",
        help="with all: fill what was found into this page, between its marks",
    )
    short = result.add_argument_group("table1, table4, fig9, fig10")
    short.add_argument("--pty", action="store_true", help="with argusd on a pseudo-terminal, in real time")
    short.add_argument(
        "--argusd",
        type=Path,
        default=find_argusd(),
        metavar="FILE",
        help="the program for --pty (default: of the build folder, or as found)",
    )
    short.add_argument("--seed", type=_seed, default=1, metavar="N", help="of everything random (default 1)")
    what = result.add_argument_group("journey")
    what.add_argument(
        "--masks",
        type=_masks,
        default=parse_dead("all"),
        metavar="M,M",
        help=f"dead sonars from the start: 3, 1+2, {HEALTHY}, {', '.join(ARRAYS)}, or one ... six: all sets of so "
        "many, all (default)",
    )
    what.add_argument(
        "--policies",
        type=_some_of("policy", POLICIES),
        default=list(POLICIES),
        metavar="P,P",
        help=f"of {', '.join(POLICIES)} (default: all)",
    )
    what.add_argument(
        "--worlds",
        type=_some_of("world", WORLDS),
        default=list(WORLDS),
        metavar="W,W",
        help=f"of {', '.join(WORLDS)} (default: all)",
    )
    what.add_argument("--seeds", type=seeds, default=range(1, 11), metavar="A-B", help="seeds (default 1-10)")
    what.add_argument("--day", choices=tuple(SETS), default="plain", help="physics of sonars and wheels")
    what.add_argument("--one", metavar="ID", help="run one journey and print its record")
    what.add_argument(
        "--results", type=Path, metavar="FILE", help="drive nothing: take this table of journeys"
    )
    what.add_argument(
        "--jobs", type=jobs, default=os.cpu_count() or 1, metavar="N", help="processes (default: cores)"
    )
    what.add_argument("--resume", action="store_true", help="go on with what is in --out")
    what.add_argument("--fresh", action="store_true", help="replace what is in --out")
    return result


def _seed(text: str) -> int:
    if not text.isdigit() or int(text) >= 2**31:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 0 to {2**31 - 1}")
    return int(text)


def _masks(text: str) -> list[str]:
    try:
        found = parse_dead(text)
    except SimError as error:
        raise argparse.ArgumentTypeError(str(error)) from None
    if not found:
        raise argparse.ArgumentTypeError("names no sonars; write all, or 1+2")
    return found


def _some_of(what: str, known: Sequence[str] | Mapping[str, object]) -> Callable[[str], list[str]]:
    def parse(text: str) -> list[str]:
        found = listed(text)
        for name in found:
            if name not in known:
                raise argparse.ArgumentTypeError(f"'{name}' is no {what}; there are {', '.join(known)}")
        if not found:
            raise argparse.ArgumentTypeError(f"names no {what}; there are {', '.join(known)}")
        return found

    return parse


def _stage(arguments: argparse.Namespace) -> Stage:
    if arguments.pty and arguments.argusd is None:
        raise SimError(NO_ARGUSD)
    return Stage(arguments.argusd if arguments.pty else None)


def _table1(arguments: argparse.Namespace) -> Parts:
    from hil_sim.experiment import table1

    return {"table1": table1.table(table1.run(_stage(arguments), arguments.seed))}


def _table4(arguments: argparse.Namespace) -> Parts:
    from hil_sim.experiment import plans

    return {"table4": plans.table4(_stage(arguments), arguments.seed)}


def _fig9(arguments: argparse.Namespace) -> Parts:
    from hil_sim.experiment import pictures, plans

    found = plans.all_plans(_stage(arguments), plans.POLICIES, arguments.seed)
    pictures.draw_fig9(arguments.out / "fig9.png", found)
    return {"fig9": plans.sums(found)}


def _fig10(arguments: argparse.Namespace) -> Parts:
    from hil_sim.experiment import fig10, pictures

    drive = fig10.run(_stage(arguments), arguments.seed)
    pictures.draw_fig10(arguments.out / "fig10.png", drive)
    return {"fig10": fig10.summary(drive)}


def _journey(arguments: argparse.Namespace) -> Parts:
    from hil_sim.experiment import study_pictures

    records = journey.read_table(arguments.results) if arguments.results else journey.run_study(arguments)
    study_pictures.draw(arguments.out, records)
    return {
        "coverage": study_tables.coverage(records),
        "bars": study_tables.bars(records),
        "goals": study_tables.goals(records),
        "prices": study_tables.prices(records),
        "safety": study_tables.safety(records),
    }


def _wheel(arguments: argparse.Namespace) -> Parts:
    from hil_sim.experiment import wheel

    return {"wheel": wheel.table(wheel.run(arguments.seed))}


def _firing(arguments: argparse.Namespace) -> Parts:
    from hil_sim.experiment import firing

    return {"firing": firing.table(firing.run(Stage(), arguments.seed))}


PARTS: Final[Mapping[str, Callable[[argparse.Namespace], Parts]]] = {
    "table1": _table1,
    "table4": _table4,
    "fig9": _fig9,
    "fig10": _fig10,
    "journey": _journey,
    "firing": _firing,
    "wheel": _wheel,
}


def _run(arguments: argparse.Namespace) -> int:
    if arguments.one:
        print(journey.show_one(arguments.one), end="")
        return 0
    names = list(PARTS) if arguments.what == "all" else [arguments.what]
    try:
        arguments.out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SimError(
            f"{arguments.out}: cannot write there ({error.strerror}); name another --out"
        ) from error
    found: Parts = {}
    for name in names:
        parts = PARTS[name](arguments)
        found |= parts
        for title, text in parts.items():
            print(f"{title}:\n{text}", flush=True)
    if arguments.doc:
        doc.fill(arguments.doc, found)
    return 0


def _check(options: argparse.ArgumentParser, arguments: argparse.Namespace) -> None:
    """Refuse arguments that another one makes void."""
    if arguments.resume and arguments.fresh:
        options.error("--resume goes on with what --fresh throws away; give one of them")
    if arguments.doc and arguments.what != "all":
        options.error("--doc is filled by all experiments together; write all")
    if arguments.one and arguments.what != "journey":
        options.error("--one is a journey; write journey --one ID")
    if arguments.results and (arguments.resume or arguments.fresh):
        options.error("--results drives nothing; leave --resume and --fresh out")


def main(argv: Sequence[str]) -> int:
    """Run `argus-sim experiment ARGV`; return the exit code."""
    options = parser()
    arguments = options.parse_args(argv)
    _check(options, arguments)
    try:
        return _run(arguments)
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
