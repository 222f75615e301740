# SPDX-License-Identifier: MIT
"""Drafts the file of a ring from a URDF, or from the transforms and Range messages of a bag.

What neither tells is guessed, and the draft's comments report each guess: a person measures it.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from argus_tools.chunks import LogError
from argus_tools.rings.geometry import Frames, Pose, frame_name, is_base
from argus_tools.rings.recording import Broken, Recording
from hil_sim.tables.ring import FORWARD_MOST, SONARS_MOST

RANGE: Final = "sensor_msgs/msg/Range"
TF: Final = "tf2_msgs/msg/TFMessage"
NAMES: Final = re.compile(
    r"sonar|ultraso|hc_?sr04|(?:^|_)us_?\d|range_?(?:sensor|finder)?_?\d", re.IGNORECASE
)
"""Links of a URDF that are sonars."""
ABEAM_DEG: Final = 65
ASTERN_DEG: Final = 115
SPACING_MOST_DEG: Final = 59
LEVEL_MOST_DEG: Final = 20.0
_MM: Final = 1000
_MESSAGES_MOST: Final = 20_000
_NUMBER: Final = re.compile(r"\d+")


@dataclass
class Found:
    """What was found of a robot: sonars by their frames, figures by their keys, and what is not known of it."""

    name: str
    sonars: dict[str, Pose] = field(default_factory=dict)
    figures: dict[str, int] = field(default_factory=dict)
    guesses: dict[str, str] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)


def drafted(path: Path) -> str:
    """Return the draft of a ring in TOML, of a URDF or a bag; LogError where it holds no sonars."""
    found = of_urdf(path) if path.suffix in (".urdf", ".xml", ".xacro") else of_bag(path)
    if not found.sonars:
        raise LogError(
            f"{path}: no sonars whose place is known" + "".join(f"; {line}" for line in found.remarks)
        )
    if len(found.sonars) > SONARS_MOST:
        raise LogError(f"{path}: {len(found.sonars)} sonars; {SONARS_MOST} are the most")
    return toml_of(found)


# ---- a URDF


def of_urdf(path: Path) -> Found:
    """Return what a URDF has: joints give the places, the shapes of the base the body."""
    try:
        root = ET.parse(path).getroot()
    except (OSError, ET.ParseError) as error:
        raise LogError(f"{path}: no XML that can be read: {error}") from error
    if root.tag != "robot" or any("xacro" in one.tag for one in root.iter()):
        raise LogError(f"{path}: no plain URDF; of a xacro file: xacro {path.name} > robot.urdf")
    found = Found(_name_of(root.get("name") or path.stem))
    joints = {_link(joint, "child"): (_link(joint, "parent"), _origin(joint)) for joint in root.iter("joint")}
    links = [link.get("name") or "" for link in root.iter("link")]
    base = next((name for name in links if is_base(name)), None)
    if base is None:
        raise LogError(f"{path}: no link base_link or base_footprint")
    for name in links:
        pose = _on(name, base, joints)
        if NAMES.search(name) and pose is not None:
            found.sonars[name] = pose
    axle = _axle(root, base, joints)
    if axle is None:
        found.guesses["track_mm"] = "no driven wheels were found: the width of the body stands for it"
    else:
        found.figures["track_mm"] = axle[1]
        if axle[0]:
            found.remarks.append(f"the axle is {axle[0]} mm ahead of {base}: all is counted from the axle")
            shift = Pose(-axle[0] / _MM)
            found.sonars = {name: shift.then(pose) for name, pose in found.sonars.items()}
    _take_body(found, _corners(root, base, joints), axle[0] if axle else 0)
    return found


def _link(joint: ET.Element, which: str) -> str:
    one = joint.find(which)
    return "" if one is None else one.get("link") or ""


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise LogError(f"a number in the URDF that is none: {error}") from error


def _numbers(text: str | None) -> tuple[float, float, float]:
    words = [_number(word) for word in (text or "0 0 0").split()]
    return (words[0], words[1], words[2]) if len(words) == 3 else (0.0, 0.0, 0.0)


def _origin(of: ET.Element) -> Pose:
    """Return where something is in the plane; a sensor that rolls or pitches is seen from above."""
    origin = of.find("origin")
    if origin is None:
        return Pose()
    (x_m, y_m, _), (_, _, yaw) = _numbers(origin.get("xyz")), _numbers(origin.get("rpy"))
    return Pose(x_m, y_m, yaw)


def _on(name: str, base: str, joints: Mapping[str, tuple[str, Pose]]) -> Pose | None:
    pose = Pose()
    for _ in range(len(joints) + 1):
        if name == base or is_base(name):
            return pose
        if name not in joints:
            return None
        name, step = joints[name]
        pose = step.then(pose)
    return None


def _axle(root: ET.Element, base: str, joints: Mapping[str, tuple[str, Pose]]) -> tuple[int, int] | None:
    """Return x of the driven wheels and how far they stand apart, mm."""
    wheels = []
    for joint in root.iter("joint"):
        child = _link(joint, "child")
        pose = _on(child, base, joints)
        is_driven = joint.get("type") == "continuous" and not re.search("cast|swivel", child, re.IGNORECASE)
        if is_driven and pose is not None and abs(pose.y_m) > 0.01:
            wheels.append(pose)
    if not wheels or min(p.y_m for p in wheels) >= 0 or max(p.y_m for p in wheels) <= 0:
        return None
    x_m = sum(pose.x_m for pose in wheels) / len(wheels)
    return round(x_m * _MM), round((max(p.y_m for p in wheels) - min(p.y_m for p in wheels)) * _MM)


def _corners(
    root: ET.Element, base: str, joints: Mapping[str, tuple[str, Pose]]
) -> list[tuple[float, float]]:
    """Return corners of all boxes, cylinders and spheres that a link collides with."""
    corners = []
    for link in root.iter("link"):
        pose = _on(link.get("name") or "", base, joints)
        for part in link.iter("collision"):
            shape = part.find("geometry")
            if pose is None or shape is None:
                continue
            here = pose.then(_origin(part))
            for half_x, half_y in _halves(shape):
                for way_x, way_y in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                    at = here.then(Pose(way_x * half_x, way_y * half_y))
                    corners.append((at.x_m * _MM, at.y_m * _MM))
    return corners


def _halves(shape: ET.Element) -> Iterable[tuple[float, float]]:
    for box in shape.iter("box"):
        x_m, y_m, _ = _numbers(box.get("size"))
        yield x_m / 2, y_m / 2
    for kind in ("cylinder", "sphere"):
        for one in shape.iter(kind):
            radius_m = _number(one.get("radius") or "0")
            yield radius_m, radius_m


# ---- a bag


def of_bag(path: Path) -> Found:
    """Return what the transforms and Range messages of a bag have."""
    from argus_tools.formats.bag import recording_of

    recording = recording_of(path)
    try:
        return _of_messages(recording, path)
    except Broken as error:
        raise LogError(f"{path}: {error}") from error
    finally:
        recording.close()


def _of_messages(recording: Recording, path: Path) -> Found:
    found = Found(_name_of(path.stem))
    wanted = [topic.name for topic in recording.topics if topic.type in (RANGE, TF)]
    frames, heard = Frames(), 0
    seen: dict[str, Any] = {}
    for message in recording.messages(wanted):
        if message.type == TF:
            for transform in message.body.transforms:
                frames.take(transform)
        else:
            seen.setdefault(frame_name(message.body.header.frame_id), message.body)
            heard += 1
        if heard > _MESSAGES_MOST:
            break
    lost = []
    for frame in sorted(seen, key=_by_number):
        pose = frames.on_robot(frame)
        if pose is None:
            lost.append(frame)
        else:
            found.sonars[frame] = pose
    if not seen:
        found.remarks.append("no messages of sensor_msgs/Range")
    if lost:
        found.remarks.append(f"no transforms from a base to {', '.join(lost)}")
    if found.sonars:
        _take_ranges(found, [seen[frame] for frame in found.sonars])
        _take_body(found, [], 0)
        found.guesses["track_mm"] = "no bag tells it: the width of the body stands for it"
    return found


def _take_ranges(found: Found, ranges: list[Any]) -> None:
    least = min(float(one.min_range) for one in ranges)
    most = max(float(one.max_range) for one in ranges)
    view = max(float(one.field_of_view) for one in ranges)
    for key, value, (low, high) in (
        ("min_mm", least * _MM, (1, 1000)),
        ("no_echo_mm", most * _MM, (500, 5000)),
        ("cone_deg", math.degrees(view), (5, 90)),
    ):
        if math.isfinite(value) and low <= round(value) <= high:
            found.figures[key] = round(value)
        else:
            figure = f"{value:.0f}" if math.isfinite(value) else str(value)
            found.guesses[key] = f"the messages have {figure}, which is out of {low} to {high}"


# ---- the body, and the text


def _take_body(found: Found, corners: list[tuple[float, float]], axle_mm: int) -> None:
    """Take the box round these corners and the sonars as the body."""
    sonars = [(pose.x_m * _MM + axle_mm, pose.y_m * _MM) for pose in found.sonars.values()]
    every = corners + sonars
    if not every:
        return
    front = math.ceil(max(x for x, _ in every) - axle_mm)
    rear = math.ceil(axle_mm - min(x for x, _ in every))
    width = 2 * math.ceil(max(abs(y) for _, y in every))
    found.figures |= {"front_mm": max(front, 1), "rear_mm": max(rear, 1), "width_mm": max(width, 1)}
    if not corners:
        why = "nothing tells the body: it is the box round the sonars. MEASURE IT: S5 and S7 rest on it"
        found.guesses |= dict.fromkeys(("front_mm", "rear_mm", "width_mm"), why)


def _name_of(text: str) -> str:
    return re.sub(r"[^A-Za-z0-9-]+", "-", text).strip("-")[:15] or "mine"


def _by_number(name: str) -> tuple[str, int]:
    numbers = _NUMBER.findall(name)
    return _NUMBER.sub("", name), int(numbers[-1]) if numbers else 0


def _bearing(pose: Pose) -> int:
    turn = round(math.degrees(pose.yaw_rad)) % 360
    return turn - 360 if turn > 180 else turn


def _role(bearing_deg: int) -> str:
    if abs(bearing_deg) <= ABEAM_DEG:
        return "ahead"
    return "astern" if abs(bearing_deg) >= ASTERN_DEG else "abeam"


def _forward(bearings: list[int]) -> list[int]:
    """Return the up to six that look the most straight ahead, left to right, none beside a gap or on one bearing."""
    ahead = sorted((k for k, b in enumerate(bearings) if _role(b) == "ahead"), key=lambda k: abs(bearings[k]))
    chosen: list[int] = []
    for k in ahead:
        if len(chosen) < FORWARD_MOST and all(bearings[k] != bearings[other] for other in chosen):
            chosen.append(k)
    return sorted(chosen, key=lambda k: -bearings[k])


def toml_of(found: Found) -> str:
    """Return the draft as text."""
    names = sorted(found.sonars, key=_by_number)
    bearings = [_bearing(found.sonars[name]) for name in names]
    forward = _forward(bearings)
    lines = [
        "# A draft: check each line that says so, then argus-log ring FILE -o picture.png, and look at it."
    ]
    lines += [f"# {remark}" for remark in found.remarks]
    lines += ["", "[identity]", f'subclass = "{found.name}"']

    def put(key: str, unknown: str) -> None:
        if key in found.figures:
            why = found.guesses.get(key)
            lines.append(f"{key} = {found.figures[key]}" + (f"  # not known: {why}" if why else ""))
        else:
            lines.append(f"# {key}: not known, {found.guesses.get(key, unknown)}")

    lines += ["", "[body]"]
    for key in ("front_mm", "rear_mm", "width_mm"):
        put(key, "")
    lines.append("# swing_radius_mm: not known, that of the rectangle holds; give it where the body is round")
    lines.append("# front_bumpers, rear_bumpers: not known, none")
    lines += ["", "[motion]"]
    put("track_mm", "the width of the body stands for it")
    lines.append("# decel_mm_s2: not known, 300 holds; measure it, S5 rests on it")
    lines += ["", "[sonar]"]
    put("min_mm", "100 holds")
    put("no_echo_mm", "5000 holds: what it gives where nothing is")
    put("cone_deg", "30 holds")
    lines.append("# cycle_ms: not known, 40 holds: between two pings of one array of eight")
    lines.append(f"forward = {forward}  # guessed from the bearings: those that face forward, left to right")
    for number, name in enumerate(names):
        pose, bearing = found.sonars[name], bearings[number]
        lines += ["", f"[[sonar.pose]]  # {number}: {name}", f"x_mm = {round(pose.x_m * _MM)}"]
        lines += [f"y_mm = {round(pose.y_m * _MM)}", f"heading_deg = {bearing}"]
        lines.append(f'role = "{_role(bearing)}"  # guessed from the bearing')
    return "\n".join(lines) + "\n"
