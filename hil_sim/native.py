# SPDX-License-Identifier: MIT
"""libargus_sim.so: what the emulator does in C, for speed; without the library Python does the same."""

from __future__ import annotations

import ctypes
import os
from functools import cache
from pathlib import Path
from typing import Any, Final

from hil_sim.errors import SimError

LIBRARY_VARIABLE: Final = "ARGUS_SIM_KERNEL"
"""Names the library to load, or is `off`."""
VERSION: Final = 7
_ROOT: Final = Path(__file__).resolve().parents[1]
_PLACES: Final = (
    Path(__file__).parent / "sonar/libargus_sim.so",  # in a package
    *(_ROOT / "build" / preset / "libargus_sim.so" for preset in ("release", "debug")),
    Path("/usr/local/lib/libargus_sim.so"),
    Path("/usr/lib/libargus_sim.so"),
)
_HANDLE: Final = ctypes.c_void_p
_PLACE: Final = (ctypes.c_double, ctypes.c_double, ctypes.c_double)
_FUNCTIONS: Final[dict[str, tuple[Any, tuple[Any, ...]]]] = {
    "argus_sim_echo_new": (_HANDLE, (ctypes.c_void_p,)),
    "argus_sim_echo_free": (None, (_HANDLE,)),
    "argus_sim_echo_add": (
        ctypes.c_int32,
        (_HANDLE, ctypes.c_int32, ctypes.c_int32, ctypes.c_void_p),
    ),
    "argus_sim_place": (None, (ctypes.c_void_p,) * 5),
    "argus_sim_echo_range": (ctypes.c_int32, (_HANDLE, *_PLACE, ctypes.c_double, ctypes.c_void_p)),
    "argus_sim_clearance": (
        ctypes.c_double,
        (ctypes.c_void_p, *_PLACE, ctypes.c_void_p, ctypes.c_int32, ctypes.c_double),
    ),
    "argus_sim_run": (ctypes.c_bool, (ctypes.c_void_p, ctypes.c_double, ctypes.c_double)),
    "argus_sim_loop": (None, (ctypes.c_void_p, ctypes.c_double)),
    "argus_sim_loop_size": (ctypes.c_size_t, ()),
    "argus_sim_sightings_size": (ctypes.c_size_t, ()),
    "argus_sim_echo_ping": (
        ctypes.c_int32,
        (_HANDLE, ctypes.c_int32, *_PLACE, ctypes.c_double, ctypes.c_double, ctypes.c_void_p),
    ),
}


@cache
def library() -> ctypes.CDLL | None:
    """Return libargus_sim.so: as ARGUS_SIM_KERNEL says, else of our package, the build folder, the system; or None."""
    given = os.environ.get(LIBRARY_VARIABLE)
    if given == "off":
        return None
    path = Path(given) if given else next((place for place in _PLACES if place.exists()), None)
    if path is None:
        return None
    try:
        found = ctypes.CDLL(str(path))
        if found.argus_sim_version() != VERSION:
            raise OSError(f"version {found.argus_sim_version()}, not {VERSION}")
        for name, (result, arguments) in _FUNCTIONS.items():
            function = getattr(found, name)
            function.restype, function.argtypes = result, arguments
    except (OSError, AttributeError) as error:
        # One that was built from other sources is as good as none, unless it was asked for.
        if given:
            raise SimError(
                f"{LIBRARY_VARIABLE}={given}: not this version's libargus_sim.so ({error}); build it again"
            ) from error
        return None
    return found
