# SPDX-License-Identifier: MIT
"""Rule: the echo model in C reads the same millimetre as the numpy model, everywhere, and a library that is missing or
of another version changes nothing but the speed."""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path

import pytest

from hil_sim import native
from hil_sim.errors import SimError
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import SonarParams
from hil_sim.sonar.patch import MovingEchoes
from hil_sim.world.files import load_world, world_names
from hil_sim.world.model import Pose, World
from hil_sim.world.movers import Door, Person
from hil_sim.world.moving import MovingSolids

FEW_POSES, POSES = 2_000, 13_000
"""In each world that comes with the emulator; the sweep over the many makes more than 100,000 together."""
ODD = SonarParams(cone_deg=67.0, air_db_m=0.0, edge_db=3.0, tip_db=6.0, mirror_db_deg2=0.01)
ROUGH = SonarParams(specular=False, margin_db=60.0)


def built() -> None:
    assert native.library() is not None, "libargus_sim.so is not built: run tools/dev build release"


def models(world: World, params: SonarParams) -> tuple[EchoModel, EchoModel]:
    built()
    return EchoModel(world, params), EchoModel(world, params, in_c=False)


def places(world: World, count: int, seed: str) -> list[tuple[float, float, float]]:
    """Poses anywhere, and a part of them on a grid, where rays meet ends of walls and run along them."""
    rng = random.Random(seed)
    x1, y1, x2, y2 = world.bounds
    found = []
    for k in range(count):
        if k % 5 == 0:
            x, y = 50.0 * round(rng.uniform(x1, x2) / 50), 50.0 * round(rng.uniform(y1, y2) / 50)
            found.append((x, y, float(rng.randrange(-360, 360, 5))))
        else:
            x, y = rng.uniform(x1 - 500, x2 + 500), rng.uniform(y1 - 500, y2 + 500)
            found.append((x, y, rng.uniform(-400, 400)))
    return found


def compare(name: str, count: int) -> None:
    world = load_world(name)
    in_c, in_numpy = models(world, SonarParams())
    seen = set()
    for pose in places(world, count, name):
        value = in_c.range_mm(*pose)
        assert value == in_numpy.range_mm(*pose), pose
        seen.add(value)
    assert len(seen) > count // 30, "the places do not all read the same"


@pytest.mark.tour(3)
@pytest.mark.parametrize("name", world_names())
def test_c_and_numpy_agree_to_the_millimetre(name: str) -> None:
    compare(name, FEW_POSES)


@pytest.mark.wide
@pytest.mark.parametrize("name", world_names())
def test_c_and_numpy_agree_in_many_places(name: str) -> None:
    compare(name, POSES)


@pytest.mark.parametrize("params", [ODD, ROUGH], ids=["odd", "rough"])
def test_they_agree_for_other_parameters(params: SonarParams) -> None:
    for name in ("office", "posts", "smooth"):
        world = load_world(name)
        in_c, in_numpy = models(world, params)
        for pose in places(world, 1000, f"{name} parameters"):
            assert in_c.range_mm(*pose) == in_numpy.range_mm(*pose), (name, pose)


def test_they_agree_while_people_and_doors_move() -> None:
    world = load_world("office")
    in_c, in_numpy = models(world, SonarParams())
    movers = (
        Person(((-1000.0, -700.0), (4000.0, -700.0)), pause=0.5),
        Person(((1000.0, -1000.0), (1000.0, 900.0), (3000.0, 900.0)), radius=150, roughness=0.3),
        Door((500.0, -1600.0), width=950, open=-75, period=5),
    )
    moving = MovingSolids(movers)
    for_c, for_numpy = MovingEchoes(moving, SonarParams()), MovingEchoes(moving, SonarParams())
    robot, differs = Pose(0.0, 0.0, 0.0), 0
    for x, y, heading in places(world, 4000, "moving"):
        for _ in range(5):
            moving.step(robot)
        value = in_c.range_mm(x, y, heading, for_c)
        assert value == in_numpy.range_mm(x, y, heading, for_numpy), (x, y, heading, moving.moment)
        differs += value != in_c.range_mm(x, y, heading)
    assert differs > 200, "the movers are heard"


def test_a_ping_is_the_range_from_where_the_sonar_sits() -> None:
    world = load_world("lab")
    in_c, in_numpy = models(world, SonarParams())
    for k, (x, y, heading) in enumerate(places(world, 2000, "mounts")):
        pose, angle = Pose(x, y, heading), float(k % 3 * 20)
        assert in_c.ping_mm(k % 16, pose, angle) == in_numpy.ping_mm(k % 16, pose, angle), (k, pose)


def test_an_empty_world_and_a_very_large_one() -> None:
    import numpy as np

    empty = World("empty", np.zeros((0, 4)), np.zeros(0))
    assert models(empty, SonarParams())[0].range_mm(0, 0, 0) == 5000
    rng = np.random.default_rng(1)
    spots = rng.uniform(-20_000, 20_000, (3000, 2))
    rows = np.concatenate((spots, spots + rng.uniform(-300, 300, (3000, 2))), axis=1)
    many = World("many", rows, rng.random(3000))
    in_c, in_numpy = models(many, SonarParams())
    for pose in places(many, 500, "many"):
        assert in_c.range_mm(*pose) == in_numpy.range_mm(*pose), pose


def says(value: str) -> tuple[int, str]:
    program = "from hil_sim import native; print(native.library() is not None)"
    done = subprocess.run(
        [sys.executable, "-c", program],
        env={"ARGUS_SIM_KERNEL": value, "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        check=False,
    )
    return done.returncode, done.stdout.strip() or done.stderr.strip().splitlines()[-1]


def test_the_library_can_be_switched_off_and_a_wrong_one_is_refused(tmp_path: Path) -> None:
    assert says("off") == (0, "False")
    code, said = says(str(tmp_path / "none.so"))
    assert code
    assert "not this version's libargus_sim.so" in said


def test_a_stale_library_of_the_build_folder_is_passed_over(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    stale = tmp_path / "libargus_sim.so"
    stale.write_bytes(b"no library")
    monkeypatch.delenv(native.LIBRARY_VARIABLE, raising=False)
    monkeypatch.setattr(native, "_PLACES", (stale,))
    assert native.library.__wrapped__() is None
    monkeypatch.setenv(native.LIBRARY_VARIABLE, str(stale))
    with pytest.raises(SimError, match="build it again"):
        native.library.__wrapped__()
