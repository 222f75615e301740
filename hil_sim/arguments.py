# SPDX-License-Identifier: MIT
"""What the command lines of all programs share."""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from typing import Any, Final, NoReturn

EXIT_USAGE: Final = 2
# So many letters more than an option has are a typing error.
_TYPO_MOST: Final = 2
_NEAR: Final = 0.65
_NEGATIVE: Final = re.compile(r"-\.?\d")
_UNKNOWN: Final = re.compile(r"unrecognized arguments: (?:.* )?(--?[^\s=]+)")
_NO_CHOICE: Final = re.compile(r"invalid choice: '([^']*)' \(choose from (.*)\)")


def meant(word: str, known: Collection[str]) -> str:
    """Return a question for the word that was likely meant, empty when none is near.

    >>> meant("--fualt", ["--fault", "--tcp"]), meant("--zzz", ["--fault"]), meant("p3xd", ["p3dx-sh", "p3at-sh"])
    ('; did you mean --fault?', '', '; did you mean p3dx-sh?')
    """
    import difflib

    heads = {one.partition("-")[0]: one for one in known if not one.startswith("-")}
    names = heads | {one: one for one in known}
    near = difflib.get_close_matches(word, names, 1, _NEAR)
    return f"; did you mean {names[near[0]]}?" if near else ""


def offer(word: str, known: Iterable[str], more: str = "") -> str:
    """Return what follows "no such X 'WORD'": the one that was likely meant, and all there are.

    >>> offer("ofice", ["lab", "office"]), offer("zzz", ["lab", "office"], "a file")
    ('; did you mean office? name one of lab, office', '; name one of lab, office, or a file')
    """
    names = list(known)
    if not names:
        return "; there is none"
    words = f"name one of {', '.join(names)}{more and f', or {more}'}"
    return f"{meant(word, names) or ';'} {words}"


def _parted(word: str, known: list[str]) -> str:
    """Return a question for an option whose value follows without a space.

    >>> _parted("--formatjsonl", ["--format", "--from"]), _parted("--fromat", ["--format", "--from"])
    ('; did you mean --format jsonl?', '')
    """
    option = max((one for one in known if word.startswith(one)), key=len, default=word)
    value = word.removeprefix(option)
    return f"; did you mean {option} {value}?" if len(value) > _TYPO_MOST else ""


def _options(parser: argparse.ArgumentParser) -> Iterator[str]:
    """Yield the options of a parser, and of its commands."""
    for action in parser._actions:
        yield from (option for option in action.option_strings if option.startswith("--"))
        if isinstance(action, argparse._SubParsersAction):
            for command in action.choices.values():
                yield from _options(command)


class Parser(argparse.ArgumentParser):
    """Reports a wrong argument in one line; what begins as a negative number is a value, as -800,0 or -2m,0."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self._negative_number_matcher = _NEGATIVE
        self._given: list[str] = []
        self.elsewhere: Sequence[str] = ()
        """Words that begin another command line."""

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse, and keep what was given for the words of an error."""
        self._given = list(sys.argv[1:] if args is None else args)
        return super().parse_known_args(args, namespace)

    def _mistyped(self) -> str:
        """Return a question for the first option given that is none: argparse misses others before it sees that."""
        known = list(_options(self))
        given = (word.partition("=")[0] for word in self._given if word.startswith("--") and word != "--")
        odd = next((word for word in given if not any(option.startswith(word) for option in known)), "")
        return meant(odd, known) if odd else ""

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print; an output that takes nothing is no matter to argparse, but to `hil_sim.output.guarded`."""
        if message and file is not None:
            file.write(message)

    def error(self, message: str) -> NoReturn:
        """Print the line and leave with code 2."""
        if "required" in message:
            message += self._mistyped()
        if unknown := _UNKNOWN.match(message):
            known = list(_options(self))
            message += _parted(unknown[1], known) or meant(unknown[1], known)
        elif message.startswith("unrecognized") and self._given:
            message += meant(self._given[0], self.elsewhere)
        if wrong := _NO_CHOICE.search(message):
            message += meant(wrong[1], re.findall(r"[^\s',]+", wrong[2]))
        message += "" if message.endswith("?") else ";"
        self.exit(EXIT_USAGE, f"{self.prog}: {message} see {self.prog} --help\n")


def whole(low: int, high: int, what: str = "whole number") -> Callable[[str], int]:
    """Return an argument type: an integer from `low` to `high`; `what` it is called when it is none."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            value = low - 1
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"'{text}' is not a {what} from {low} to {high}")
        return value

    return parse
