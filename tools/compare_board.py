#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Drives the demonstration with argusd and with a board's image in QEMU, and compares diagnosis, plans and verdict."""

from __future__ import annotations

import argparse
import concurrent.futures
import dataclasses
import itertools
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[1]
EPILOG: Final = """examples:
  .venv/bin/python tools/compare_board.py --seeds 1 --fail off:3,wrong:6
  .venv/bin/python tools/compare_board.py --board stm32f405 --jobs 2

Both programs and the image must be built: tools/dev build, tools/dev firmware --board BOARD.
exit codes: 0 all pairs of drives agree, 1 some do not, 2 wrong arguments"""
PAIRS: Final = ("off:3,wrong:6", "off:2,wrong:5", "wrong:4,off:1")


@dataclasses.dataclass(frozen=True)
class Outcome:
    """What a drive came to, as the judge has it."""

    passed: bool
    diagnosed: tuple[tuple[int, str | None], ...]
    false_disables: int
    plans: tuple[tuple[int, ...], ...]
    late_turns: int
    time_s: float

    def agrees(self, other: Outcome) -> bool:
        """Whether both came to the same: sonars, kinds, plans, verdict. Times differ with the host's."""
        mine, theirs = dataclasses.asdict(self), dataclasses.asdict(other)
        return all(mine[key] == theirs[key] for key in ("passed", "diagnosed", "false_disables", "plans"))

    def __str__(self) -> str:
        found = ", ".join(f"{sonar} {kind}" for sonar, kind in self.diagnosed)
        plans = "; ".join(" ".join(str(turn) for turn in plan) for plan in self.plans)
        late = f", host late {self.late_turns} times" if self.late_turns else ""
        verdict = "passed" if self.passed else "NOT PASSED"
        return f"{verdict} in {self.time_s:5.1f} s: {found}, {self.false_disables} false; plans {plans}{late}"


def outcome_of(report: dict[str, Any]) -> Outcome:
    """Return what the judge's report says; of plans that were announced again, each once."""
    plans = [tuple(plan["rotations_deg"]) for plan in report["journey"]["plans"]]
    return Outcome(
        passed=report["passed"],
        diagnosed=tuple((one["fault"]["sonar"], one["diagnosed_kind"]) for one in report["findings"]),
        false_disables=len(report["false_disables"]),
        plans=tuple(plan for plan, _ in itertools.groupby(plans)),
        late_turns=report["host"]["late_turns"],
        time_s=report["journey"]["time_s"],
    )


def drive(program: Path, board: str, seed: int, fail: str, out: Path) -> Outcome | str:
    """Drive once; the outcome, or why there is none."""
    command = [sys.executable, "-m", "hil_sim.demo", "--argusd", str(program), "--no-live", "--json"]
    command += ["--seed", str(seed), "--fail", fail, "--out", str(out)]
    done = subprocess.run(
        command,
        cwd=ROOT,
        env=os.environ | {"ARGUS_BOARD": board},
        capture_output=True,
        text=True,
        check=False,
    )
    if not done.stdout:
        return (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
    return outcome_of(json.loads(done.stdout))


def compare(board: str, seed: int, fail: str, out: Path) -> bool:
    """Drive with both, tell both outcomes, and return whether they agree."""
    folder = out / f"{seed}-{fail.replace(':', '').replace(',', '-')}"
    argusd = drive(ROOT / "build/release/argusd", board, seed, fail, folder / "argusd")
    image = drive(ROOT / "tools/qemu-board", board, seed, fail, folder / board)
    good = isinstance(argusd, Outcome) and isinstance(image, Outcome) and argusd.agrees(image)
    print(f"seed {seed}, {fail}: {'agree' if good else 'DIFFER'}", flush=True)
    print(f"  argusd      {argusd}\n  {board:11} {image}", flush=True)
    return good


def main() -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--board", default="mps2-an386")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3, 4, 5], metavar="N")
    parser.add_argument("--fail", nargs="+", default=list(PAIRS), metavar="PAIR")
    parser.add_argument(
        "--jobs", type=int, default=2, help="drives at a time (default 2); they are in real time"
    )
    parser.add_argument(
        "--out", type=Path, default=ROOT / "build/compare", help="records (default build/compare)"
    )
    args = parser.parse_args()
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        drives = itertools.product([args.board], args.seeds, args.fail, [args.out])
        agreed = list(pool.map(lambda one: compare(*one), drives))
    print(f"{sum(agreed)} of {len(agreed)} pairs of drives agree")
    return 0 if all(agreed) else 1


if __name__ == "__main__":
    sys.exit(main())
