# SPDX-License-Identifier: MIT
"""The echo model in C (kernel.c), for speed; without the library the numpy model in echo.py does the same."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping, Sequence
from typing import Any, Final

from hil_sim.native import library

UNKNOWN_CELL: Final = -1
_NO_MEMORY: Final = -2
PATCH_ARRAYS: Final = (
    "ax", "ay", "ex", "ey", "length", "mirror", "corner_x", "corner_y", "inverse", "retro",
)  # fmt: skip
_NUMBERS: Final = (
    "cone_deg", "cos_half", "edge_db", "margin_db", "air_db_mm", "corner_db", "tip_db", "side_lobe_db",
    "min_mm", "no_echo_mm", "cell_mm", "touch",
)  # fmt: skip
_MODEL_ARRAYS: Final = ("ray_cos", "ray_sin", "ray_db", "mount")


class _Patch(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_void_p) for name in PATCH_ARRAYS),
        ("segments", ctypes.c_int32),
        ("corners", ctypes.c_int32),
    ]


class _Model(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_double) for name in _NUMBERS),
        *((name, ctypes.c_void_p) for name in _MODEL_ARRAYS),
        ("rays", ctypes.c_int32),
        ("sonars", ctypes.c_int32),
    ]


class Patch:
    """The solids heard from one cell, as C wants them; keeps the arrays alive."""

    def __init__(self, arrays: Mapping[str, Any]) -> None:
        """`arrays`: contiguous float64 arrays by the names in `PATCH_ARRAYS`."""
        self._arrays = [arrays[name] for name in PATCH_ARRAYS]
        pointers = [array.ctypes.data for array in self._arrays]
        self._struct = _Patch(*pointers, len(arrays["ax"]), len(arrays["corner_x"]))
        self.address = ctypes.addressof(self._struct)


class Placer:
    """Puts each segment and each corner of a shape where its owner is now."""

    def __init__(self, here: Patch, shape: Patch, owner: Any, corner_owner: Any, places: Any) -> None:
        """`owner`, `corner_owner`: int32 arrays. `places`: float64, x, y, cosine and sine of each owner."""
        found = library()
        assert found is not None
        self._kept = here, shape, owner, corner_owner, places
        self._place = found.argus_sim_place
        arrays = [array.ctypes.data for array in (owner, corner_owner, places)]
        self._addresses = here.address, shape.address, *arrays

    def place(self) -> None:
        """Do it."""
        self._place(*self._addresses)


class Kernel:
    """One echo model in C, which learns the cells of its world as they are needed."""

    def __init__(self, numbers: Mapping[str, float], arrays: Mapping[str, Any]) -> None:
        """`arrays`: contiguous float64 arrays by the names in `_MODEL_ARRAYS`."""
        found = library()
        assert found is not None
        self._library = found
        self.handle: int | None = None
        self._arrays = [arrays[name] for name in _MODEL_ARRAYS]
        self._patches: list[Patch] = []
        pointers = [array.ctypes.data for array in self._arrays]
        values = [numbers[name] for name in _NUMBERS]
        model = _Model(*values, *pointers, len(arrays["ray_cos"]), len(arrays["mount"]))
        self.handle = found.argus_sim_echo_new(ctypes.byref(model))
        if not self.handle:
            raise MemoryError
        self._range, self._ping = found.argus_sim_echo_range, found.argus_sim_echo_ping

    def __del__(self) -> None:
        if self.handle:
            self._library.argus_sim_echo_free(self.handle)

    def add(self, cell: Sequence[int], patch: Patch) -> None:
        """Tell what is heard from a cell."""
        self._patches.append(patch)
        if self._library.argus_sim_echo_add(self.handle, *cell, patch.address):
            raise MemoryError

    def range_mm(
        self, x_mm: float, y_mm: float, heading_deg: float, gain_db: float, others: Patch | None
    ) -> int:
        """Return the range from a transducer at this place, UNKNOWN_CELL when `add` is needed first."""
        address = others.address if others is not None else None
        value = int(self._range(self.handle, x_mm, y_mm, heading_deg, gain_db, address))
        if value == _NO_MEMORY:
            raise MemoryError
        return value

    def ping_mm(
        self,
        number: int,
        x_mm: float,
        y_mm: float,
        heading_deg: float,
        angle_deg: float,
        gain_db: float,
        others: Patch | None,
    ) -> int:
        """Return the range of one of the robot's sonars, its axis turned, its gain off; as `range_mm`."""
        address = others.address if others is not None else None
        return int(self._ping(self.handle, number, x_mm, y_mm, heading_deg, angle_deg, gain_db, address))
