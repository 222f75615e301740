# SPDX-License-Identifier: MIT
"""Table IV and Fig. 9 of the paper: the rotations that cover for each set of dead sonars, as the fault manager says."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from hil_sim.experiment.cases import dead_sets
from hil_sim.experiment.stage import Seen, Stage
from hil_sim.sil import Mission

TABLE_IV: Final[Mapping[str, tuple[int, ...]]] = {
    "3": (-20,),
    "2+3": (20, -20),
    "2+4+5+6": (-20, -40, -60),
    "1+2+3": (60,),
}
"""As the paper prints it. Its first three rows are the walk of its Algorithm 3, the last is the fewest rotations."""
FEWEST_ROW: Final = "1+2+3"
POLICIES: Final = ("paper", "fewest", "least-turn", "adaptive")
WORLD: Final = "demo"
_COURSE: Final = ((1700.0, 0.0),)
_LIMIT_S: Final = 20.0


@dataclass(frozen=True)
class Plan:
    """The rotations of one plan, in degrees, in the order of visit; `back`: to the heading after each."""

    policy: str
    dead: str
    rotations: tuple[int, ...]

    @property
    def turned_deg(self) -> int:
        """All that a sweep turns: the walk returns after each rotation, the others make one pass and one return."""
        if self.policy == "paper":
            return sum(2 * abs(r) for r in self.rotations)
        span = max(0, *self.rotations) - min(0, *self.rotations) if self.rotations else 0
        return min(2 * span, 360)


def plan_of(stage: Stage, policy: str, dead: str, seed: int = 1) -> Plan:
    """Let the fault manager plan for sonars that are dead from the beginning."""
    # Under `argus` a 5000 is no proof, so there the sonars yield nothing at all.
    adaptive = policy == "adaptive"
    config = {"profile": "argus" if adaptive else "paper", "policy": policy}
    kind = "silent" if adaptive else "off"
    mission = Mission(
        WORLD,
        _COURSE,
        faults=(f"{kind}:{dead}",),
        seed=seed,
        config=config,
        sonar={"crosstalk": 0.0},
        limit_s=_LIMIT_S,
    )
    wanted = {int(number) for number in dead.split("+")}
    seen = stage(mission, _has_lost(wanted))
    return Plan(policy, dead, _last_plan(seen))


def _has_lost(wanted: set[int]) -> Callable[[Seen], bool]:
    def has_lost(seen: Seen) -> bool:
        return wanted <= {event.sonar for event in seen.events if event.name == "SONAR_DISABLED"}

    return has_lost


def _last_plan(seen: Seen) -> tuple[int, ...]:
    rotations: list[int] = []
    for event in seen.events:
        if event.name == "PLAN":
            rotations = []
        elif event.name == "PLAN_ROTATION":
            rotations.append(event.value)
    return tuple(rotations)


def table4(stage: Stage, seed: int = 1) -> str:
    """Return Table IV in Markdown: the paper's rotations beside ours."""
    policies = ("paper", "fewest", "adaptive")
    lines = [
        f"| dead | the paper | {' | '.join(f'`{name}`' for name in policies)} |",
        "|---|---|---|---|---|",
    ]
    for dead, rotations in TABLE_IV.items():
        own = {name: plan_of(stage, name, dead, seed).rotations for name in policies}
        same = "fewest" if dead == FEWEST_ROW else "paper"
        cells = [
            _cell(own[name]) + (" =" if name == same and set(own[name]) == set(rotations) else "")
            for name in policies
        ]
        lines.append(f"| {dead.replace('+', ', ')} | {_cell(rotations)} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def _cell(rotations: Sequence[int]) -> str:
    return ", ".join(f"{r:+d}" for r in rotations) or "none"


def all_plans(stage: Stage, policies: Sequence[str] = POLICIES, seed: int = 1) -> dict[str, list[Plan]]:
    """Return the plans for the 62 sets that are neither empty nor whole, by policy."""
    sets = dead_sets()[:-1]
    return {name: [plan_of(stage, name, dead, seed) for dead in sets] for name in policies}


def sums(plans: Mapping[str, Sequence[Plan]]) -> str:
    """Return the sums over all sets in Markdown."""
    lines = [
        "| policy | rotations | degrees turned | most rotations | most degrees |",
        "|---|---|---|---|---|",
    ]
    for policy, own in plans.items():
        counts, degrees = [len(plan.rotations) for plan in own], [plan.turned_deg for plan in own]
        lines.append(f"| `{policy}` | {sum(counts)} | {sum(degrees)} | {max(counts)} | {max(degrees)} |")
    return "\n".join(lines) + "\n"
