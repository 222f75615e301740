# SPDX-License-Identifier: MIT
"""Logs of a robot's link, whoever recorded them: read, decode, and judge them by the fault manager itself.

The form of a log is told by its contents (docs/logs.md lists the forms), and it may be gzipped. What cannot be read
raises LogError, whose text is one line for a person.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any

from argus_tools.formats import Direction, LogError, formats, open_log
from argus_tools.log.faults import Listener, Said
from argus_tools.log.fields import Decoder
from argus_tools.log.packets import Row as LogPacket
from argus_tools.log.packets import packets
from argus_tools.log.summary import Summary

from hil_sim.arguments import offer
from hil_sim.core.library import setting_value

__all__ = ["Diagnosis", "LogError", "LogPacket", "Said", "decode", "diagnose", "read"]


def read(
    path: str | PathLike[str],
    *,
    form: str | None = None,
    direction: Direction | None = None,
    port: int | None = None,
    robot: int | None = None,
) -> Iterator[LogPacket]:
    """Yield every packet of a log, and each stretch of bytes that is none (`ok` false, `error` says why).

    form: as of `argus-log --format`; None sees it from the contents. direction: "r2c" or "c2r", of which packets are
    wanted; of a raw capture what it is. port: the robot's TCP port in a capture. robot: its number on a CAN bus.
    """
    if form is not None and form not in formats():
        raise LogError(f"no form '{form}'{offer(form, formats())}")
    log = open_log(fspath(path), form, direction=direction, port=port, robot=robot)
    found = False
    for row in packets(iter(log), False):
        found = found or row.ok
        if direction is None or row.dir == direction:
            yield row
    if not found:
        raise LogError(f"{fspath(path)}: no ARCOS packet, read as {log.format.help}")


def decode(
    path: str | PathLike[str], *, subclass: str | None = None, **options: Any
) -> Iterator[dict[str, Any]]:
    """Yield every packet of a log with its fields by name and in units, as `argus-log decode --json` prints them.

    subclass: the robot's, for its units of length; None takes it from the log. options: those of `read`.
    """
    decoder = Decoder(subclass)
    for row in read(path, **options):
        decoder.track(row)
        yield decoder.fields(row)


@dataclass(frozen=True)
class Diagnosis:
    """What the fault manager makes of a log.

    events: all that it said, each with the log's time. health, kind: of each sonar at the end, by the names of
    docs/diagnosis.md. failure: the failure state. text: what a person should know, as `argus-log faults` prints it.
    status: all that it knew at the end, by name.
    """

    events: tuple[Said, ...]
    health: tuple[str, ...]
    kind: tuple[str, ...]
    failure: str
    text: str
    status: Mapping[str, Any]


def diagnose(
    path: str | PathLike[str],
    *,
    config: Mapping[str, int | str] | None = None,
    subclass: str | None = None,
    **options: Any,
) -> Diagnosis:
    """Return what the fault manager would have said from a log alone; it only listens, so it turns no robot.

    config: settings as in argusd's configuration, but `active`. subclass, options: as of `decode`.
    """
    given = {key: setting_value(key, str(value)) for key, value in (config or {}).items()}
    if "active" in given:
        raise LogError("active: a manager that reads a log is passive")
    listener, summary = Listener(given, subclass), Summary()
    events = []
    for row in read(path, **options):
        summary.see(row.t, row.type == "SIP" and row.ok)
        for said in listener.take(row):
            events.append(said)
            summary.add(said.event, said.t, said.offset)
    status = listener.status
    if status is None:
        raise LogError(f"{fspath(path)}: holds no SIP from the robot, so there is nothing to judge")
    return Diagnosis(
        tuple(events),
        tuple(status["health"]),
        tuple(status["kind"]),
        status["failure"],
        "\n".join(summary.lines(status, 0, listener.unborne, listener.unheard)),
        status,
    )
