# SPDX-License-Identifier: MIT
"""What the command lines of all programs share."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Final, NoReturn

EXIT_USAGE: Final = 2


class Parser(argparse.ArgumentParser):
    """Reports a wrong argument in one line."""

    def error(self, message: str) -> NoReturn:
        """Print the line and leave with code 2."""
        self.exit(EXIT_USAGE, f"{self.prog}: {message}; see {self.prog} --help\n")


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
