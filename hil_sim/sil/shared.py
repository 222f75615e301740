# SPDX-License-Identifier: MIT
"""What is worked out for a world serves all missions in it."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from hil_sim.errors import SimError
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import SonarParams
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world
from hil_sim.world.model import World

Stamp = tuple[int, int] | None


def stamp_of(name: str) -> Stamp:
    """What changes when the file of a world is written anew; None for one of ours."""
    try:
        status = Path(name).stat()
    except (OSError, ValueError):
        return None
    return status.st_mtime_ns, status.st_size


# What is worked out for a world serves all missions in it; only few at a time, since that takes memory.
@lru_cache(maxsize=8)
def shared_world(name: str, stamp: Stamp) -> World:  # noqa: ARG001 (a key)
    """Return a world, read once."""
    return load_world(name)


@lru_cache(maxsize=8)
def shared_echoes(name: str, stamp: Stamp, params: SonarParams, robot: str) -> EchoModel:
    """Return the echo model of a world, made once."""
    return EchoModel(shared_world(name, stamp), params, robot_table(robot).without_laser)


def sonar_params(values: Mapping[str, float]) -> SonarParams:
    """Return the parameters of the sonar model with these values; SimError for one that there is not."""
    known = {f.name for f in dataclasses.fields(SonarParams)}
    if wrong := set(values) - known:
        raise SimError(
            f"sonar: '{min(wrong)}' is no parameter of the model; there are {', '.join(sorted(known))}"
        )
    given: dict[str, Any] = dict(values)
    return SonarParams(**given)
