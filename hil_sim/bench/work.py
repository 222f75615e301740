# SPDX-License-Identifier: MIT
"""One mission of the bench from id to record, in whatever process or machine it is run."""

from __future__ import annotations

import hashlib
import platform
import tempfile
import time
import traceback
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from hil_sim.bench.judge import Track, judge
from hil_sim.bench.plan import Case, mission_of, parse_id, without_faults
from hil_sim.core.library import LIBRARY_VARIABLE, library
from hil_sim.errors import SimError
from hil_sim.sil import Outcome, Sightings, run

Record = dict[str, Any]


def run_case(case: Case) -> tuple[Record, Outcome]:
    """Run a case; return its record and, for callers that want more, all that came of it."""
    begin = time.perf_counter()
    mission = mission_of(case)
    sightings = Sightings()
    outcome = run(mission, sightings=sightings)
    twin = None
    if mission.faults and any(not hit.struck for hit in outcome.collisions):
        twin = run(without_faults(mission))
    record = head(case) | judge(outcome, Track.of(sightings.seen), twin)
    record["wall_s"] = round(time.perf_counter() - begin, 3)
    return record, outcome


def head(case: Case) -> Record:
    """Return the fields of a record that say which case it is."""
    return {
        "id": case.id,
        "profile": case.profile,
        "split": case.split,
        "world": case.world,
        "place": case.place,
        "seed": case.seed,
        "variant": case.variant,
        "sonar": dict(case.sonar),
        "error": None,
    }


def work(case_id: str, files: Mapping[str, bytes] | None = None, core: str | None = None) -> Record:
    """Run the case of an id; never raises: a record with `error` tells what went wrong, so that the bench goes on.

    `files`: contents of world files, for a machine that does not have them. `core`: digest of the fault manager
    that must run it.
    """
    case = parse_id(case_id)
    try:
        if core is not None and core_digest() != core:
            reason = f"{platform.node()} has another build of the fault manager; copy the file, set {LIBRARY_VARIABLE}"
            return failed(case, reason)
        return run_case(_with_file(case, files or {}))[0] | head(case)
    except Exception as error:  # whatever a mission does, the others must run
        return failed(case, f"{type(error).__name__}: {error}", traceback.format_exc())


@lru_cache(maxsize=1)
def core_digest() -> str:
    """Return the digest of the fault manager that this process runs."""
    return hashlib.sha256(Path(str(library()._name)).read_bytes()).hexdigest()


def failed(case: Case, reason: str, details: str = "") -> Record:
    """Return the record of a case that did not run."""
    return head(case) | {"error": reason, "details": details}


def _with_file(case: Case, files: Mapping[str, bytes]) -> Case:
    """The case, its world's file restored where it is missing."""
    data = files.get(case.world)
    if data is None or Path(case.world).exists():
        return case
    path = _folder() / hashlib.sha256(case.world.encode()).hexdigest()[:16] / Path(case.world).name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(data)
    return Case(case.profile, case.split, str(path), case.seed, case.variant, case.sonar)


@lru_cache(maxsize=1)
def _folder() -> Path:
    return Path(tempfile.mkdtemp(prefix="argus-bench-"))


def world_files(cases: list[Case]) -> dict[str, bytes]:
    """Return the contents of all world files that the cases name; SimError when one cannot be read."""
    names = {case.world for case in cases if Path(case.world).suffix}
    try:
        return {name: Path(name).read_bytes() for name in sorted(names)}
    except OSError as error:
        raise SimError(
            f"{error.filename}: cannot read the world ({error.strerror}); correct --worlds"
        ) from error
