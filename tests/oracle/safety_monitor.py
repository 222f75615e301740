# SPDX-License-Identifier: MIT
"""The monitor of the safety rules for Python: tests/oracle/safety.c, compiled once and called through ctypes."""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Final, NamedTuple

_HERE: Final = Path(__file__).resolve().parent
_FLAGS: Final = ("-std=c11", "-O2", "-fPIC", "-shared", "-Wall", "-Wextra", "-Werror")
_REASON: Final = 112
_SETTINGS: Final = (
    "object_range_mm", "step_mm", "step_speed_mm_s", "speed_mm_s", "speed_max_mm_s", "creep_mm_s", "stale_ms",
    "link_stall_ms", "sonar_cycle_ms", "baud", "sonars", "body", "guard", "paper", "within_ms", "contact",
)  # fmt: skip
OUT: Final = frozenset({"DISABLED", "PROBATION", "STALE", "ABSENT"})
"""Health of a sonar that is not used."""


class _Settings(ctypes.Structure):
    _fields_ = [(name, ctypes.c_int32) for name in _SETTINGS]


class _Violation(ctypes.Structure):
    _fields_ = [("rule", ctypes.c_int32), ("t_ms", ctypes.c_uint32), ("reason", ctypes.c_char * _REASON)]


class Violation(NamedTuple):
    """A rule that was broken: its number in safety.h, when, and what was seen."""

    rule: int
    t_ms: int
    meaning: str
    reason: str

    def __str__(self) -> str:
        return f"{self.t_ms / 1000:.3f} s {self.meaning} ({self.reason})"


def build(folder: Path | None = None) -> Path:
    """Return the library, compiled from the sources as they are if that was not done before."""
    sources = sorted(_HERE.glob("*.c"))
    digest = hashlib.sha256(" ".join(_FLAGS).encode())
    for file in (*sources, *sorted(_HERE.glob("*.h"))):
        digest.update(file.read_bytes())
    place = folder or _HERE.parents[1] / "build" / "core"
    library = place / f"libsafety-{digest.hexdigest()[:16]}.so"
    if not library.exists():
        words = os.environ.get("CC", "").split() or [next(filter(shutil.which, ("cc", "gcc", "clang")), "cc")]
        place.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=place) as made:
            file = Path(made) / library.name
            parts = [str(source) for source in sources if not source.name.startswith("fuzz_")]
            subprocess.run([*words, *_FLAGS, "-o", str(file), *parts, "-lm"], check=True)
            file.replace(library)
    return library


@cache
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(str(build()))
    pointer, number, size = ctypes.c_void_p, ctypes.c_uint32, ctypes.c_size_t
    library.safety_defaults.restype = _Settings
    library.safety_size.restype = library.safety_settings_size.restype = size
    library.safety_init.argtypes = (pointer, ctypes.POINTER(_Settings))
    library.safety_feed.argtypes = (pointer, number, ctypes.c_int, ctypes.c_char_p, size)
    library.safety_truth.argtypes = (pointer, number, *[ctypes.c_double] * 3, ctypes.c_bool)
    library.safety_health.argtypes = (pointer, number, number)
    library.safety_event.argtypes = (pointer, number, ctypes.c_int32, ctypes.c_int32)
    library.safety_hold.argtypes = (pointer, number, ctypes.c_bool)
    library.safety_tick.argtypes = (pointer, number)
    library.safety_meaning.argtypes, library.safety_meaning.restype = (ctypes.c_int32,), ctypes.c_char_p
    library.safety_body_row.argtypes = (ctypes.c_char_p,)
    library.safety_count.argtypes = (pointer,)
    library.safety_kept.argtypes = (pointer, number)
    library.safety_kept.restype = ctypes.POINTER(_Violation)
    if library.safety_settings_size() != ctypes.sizeof(_Settings):
        raise RuntimeError("safety.h has other settings than safety_monitor.py")
    return library


def body_row(subclass: str) -> int:
    """Return the number of a body that is known, for the setting `body`; -1: none of that name."""
    return int(_library().safety_body_row(subclass.encode()))


class Monitor:
    """One monitor. Times are ms of one clock; settings are those of safety.h, the others keep their defaults."""

    def __init__(self, **settings: int) -> None:
        self._library = _library()
        self._self = ctypes.create_string_buffer(self._library.safety_size())
        values = self._library.safety_defaults()
        for name, value in settings.items():
            if name not in _SETTINGS:
                raise ValueError(f"{name}: no setting of the monitor")
            setattr(values, name, value)
        self._library.safety_init(self._self, ctypes.byref(values))

    def _bytes(self, way: int, t_ms: float, data: bytes) -> None:
        self._library.safety_feed(self._self, int(t_ms) & 0xFFFFFFFF, way, data, len(data))

    def from_robot(self, t_ms: float, data: bytes) -> None:
        """Bytes that the manager gets."""
        self._bytes(0, t_ms, data)

    def to_robot(self, t_ms: float, data: bytes) -> None:
        """Bytes that it sends."""
        self._bytes(1, t_ms, data)

    def truth(self, t_ms: float, v_mm_s: float, w_deg_s: float, gap_mm: float, contact: bool) -> None:
        """The robot as it really is."""
        self._library.safety_truth(self._self, int(t_ms) & 0xFFFFFFFF, v_mm_s, w_deg_s, gap_mm, contact)

    def health(self, states: Iterable[tuple[str, str]]) -> None:
        """Health and kind of each sonar, as the manager says."""
        out = doubted = 0
        for number, (state, kind) in enumerate(states):
            out |= (state in OUT) << number
            doubted |= (state == "SUSPECT" and kind not in ("", "none")) << number
        self._library.safety_health(self._self, out, doubted)

    def event(self, t_ms: float, number: int, value: int = 0) -> None:
        """An event that the manager says."""
        self._library.safety_event(self._self, int(t_ms) & 0xFFFFFFFF, number, value)

    def hold(self, t_ms: float, holds: bool) -> None:
        """An operator holds it, or lets it go."""
        self._library.safety_hold(self._self, int(t_ms) & 0xFFFFFFFF, holds)

    def tick(self, t_ms: float) -> None:
        """Time passes."""
        self._library.safety_tick(self._self, int(t_ms) & 0xFFFFFFFF)

    @property
    def count(self) -> int:
        """How many violations there were."""
        return int(self._library.safety_count(self._self))

    @property
    def violations(self) -> list[Violation]:
        """The first of them."""
        found: list[Violation] = []
        while one := self._library.safety_kept(self._self, len(found)):
            it = one.contents
            meaning = self._library.safety_meaning(it.rule).decode()
            found.append(Violation(it.rule, it.t_ms, meaning, it.reason.decode("utf-8", "replace")))
        return found


def settings_of(config: Mapping[str, Any], *, baud: int = 9600) -> dict[str, int]:
    """Return the monitor's settings for a manager with these settings, as in a mission of the SIL."""
    known = {key: int(value) for key, value in config.items() if key in _SETTINGS and value != "auto"}
    known["paper"] = int(config.get("profile") == "paper")
    return {"baud": baud, **known}
