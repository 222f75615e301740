# SPDX-License-Identifier: MIT
"""Worlds of the HIL tests: rough, and so wide that no edge sonar is shorter than its neighbour without a reason."""

from __future__ import annotations

from typing import Any, Final

START: Final = [0, 0, 0]


def hall(length_mm: float = 3000.0, half_width_mm: float = 2600.0, behind_mm: float = 1000.0, **more: Any) -> dict[str, Any]:
    """A rough room: the start faces its far wall; every reading stays below 4 m, so that 5000 means a fault."""
    corners = [
        [-behind_mm, -half_width_mm],
        [length_mm, -half_width_mm],
        [length_mm, half_width_mm],
        [-behind_mm, half_width_mm],
    ]
    return {"start": START, "roughness": 1.0, "walls": [{"points": corners, "closed": True}], **more}
