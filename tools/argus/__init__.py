# SPDX-License-Identifier: MIT
"""Argus from Python: the protocol, a live robot, missions in software, and logs judged by the fault manager itself.

    argus.protocol      ARCOS packets from bytes and back
    argus.sil           a mission of the fault manager on the emulated robot, in one process, under virtual time
    argus.live          a running argusd: watch it, drive the robot
    argus.guard         a guard port of it: drive by wheels, and meet nothing
    argus.ranges        pose and ranges of any robot, judged as they come
    argus.log           logs of a robot's link: read, decode, diagnose

The names used most are here too:

>>> import argus
>>> argus.frame(argus.Command.integer(argus.COMMAND["VEL"], -300).data).hex(" ")
'fa fb 06 0b 1b 2c 01 37 1c'

docs/python.md has more examples. What is not in `__all__` of these modules may change without notice.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from argus import guard, live, log, protocol, ranges, sil
    from argus.guard import GuardedRobot, GuardError, connect_guard
    from argus.live import AsyncRobot, ControlError, Refused, Robot, connect, connect_async
    from argus.log import Diagnosis, LogError, LogPacket, diagnose, read
    from argus.protocol import COMMAND, Command, PacketError, Sip, Unframer, decode, frame
    from argus.ranges import Observer
    from argus.sil import Mission, Outcome, Sil, run

    __version__: str

__all__ = [
    "COMMAND",
    "AsyncRobot",
    "Command",
    "ControlError",
    "Diagnosis",
    "GuardError",
    "GuardedRobot",
    "LogError",
    "LogPacket",
    "Mission",
    "Observer",
    "Outcome",
    "PacketError",
    "Refused",
    "Robot",
    "Sil",
    "Sip",
    "Unframer",
    "__version__",
    "connect",
    "connect_async",
    "connect_guard",
    "decode",
    "diagnose",
    "frame",
    "guard",
    "live",
    "log",
    "protocol",
    "ranges",
    "read",
    "run",
    "sil",
]

# Which module has a name; each is loaded when it is asked for, since `sil` alone takes as long as ten interpreters.
_HOMES = {
    "guard": ("GuardError", "GuardedRobot", "connect_guard"),
    "live": ("AsyncRobot", "ControlError", "Refused", "Robot", "connect", "connect_async"),
    "log": ("Diagnosis", "LogError", "LogPacket", "diagnose", "read"),
    "protocol": ("COMMAND", "Command", "PacketError", "Sip", "Unframer", "decode", "frame"),
    "ranges": ("Observer",),
    "sil": ("Mission", "Outcome", "Sil", "run"),
}


def __getattr__(name: str) -> Any:
    """Return a module of the package, or a name of one, and keep it."""
    from importlib import import_module

    if name == "__version__":
        from importlib.metadata import version

        found: Any = version("argus-p3dx")
    elif name in _HOMES:
        found = import_module(f"argus.{name}")
    else:
        home = next((module for module, names in _HOMES.items() if name in names), None)
        if home is None:
            raise AttributeError(f"module 'argus' has no attribute '{name}'")
        found = getattr(import_module(f"argus.{home}"), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """Return the names, loaded or not."""
    return sorted({*globals(), *__all__})
