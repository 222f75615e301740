# SPDX-License-Identifier: MIT
"""Rule: a SIP that the link delivers again, behind newer ones, moves nothing: the robot arrives, and says so."""

from __future__ import annotations

import random
from typing import Final

import pytest

from hil_sim.sil import Mission
from hil_sim.sil.run import Sil

SIP: Final = (0x32, 0x33)
KEPT: Final = 25
FALSE_MM: Final = 150.0


class Copied(Sil):
    """A link that now and then delivers one of the last 25 SIPs once more."""

    def __init__(self, mission: Mission, often: float) -> None:
        self.sips: list[bytes] = []
        self.rng = random.Random(f"copied {mission.seed}")
        self.often = often
        self.copies = 0
        super().__init__(mission)

    def _to_manager(self, data: bytes) -> None:
        super()._to_manager(data)
        if data[3] not in SIP:
            return
        self.sips = [*self.sips[-KEPT:], data]
        if len(self.sips) > KEPT and self.rng.random() < self.often:
            self.copies += 1
            super()._to_manager(self.rng.choice(self.sips[:-3]))


@pytest.mark.parametrize("often", [0.02, 0.2])
@pytest.mark.parametrize("seed", range(40701, 40704))
def test_copies_move_nothing(seed: int, often: float) -> None:
    link = Copied(Mission("demo", ((900, 0), (1500, 300)), seed=seed, limit_s=90), often)
    outcome = link.run()
    names = {event.name for event in outcome.events}
    assert link.copies > 0
    assert "GOAL_REACHED" in names, f"seed {seed}: {names}"
    assert not names & {"ODOMETRY_LOST", "POSE_LEAP", "HEADING_LEAP", "SLIP"}, f"seed {seed}"
    assert outcome.goal_mm <= FALSE_MM, f"seed {seed}: {outcome.goal_mm:.0f} mm off"
    assert not outcome.collisions, f"seed {seed}"
    assert often < 0.1 or "SIP_COPIED" in names, f"seed {seed}"
