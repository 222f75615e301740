# SPDX-License-Identifier: MIT
"""What all programs do when standard output is closed, is full, or has no reader any more."""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Callable
from typing import Final

# Errors of a write, none of a file that could not be opened.
_WRITING: Final = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF)

_STDOUT: Final = 1

EXIT_UNREAD: Final = 128 + signal.SIGPIPE
"""As a shell has it, for programs whose work is not done when nobody reads on."""


def is_of_output(error: OSError) -> bool:
    """Whether it is of a write to standard output, which `guarded` tells."""
    return error.errno in _WRITING and error.filename is None


def guarded(program: str, run: Callable[[], int], unwritable: int, unread: int) -> int:
    """Run a program and return its exit code.

    It is `unwritable`, with one line of why, when standard output takes nothing, and `unread` when its reader went.
    """
    is_closed = sys.stdout is None
    if is_closed:
        _stand_in()
    try:
        return _flushed(run)
    except BrokenPipeError:
        # Nobody reads our output.
        _drop()
        return unread
    except OSError as error:
        if not is_of_output(error):
            raise
        why = "closed; give it a file, or /dev/null" if is_closed else error.strerror
        print(f"{program}: standard output: {why}", file=sys.stderr)
        _drop()
        return unwritable


def _stand_in() -> None:
    """Take the place of a closed output: nothing else gets its descriptor, and only who prints fails."""
    descriptor = os.open(os.devnull, os.O_RDONLY)
    if descriptor != _STDOUT:
        os.dup2(descriptor, _STDOUT)
        os.close(descriptor)
    sys.stdout = open(_STDOUT, "w", encoding="utf-8", closefd=False)  # noqa: SIM115


def _flushed(run: Callable[[], int]) -> int:
    try:
        code = run()
    except SystemExit:
        # The help was asked for, or an argument was wrong.
        sys.stdout.flush()
        raise
    sys.stdout.flush()
    return code


def _drop() -> None:
    """The interpreter must not try once more, at its end, to write what is left."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
