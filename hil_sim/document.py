# SPDX-License-Identifier: MIT
"""YAML documents whose every value knows its file and line, so that a mistake is reported where it is."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final, NoReturn, TypeVar

import yaml

from hil_sim.arguments import offer
from hil_sim.errors import SimError

T = TypeVar("T")

MAX_VALUES: Final = 200_000
"""Values of one document: some kilobytes of aliases can otherwise stand for more than any memory holds."""

_PROBLEM_MAX = 200
"""Characters of the parser's own words, which may quote the file at any length."""


class Item:
    """One value of a document: a mapping, a list or a scalar, with the line it stands on."""

    def __init__(self, path: str, line: int, value: Any) -> None:
        self.path = path
        self.line = line
        self.value = value

    def fail(self, what: str) -> NoReturn:
        """Refuse this value: raise with file, line and `what`, which says what to do."""
        raise SimError(f"{self.path}:{self.line}: {what}")

    def mapping(self, known: Iterable[str]) -> dict[str, Item]:
        """Return the mapping; every key must be among `known`."""
        names = list(known)
        if not isinstance(self.value, dict):
            self.fail(f"expected a mapping with the keys {', '.join(names)}")
        for key, item in self.value.items():
            if key not in names:
                item.fail(f"unknown key '{_shown(key)}'{offer(_shown(key), names)}")
        return dict(self.value)

    def named(self) -> dict[str, Item]:
        """Return a mapping with free keys."""
        if not isinstance(self.value, dict):
            self.fail("expected a mapping of names to values")
        return dict(self.value)

    def items(self) -> list[Item]:
        """Return the list."""
        if not isinstance(self.value, list):
            self.fail("expected a list")
        return list(self.value)

    def text(self) -> str:
        """Return the scalar as text."""
        if not isinstance(self.value, str):
            self.fail("expected text; put it in quotes")
        return self.value

    def number(self, low: float = -1e6, high: float = 1e6) -> float:
        """Return a number within the range given, which must be finite."""
        value = self.value
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not _is_finite(value):
            self.fail(f"expected a number from {low:g} to {high:g}, not '{_shown(value)}'")
        if not low <= value <= high:
            self.fail(f"{value:g} is outside {low:g} to {high:g}")
        return float(value)

    def integer(self, low: int, high: int) -> int:
        """Return a whole number within the range given."""
        value = self.value
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            self.fail(f"expected a whole number from {low} to {high}, not '{_shown(value)}'")
        return value

    def flag(self) -> bool:
        """Return true or false."""
        if not isinstance(self.value, bool):
            self.fail(f"expected true or false, not '{_shown(self.value)}'")
        return self.value

    def numbers(self, *lengths: int) -> list[float]:
        """Return a list of numbers with one of the lengths given."""
        items = self.value if isinstance(self.value, list) else None
        if items is None or len(items) not in lengths:
            self.fail(f"expected a list of {' or '.join(str(n) for n in lengths)} numbers")
        return [item.number() for item in items]

    def convert(self, reader: Callable[[str], T]) -> T:
        """Return what `reader` makes of the text; its complaint gets file and line."""
        try:
            return reader(self.text())
        except SimError as error:
            if str(error).startswith(f"{self.path}:"):
                raise
            self.fail(str(error))


def _is_finite(value: float) -> bool:
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _shown(value: Any) -> str:
    """What stands there, short enough for a message."""
    if isinstance(value, (dict, list)):
        return "a mapping" if isinstance(value, dict) else "a list"
    try:
        text = str(value)
    except ValueError:
        return "a number of thousands of digits"
    return text if len(text) <= 60 else f"{text[:57]}..."


def _item(path: str, node: yaml.Node, count: list[int], line: int | None = None) -> Item:
    count[0] += 1
    if count[0] > MAX_VALUES:
        Item(path, node.start_mark.line + 1, None).fail(
            f"more than {MAX_VALUES} values; use fewer aliases or parts"
        )
    here = node.start_mark.line + 1 if line is None else line
    if isinstance(node, yaml.MappingNode):
        values: dict[str, Item] = {}
        for key, value in node.value:
            at = key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode):
                Item(path, at, None).fail("a key must be a word")
            if key.value in values:
                Item(path, at, None).fail(f"key '{_shown(key.value)}' is given twice; keep one")
            values[key.value] = _item(path, value, count, at if isinstance(value, yaml.ScalarNode) else None)
        return Item(path, here, values)
    if isinstance(node, yaml.SequenceNode):
        return Item(path, here, [_item(path, value, count) for value in node.value])
    return Item(path, here, _scalar(node))


def _scalar(node: yaml.Node) -> Any:
    try:
        return yaml.constructor.SafeConstructor().construct_object(node)
    except (yaml.YAMLError, ValueError, LookupError, AttributeError, OverflowError):
        # Not what its tag promises (`!!bool perhaps`): the text, which the reader of the value then refuses.
        return str(node.value)


def read_text(path: str | Path, on_latin_1: Callable[[int], None] | None = None) -> str:
    """Return the text of a file, or refuse it in one line.

    on_latin_1: called with the first byte that is not UTF-8; the file is Latin-1 then. None refuses it.
    """
    try:
        data = Path(path).read_bytes()
        try:
            return data.decode("utf-8")
        except UnicodeDecodeError as error:
            if on_latin_1 is None or b"\0" in data:
                raise
            on_latin_1(error.start)
            return data.decode("latin-1")
    except OSError as error:
        raise SimError(f"{path}: cannot be read ({error.strerror}); check the name") from None
    except UnicodeDecodeError as error:
        raise SimError(f"{path}: not UTF-8 text (byte {error.start}); save it as UTF-8") from None
    except ValueError:
        raise SimError(f"{path}: no file can have this name; check it") from None


def read_document(path: str | Path) -> Item:
    """Parse a YAML file without running anything in it."""
    text = read_text(path)
    try:
        node = yaml.compose(text, Loader=yaml.SafeLoader)
    except yaml.MarkedYAMLError as error:
        line = error.problem_mark.line + 1 if error.problem_mark else 1
        said = str(error.problem)
        problem = said if len(said) <= _PROBLEM_MAX else said[:_PROBLEM_MAX] + "..."
        raise SimError(f"{path}:{line}: not valid YAML: {problem}; correct the line") from None
    except (yaml.YAMLError, RecursionError, ValueError, OverflowError) as error:
        raise SimError(f"{path}:1: not valid YAML: {str(error).splitlines()[0]}") from None
    if node is None:
        raise SimError(f"{path}:1: the file is empty; see docs for its keys")
    try:
        return _item(str(path), node, [0])
    except RecursionError:
        raise SimError(f"{path}:1: nested too deeply or into itself; write it out flat") from None
