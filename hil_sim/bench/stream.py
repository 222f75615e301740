# SPDX-License-Identifier: MIT
"""A recorded drive-by: what the robot said on the wire, and beside it what was true."""

from __future__ import annotations

import json
import zipfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from hil_sim.errors import SimError
from hil_sim.sil import FaultTruth

FORMAT: Final = 1
SUFFIX: Final = ".npz"
READING_FIELDS: Final = ("number", "range_mm", "true_mm", "faulty", "fired_ms")


@dataclass(frozen=True)
class Stream:
    """One recording.

    times_ms, lengths, data: the packets to the fault manager, when the last bit of each was through. readings: a row
    of READING_FIELDS for each reading in a SIP. driving_s: time in motion. end_s: robot time at the end.
    """

    id: str
    times_ms: npt.NDArray[np.uint32]
    lengths: npt.NDArray[np.uint16]
    data: bytes
    readings: npt.NDArray[np.int32]
    truth: tuple[FaultTruth, ...]
    people: bool
    place: str
    driving_s: float
    end_s: float

    def save(self, path: Path) -> None:
        """Write the stream; a reader never sees half of it."""
        meta = {
            "format": FORMAT,
            "id": self.id,
            "truth": [asdict(truth) for truth in self.truth],
            "people": self.people,
            "place": self.place,
            "driving_s": self.driving_s,
            "end_s": self.end_s,
        }
        part = path.with_name(path.name + ".part")
        with part.open("wb") as file:
            np.savez_compressed(
                file,
                times_ms=self.times_ms,
                lengths=self.lengths,
                data=np.frombuffer(self.data, dtype=np.uint8),
                readings=self.readings,
                meta=np.array(json.dumps(meta)),
            )
        part.replace(path)


def load_stream(path: Path) -> Stream:
    """Read a stream; SimError when the file is none."""
    try:
        with np.load(path) as file:
            meta: dict[str, Any] = json.loads(str(file["meta"]))
            if meta.pop("format") != FORMAT:
                raise ValueError("another format")
            meta["truth"] = tuple(FaultTruth(**fields) for fields in meta["truth"])
            arrays = {name: file[name] for name in ("times_ms", "lengths", "readings")}
            return Stream(**meta, **arrays, data=file["data"].tobytes())
    except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
        raise SimError(
            f"{path}: is no stream of this version ({error}); remove it to record it anew"
        ) from error


def stream_path(folder: Path, case_id: str) -> Path:
    """Return where the stream of a case is kept."""
    return folder / (case_id.replace("/", "_") + SUFFIX)


def missing(folder: Path, ids: Sequence[str]) -> list[str]:
    """Return the cases whose streams are not there yet."""
    return [name for name in ids if not stream_path(folder, name).exists()]
