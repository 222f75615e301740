# SPDX-License-Identifier: MIT
"""Puts a robot together: body, sonars and faults in a world, each with a random stream of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np

from hil_sim.errors import SimError
from hil_sim.faults.execute import FaultSet
from hil_sim.faults.kinds import Fault
from hil_sim.laser.scan import Laser, laser_of
from hil_sim.laser.scanner import Scanner
from hil_sim.record.truth import Log
from hil_sim.robot.robot import Robot
from hil_sim.robot.sectors import Sectors
from hil_sim.scenario.scenario import Scenario
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import SonarParams
from hil_sim.sonar.ring import SonarRing
from hil_sim.sonar.rough import Roughness
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.world.body import BodyModel
from hil_sim.world.model import Pose, World
from hil_sim.world.movers import Mover
from hil_sim.world.moving import MovingSolids, moving_solids
from hil_sim.world.physics import Physics

R = TypeVar("R", bound=Robot)
OUTSIDE_MM = 1000.0
"""Farther from all solids and the start of a world is outside of it."""
VENDORS_LASER = Laser(most_mm=32_767.0, noise_mm=2.9)
"""As the vendor's emulator has it: its noise is even, up to 5 mm."""


def assemble(
    world: World,
    start: Pose,
    *,
    make: Callable[..., R],
    table: RobotTable,
    seed: int,
    sonar: SonarParams,
    physics: Physics | None = None,
    faults: Sequence[Fault] = (),
    movers: Sequence[Mover] = (),
    bumpers: int | None = None,
    rear_bumpers: int | None = None,
    log: Log | None = None,
    echoes: EchoModel | None = None,
    make_faults: Callable[[Sequence[Fault], np.random.Generator], FaultSet] = FaultSet,
    faults_to_come: bool = False,
) -> R:
    """Return a robot, made by `make`, at `start`; SimError when a solid is there, or nothing far and wide.

    physics: None is as the world says. movers: besides the world's own. echoes: a model of the same world, parameters
    and robot, to share what it has worked out. faults_to_come: more may be injected while it runs.
    """
    moving = moving_solids((*world.movers, *movers), table.body)
    body = BodyModel(world, moving, table.body)
    place = f"{start.x_mm:g},{start.y_mm:g},{start.heading_deg:g}"
    x1, y1, x2, y2 = world.bounds
    if not (
        x1 - OUTSIDE_MM <= start.x_mm <= x2 + OUTSIDE_MM and y1 - OUTSIDE_MM <= start.y_mm <= y2 + OUTSIDE_MM
    ):
        size = f"x {x1:.0f} to {x2:.0f}, y {y1:.0f} to {y2:.0f} mm"
        raise SimError(f"start {place}: outside of world {world.name} ({size}); choose another start")
    if body.contact(start, 0.0) is not None:
        raise SimError(f"start {place}: a solid of world {world.name} is there; choose another start")
    # Streams of their own, so that one more draw in one place changes nothing elsewhere.
    injected = make_faults(faults, np.random.default_rng([seed, 1])) if faults or faults_to_come else None
    physics = world.physics if physics is None else physics
    rough = None
    if physics.on_sonars:
        rough = Roughness(physics, table.without_laser.sonars, np.random.default_rng([seed, 3]))
    ring = SonarRing(
        world,
        sonar,
        injected,
        np.random.default_rng([seed, 2]),
        robot=table.without_laser,
        echoes=echoes,
        moving=moving,
        rough=rough,
    )
    sectors = None
    if table.sectors:
        scanner = Scanner(laser_of(table), world, moving, np.random.default_rng([seed, 4]))
        sectors = Sectors(table, scanner, injected)
    return make(
        body,
        ring,
        start,
        table=table,
        physics=physics,
        faults=injected,
        bumpers=bumpers,
        rear_bumpers=rear_bumpers,
        seed=seed,
        moving=moving,
        log=log,
        sectors=sectors,
    )


def build_robot(
    scenario: Scenario,
    world: World,
    start: Pose,
    log: Log | None,
    rear_bumpers: int | None = None,
    faults_to_come: bool = False,
) -> Robot:
    """Return a robot at `start` in `world` with all that the scenario gives it."""
    return assemble(
        world,
        start,
        make=Robot,
        table=robot_table(scenario.robot),
        seed=scenario.seed,
        sonar=scenario.sonar,
        physics=scenario.physics,
        faults=scenario.faults,
        movers=scenario.movers,
        bumpers=scenario.bumpers,
        rear_bumpers=rear_bumpers,
        log=log,
        faults_to_come=faults_to_come,
    )


def scanner_of(scenario: Scenario, world: World, robot: Robot) -> Scanner:
    """Return the laser of a robot, which sees what it meets."""
    moving = robot.moving
    assert moving is None or isinstance(moving, MovingSolids)
    return Scanner(VENDORS_LASER, world, moving, np.random.default_rng([scenario.seed, 5]))
