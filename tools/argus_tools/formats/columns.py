# SPDX-License-Identifier: MIT
"""CSV and JSON with named columns: a row has a time, a pose, and the range of each sonar."""

from __future__ import annotations

import json
from io import BufferedReader
from typing import Final

from argus_tools.formats.base import DamageList, Format, Reader, ReadOptions
from argus_tools.formats.jsonl import Records
from argus_tools.formats.source import BLOCK_BYTES
from argus_tools.formats.text import first_lines
from argus_tools.rings.columns import ColumnsLog, flat, json_rows, separator_of, table_rows, understood

_LINES_SEEN: Final = 5
_PARSER: Final = json.JSONDecoder()


def _is_table(head: bytes) -> bool:
    lines = [line for line in first_lines(head)[:_LINES_SEEN] if line.strip() and not line.startswith(b"#")]
    if not lines:
        return False
    line = lines[0].decode("utf-8", "replace").strip("\ufeff")
    return understood([cell.strip().strip('"') for cell in line.split(separator_of(line))]).is_ring


def _is_json(head: bytes) -> bool:
    """Whether the first object, in a line or laid out over many, has the keys of a ring."""
    if head.lstrip()[:1] not in (b"{", b"["):
        return False
    text = head[: head.rfind(b"}") + 1].decode("utf-8", "replace")
    try:
        value, _ = _PARSER.raw_decode(text, text.index("{"))
    except ValueError:
        return False
    return "hex" not in value and understood([name for name, _ in flat(value)]).is_ring


def _table(stream: BufferedReader, options: ReadOptions) -> Reader:
    damage = DamageList()
    return ColumnsLog(table_rows(stream, damage), options, damage)


def _json(stream: BufferedReader, options: ReadOptions) -> Reader:
    damage = DamageList()
    if stream.peek(1)[:1] == b"[":
        stream = BufferedReader(Records(stream), BLOCK_BYTES)
    return ColumnsLog(json_rows(stream, damage), options, damage)


FORMATS: Final = (
    Format("range-csv", "a table with columns as t_s, x_m, y_m, heading_deg, sonar_0_mm", _is_table, _table),
    Format("range-json", "JSON lines or an array with the same keys", _is_json, _json),
)
