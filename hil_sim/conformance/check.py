# SPDX-License-Identifier: MIT
"""What a check is, and the list of all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hil_sim.conformance.client import Client, Failed

Run = Callable[[Client], str]


@dataclass(frozen=True)
class Check:
    """One check: its group and name, what it expects, and whether the robot moves or its motors come on."""

    group: str
    name: str
    expects: str
    motion: bool
    run: Run

    @property
    def title(self) -> str:
        """GROUP/NAME, as `--only` takes it."""
        return f"{self.group}/{self.name}"


class Group(list[Check]):
    """The checks of one module, in the order written."""

    def check(self, group: str, motion: bool = False) -> Callable[[Run], Run]:
        """Register a check: its name is the function's, what it expects is its docstring."""

        def register(run: Run) -> Run:
            name, expects = run.__name__.replace("_", "-"), (run.__doc__ or "").rstrip(".")
            self.append(Check(group, name, expects, motion, run))
            return run

        return register


def require(fine: bool, observed: str) -> str:
    """Return what was observed, or fail with it."""
    if not fine:
        raise Failed(observed)
    return observed
