# SPDX-License-Identifier: MIT
"""A ring and the body that carries it, out of a TOML file of the user's: the form that the robots' tables have."""

from __future__ import annotations

import math
import re
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any, Final

from hil_sim.arguments import offer
from hil_sim.core.library import Ring
from hil_sim.errors import SimError
from hil_sim.tables import load, robots
from hil_sim.tables.inherit import KEY, merged, whole

SUFFIX: Final = ".toml"
ROLES: Final = ("none", "ahead", "astern", "abeam")
"""By their numbers in argus/argus.h."""
ARRAY_SONARS: Final = 8
FORWARD_MOST: Final = 6
SONARS_MOST: Final = 32
_LIKE: Final = "p3dx-sh"
_POSE: Final = ("number", "x_mm", "y_mm", "heading_deg", "array", "role")
_POSE_NEEDS: Final = ("x_mm", "y_mm", "heading_deg", "role")
_ARRAY: Final = ("index", "place", "order")
_LAST_ASTERN_DEG: Final = 140
_NAME_MOST: Final = 15
_CORNERS: Final = "corners_mm"
_LASER: Final = "laser"
_LASER_KEYS: Final = {
    "sectors": 0,
    "field_deg": 180,
    "facing_deg": 0,
    "ahead_mm": 0,
    "aside_mm": 0,
    "guards": 0,
}
"""With what stands for one that is left out or 0: as in argus/argus.h."""
_AHEAD_MOST_DEG: Final = 55
_UNITS: Final = ("_mm", "_deg", "_um", "_ms", "_mm_s", "_mm_s2", "_deg_s", "_deg_s2", "_bumpers")
_INT16: Final = range(-32768, 32768)


class Lines:
    """Where in a TOML text each key stands; where it has none, its section, else nowhere."""

    _HEAD: Final = re.compile(r"\s*(\[\[?)\s*([\w.\s\"'-]+?)\s*\]")
    _KEY: Final = re.compile(r"\s*[\"']?([\w-]+)[\"']?\s*=")

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self._at: dict[tuple[str, int, str], int] = {}
        counts: Counter[str] = Counter()
        section, index = "", 0
        for number, line in enumerate(text.splitlines(), 1):
            if head := self._HEAD.match(line):
                section = re.sub(r"[\s\"']", "", head[2])
                index = counts[section] if head[1] == "[[" else 0
                counts[section] += 1
                self._at.setdefault((section, index, ""), number)
            elif key := self._KEY.match(line):
                self._at.setdefault((section, index, key[1]), number)

    def where(self, section: str, key: str = "", index: int = 0) -> str:
        """Return FILE:LINE, or the file alone where the key is inherited."""
        line = self._at.get((section, index, key)) or self._at.get((section, index, ""))
        return f"{self.path}:{line}" if line else str(self.path)


def is_ring(name: str) -> bool:
    """Whether a robot's name is that of a file.

    >>> is_ring("scitos.toml"), is_ring("p3dx-sh")
    (True, False)
    """
    return name.endswith(SUFFIX)


def ring_file(text: str) -> str:
    """Return the name of a file as that of a robot; SimError where it does not end as such files do."""
    if not is_ring(text):
        raise SimError(f"{text}: the file of a ring ends in {SUFFIX}")
    return text


def read_ring(path: Path) -> tuple[dict[str, Any], Lines]:
    """Return a ring's table, whole and of the form of a robot's, and where its keys stand; SimError says what is wrong.

    What only an emulator wants may be left out: it is a P3-DX's then.
    """
    texts: dict[str, str] = {}
    try:
        own = whole(path.stem, lambda name: _parsed(path, name, texts))
    except ValueError as error:
        raise SimError(f"{path}: {error}") from None
    lines = Lines(path, texts[path.stem])
    _check_keys(own, lines)
    return _filled(own, lines), lines


