# SPDX-License-Identifier: MIT
"""When each sonar was a suspect or dead, as the fault manager judges it, for the pictures of `argus-log plot`."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Iterator
from typing import Final, NamedTuple

from argus_tools.formats import LogError
from argus_tools.log.common import Input
from argus_tools.log.packets import Row

DEAD, SUSPECT = "dead", "suspect"
# What an event about a sonar makes of it; None ends what was before.
_BECOMES: Final[dict[str, str | None]] = {
    "SONAR_DEAD": DEAD,
    "SONAR_SILENT": DEAD,
    "SONAR_DISABLED": DEAD,
    "SONAR_STALE": DEAD,
    "SONAR_SUSPECT": SUSPECT,
    "SONAR_VERIFYING": SUSPECT,
    "SONAR_UNPROVEN": SUSPECT,
    "SONAR_CLEARED": None,
    "SUSPICION_DROPPED": None,
    "SONAR_HEALTHY": None,
}


class Span(NamedTuple):
    """A time in which a sonar was not to be trusted."""

    sonar: int
    kind: str
    start: float
    end: float


class Happening(NamedTuple):
    """What was said of a sonar, and when."""

    t: float
    event: str
    sonar: int


def spans(happenings: Iterable[Happening], end: float) -> list[Span]:
    """Turn events into spans; those that never end last until `end`.

    >>> spans([Happening(1.0, "SONAR_SUSPECT", 3), Happening(2.5, "SONAR_CLEARED", 3)], 9.0)
    [Span(sonar=3, kind='suspect', start=1.0, end=2.5)]
    """
    found: list[Span] = []
    since: dict[int, tuple[str, float]] = {}
    for t, event, sonar in happenings:
        if event not in _BECOMES:
            continue
        becomes = _BECOMES[event]
        kind, start = since.get(sonar, (None, t))
        if becomes == kind:
            continue
        if kind is not None:
            found.append(Span(sonar, kind, start, t))
            del since[sonar]
        if becomes is not None:
            since[sonar] = (becomes, t)
    found += [Span(sonar, kind, start, end) for sonar, (kind, start) in since.items()]
    return found


def _judge(rows: Iterable[Row], source: Input, profile: str, subclass: str | None) -> Iterator[Happening]:
    from argus_tools.log.faults import Listener
    from hil_sim.core.library import setting_value

    given = {"profile": setting_value("profile", profile)}
    listener = Listener(given, subclass, lambda: source.log.options.absent)
    for row in rows:
        for said in listener.take(row):
            if said.event.sonar is not None and said.t is not None:
                yield Happening(said.t, said.event.event, said.event.sonar)


def find_spans(args: argparse.Namespace) -> tuple[list[Span], str]:
    """Run the fault manager over the log; return the spans, and why there are none if it cannot be run."""
    from argus_tools.log.convert import clocked

    if args.log == "-":
        return [], "standard input can be read only once; save it to a file"
    last = 0.0
    source = Input(args, quiet=True)

    def watched() -> Iterator[Row]:
        nonlocal last
        for row in clocked(source, quiet=True):
            last = row.t or last
            yield row

    try:
        happenings = list(_judge(watched(), source, args.profile, args.subclass))
    except (LogError, ImportError) as error:
        return [], f"not judged: {error}"
    return spans(happenings, last), ""
