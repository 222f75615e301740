# SPDX-License-Identifier: MIT
"""The fault manager itself, the C core, for Python: what argusd runs, called through libargus.so."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

from hil_sim.arguments import meant
from hil_sim.core.build import build
from hil_sim.core.functions import FUNCTIONS
from hil_sim.errors import InputError

LIBRARY_VARIABLE: Final = "ARGUS_CORE"
_ROOT: Final = Path(__file__).resolve().parents[2]
_PLACES: Final = (
    Path(__file__).with_name("libargus.so"),  # in a package
    *(_ROOT / "build" / preset / "libargus.so" for preset in ("release", "debug")),
    Path("/usr/local/lib/libargus.so"),
    Path("/usr/lib/libargus.so"),
)
AUTO: Final = "auto"
_BRIEF_HEAD: Final = 2
"""Bytes of brief() before those of the sonars."""
_LISTED_LEAST: Final = 16
_PACKET_MAX: Final = 256
EVENT_FIELDS: Final = 8
"""Room for the fields of an event in C."""
_RECORD_MAX: Final = 65536
_NO_SONAR: Final = -1
_LEVELS: Final = ("OK", "WARN", "ERROR", "STALE")
_FIRST_REAR: Final = 8


class _Names(IntEnum):
    """argus_name_of_t."""

    EVENT = 0
    SUBJECT = 1
    LEVEL = 2
    MODE = 3
    MISSION = 4
    WAIT = 5
    FAILURE = 6
    HEALTH = 7
    KIND = 8
    OP = 9
    BAR = 10


def _load() -> ctypes.CDLL:
    given = os.environ.get(LIBRARY_VARIABLE)
    places = (Path(given),) if given else _PLACES
    path = next((place for place in places if place.exists()), None)
    if path is None and given:
        raise InputError(f"{LIBRARY_VARIABLE}={given} does not exist: unset it, or set it to a libargus.so")
    if path is None:
        path = build()
    return load_library(path)


def sonars_of(library: ctypes.CDLL) -> int:
    """Return how many sonars a libargus.so manages."""
    return int(library.argus_shim_brief_size() - _BRIEF_HEAD) // 2


def init_of(library: ctypes.CDLL) -> Any:
    """Return argus_init of a libargus.so, whose symbol has the number of its sonars in its name."""
    init = getattr(library, f"argus_init_for_{sonars_of(library)}_sonars")
    init.restype, init.argtypes = ctypes.c_void_p, (ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint32)
    return init


def load_library(path: Path) -> ctypes.CDLL:
    """Return the libargus.so of a path; InputError when it is none of this version."""
    try:
        library = ctypes.CDLL(str(path))
        for name, (result, arguments) in FUNCTIONS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
        init_of(library)
    except (OSError, AttributeError) as error:
        raise InputError(f"{path}: is not this version's libargus.so ({error}); build it again") from error
    return library


@cache
def library() -> ctypes.CDLL:
    """Return libargus.so: of ARGUS_CORE, else of our package, of the build folder, as installed, or compiled now."""
    return _load()


def _names(function: Any) -> tuple[str, ...]:
    found: list[str] = []
    while name := function(len(found)):
        found.append(name.decode())
    return tuple(found)


@cache
def settings() -> dict[str, tuple[int, int, tuple[str, ...]]]:
    """Return the settings: row, default and the names of its choices (none: a number) by key.

    `auto` alone names the default of a number that follows the robot.

    >>> settings()["active"][1:]
    (1, ('off', 'on'))
    """
    core = library()
    config = ctypes.create_string_buffer(core.argus_shim_config_size())
    core.argus_config_default(config)
    return {
        key: (
            row,
            core.argus_shim_config_get(config, row),
            tuple(filter(None, core.argus_shim_config_choices(row).decode().split("|"))),
        )
        for row, key in enumerate(_names(core.argus_shim_config_key))
    }


def setting_value(key: str, text: str) -> int:
    """Return the number that stands for `text` in a setting; InputError says what is allowed."""
    if key not in settings():
        raise InputError(f"{key}: no such setting{meant(key, settings())}; argusd --list-config lists them")
    choices = settings()[key][2]
    if text in choices:
        return choices.index(text)
    if choices not in ((), (AUTO,)):
        raise InputError(f"{key} = {text}: give {' or '.join(choices)}")
    try:
        return int(text)
    except ValueError as error:
        raise InputError(f"{key} = {text}: give a whole number{' or auto' if choices else ''}") from error


class CoreEvent(NamedTuple):
    """One thing that the manager said."""

    t_ms: int
    id: int
    sonar: int | None
    state: str
    value: int

    @property
    def event(self) -> str:
        """Its name in the catalogue."""
        return _name(_Names.EVENT, self.id)

    @property
    def level(self) -> int:
        """0 OK, 1 WARN, 2 ERROR, 3 STALE."""
        return int(library().argus_shim_event_level(self.id))

    @property
    def level_name(self) -> str:
        """The level in words."""
        return _LEVELS[self.level]

    @property
    def name(self) -> str:
        """What it is about, as sonar/front/03."""
        if self.sonar is None:
            return _name(_Names.SUBJECT, self.id)
        return f"sonar/{'rear' if self.sonar >= _FIRST_REAR else 'front'}/{self.sonar:02d}"

    @property
    def meaning(self) -> str:
        """What it means, in words."""
        return _text(library().argus_shim_event_meaning(self.id))

    @property
    def has_value(self) -> bool:
        """Whether the catalogue gives the value a meaning."""
        return "value:" in self.meaning


def kind_name(kind: int) -> str:
    """Return the name of a fault kind.

    >>> kind_name(1)
    'off'
    """
    return _name(_Names.KIND, kind)


def health_name(health: int) -> str:
    """Return the name of a health state.

    >>> health_name(1)
    'HEALTHY'
    """
    return _name(_Names.HEALTH, health)


def mode_name(mode: int) -> str:
    """Return the name of a mode of the manager."""
    return _name(_Names.MODE, mode)


def mission_name(mission: int) -> str:
    """Return the name of a state of the mission.

    >>> mission_name(2)
    'reached'
    """
    return _name(_Names.MISSION, mission)


def _name(of: _Names, number: int) -> str:
    return _text(library().argus_name(of, number))


def _storage(size: int) -> ctypes.Array[ctypes.c_uint64]:
    return (ctypes.c_uint64 * -(-size // ctypes.sizeof(ctypes.c_uint64)))()


def _text(value: bytes) -> str:
    return value.decode("utf-8", "replace")


@dataclass(frozen=True)
class Ring:
    """A ring and the body that carries it: figures by SECTION.KEY, then x, y, heading and role of each sonar."""

    name: str
    figures: Mapping[str, int]
    mounts: tuple[tuple[int, int, int, int], ...]
    forward: tuple[int, ...]


class RingFault(NamedTuple):
    """Why a ring is refused: the meaning, and what it is about."""

    meaning: str
    key: str | None
    """SECTION.KEY of a figure."""
    sonar: int | None


def ring_fault(ring: Ring) -> RingFault | None:
    """Return what is wrong with a ring, with the settings at their defaults; None: nothing."""
    return _hand_over(None, _storage(library().argus_shim_robot_size()), ring)


@cache
def _ring_keys() -> tuple[str, ...]:
    core = library()
    keys = _names(core.argus_shim_ring_key)
    sections = _names(core.argus_shim_ring_section)
    return tuple(f"{section}.{key}" for section, key in zip(sections, keys, strict=True))


def _hand_over(core: Any, storage: Any, ring: Ring) -> RingFault | None:
    keys = _ring_keys()
    flat = [value for mount in ring.mounts for value in mount]
    report = (ctypes.c_int32 * 3)()
    library().argus_shim_set_ring(
        core,
        storage,
        ring.name.encode("utf-8"),
        (ctypes.c_int32 * len(keys))(*(ring.figures.get(key, 0) for key in keys)),
        (ctypes.c_int32 * len(flat))(*flat),
        len(ring.mounts),
        (ctypes.c_int32 * len(ring.forward))(*ring.forward),
        len(ring.forward),
        report,
    )
    fault, key, sonar = report
    if not fault:
        return None
    meaning = _text(library().argus_shim_ring_fault(fault))
    return RingFault(meaning, keys[key] if key >= 0 else None, sonar if sonar >= 0 else None)


class Fed(NamedTuple):
    """What came of many packets: how many were taken, the time, and events with their packet and time."""

    taken: int
    now_ms: int
    said: list[tuple[int, int, CoreEvent]]


class Core:
    """One fault manager in memory of its own. Times are ms of any clock; their low 32 bits count."""

    def __init__(self, now_ms: int, given: Mapping[str, int] | None = None, ring: Ring | None = None) -> None:
        """Begin with the settings given; ring: which body the robot has. InputError says what does not hold."""
        self._library = library()
        self._core = _storage(self._library.argus_shim_core_size())
        self._packet = ctypes.create_string_buffer(_PACKET_MAX)
        self._event_names = _names(self._library.argus_shim_event_field)
        self._event = (ctypes.c_int32 * len(self._event_names))()
        config = ctypes.create_string_buffer(self._library.argus_shim_config_size())
        self._library.argus_config_default(config)
        for key, value in (given or {}).items():
            self._library.argus_shim_config_set(config, settings()[key][0], value)
        self._check(config, own_body=ring is not None)
        init_of(self._library)(self._core, config, now_ms & 0xFFFFFFFF)
        self._brief = ctypes.create_string_buffer(self._library.argus_shim_brief_size())
        if ring is not None:
            self._set_ring(ring)

    def _check(self, config: Any, *, own_body: bool) -> None:
        row = ctypes.c_int32()
        if self._library.argus_shim_config_check(config, ctypes.byref(row)):
            keys = [key for key, (at, _, _) in settings().items() if at == row.value]
            if not keys and own_body:  # S5 is asked of that body
                return
            what = f"{keys[0]} is out of its range" if keys else "driving would be unsafe (S5)"
            raise InputError(f"the settings do not hold: {what}; see argusd --list-config")

    def _set_ring(self, ring: Ring) -> None:
        self._robot = _storage(self._library.argus_shim_robot_size())
        if fault := _hand_over(self._core, self._robot, ring):
            raise InputError(f"the ring {ring.name} is refused with these settings: {fault.meaning}")

    def link_up(self, now_ms: int) -> None:
        """The transport is open."""
        self._library.argus_link_up(self._core, now_ms & 0xFFFFFFFF)

    def link_lost(self, now_ms: int) -> None:
        """The transport is gone."""
        self._library.argus_link_lost(self._core, now_ms & 0xFFFFFFFF)

    def receive(self, now_ms: int, data: bytes) -> None:
        """Take bytes from the robot."""
        self._library.argus_receive(self._core, now_ms & 0xFFFFFFFF, data, len(data))

    def observe(
        self, now_ms: int, motion: tuple[int, int, int, int, int], ranges: Sequence[tuple[int, int, int]]
    ) -> None:
        """Take x, y, heading, speed and turn, and sonar, range and age of each new reading: mm, cdeg, ms."""
        flat = [value for reading in ranges for value in reading]
        self._library.argus_shim_observe(
            self._core,
            now_ms & 0xFFFFFFFF,
            (ctypes.c_int32 * len(motion))(*motion),
            (ctypes.c_uint16 * len(flat))(*flat),
            len(ranges),
        )

    def process(self, now_ms: int) -> int:
        """Do what time makes due; return the ms after which it wants to be called again."""
        return int(self._library.argus_process(self._core, now_ms & 0xFFFFFFFF))

    def transmit(self) -> list[bytes]:
        """Return the packets to be written now."""
        packets = []
        while size := self._library.argus_transmit(self._core, self._packet, _PACKET_MAX):
            packets.append(self._packet.raw[:size])
        return packets

    def events(self) -> Iterator[CoreEvent]:
        """Yield what was said since the last call."""
        while self._library.argus_shim_event(self._core, self._event):
            yield self._event_of(tuple(self._event))

    def _event_of(self, values: Sequence[int]) -> CoreEvent:
        fields = dict(zip(self._event_names, values, strict=True))
        return CoreEvent(
            fields["t_ms"] & 0xFFFFFFFF,
            fields["id"],
            None if fields["sonar"] == _NO_SONAR else fields["sonar"],
            _name(_Names.FAILURE, fields["state"]),
            fields["value"],
        )

    def feed(self, now_ms: int, t_ms: bytes, lengths: bytes, data: bytes) -> Fed:
        """Take the data parts of many packets, each at its time, with what time makes due between them.

        t_ms: 32 bits each, lengths: 16 bits each, in the byte order of this machine. What is to be sent is dropped.
        """
        now = ctypes.c_uint32(now_ms)
        count = ctypes.c_size_t()
        rows = (ctypes.c_uint32 * self._library.argus_shim_said_size())()
        taken = self._library.argus_shim_feed(
            self._core,
            ctypes.byref(now),
            t_ms,
            lengths,
            len(lengths) // 2,
            data,
            rows,
            ctypes.byref(count),
        )
        width = 2 + len(self._event_names)
        flat = rows[: width * count.value]
        said = []
        for at in range(0, len(flat), width):
            values = [value - (value >> 31 << 32) for value in flat[at + 2 : at + width]]
            said.append((flat[at], flat[at + 1], self._event_of(values)))
        return Fed(taken, now.value, said)

    def for_c(self) -> dict[str, int | None]:
        """Where the core and the functions of a loop around it are, for C."""
        functions = {
            "receive": "argus_receive",
            "process": "argus_process",
            "transmit": "argus_transmit",
            "event": "argus_shim_event",
            "brief_of": "argus_shim_brief",
        }
        found = {
            name: ctypes.cast(getattr(self._library, function), ctypes.c_void_p).value
            for name, function in functions.items()
        }
        return found | {"core": ctypes.addressof(self._core), "brief_size": len(self._brief)}

    def said(self, values: Sequence[int]) -> Iterator[CoreEvent]:
        """Yield events as a loop in C has taken them, `EVENT_FIELDS` values each."""
        for at in range(0, len(values), EVENT_FIELDS):
            yield self._event_of(values[at : at + len(self._event_names)])

    @property
    def is_open(self) -> bool:
        """Whether there is a session with a robot."""
        return bool(self._library.argus_shim_is_open(self._core))

    def set_course(self, points: Sequence[tuple[int, int]]) -> None:
        """Give the points to drive to, mm in the frame of the odometry at connection; InputError if they do not fit."""
        flat = [value for point in points for value in point]
        values = (ctypes.c_int32 * len(flat))(*flat)
        if not self._library.argus_set_course(self._core, values, len(points)):
            raise InputError(f"a course of {len(points)} points does not fit the fault manager; shorten it")

    def save_record(self) -> bytes:
        """Return the persistent record: health and history of every sonar."""
        record = ctypes.create_string_buffer(_RECORD_MAX)
        length = self._library.argus_record_save(self._core, record, _RECORD_MAX)
        return record.raw[:length]

    def load_record(self, record: bytes) -> bool:
        """Take a record of an earlier mission as history; False, and an event, when it is damaged or foreign."""
        return bool(self._library.argus_record_load(self._core, record, len(record)))

    def brief(self) -> bytes:
        """Return mode, mission, then health and kind of each sonar, one byte each: cheap enough for every call."""
        self._library.argus_shim_brief(self._core, self._brief)
        return self._brief.raw

    def status(self) -> dict[str, Any]:
        """Return what is known, names for the enumerations, and lists with one entry per sonar, 16 at least."""
        names = _names(self._library.argus_shim_status_field)
        per_sonar = _names(self._library.argus_shim_sonar_field)
        fields = (ctypes.c_int64 * len(names))()
        sonars = (ctypes.c_int64 * (len(per_sonar) * sonars_of(self._library)))()
        self._library.argus_shim_status(self._core, fields, sonars)
        found: dict[str, Any] = dict(zip(names, fields, strict=True))
        listed = max(found["sonars"], _LISTED_LEAST)
        found |= {name: sonars[at :: len(per_sonar)][:listed] for at, name in enumerate(per_sonar)}
        found["mode"] = _name(_Names.MODE, found["mode"])
        found["failure"] = _name(_Names.FAILURE, found["failure"])
        found["health"] = [_name(_Names.HEALTH, value) for value in found["health"]]
        found["kind"] = [kind_name(value) for value in found["kind"]]
        return found
