# SPDX-License-Identifier: MIT
"""Let each kind of fault begin on the way and print which are found, in software and without a robot."""

import argus

BEGINS = "3@travelled>600"
FAULTS = (
    f"off:{BEGINS}",
    f"silent:{BEGINS}",
    f"stuck:{BEGINS}",
    f"wrong:{BEGINS}:scale=0.5",
    f"garbage:{BEGINS}",
    f"slow:{BEGINS}:n=5",
)


def main() -> None:
    """Run one mission for each fault."""
    for fault in FAULTS:
        mission = argus.Mission("demo", ((1700, 0), (1700, 1550)), faults=(fault,), seed=7)
        outcome = argus.run(mission)
        health, named = outcome.final[3]
        end = "reached" if outcome.reached else f"{outcome.goal_mm:.0f} mm short"
        print(f"{fault:35} {end}, {len(outcome.collisions)} collisions, sonar 3 {health} {named}".rstrip())


if __name__ == "__main__":
    main()
