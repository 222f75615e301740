# SPDX-License-Identifier: MIT
"""Measures software in the loop: how many times faster than real time one core runs a mission."""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Mapping

from hil_sim import native
from hil_sim.bench.journey import Case, mission_of, parse_id
from hil_sim.bench.journey_track import run_case
from hil_sim.sil import Mission, Sil
from hil_sim.world.files import load_world
from hil_sim.world.movers import Door, Person

_ROUNDS = ((2300.0, 1000.0), (-500.0, 500.0), (2300.0, -800.0), (0.0, 0.0))
_PEOPLE = (
    Person(((-900.0, -1100.0), (4000.0, -1100.0))),
    Person(((300.0, -800.0), (300.0, 1400.0)), pause=1),
    Door((500.0, -1600.0), width=950, open=80, period=10),
)
_FAULTS = ("wrong:9@20s:scale=0.7", "slow:12@30s", "intermittent:15@40s:p=0.3")


def _missions(world: str, seconds: float) -> Mapping[str, Mission]:
    """Rounds through a room, so that the robot drives for most of the time; all 16 sonars fire."""
    course = (
        _ROUNDS * 8
        if world == "office"
        else tuple((p.x_mm, p.y_mm) for p in load_world(world).goals.values())
    )
    # Rough walls: what is measured is the simulator, not how the rules take a wall that mirrors sound away.
    sonar = {"specular": False, "crosstalk": 0.0, "margin_db": 60.0}
    plain = Mission(world, course, sonar=sonar, limit_s=seconds)
    return {
        "no fault": plain,
        "three faults": Mission(world, course, sonar=sonar, limit_s=seconds, faults=_FAULTS),
        "two people, a door": Mission(world, course, sonar=sonar, limit_s=seconds, movers=_PEOPLE),
    }


def _report(name: str, mission: Mission, repeats: int) -> None:
    Sil(mission).run_until(5.0)
    speeds, share = [], 0.0
    for _ in range(repeats):
        start = time.process_time()
        outcome = Sil(mission).run()
        speeds.append(outcome.t_s / (time.process_time() - start))
        share = outcome.driving_s / outcome.t_s
    low, high = min(speeds), max(speeds)
    median = statistics.median(speeds)
    spread = f"{low:.0f} to {high:.0f}"
    print(
        f"  {name:20} {median:7.0f} x real time ({spread}), {outcome.t_s:.0f} s, in motion {100 * share:.0f} %"
    )


def _report_bench(name: str, case: Case, repeats: int) -> None:
    """What part of a journey of the bench is its mission."""
    run_case(case)
    mission, shares = mission_of(case), []
    for _ in range(repeats):
        start = time.process_time()
        Sil(mission).run()
        alone_s = time.process_time() - start
        run_case(case)
        shares.append(alone_s / (time.process_time() - start - alone_s))
    spread = f"{min(shares):.2f} to {max(shares):.2f}"
    print(f"  {name:20} {statistics.median(shares):7.2f} of bench journey's time ({spread})")


def main() -> None:
    """Run the benchmark."""
    parser = argparse.ArgumentParser(description=__doc__, epilog="exit codes: 0 measured, 1 no library")
    parser.add_argument("--world", default="office")
    parser.add_argument("--seconds", type=float, default=120.0, help="robot time of a mission")
    parser.add_argument("--repeats", type=int, default=5)
    arguments = parser.parse_args()
    how = "in C" if native.library() is not None else "with numpy (libargus_sim.so is not built)"
    print(f"software in the loop, world {arguments.world}, echoes {how}, one core, processor time")
    for name, mission in _missions(arguments.world, arguments.seconds).items():
        _report(name, mission, arguments.repeats)
    for row in ("rooms", "rooms+one", "rooms+people"):
        _report_bench(row, parse_id(f"argus/tune/{row}/{arguments.world}/7"), arguments.repeats)


if __name__ == "__main__":
    main()
