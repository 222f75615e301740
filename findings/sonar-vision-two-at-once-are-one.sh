#!/bin/sh
# SPDX-License-Identifier: MIT
# Two objects that a sonar sees at once are one track in the tracker of sonar-vision, at the place of the second.
#
# Version:   sonar-vision 0.1.0.
# Expected:  A tracker that gets two detections of one moment makes two tracks: an object is at one place at a time.
# Behaviour: A track that is made for the first detection is not marked as used, so the second detection of the same
#            batch, up to 5 m away, moves it. Six echoes of one ping, 1 m apart, make three tracks, each at the second
#            of a pair. With the next ping the track goes back to the first, and a new one begins at the second. Two
#            that are seen 9 m apart first are two tracks, and stay it.
# Hurts:     Anyone who counts objects, or starts the tracker in a room that is not empty. Give the first detections one
#            by one, with the gate closed (association_gate=0).
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            sonar-vision==0.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >tracks.py <<'END'
from sonar_vision.tracker import Detection, ObjectTracker


def show(what: str, tracker: ObjectTracker) -> None:
    """Print the tracks of TRACKER."""
    print(f"{what}:", ", ".join(f"at {track.x:g} after {track.detections} detections" for track in tracker.tracks))


together = ObjectTracker()
together.update([Detection(x=0, y=0), Detection(x=4, y=0)], now=100)
show("two at once", together)
together.update([Detection(x=0, y=0), Detection(x=4, y=0)], now=101)
show("the same a second later", together)

many = ObjectTracker()
many.update([Detection(x=step, y=0) for step in range(6)], now=100)
show("six at once", many)

apart = ObjectTracker()
apart.update([Detection(x=0, y=0), Detection(x=9, y=0)], now=100)
apart.update([Detection(x=2, y=0), Detection(x=7, y=0)], now=101)
show("two that were 9 m apart", apart)
END
venv/bin/python tracks.py >seen

cat >expected <<'END'
two at once: at 4 after 2 detections
the same a second later: at 0 after 3 detections, at 4 after 1 detections
six at once: at 1 after 2 detections, at 3 after 2 detections, at 5 after 2 detections
two that were 9 m apart: at 2 after 2 detections, at 7 after 2 detections
END
diff expected seen || { echo "CHANGED: sonar-vision-two-at-once-are-one" >&2; exit 1; }
echo "PASS: two echoes at once are one track"
