# SPDX-License-Identifier: MIT
"""The results of a bench on disk: one JSON line for each mission, kept whole across interrupts."""

from __future__ import annotations

import json
from pathlib import Path
from types import TracebackType
from typing import Any, Final, Self

from hil_sim.errors import SimError

RESULTS: Final = "results.jsonl"
META: Final = "bench.json"
Record = dict[str, Any]


class Store:
    """Appends records to DIR/results.jsonl; knows what is already there.

    meta: what the results depend on (the fault manager's digest); resumed only when it is the same.
    """

    def __init__(self, folder: Path, meta: Record, *, resume: bool, fresh: bool = False) -> None:
        self.path = folder / RESULTS
        self.records: dict[str, Record] = {}
        try:
            folder.mkdir(parents=True, exist_ok=True)
            if self.path.exists() and not fresh:
                if not resume:
                    raise SimError(
                        f"{self.path}: there are results; go on with --resume, replace with --fresh"
                    )
                self._check(folder, meta)
                self._load()
            else:
                self.path.write_text("", encoding="utf-8")
            (folder / META).write_text(json.dumps(meta, indent=2) + "\n", encoding="utf-8")
            self._file = self.path.open("a", encoding="utf-8")
        except OSError as error:
            raise SimError(
                f"{folder}: cannot write results ({error.strerror}); name another --out"
            ) from error

    def _check(self, folder: Path, meta: Record) -> None:
        try:
            before = json.loads((folder / META).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            raise SimError(f"{folder / META}: missing or damaged; start again with --fresh") from None
        if not isinstance(before, dict) or before.get("core") != meta.get("core"):
            raise SimError(
                f"{folder}: its results are of another build of the fault manager; start again with --fresh"
            )
        if before.get("format") != meta.get("format"):
            raise SimError(
                f"{folder}: its results are of another version of the bench; start again with --fresh"
            )

    def _load(self) -> None:
        """Read what is there; a last line that was cut short by an interrupt is dropped, any other is an error."""
        self.records, good = read_results(self.path)
        if good < self.path.stat().st_size:
            with self.path.open("rb+") as file:
                file.truncate(good)

    def add(self, record: Record) -> None:
        """Write a record and flush it."""
        if record["id"] in self.records and self.records[record["id"]].get("error") is None:
            return
        self.records[record["id"]] = record
        self._file.write(json.dumps(record, separators=(",", ":")) + "\n")
        self._file.flush()

    def done(self, case_id: str) -> bool:
        """Whether there is a record of this mission that is not an error."""
        record = self.records.get(case_id)
        return record is not None and record.get("error") is None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()


def read_results(path: Path) -> tuple[dict[str, Record], int]:
    """Return the records of a file by id, the last of each, and how many bytes of the file are whole lines."""
    records: dict[str, Record] = {}
    good = 0
    lines = path.read_bytes().splitlines(keepends=True)
    for number, line in enumerate(lines, 1):
        try:
            record = json.loads(line) if line.endswith(b"\n") else None
            if not isinstance(record, dict) or not isinstance(record.get("id"), str):
                raise ValueError
        except ValueError:
            if number == len(lines):
                break
            raise SimError(
                f"{path}:{number}: no result of a mission; remove the line or use --fresh"
            ) from None
        records[record["id"]] = record
        good += len(line)
    return records, good
