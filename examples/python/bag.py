# SPDX-License-Identifier: MIT
"""Judge the sonars in a bag of ROS 1 or 2, without ROS; argument: the bag."""

import sys

import argus


def main(path: str) -> int:
    """Print what is found; return 1 when a sonar is faulty."""
    found = argus.diagnose(path)
    print(found.text)
    bad = [k for k, health in enumerate(found.health) if health not in ("HEALTHY", "UNKNOWN", "ABSENT")]
    for k in bad:
        print(f"sonar {k}: {found.health[k]} {found.kind[k]}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
