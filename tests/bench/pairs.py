# SPDX-License-Identifier: MIT
"""Measures which pairs of faults the demo's drive tells: one sonar goes dead, later another reads half the truth.

Both profiles drive in virtual time: `argus` through the open office, `paper` through its own world.
"""

from __future__ import annotations

import argparse
import datetime
import itertools
import json
from collections import Counter
from pathlib import Path
from typing import Any, Final

from hil_sim.bench.work import core_digest
from hil_sim.scenario.scenario import load_scenario
from hil_sim.sil import Mission, run

AHEAD: Final = range(1, 7)
PAIRS: Final = tuple(itertools.permutations(AHEAD, 2))
DEMO_PAIR: Final = (3, 6)
LIMIT_S: Final = 120.0
YES, NOT_FOUND, CONVICTS = "yes", "not found", "convicts"


def drive(pair: tuple[int, int], seed: int, profile: str, physics: str = "") -> str:
    """Drive once and return what became of the two faults."""
    dead, liar = pair
    world = "demo" if profile == "paper" else "open-office"
    mission = Mission(
        world,
        tuple(load_scenario(world).course),
        faults=(f"off:{dead}@travelled>600", f"wrong:{liar}@travelled>1400:scale=0.5"),
        seed=seed,
        config={"profile": profile, "policy": "paper" if profile == "paper" else "adaptive"},
        sonar={"crosstalk": 0.0},
        physics=physics,
        limit_s=LIMIT_S,
    )
    seen = run(mission)
    wronged = [
        number
        for number, states in enumerate(seen.health)
        if number not in pair and any(health == "DISABLED" for _, health, _ in states)
    ]
    if seen.collisions:
        return f"hit {len(seen.collisions)}"
    if wronged:
        return f"{CONVICTS} {wronged[0]}"
    out = {number: state for number, state in enumerate(seen.final) if state[0] == "DISABLED"}
    return YES if out == {dead: ("DISABLED", "off"), liar: ("DISABLED", "wrong")} else NOT_FOUND


def counted(said: list[str]) -> str:
    """Return one word if all drives ended alike, else each with its count."""
    counts = Counter(said)
    return said[0] if len(counts) == 1 else ", ".join(f"{n} {word}" for word, n in counts.most_common())


def measure(seeds: int, pair_seeds: int) -> dict[str, Any]:
    """Return what each pair came to."""
    argus = {}
    for name, physics in (("plain", ""), ("rough", "rough-day")):
        pairs = [drive(pair, 1, "argus", physics) for pair in PAIRS]
        again = [drive(DEMO_PAIR, seed, "argus", physics) for seed in range(1, seeds + 1)]
        argus[name] = {"pairs": dict(Counter(pairs)), "demo_pair": dict(Counter(again))}
    paper: dict[str, dict[str, str]] = {str(dead): {} for dead in AHEAD}
    for dead, liar in PAIRS:
        paper[str(dead)][str(liar)] = counted(
            [drive((dead, liar), seed, "paper") for seed in range(1, pair_seeds + 1)]
        )
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    meta = {"core": core_digest(), "date": today, "paper_seeds": pair_seeds}
    return {"meta": meta, "argus": argus, "paper": paper}


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, epilog="exit code: 0 measured")
    parser.add_argument("--seeds", type=int, default=20, metavar="N", help="seeds of the demo's own pair")
    parser.add_argument(
        "--paper-seeds", type=int, default=6, metavar="N", help="seeds of each pair of `paper`"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures here, too")
    arguments = parser.parse_args()
    found = measure(arguments.seeds, arguments.paper_seeds)
    text = json.dumps(found, indent=2) + "\n"
    if arguments.json:
        arguments.json.write_text(text, encoding="utf-8")
    print(text, end="")


if __name__ == "__main__":
    main()
