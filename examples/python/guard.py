# SPDX-License-Identifier: MIT
"""Drive by wheels through a guard port, however badly: it stops before the wall; argument: the port."""

import sys

import argus


def main(place: str) -> None:
    """Order 300 mm/s ahead for 15 s and look at what comes of it."""
    with argus.connect_guard(place) as robot:
        print(" ".join(robot.identity))
        robot.drive(300)
        sips = list(robot.sips(15.0))
        ahead = [robot.readings[number] for number in (3, 4)]
        print(f"bumped: {any(sip.stall_left & 0x3E or sip.stall_right & 0x3E for sip in sips)}")
        print(f"stands {min(ahead)} mm before the wall, though 300 mm/s are ordered still")
        robot.turn(90)
        print(f"turned, and stands: {robot.until_it_stands().left_vel} mm/s")


if __name__ == "__main__":
    main(sys.argv[1])
