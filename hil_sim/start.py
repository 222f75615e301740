# SPDX-License-Identifier: MIT
"""How every program in Python begins and ends: Ctrl-C ends it, without a traceback, from its first import on."""

from __future__ import annotations

import signal

TYPE_CHECKING = False  # of `typing`, whose import takes a while: the less there is before `begun`, the better
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    Main = Callable[[Sequence[str] | None], int]

EXIT_INTERRUPTED = 128 + int(signal.SIGINT)


def begun(load: Callable[[], Main], arguments: Sequence[str] | None = None) -> int:
    """Run the program that `load` imports; return its exit code, as a shell has it when an interrupt ended it.

    There is nothing to tidy while it is imported, and nothing once it has returned: SIGINT ends the process then, as
    it does any program that knows nothing of it. Where it is ignored, as behind nohup, it stays so; where it is
    blocked, as by one of ours that started this one in its own place, it comes now.
    """
    if signal.getsignal(signal.SIGINT) is not signal.default_int_handler:
        return load()(arguments)
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    program = load()
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        return program(arguments)
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
