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

from importlib.metadata import version as _version

from argus import guard, live, log, protocol, ranges, sil
from argus.guard import GuardedRobot, GuardError, connect_guard
from argus.live import AsyncRobot, ControlError, Refused, Robot, connect, connect_async
from argus.log import Diagnosis, LogError, LogPacket, diagnose, read
from argus.protocol import COMMAND, Command, PacketError, Sip, Unframer, decode, frame
from argus.ranges import Observer
from argus.sil import Mission, Outcome, Sil, run

__version__ = _version("argus-p3dx")

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
