# SPDX-License-Identifier: MIT
"""A ring as TOML, whole: what a program reads that does not know the other robots."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from hil_sim.tables.robot import RobotTable

_SECTIONS: Final = ("body", "motion", "odometry", "sonar")


def toml_of(robot: RobotTable) -> str:
    """Return the file of a robot with a ring of its own."""
    assert robot.ring is not None
    sections: dict[str, dict[str, Any]] = {name: {} for name in _SECTIONS}
    for key, value in robot.ring.figures.items():
        section, _, name = key.partition(".")
        sections[section][name] = value
    sections["sonar"]["forward"] = list(robot.forward)
    lines = ["[identity]", f'subclass = "{robot.subclass}"']
    for section, values in sections.items():
        lines += ["", f"[{section}]", *(f"{key} = {value}" for key, value in values.items())]
    for index, order in enumerate(robot.orders):
        lines += ["", "[[sonar.array]]", f"index = {index}", f'place = "{robot.places[index]}"']
        lines.append(f"order = {list(order)}")
    for number, mount in enumerate(robot.mounts):
        figures: Mapping[str, float] = {
            "x_mm": mount.x_mm,
            "y_mm": mount.y_mm,
            "heading_deg": mount.heading_deg,
        }
        lines += ["", "[[sonar.pose]]", f"number = {number}", *(f"{k} = {v:.0f}" for k, v in figures.items())]
        lines += [f"array = {mount.array}", f'role = "{mount.role}"']
    return "\n".join(lines) + "\n"
