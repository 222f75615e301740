# SPDX-License-Identifier: MIT
"""The sonar ring: firing schedule, beam cone, echoes from smooth and rough surfaces, noise and crosstalk."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Final, NamedTuple, Protocol, SupportsIndex

import numpy as np

from hil_sim import kernel
from hil_sim.moving import MovingSolids
from hil_sim.tables import load
from hil_sim.world import Floats, Pose, World

_TABLE: Final[dict[str, Any]] = load("robots/p3dx-sh")["sonar"]
MIN_MM: Final[int] = _TABLE["min_mm"]
NO_ECHO_MM: Final[int] = _TABLE["no_echo_mm"]
CYCLE_MS: Final[int] = _TABLE["cycle_ms"]
PER_ARRAY: Final[int] = _TABLE["transducers_per_array"]
FITTED_ARRAYS: Final[int] = _TABLE["arrays"]
ARRAYS: Final = 4
"""Arrays that ARCOS knows; a P3-DX has the first two."""
MAX_ORDER: Final = 16
SOUND_MM_MS: Final = 343.0

SONAR_POSES: Final[tuple[Pose, ...]] = tuple(
    Pose(float(p["x_mm"]), float(p["y_mm"]), float(p["heading_deg"])) for p in _TABLE["pose"]
)


def transducer_pose(number: int, robot: Pose) -> Pose:
    """Return where sonar 0 to 15 of a robot is in the world, and where it looks; degrees as they add up."""
    mount = SONAR_POSES[number]
    heading = math.radians(robot.heading_deg)
    c, s = math.cos(heading), math.sin(heading)
    return Pose(
        robot.x_mm + mount.x_mm * c - mount.y_mm * s,
        robot.y_mm + mount.x_mm * s + mount.y_mm * c,
        robot.heading_deg + mount.heading_deg,
    )


_RAY_STEP_DEG: Final = 1.5
_CELL_MM: Final = 500.0
_RESUME_MS: Final = 1000.0
_TOUCH: Final = 1e-9


@dataclass(frozen=True)
class SonarParams:
    """How the sonar behaves; the model and the source of the defaults are in docs/worlds.md.

    noise_mm, noise_part: standard deviation of the range noise: fixed part, and part of the range.
    crosstalk: probability that a ping hears another one and reads too short.
    specular: False makes every surface scatter, whatever its roughness.
    cone_deg: full width of the beam. edge_db: loss at the edge of the cone, there and back.
    margin_db: loss at which an echo is no longer heard. air_db_m: loss for each metre of range that the receiver's gain
    does not make up. mirror_db_deg2: loss of a smooth surface for each squared degree of incidence.
    corner_db, tip_db: loss at an inner corner and at an edge or end, against a square-on wall.
    """

    noise_mm: float = 5.0
    noise_part: float = 0.002
    crosstalk: float = 0.01
    specular: bool = True
    cone_deg: float = float(_TABLE["cone_deg"])
    edge_db: float = 20.0
    margin_db: float = 30.0
    air_db_m: float = 2.0
    mirror_db_deg2: float = 0.24
    corner_db: float = 3.0
    tip_db: float = 18.0


class Reading(NamedTuple):
    """One ping's result. `t_ms`: when its echo, or its time-out, was in.

    true_mm: what the model gives without noise, crosstalk and fault. fault: the fault kind that changed it.
    """

    t_ms: float
    number: int
    range_mm: int
    true_mm: int
    fault: str | None


class PingWatch(Protocol):
    """Is told of every ping that a fault may have changed: what it would have read, and what it reports."""

    def __call__(self, t_ms: float, number: int, true_mm: int, heard_mm: int, value: int | None) -> None:
        """`heard_mm`: with noise and crosstalk, without the fault; `value` None: a silent slot."""


class SonarFaults(Protocol):
    """What the ring asks of the injected faults."""

    def apply(
        self, number: int, now_ms: float, true_measured_mm: int, remeasure: Callable[[float], int]
    ) -> tuple[int | None, str | None]:
        """Return the reading after faults (None: the slot stays silent) and the kind that changed it."""


# ---- echoes -----------------------------------------------------------------------------------------------------


class _Patch:
    """The solids that can be heard from one grid cell, as arrays ready for use."""

    def __init__(self, segments: Floats, roughness: Floats, corners: Floats, params: SonarParams) -> None:
        self.ax, self.ay = segments[:, 0].copy(), segments[:, 1].copy()
        self.ex, self.ey = segments[:, 2] - self.ax, segments[:, 3] - self.ay
        self.length = np.hypot(self.ex, self.ey)
        rough = roughness if params.specular else np.ones_like(roughness)
        self.mirror = params.mirror_db_deg2 * (1 - rough) ** 2
        self.corner_x, self.corner_y = corners[:, 0].copy(), corners[:, 1].copy()
        self.inverse = corners[:, 2:6].copy()
        self.retro = corners[:, 6].copy()
        self._for_c: kernel.Patch | None = None

    @property
    def for_c(self) -> kernel.Patch:
        """The same for the kernel."""
        if self._for_c is None:
            self._for_c = kernel.Patch(vars(self))
        return self._for_c

    def joined(self, other: _Patch) -> _Patch:
        """Return both as one, this one first."""
        both = object.__new__(_Patch)
        for name in kernel.PATCH_ARRAYS:
            setattr(both, name, np.concatenate((getattr(self, name), getattr(other, name))))
        return both


def _corners(segments: Floats) -> Floats:
    """Ends of segments, each once: x, y, the inverse of the matrix of its two arms, 1 when it can send sound back.

    An inner corner of about a right angle returns sound the way it came to whoever looks into it.
    """
    arms: dict[tuple[float, float], list[tuple[float, float]]] = {}
    for x1, y1, x2, y2 in segments.tolist():
        length = math.hypot(x2 - x1, y2 - y1)
        ux, uy = (x2 - x1) / length, (y2 - y1) / length
        arms.setdefault((round(x1, 3), round(y1, 3)), []).append((ux, uy))
        arms.setdefault((round(x2, 3), round(y2, 3)), []).append((-ux, -uy))
    rows = []
    for (x, y), out in arms.items():
        row = [x, y, 0.0, 0.0, 0.0, 0.0, 0.0]
        if len(out) == 2:
            (a, b), (c, d) = out
            det, dot = a * d - b * c, a * c + b * d
            if abs(det) < 0.1 and dot < 0:
                continue  # a wall that goes straight on has no corner there
            if abs(dot) < 0.5:
                row[2:] = [d / det, -c / det, -b / det, a / det, 1.0]
        rows.append(row)
    return np.array(rows, dtype=np.float64).reshape(-1, 7)


class MovingEchoes:
    """The solids in motion of one run, as a patch that follows them."""

    def __init__(self, moving: MovingSolids, params: SonarParams) -> None:
        self._moving = moving
        self._moment = -1
        corners = [_corners(actor.shape) for actor in moving.actors]
        self._owner = moving.owner
        counts = [len(rows) for rows in corners]
        self._corner_owner = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
        self._shape = _Patch(moving.shape, moving.roughness, np.concatenate(corners), params)
        self._patch = _Patch(moving.shape, moving.roughness, np.concatenate(corners), params)
        self._placer: kernel.Placer | None = None
        # A corner that sends sound back would have to turn with its owner; people and doors have none.
        assert not self._shape.retro.any()

    def patch(self, in_c: bool) -> _Patch:
        """Return the solids as they are now: always the same arrays."""
        if self._moment != self._moving.moment:
            self._moment = self._moving.moment
            self._moving.place()
            if not in_c:
                self._place()
            else:
                if self._placer is None:
                    arrays = self._owner, self._corner_owner, self._moving.places
                    self._placer = kernel.Placer(self._patch.for_c, self._shape.for_c, *arrays)
                self._placer.place()
        return self._patch

    def _place(self) -> None:
        here, shape = self._patch, self._shape
        places = self._moving.places
        x, y, c, s = places[self._owner].T
        here.ax[:] = x + shape.ax * c - shape.ay * s
        here.ay[:] = y + shape.ax * s + shape.ay * c
        here.ex[:] = shape.ex * c - shape.ey * s
        here.ey[:] = shape.ex * s + shape.ey * c
        x, y, c, s = places[self._corner_owner].T
        here.corner_x[:] = x + shape.corner_x * c - shape.corner_y * s
        here.corner_y[:] = y + shape.corner_x * s + shape.corner_y * c


class EchoModel:
    """Ranges that a transducer reads in a world: the nearest echo within its cone that is loud enough.

    Computed in C when the library is there, else here with numpy; to the same mm.
    """

    def __init__(self, world: World, params: SonarParams, *, in_c: bool = True) -> None:
        self.params = params
        self._segments = world.segments
        self._roughness = world.roughness
        self._corners = _corners(world.segments)
        self._patches: dict[tuple[int, int], _Patch] = {}
        half = params.cone_deg / 2
        count = 2 * max(1, math.ceil(half / _RAY_STEP_DEG)) + 1
        offsets = np.linspace(-half, half, count)
        self._ray_cos, self._ray_sin = np.cos(np.radians(offsets)), np.sin(np.radians(offsets))
        self._ray_db = params.edge_db * (offsets / half) ** 2
        self._cos_half = math.cos(math.radians(half))
        self._kernel = self._new_kernel() if in_c and kernel.library() is not None else None

    def _new_kernel(self) -> kernel.Kernel:
        numbers = vars(self.params) | {
            "cos_half": self._cos_half,
            "air_db_mm": self.params.air_db_m / 1000,
            "min_mm": MIN_MM,
            "no_echo_mm": NO_ECHO_MM,
            "cell_mm": _CELL_MM,
            "touch": _TOUCH,
        }
        mount = np.array([(p.x_mm, p.y_mm, p.heading_deg) for p in SONAR_POSES])
        # From the axis outwards: what is heard there mostly settles what the rays further out could add.
        order = np.argsort(self._ray_db, kind="stable")
        rays = {f"ray_{name}": getattr(self, f"_ray_{name}")[order] for name in ("cos", "sin", "db")}
        return kernel.Kernel(numbers, rays | {"mount": mount})

    def ping_mm(
        self, number: int, pose: Pose, angle_deg: float = 0.0, moving: MovingEchoes | None = None
    ) -> int:
        """Return what sonar 0 to 15 of a robot at `pose` reads, its axis turned by `angle_deg`."""
        if self._kernel is not None:
            patch = moving.patch(True).for_c if moving is not None else None
            value = self._kernel.ping_mm(number, pose.x_mm, pose.y_mm, pose.heading_deg, angle_deg, patch)
            if value >= 0:
                return value
        at = transducer_pose(number, pose)
        return self.range_mm(at.x_mm, at.y_mm, at.heading_deg + angle_deg, moving)

    def range_mm(
        self, x_mm: float, y_mm: float, heading_deg: float, moving: MovingEchoes | None = None
    ) -> int:
        """Return the range from a transducer at this place, 100 to 5000; 5000 when nothing is heard.

        Cost: about 1 us in C, 80 us with numpy, in a world of some 30 segments.
        """
        if self._kernel is None:
            patch = self._patch(x_mm, y_mm)
            if moving is not None:
                patch = patch.joined(moving.patch(False))
            return self._range_numpy(patch, x_mm, y_mm, heading_deg)
        others = moving.patch(True).for_c if moving is not None else None
        value = self._kernel.range_mm(x_mm, y_mm, heading_deg, others)
        if value == kernel.UNKNOWN_CELL:
            self._patch(x_mm, y_mm)
            value = self._kernel.range_mm(x_mm, y_mm, heading_deg, others)
        return value

    def _range_numpy(self, patch: _Patch, x_mm: float, y_mm: float, heading_deg: float) -> int:
        if len(patch.ax) == 0:
            return NO_ECHO_MM
        heading = math.radians(heading_deg)
        c, s = math.cos(heading), math.sin(heading)
        dir_x = self._ray_cos * c - self._ray_sin * s
        dir_y = self._ray_cos * s + self._ray_sin * c
        beam_db = self._ray_db
        far, tip_db = self._seen_corners(patch, x_mm, y_mm, c, s)
        if far is not None:
            dir_x, dir_y = np.concatenate((dir_x, far[0])), np.concatenate((dir_y, far[1]))
            beam_db = np.concatenate((beam_db, far[3]))
        wx, wy = patch.ax - x_mm, patch.ay - y_mm
        across, up = dir_x[:, None], dir_y[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            # Products one by one, not as a matrix: their rounding is then the same on every machine, and in C.
            inverse = 1.0 / (across * patch.ey - up * patch.ex)
            where = (up * wx - across * wy) * inverse
            ranges = (wx * patch.ey - wy * patch.ex) * inverse
            # Written so that a ray along a segment (NaN) misses it.
            hit = (where >= -_TOUCH) & (where <= 1 + _TOUCH) & (ranges > 0)
        ranges[~hit] = np.inf
        first = ranges.argmin(axis=1)
        index = np.arange(len(first))
        nearest = ranges[index, first]
        with np.errstate(divide="ignore", invalid="ignore"):
            cosine = np.abs(1.0 / (inverse[index, first] * patch.length[first]))
            degrees = np.degrees(np.arccos(np.minimum(cosine, 1.0)))
            loss = patch.mirror[first] * degrees**2 - 20 * np.log10(cosine)
            if far is not None:
                count = len(tip_db)
                reached = nearest[-count:] >= far[2] - 1.0
                nearest[-count:] = np.where(reached, far[2], nearest[-count:])
                loss[-count:] = np.where(reached, np.fmin(loss[-count:], tip_db), loss[-count:])
            # NaN where nothing was hit and the air takes nothing: not heard either.
            loss = loss + beam_db + self.params.air_db_m / 1000 * nearest
        heard = nearest[loss <= self.params.margin_db]
        if heard.size == 0:
            return NO_ECHO_MM
        return int(min(NO_ECHO_MM, max(MIN_MM, round(float(heard.min())))))

    def _seen_corners(
        self, patch: _Patch, x: float, y: float, c: float, s: float
    ) -> tuple[tuple[Floats, Floats, Floats, Floats] | None, Floats]:
        """Directions, distances, beam losses and own losses of the corners within the cone.

        Rays are sent to them so that nothing thin falls between the rays of the fan.
        """
        dx, dy = patch.corner_x - x, patch.corner_y - y
        distance = np.sqrt(dx * dx + dy * dy)
        along = dx * c + dy * s
        inside = np.flatnonzero(
            (along >= self._cos_half * distance) & (distance > 1.0) & (distance < NO_ECHO_MM)
        )
        if inside.size == 0:
            return None, distance
        dx, dy, distance, along = dx[inside], dy[inside], distance[inside], along[inside]
        dx, dy = dx / distance, dy / distance
        off = np.degrees(np.arccos(np.minimum(along / distance, 1.0))) * 2 / self.params.cone_deg
        inverse = patch.inverse[inside]
        # The transducer looks into the corner when the way back is a positive mix of the corner's arms.
        into = (inverse[:, 0] * dx + inverse[:, 1] * dy < 0) & (inverse[:, 2] * dx + inverse[:, 3] * dy < 0)
        own = np.where(into & (patch.retro[inside] > 0), self.params.corner_db, self.params.tip_db)
        return (dx, dy, distance, self.params.edge_db * off * off), own

    def _patch(self, x: float, y: float) -> _Patch:
        cell = (math.floor(x / _CELL_MM), math.floor(y / _CELL_MM))
        patch = self._patches.get(cell)
        if patch is None:
            centre_x, centre_y = (cell[0] + 0.5) * _CELL_MM, (cell[1] + 0.5) * _CELL_MM
            limit = NO_ECHO_MM + _CELL_MM
            near = _distances(self._segments, centre_x, centre_y) <= limit
            away = np.hypot(self._corners[:, 0] - centre_x, self._corners[:, 1] - centre_y) <= limit
            patch = _Patch(self._segments[near], self._roughness[near], self._corners[away], self.params)
            self._patches[cell] = patch
            if self._kernel is not None:
                self._kernel.add(cell, patch.for_c)
        return patch


def _distances(segments: Floats, x: float, y: float) -> Floats:
    ex, ey = segments[:, 2] - segments[:, 0], segments[:, 3] - segments[:, 1]
    wx, wy = x - segments[:, 0], y - segments[:, 1]
    t = np.clip((wx * ex + wy * ey) / (ex * ex + ey * ey), 0.0, 1.0)
    result: Floats = np.hypot(wx - t * ex, wy - t * ey)
    return result


# ---- the ring ---------------------------------------------------------------------------------------------------


class _Switches(list[bool]):
    """Which arrays fire; remembers that they were set, and which were switched off: that restarts their clock."""

    def __init__(self, values: Iterable[bool]) -> None:
        super().__init__(values)
        self.touched = True
        self.cut: set[int] = set()

    def __setitem__(self, key: SupportsIndex | slice, value: Any) -> None:
        super().__setitem__(key, value)
        self.touched = True
        self.cut |= {array for array, on in enumerate(self) if not on}


@dataclass
class _Array:
    """The firing state of one array."""

    order: list[int]
    place: int = 0
    next_ms: float | None = None


def _next_ms(state: _Array) -> float:
    assert state.next_ms is not None
    return state.next_ms


def _completion_ms(reading: Reading) -> float:
    return reading.t_ms


class SonarRing:
    """The arrays of a P3-DX: every `cycle_ms` each enabled array fires its next transducer.

    enabled: one switch for each array; [0] front, [1] rear, the others are not fitted.
    """

    def __init__(
        self,
        world: World,
        params: SonarParams | None = None,
        faults: SonarFaults | None = None,
        rng: np.random.Generator | None = None,
        *,
        echoes: EchoModel | None = None,
        moving: MovingSolids | None = None,
    ) -> None:
        """`echoes`: a model of the same world and parameters, to share what it has worked out.

        `moving`: what else is in the way; whoever owns it lets it move.
        """
        self.params = params or SonarParams()
        self.echoes = echoes if echoes is not None else EchoModel(world, self.params)
        self.faults = faults
        self.watch: PingWatch | None = None
        self.cycle_ms = CYCLE_MS
        rng = rng if rng is not None else np.random.default_rng(0)
        self._normal: Callable[[], float] = rng.standard_normal
        self._random: Callable[[], float] = rng.random
        self._enabled = _Switches([True] * FITTED_ARRAYS + [False] * (ARRAYS - FITTED_ARRAYS))
        self._arrays = [self._default(array) for array in range(FITTED_ARRAYS)]
        self._quiet = False
        self._last_ms: float | None = None
        self._pending: list[Reading] = []
        self._live: list[_Array] = []
        self._fire_ms = -math.inf
        self._ready_ms = math.inf
        self._moving = moving
        self._moving_echoes = MovingEchoes(moving, self.params) if moving is not None else None
        self._known: dict[int, tuple[Pose, int, int]] = {}

    @property
    def enabled(self) -> list[bool]:
        """One switch for each array; set its elements."""
        return self._enabled

    @enabled.setter
    def enabled(self, values: Sequence[bool]) -> None:
        self._enabled[:] = list(values)

    @staticmethod
    def _default(array: int) -> _Array:
        return _Array(list(range(PER_ARRAY * array, PER_ARRAY * (array + 1))))

    def reset(self) -> None:
        """Return to the power-up firing order and cycle; the switches stay."""
        self.cycle_ms = CYCLE_MS
        self._quiet = False
        for array, state in enumerate(self._arrays):
            state.order = self._default(array).order
            state.place = 0

    def set_polling(self, numbers: Sequence[int]) -> None:
        """Take a POLLING string: transducers 1 to 32 in firing order.

        An array that is not mentioned keeps its order; in a mentioned one, transducers left out do not fire, and
        repeated ones fire more often (at most 16 entries an array, the rest is dropped). Numbers outside 1 to 32 are
        passed over. An empty string silences all until the next string that is not empty.
        """
        named = [number - 1 for number in numbers if 1 <= number <= ARRAYS * PER_ARRAY]
        self._quiet = not named
        for array, state in enumerate(self._arrays):
            order = [number for number in named if number // PER_ARRAY == array][:MAX_ORDER]
            if order:
                state.order, state.place = order, 0

    def advance(self, now_ms: float, pose_at: Callable[[float], Pose]) -> list[Reading]:
        """Fire what is due up to `now_ms`; return the readings whose echo is in, oldest first.

        `pose_at(t)` gives the true pose at a time since the last call. A pause of more than a second is not made
        up for: firing resumes now.
        """
        last_ms, self._last_ms = self._last_ms, now_ms
        if last_ms is not None and now_ms - last_ms > _RESUME_MS:
            self._restart(range(FITTED_ARRAYS))
        if self._enabled.touched:
            self._take_switches()
        if now_ms >= self._fire_ms:
            self._fire_due(now_ms, pose_at)
        if now_ms < self._ready_ms:
            return []
        ready = [reading for reading in self._pending if reading.t_ms <= now_ms]
        self._wait_for([reading for reading in self._pending if reading.t_ms > now_ms])
        ready.sort(key=_completion_ms)
        return ready

    def _take_switches(self) -> None:
        """Note which arrays fire from now on."""
        self._restart(array for array in self._enabled.cut if array < FITTED_ARRAYS)
        self._enabled.cut.clear()
        self._enabled.touched = False
        self._live = [state for array, state in enumerate(self._arrays) if self._enabled[array]]
        self._fire_ms = -math.inf

    def _wait_for(self, pending: list[Reading]) -> None:
        self._pending = pending
        self._ready_ms = min(map(_completion_ms, pending), default=math.inf)

    def _fire_due(self, now_ms: float, pose_at: Callable[[float], Pose]) -> None:
        live = self._live
        for state in live:
            if state.next_ms is None:
                state.next_ms = now_ms
        while live:
            first = min(live, key=_next_ms)
            self._fire_ms = _next_ms(first)
            if self._fire_ms > now_ms:
                return
            self._fire(first, self._fire_ms, pose_at)
        self._fire_ms = math.inf

    def fire_all(self, now_ms: float, pose: Pose) -> list[Reading]:
        """Return a reading of every sonar of the enabled arrays, without noise and crosstalk, faults applied.

        This is what emulators that know no schedule do; the firing order and its clock are left alone.
        """
        readings = []
        for array in range(FITTED_ARRAYS):
            if self._enabled[array]:
                for number in self._default(array).order:
                    readings += self._fire_one(number, now_ms, pose)
        return readings

    def _fire_one(self, number: int, now_ms: float, pose: Pose) -> list[Reading]:
        true_mm = self.true_range(number, pose)
        value: int | None = true_mm
        kind = None
        if self.faults is not None:
            value, kind = self.faults.apply(
                number, now_ms, true_mm, lambda angle_deg: self._measure(number, pose, angle_deg)
            )
        return [] if value is None else [Reading(now_ms, number, value, true_mm, kind)]

    def _restart(self, arrays: Iterable[int]) -> None:
        for array in arrays:
            self._arrays[array].next_ms = None
            low = array * PER_ARRAY
            self._wait_for([r for r in self._pending if not low <= r.number < low + PER_ARRAY])
        self._fire_ms = -math.inf

    def _fire(self, state: _Array, t_ms: float, pose_at: Callable[[float], Pose]) -> None:
        state.next_ms = t_ms + self.cycle_ms
        if self._quiet:
            return
        number = state.order[state.place]
        state.place = (state.place + 1) % len(state.order)
        pose = pose_at(t_ms)
        true_mm = self.true_range(number, pose)
        # Drawn for every ping, so that a fault or a world changes no later draw.
        noise, chance, where = self._normal(), self._random(), self._random()
        heard = self._heard(true_mm, noise, chance, where)
        value: int | None = heard
        kind = None
        if self.faults is not None:

            def remeasure(angle_deg: float) -> int:
                turned = self._measure(number, pose, angle_deg)
                return self._heard(turned, noise, chance, where)

            value, kind = self.faults.apply(number, t_ms, heard, remeasure)
            if kind is not None and self.watch is not None:
                self.watch(t_ms, number, true_mm, heard, value)
        if value is not None:
            ready_ms = t_ms + min(2 * value / SOUND_MM_MS, self.cycle_ms)
            self._pending.append(Reading(ready_ms, number, value, true_mm, kind))
            if ready_ms < self._ready_ms:
                self._ready_ms = ready_ms

    def true_range(self, number: int, pose: Pose) -> int:
        """Return what sonar 0 to 15 reads at a pose without noise, crosstalk and faults."""
        moment = self._moving.moment if self._moving is not None else 0
        known = self._known.get(number)
        if known is not None and known[1] == moment and (known[0] is pose or known[0] == pose):
            return known[2]
        value = self._measure(number, pose, 0.0)
        self._known[number] = (pose, moment, value)
        return value

    def _measure(self, number: int, pose: Pose, angle_deg: float) -> int:
        return self.echoes.ping_mm(number, pose, angle_deg, self._moving_echoes)

    def _heard(self, true_mm: int, noise: float, chance: float, where: float) -> int:
        """Add what a real ping adds: noise, another sonar's ping, and an echo that comes after the next firing."""
        params = self.params
        value = float(true_mm)
        if value < NO_ECHO_MM:
            value += noise * (params.noise_mm + params.noise_part * value)
        if chance < params.crosstalk:
            value = MIN_MM + where * (value - MIN_MM)
        if 2 * value / SOUND_MM_MS > self.cycle_ms:
            value = NO_ECHO_MM
        whole = round(value)
        return MIN_MM if whole < MIN_MM else min(whole, NO_ECHO_MM)
