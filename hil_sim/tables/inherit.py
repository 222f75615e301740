# SPDX-License-Identifier: MIT
"""A table that says only in what it differs from another one."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any, Final

KEY: Final = "inherits"
"""The name of the other table, which stands in the same folder."""


def merged(base: dict[str, Any], own: dict[str, Any]) -> dict[str, Any]:
    """Return `base` with the values of `own`: sections are merged key by key, lists are replaced as a whole.

    >>> merged({"body": {"a": 1, "b": 2}, "list": [1, 2]}, {"body": {"b": 3}, "list": [4]})
    {'body': {'a': 1, 'b': 3}, 'list': [4]}
    """
    found = dict(base)
    for key, value in own.items():
        before = base.get(key)
        both = isinstance(before, dict) and isinstance(value, dict)
        found[key] = merged(before, value) if both else value  # type: ignore[arg-type]
    return found


def whole(name: str, read: Callable[[str], dict[str, Any]]) -> dict[str, Any]:
    """Return table `name` with what it inherits, by `read`, which reads one file; ValueError where it goes round."""
    chain = [name]
    table = read(name)
    while KEY in table:
        other = table.pop(KEY)
        chain.append(str(PurePosixPath(chain[-1]).with_name(str(other))))
        if chain[-1] in chain[:-1]:
            raise ValueError(f"inherits from itself: {' from '.join(chain)}")
        table = merged(read(chain[-1]), table)
    return table
