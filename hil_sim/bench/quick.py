# SPDX-License-Identifier: MIT
"""The quick bench: a fixed set of missions, and the checked-in bounds that a change must not break."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from hil_sim.bench.figures import KINDS, Record
from hil_sim.bench.plan import KINDS as ALL_KINDS
from hil_sim.bench.plan import Case, make_cases
from hil_sim.errors import SimError

BOUNDS: Final = Path(__file__).with_name("bounds.toml")
SPLIT: Final = "tune"
"""The judge split is for what is published; a bench of each change would slowly tune on it."""
WORLDS: Final[Mapping[str, tuple[str, ...]]] = {
    "argus": ("office", "gen-room", "gen-glass", "gen-corridor", "gen-hall", "gen-clutter"),
    "paper": ("lab",),
}
SEEDS: Final = range(1, 2)
_LEAST: Final = ("found", "found_all", "named", "named_end", "rehabilitated")
_MOST: Final = ("false_disables", "false_disables_with_faults", "attributable", "undetected")
_FIELDS: Final = ("missions", *_LEAST, *_MOST)


def cases() -> list[Case]:
    """Return the missions of the quick bench."""
    return [
        case
        for profile, worlds in WORLDS.items()
        for case in make_cases([profile], SPLIT, worlds, SEEDS, ALL_KINDS)
    ]


def load_bounds(path: Path = BOUNDS) -> dict[str, dict[str, Any]]:
    """Return the bounds of each profile; SimError when the file is missing or has what is no bound."""
    try:
        bounds = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise SimError(f"{path}: cannot read the bounds ({error.strerror}); install again") from error
    except tomllib.TOMLDecodeError as error:
        raise SimError(f"{path}: not TOML ({error}); correct it") from None
    for profile, wanted in bounds.items():
        if not isinstance(wanted, dict):
            raise SimError(f"{path}: '{profile}' is no table; write the bounds of a profile under [NAME]")
        for name, value in wanted.items():
            _check_bound(f"{path}: [{profile}]", name, value)
    return bounds


def _check_bound(where: str, name: str, value: Any) -> None:
    if name not in _FIELDS:
        raise SimError(f"{where} {name} is no bound; there are {', '.join(_FIELDS)}")
    rows = value if name == "found" else {"": value}
    if not isinstance(rows, dict) or any(type(one) not in (int, float) for one in rows.values()):
        raise SimError(f"{where} {name} is no number, or no table of one for each kind")
    if name == "found" and set(rows) - set(KINDS):
        raise SimError(f"{where} found: there are {', '.join(KINDS)}")


def broken(summary: Record, bounds: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """Return a line for each bound that the figures break; one with nothing to judge is broken, too."""
    lines = []
    for profile, wanted in bounds.items():
        one = summary["profiles"].get(profile)
        if one is None:
            lines.append(f"{profile}: no mission ran")
            continue
        have = _values(one)
        for name, value in wanted.items():
            if name == "found":
                for kind, bound in value.items():
                    lines += _against(f"{profile}: {name} of {kind}", name, have[name][kind], bound)
            else:
                lines += _against(f"{profile}: {name}", name, have[name], value)
    return lines


def _against(what: str, name: str, got: float | None, bound: float) -> list[str]:
    """A line when a figure breaks its bound."""
    if got is None:
        return [f"{what}: nothing to judge"]
    if name == "missions":
        return [f"{what} is {got}, must be {bound}"] if got != bound else []
    if name in _MOST:
        return [f"{what} is {got:g}, must be at most {bound:g}"] if got > bound else []
    return [f"{what} is {got:g}, must be at least {bound:g}"] if got < bound else []


def _values(one: Record) -> dict[str, Any]:
    """The figures that can have a bound, by its name."""
    return {
        "missions": one["missions"],
        "found": {
            kind: one["kinds"][kind]["rate"] if one["kinds"][kind]["judged"] else None for kind in KINDS
        },
        "found_all": one["all"]["rate"],
        "named": one["all"]["named"]["rate"],
        "named_end": one["all"]["named_end"]["rate"],
        "rehabilitated": one["rehabilitation"]["rate"],
        "false_disables": one["false_disables"]["count"],
        "false_disables_with_faults": one["false_disables_with_faults"]["count"],
        "attributable": one["collisions"]["attributable"],
        "undetected": one["collisions"]["undetected"],
    }
