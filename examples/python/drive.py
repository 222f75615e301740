# SPDX-License-Identifier: MIT
"""Drive 2 m ahead and print what became of the sonars; argument: the control socket of an active argusd."""

import sys

import argus


def main(place: str) -> None:
    """Drive, then report."""
    with argus.connect(place) as robot:
        state = robot.drive_to(2000, 0)
        print(f"at {state.x_mm},{state.y_mm} mm, {state.failure}, battery {state.battery_v} V")
        for sonar in state.sonars:
            print(sonar)
        print(f"{len(state.failing)} of {len(state.sonars)} sonars are not relied on")


if __name__ == "__main__":
    main(sys.argv[1])
