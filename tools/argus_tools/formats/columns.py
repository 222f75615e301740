# SPDX-License-Identifier: MIT
"""CSV and JSON with named columns: a row has a time, a pose, and the range of each sonar."""

from __future__ import annotations

import json
from collections.abc import Iterator
from io import BufferedReader
from itertools import islice
from typing import Any, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import DamageList, Format, Reader, ReadOptions
from argus_tools.formats.jsonl import Records
from argus_tools.formats.source import BLOCK_BYTES
from argus_tools.formats.text import first_lines
from argus_tools.rings.columns import ColumnsLog, flat, json_rows, separator_of, table_rows, understood

_LINES_SEEN: Final = 5
_OBJECTS_SEEN: Final = 20
_PARSER: Final = json.JSONDecoder()


def _is_table(head: bytes) -> bool:
    lines = [line for line in first_lines(head)[:_LINES_SEEN] if line.strip() and not line.startswith(b"#")]
    if not lines:
        return False
    line = lines[0].decode("utf-8", "replace").strip("\ufeff")
    return understood([cell.strip().strip('"') for cell in line.split(separator_of(line))]).is_ring


def _objects(text: str) -> Iterator[Any]:
    """Yield the whole objects of JSON lines or an array, in lines or laid out over many."""
    at = text.find("{")
    while at >= 0:
        try:
            value, end = _PARSER.raw_decode(text, at)
        except ValueError:
            return
        yield value
        at = text.find("{", end)


def _is_json(head: bytes) -> bool:
    """Whether one of the first objects has the keys of a ring: packets of other kinds may stand before it."""
    if head.lstrip()[:1] not in (b"{", b"["):
        return False
    for value in islice(_objects(head.decode("utf-8", "replace")), _OBJECTS_SEEN):
        if "hex" in value:
            return False
        if understood([name for name, _ in flat(value)]).is_ring:
            return True
    return False


def _table(stream: BufferedReader, options: ReadOptions) -> Reader:
    damage = DamageList()
    return ColumnsLog(table_rows(stream, damage), options, damage)


def _json(stream: BufferedReader, options: ReadOptions) -> Reader:
    damage = DamageList()
    if stream.peek(1)[:1] == b"[":
        stream = BufferedReader(Records(stream), BLOCK_BYTES)
    return ColumnsLog(json_rows(stream, damage), options, damage)


FORMATS: Final = (
    Format("range-csv", HELP["range-csv"], _is_table, _table),
    Format("range-json", HELP["range-json"], _is_json, _json),
)
