#!/bin/sh
# SPDX-License-Identifier: MIT
# In sonar-vision a robot that touches a pillar of 2 m radius is 2 m away from the nearest obstacle, and a post that is
# taken away takes the wall beside it along.
#
# Version:   sonar-vision 0.1.0.
# Expected:  distance_to_nearest is documented as the distance to the nearest occupied cell or obstacle, so it agrees
#            with ray_cast. remove_obstacle undoes add_obstacle.
# Behaviour: The distance is the one to the middle of an obstacle, and cells that are occupied without an obstacle (as a
#            sonar marks them) are at infinity. A post without a radius occupies one cell and frees nine when it is
#            removed, those of its neighbours among them: the ray goes through the wall, whose obstacle is still in the
#            list. Of two pillars that overlap, the one that stays has a hole.
# Hurts:     Anyone who brakes by the distance, or removes moving obstacles from a map. Take ray_cast, and add all
#            obstacles again after a removal.
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

cat >distance.py <<'END'
from sonar_vision.map import CellState, Obstacle, SpatialMap


def world() -> SpatialMap:
    """Return an empty map."""
    return SpatialMap(width=20, height=20, resolution=0.1)


def ahead(room: SpatialMap, y: float = 0.05) -> str:
    """Return how far a ray from 0, Y goes to the right."""
    hit = room.ray_cast(0, y, 0, 9)
    return "nothing" if hit is None else f"{hit[0]:.1f}"


pillar = world()
pillar.add_obstacle(Obstacle(x=3, y=0, radius=2))
for x in (0.0, 1.0):
    print(f"pillar from 1 m on, robot at {x}: distance {pillar.distance_to_nearest(x, 0):.1f}")
print("ray to the pillar:", ahead(pillar))

seen = world()
seen.set_cell(1, 0, CellState.OCCUPIED)
print(f"occupied cell at 1.0: distance {seen.distance_to_nearest(0, 0):.1f}, ray {ahead(seen)}")

wall = world()
for row in range(-5, 5):
    wall.add_obstacle(Obstacle(x=3.05, y=row / 10 + 0.05))
wall.add_obstacle(Obstacle(x=2.95, y=0.05))
print("wall and post: ray", ahead(wall))
wall.remove_obstacle(10)
rows = [ahead(wall, row / 10 + 0.05) for row in range(-3, 4)]
print(f"post removed, {len(wall.obstacles)} obstacles left: rays", *rows)
END
venv/bin/python distance.py >seen

cat >expected <<'END'
pillar from 1 m on, robot at 0.0: distance 3.0
pillar from 1 m on, robot at 1.0: distance 2.0
ray to the pillar: 1.0
occupied cell at 1.0: distance inf, ray 1.0
wall and post: ray 2.9
post removed, 10 obstacles left: rays 3.0 3.0 nothing nothing nothing 3.0 3.0
END
diff expected seen || { echo "CHANGED: sonar-vision-distance-to-the-middle" >&2; exit 1; }
echo "PASS: the distance is the one to the middle, and a removed post leaves a hole"
