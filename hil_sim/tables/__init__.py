# SPDX-License-Identifier: MIT
"""Loader of the tables of numbers that the firmware and the emulator share."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from hil_sim.errors import SimError
from hil_sim.tables.inherit import whole

TABLE_DIR = Path(__file__).resolve().parent


def _read(name: str) -> dict[str, Any]:
    path = TABLE_DIR / f"{name}.toml"
    try:
        with path.open("rb") as file:
            return tomllib.load(file)
    except OSError as error:
        raise SimError(f"{path}: no such table ({error.strerror}); reinstall hil_sim") from error
    except tomllib.TOMLDecodeError as error:
        raise SimError(f"{path}: {error}; correct the table") from error


@cache
def load(name: str) -> dict[str, Any]:
    """Return table `name` ("arcos", "energy", "robots/p3dx-sh") as nested dictionaries; read once, not to be changed.

    >>> load("arcos")["frame"]["HEADER0"] == 0xFA
    True
    """
    try:
        return whole(name, _read)
    except ValueError as error:
        raise SimError(f"{TABLE_DIR / name}.toml: {error}; correct the table") from error


def section(name: str, part: str) -> dict[str, int]:
    """Return the integers of one section of a table.

    >>> section("arcos", "command")["SONAR_CYCLE"]
    48
    """
    return {key: value for key, value in load(name)[part].items() if isinstance(value, int)}


def robots() -> tuple[str, ...]:
    """Return the subclasses of the robots that have a table, in order.

    >>> "p3dx-sh" in robots()
    True
    """
    return tuple(sorted(path.stem for path in (TABLE_DIR / "robots").glob("*.toml")))
