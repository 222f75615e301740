# SPDX-License-Identifier: MIT
"""Rule: the slots of dead sonars go to living ones that look ahead; those that watch the swing circle stay heard."""

from __future__ import annotations

import pytest

from hil_sim.experiment import firing
from hil_sim.experiment.stage import Stage


@pytest.mark.parametrize("profile", firing.PROFILES)
@pytest.mark.parametrize("dead", ["3", "2+4+5+6"])
def test_living_sonars_are_heard_sooner(profile: str, dead: str) -> None:
    row = firing.run_one(Stage(), profile, dead)
    lost = len(dead.split("+"))
    before, after = row.mean_ms(row.ahead)
    assert before == pytest.approx(320, abs=5)
    # Two rounds hold each living one twice, 0 and 7 once, and under argus each dead one once.
    slots = 2 * (6 - lost) + 2 + (lost if profile == "argus" else 0)
    assert after == pytest.approx(slots * 40 / 2, rel=0.03), row
    assert row.mean_ms((0, 7))[1] == pytest.approx(slots * 40, rel=0.05), row
    assert row.mean_ms(range(8, 16))[1] == pytest.approx(320, abs=5), row