def _parsed(path: Path, name: str, texts: dict[str, str]) -> dict[str, Any]:
    file = path.with_name(name + SUFFIX) if texts else path
    if texts and not file.exists():
        if name in robots():
            return dict(load(f"robots/{name}"))
        raise SimError(f'{path}: {KEY} = "{name}": no file {file}, nor a robot{offer(name, robots())}')
    try:
        text = file.read_text("utf-8")
        texts[name] = text
        return tomllib.loads(text)
    except OSError as error:
        raise SimError(f"{file}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise SimError(f"{file}: not UTF-8, so no TOML") from None
    except tomllib.TOMLDecodeError as error:
        found = re.search(r"\(at line (\d+)[^)]*\)", str(error))
        where = f"{file}:{found[1]}" if found else str(file)
        raise SimError(f"{where}: not valid TOML: {str(error).partition(' (at ')[0]}") from None


# ---- what stands in it


def _known() -> dict[str, set[str]]:
    like = load(f"robots/{_LIKE}")
    known = {section: set(values) for section, values in like.items() if isinstance(values, dict)}
    return known | {_LASER: set(_LASER_KEYS)}


def _check_keys(table: dict[str, Any], lines: Lines) -> None:
    known = _known()
    for section, values in table.items():
        if section not in known:
            raise SimError(
                f"{lines.where(section)}: [{section}]: no such section{offer(section, sorted(known))}"
            )
        if not isinstance(values, dict):
            raise SimError(f"{lines.where('', section)}: {section}: write it as a section, [{section}]")
        for key, value in values.items():
            if key not in known[section]:
                where = lines.where(section, key)
                raise SimError(f"{where}: [{section}] {key}: no such key{offer(key, sorted(known[section]))}")
            if (key.endswith(_UNITS) or section == _LASER) and key != _CORNERS and not _is_whole(value):
                raise SimError(f"{lines.where(section, key)}: [{section}] {key} must be a whole number")


def _is_whole(value: object) -> bool:
    return isinstance(value, int) and not isinstance(value, bool) and value in _INT16


def _poses(sonar: dict[str, Any], lines: Lines, has_laser: bool) -> list[dict[str, Any]]:
    poses = sonar.get("pose", [] if has_laser else None)
    if poses == [] and has_laser:
        return []
    if not isinstance(poses, list) or not poses or not all(isinstance(pose, dict) for pose in poses):
        raise SimError(f"{lines.where('sonar', 'pose')}: no [[sonar.pose]]: give one for each sonar")
    if len(poses) > SONARS_MOST:
        raise SimError(f"{lines.where('sonar.pose', '', SONARS_MOST)}: more than {SONARS_MOST} sonars")
    return [_pose(index, pose, lines) for index, pose in enumerate(poses)]


def _pose(index: int, pose: dict[str, Any], lines: Lines) -> dict[str, Any]:
    def refuse(key: str, why: str) -> SimError:
        return SimError(f"{lines.where('sonar.pose', key, index)}: sonar {index}: {why}")

    for key in pose:
        if key not in _POSE:
            raise refuse(key, f"{key}: no such key{offer(key, _POSE)}")
    for key in _POSE_NEEDS:
        if key not in pose:
            raise refuse("", f"{key} is missing")
        if key != "role" and not _is_whole(pose[key]):
            raise refuse(key, f"{key} must be a whole number")
    if pose["role"] not in ROLES:
        raise refuse("role", f"role must be one of {', '.join(ROLES)}")
    whole_pose = {"number": index, "array": index // ARRAY_SONARS, **pose}
    if whole_pose["number"] != index:
        raise refuse("number", f"number must be {index}: they are given in their order")
    if whole_pose["array"] != index // ARRAY_SONARS:
        raise refuse("array", f"array must be {index // ARRAY_SONARS}: eight in turn are one array")
    return whole_pose


def _check_array(array: Any, k: int, own: list[int], lines: Lines) -> None:
    """Refuse array K that does not fire its OWN sonars, each once."""
    order = array.get("order") if isinstance(array, dict) else None
    if not own or not isinstance(order, list) or sorted(map(str, order)) != sorted(map(str, own)):
        want = f"its order must have {own[0]} to {own[-1]}" if own else "it has no sonars"
        raise SimError(f"{lines.where('sonar.array', 'order', k)}: sonar.array {k}: {want}")
    for key in sorted(set(array) - set(_ARRAY)):
        raise SimError(f"{lines.where('sonar.array', key, k)}: {key}: no such key{offer(key, _ARRAY)}")


def _arrays(sonar: dict[str, Any], sonars: int, sectors: int, lines: Lines) -> list[dict[str, Any]]:
    """Return the arrays of the sonars, then those that sectors make."""
    made = _own_arrays(sonar, sonars, lines) if sonars else []
    more = range(len(made), -(-(sonars + sectors) // ARRAY_SONARS))
    own = [list(range(ARRAY_SONARS * k, min(ARRAY_SONARS * (k + 1), sonars + sectors))) for k in more]
    return made + [{"index": k, "place": "ring", "order": order} for k, order in zip(more, own, strict=True)]


def _own_arrays(sonar: dict[str, Any], sonars: int, lines: Lines) -> list[dict[str, Any]]:
    count = -(-sonars // ARRAY_SONARS)
    own = [list(range(sonars))[k * ARRAY_SONARS : (k + 1) * ARRAY_SONARS] for k in range(count)]
    given = sonar.get("array", [{"index": k, "place": "ring", "order": order} for k, order in enumerate(own)])
    for k, array in enumerate(given):
        _check_array(array, k, own[k] if k < count else [], lines)
    if len(given) != count:
        raise SimError(f"{lines.where('sonar.array')}: {sonars} sonars are {count} arrays of eight")
    return [{"place": "ring", **array} for array in given]


def _forward(sonar: dict[str, Any], sonars: int, lines: Lines) -> list[int]:
    forward = sonar.get("forward")
    where = lines.where("sonar", "forward")
    if not isinstance(forward, list) or not all(_is_whole(k) and 0 <= k < sonars for k in forward):
        raise SimError(f"{where}: [sonar] forward must list sonars, 0 to {sonars - 1}, left to right")
    if not 2 <= len(forward) <= FORWARD_MOST:
        raise SimError(f"{where}: [sonar] forward must list 2 to {FORWARD_MOST} sonars")
    return forward


def _filled(own: dict[str, Any], lines: Lines) -> dict[str, Any]:
    """Return the table with what may be left out."""
    like = load(f"robots/{_LIKE}")
    name = own.get("identity", {}).get("subclass", lines.path.stem)
    if not isinstance(name, str) or not 0 < len(name.encode()) <= _NAME_MOST or not name.isprintable():
        where = lines.where("identity", "subclass")
        raise SimError(f"{where}: [identity] subclass: give a name of 1 to {_NAME_MOST} letters")
    body, sonar = dict(own.get("body", {})), dict(own.get("sonar", {}))
    for key in ("front_mm", "rear_mm", "width_mm"):
        if body.get(key, 0) <= 0:
            raise SimError(f"{lines.where('body', key)}: [body] {key} must be given, above 0")
    laser = _laser(own.get(_LASER, {}))
    poses = _poses(sonar, lines, laser["sectors"] > 0)
    poses = poses + _sectors(laser, len(poses), lines)
    forward = _forward(sonar, len(poses), lines)
    corner = math.hypot(max(body["front_mm"], body["rear_mm"]), body["width_mm"] / 2)
    face = max(1, *(poses[k]["x_mm"] for k in forward))
    body = {"swing_radius_mm": math.ceil(corner), "sonar_face_mm": face, **body}
    body = {"tolerance_centre_mm": body["sonar_face_mm"], "front_bumpers": 0, "rear_bumpers": 0, **body}
    kept = {key: like["sonar"][key] for key in ("cycle_ms", "min_mm", "no_echo_mm", "cone_deg")}
    arrays = _arrays(sonar, len(poses) - laser["sectors"], laser["sectors"], lines)
    sonar = {**kept, **sonar, "pose": poses, "array": arrays, "arrays": len(arrays), "forward": forward}
    return {
        "identity": {
            "class": "Pioneer",
            "name": name,
            "serial": name,
            **own.get("identity", {}),
            "subclass": name,
        },
        "body": body,
        "motion": merged(like["motion"], {"track_mm": body["width_mm"], **own.get("motion", {})}),
        "odometry": merged(like["odometry"], own.get("odometry", {})),
        "sonar": sonar,
        **({_LASER: laser} if laser["sectors"] else {}),
    }


def _laser(own: dict[str, int]) -> dict[str, int]:
    return {key: own.get(key, 0) or default for key, default in _LASER_KEYS.items()}


def _sectors(laser: dict[str, int], sonars: int, lines: Lines) -> list[dict[str, Any]]:
    """Return the sectors of a laser's scan as sensors after the sonars, left to right."""
    sectors, field = laser["sectors"], laser["field_deg"]
    if not 0 <= sectors <= SONARS_MOST - sonars:
        raise SimError(
            f"{lines.where(_LASER, 'sectors')}: sectors and sonars are more than {SONARS_MOST}, or less than none"
        )
    if sectors and (sonars % ARRAY_SONARS or field % sectors):
        raise SimError(
            f"{lines.where(_LASER, 'sectors' if sonars % ARRAY_SONARS else 'field_deg')}: sectors of a laser are whole "
            f"degrees wide, and sonars before them fill arrays of eight"
        )
    return [_sector(laser, sonars, k) for k in range(sectors)]


def _sector(laser: dict[str, int], sonars: int, k: int) -> dict[str, Any]:
    width = laser["field_deg"] // laser["sectors"]
    turned = laser["facing_deg"] + (laser["field_deg"] - width) // 2 - k * width
    heading = 180 - (180 - turned) % 360
    off = abs(heading)
    role = "ahead" if off <= _AHEAD_MOST_DEG else "astern" if off >= 180 - _AHEAD_MOST_DEG else "abeam"
    return {
        "number": sonars + k,
        "x_mm": laser["ahead_mm"],
        "y_mm": laser["aside_mm"],
        "heading_deg": heading,
        "array": (sonars + k) // ARRAY_SONARS,
        "role": role if laser["guards"] or not sonars else "none",
    }


# ---- for the fault manager


def ring_of(table: dict[str, Any]) -> Ring:
    """Return what the fault manager takes of a table."""
    figures = {
        f"{section}.{key}": value
        for section in ("body", "motion", "odometry", "sonar", _LASER)
        for key, value in table.get(section, {}).items()
        if isinstance(value, int)
    }
    sonars = len(table["sonar"]["pose"]) - table.get(_LASER, {}).get("sectors", 0)
    mounts = tuple(
        (p["x_mm"], p["y_mm"], p["heading_deg"], ROLES.index(p["role"]))
        for p in table["sonar"]["pose"][:sonars]
    )
    return Ring(table["identity"]["subclass"], figures, mounts, tuple(table["sonar"]["forward"]))


def place_of(fault_key: str | None, sonar: int | None, lines: Lines) -> str:
    """Return FILE:LINE of what a fault of a ring is about: a figure, a sonar, or those that face forward."""
    if fault_key is not None:
        section, _, key = fault_key.partition(".")
        return lines.where(section, key)
    return lines.where("sonar.pose", "", sonar) if sonar is not None else lines.where("sonar", "forward")
