#!/bin/sh
# SPDX-License-Identifier: MIT
# A simulated receiver of nmeasim with no variation of its heading ignores its target, and one that has reached a
# target never moves again.
#
# Version:   nmeasim 1.1.1.0, geographiclib 2.1.
# Expected:  It goes to the target, in a straight line where the variation is 0, and on to the next target that is set.
# Behaviour: The target is looked at only where there is a variation. On the last step the speed is lowered so that the
#            receiver does not go beyond the target, to 0 in the end, and stays so: with a new target the heading turns
#            to it, and the position does not change.
# Hurts:     Anyone who tests a way of several points, or wants runs that can be repeated.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            nmeasim==1.1.1.0 \
            geographiclib==2.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >target.py <<'END'
from datetime import datetime, timezone

from nmeasim.models import GpsReceiver
from nmeasim.simulator import Simulator

for variation in (0, 1e-6):
    receiver = GpsReceiver(date_time=datetime(2026, 1, 1, tzinfo=timezone.utc), output=("RMC",))
    receiver.lat, receiver.lon, receiver.kph, receiver.heading = 48.0, 11.0, 3.6, 90.0
    simulator = Simulator(gps=receiver, heading_variation=variation)
    for target in ((48.001, 11.0), (48.002, 11.0)):  # 111 m each: two minutes
        simulator.target = target
        for _ in simulator.get_output(200):
            pass
        print(f"variation {variation}, target {target[0]:.3f} {target[1]:.3f}: after 200 s at {receiver.lat:.3f} {receiver.lon:.3f}, {receiver.kph:.1f} km/h")
END
venv/bin/python target.py >seen

cat >expected <<'END'
variation 0, target 48.001 11.000: after 200 s at 48.000 11.003, 3.6 km/h
variation 0, target 48.002 11.000: after 200 s at 48.000 11.005, 3.6 km/h
variation 1e-06, target 48.001 11.000: after 200 s at 48.001 11.000, 0.0 km/h
variation 1e-06, target 48.002 11.000: after 200 s at 48.001 11.000, 0.0 km/h
END
diff expected seen || { echo "CHANGED: nmeasim-target-is-ignored" >&2; exit 1; }
echo "PASS: without variation the target is ignored, and after the first one it stands"
