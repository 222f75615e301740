# SPDX-License-Identifier: MIT
"""Links that lie: another robot behind the cable, counters that restart, values that leap, cables that come and go."""

from __future__ import annotations

import dataclasses
import math
import random
from collections.abc import Callable
from typing import Any, Final

from hil_sim.arcos import COMMAND, Command, Sip
from hil_sim.server.server import ArcosServer, State
from hil_sim.sil import Mission, Sil

MOTIONS: Final = frozenset(
    COMMAND[name] for name in ("ENABLE", "MOVE", "ROTATE", "VEL", "HEAD", "DHEAD", "DCHEAD", "RVEL", "VEL2")
)
STOPS: Final = frozenset(COMMAND[name] for name in ("ENABLE", "ROTATE", "VEL", "RVEL", "VEL2"))
"""With 0."""
SUBCLASSES: Final = ("p3at-sh", "amigo-sh", "powerbot-sh", "pioneer1")
LIMIT_S: Final = 75.0


class LyingServer(ArcosServer):
    """A server whose SIPs may be altered; it keeps what motion was asked of it in its sessions."""

    alter: Callable[[Sip], Sip] | None = None

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.asked: list[str] = []

    def _sip(self) -> Sip:
        packet = super()._sip()
        return self.alter(packet) if self.alter is not None else packet

    def _obey(self, command: Command) -> None:
        stops = command.number in STOPS and command.value == 0
        if command.number in MOTIONS and not stops:
            self.asked.append(f"{command.number} {command.value}")
        super()._obey(command)


class MutatedSil(Sil):
    """A mission during which the link is mutated; `server` changes when another one is behind the cable.

    stranger: the present robot is not the one that was met first, or none that is known. slack_mm: what its own
    mutations may put the robot off its goal. said: what was done, for the message of a failure.
    """

    def __init__(self, mission: Mission, *, subclass: str | None = None) -> None:
        super().__init__(mission)
        self.identity: dict[str, str] = {} if subclass is None else {"subclass": subclass}
        self.stranger = subclass is not None
        self.serial = self.robot.table.serial
        self.slack_mm = 150.0
        self.said: list[str] = []
        self.false_goals: list[str] = []
        self.strangers: list[LyingServer] = []
        self._seen = 0
        self._put(self.identity, self.serial)

    @property
    def lying(self) -> LyingServer:
        """The robot's server."""
        assert isinstance(self.server, LyingServer)
        return self.server

    def _put(self, identity: dict[str, str], serial: str) -> None:
        robot = self.robot
        if self.server.state is State.CONNECTED:
            robot.close()
        robot.table = dataclasses.replace(robot.table, serial=serial)
        self.server = LyingServer(robot, flash_baud=self.mission.baud, **identity)
        self.server.sips = self._sips
        if self.stranger:
            self.strangers.append(self.server)

    def lose(self) -> None:
        """Unplug."""
        self.core.link_lost(int(self.now_ms))
        self._serve_core(int(self.now_ms))
        self._to_core.held.clear()
        self._to_robot.held.clear()

    def plug(self) -> None:
        """Plug in."""
        self.core.link_up(int(self.now_ms))
        self._serve_core(int(self.now_ms))

    def power_cycle(self) -> None:
        """The robot restarts: no session, odometry zero."""
        self._put(self.identity, self.serial)
        chassis = self.robot.chassis
        chassis.odo_x = chassis.odo_y = chassis.odo_th = 0.0

    def swap(self, identity: dict[str, str], serial: str) -> None:
        """Put another robot behind the cable."""
        if identity != self.identity or serial != self.serial:
            self.stranger = True
        self.identity, self.serial = identity, serial
        self._put(identity, serial)

    def look(self) -> None:
        """Note goals that are none."""
        for event in self.events[self._seen :]:
            if event.name == "GOAL_REACHED" and self._goal_mm() > self.slack_mm:
                self.false_goals.append(
                    f"{event.t_s:.1f} s: {self._goal_mm():.0f} mm off, {self.slack_mm:.0f} allowed"
                )
        self._seen = len(self.events)

    def wait(self, seconds: float) -> None:
        """Let time pass."""
        end_s = min(self.now_ms / 1000 + seconds, self.mission.limit_s)
        while self.now_ms / 1000 < end_s and not self.over:
            self.step()
            self.look()


Mutation = Callable[[MutatedSil, random.Random], str]


def reopen(sil: MutatedSil, rng: random.Random) -> str:
    sil.lose()
    seconds = rng.choice((0.05, 0.5, 2.0, 5.0))
    sil.wait(seconds)
    sil.plug()
    return f"unplugged for {seconds} s"


def flaps(sil: MutatedSil, rng: random.Random) -> str:
    count = rng.randint(2, 4)
    for _ in range(count):
        sil.lose()
        sil.wait(rng.uniform(0.02, 0.6))
        sil.plug()
        sil.wait(rng.uniform(0.02, 0.6))
    return f"{count} flaps"


def restart(sil: MutatedSil, rng: random.Random) -> str:
    lost = rng.random() < 0.5
    if lost:
        sil.lose()
        sil.wait(rng.uniform(0.0, 1.8))  # it drives on unseen until its watchdog stops it
    sil.power_cycle()
    if lost:
        sil.wait(rng.uniform(0.1, 3.0))
        sil.plug()
    return "restarted" + (" behind an unplugged cable" if lost else "")


def other_robot(sil: MutatedSil, rng: random.Random) -> str:
    identity, serial = dict(sil.identity), sil.serial
    what = rng.choice(("name", "subclass", "serial"))
    if what == "serial":
        serial = f"X{rng.randrange(10**6)}"
    elif what == "name":
        identity["name"] = f"Robot{rng.randrange(1000)}"
    else:
        identity["subclass"] = rng.choice(SUBCLASSES)
    lost = rng.random() < 0.7
    if lost:
        sil.lose()
    sil.swap(identity, serial)
    if lost:
        sil.wait(rng.uniform(0.05, 5.0))
        sil.plug()
    return f"another {what}" + ("" if lost else ", swapped in silence")


def leap(sil: MutatedSil, rng: random.Random) -> str:
    chassis = sil.robot.chassis
    kind = rng.choice(("zero", "far", "near", "turned"))
    if kind == "zero":
        chassis.odo_x = chassis.odo_y = chassis.odo_th = 0.0
    elif kind == "far":
        chassis.odo_x += rng.choice((-1, 1)) * rng.uniform(5000, 15000)
    elif kind == "near":
        chassis.odo_y += rng.choice((-1, 1)) * rng.uniform(500, 2500)
    else:
        chassis.odo_th += rng.choice((-1, 1)) * rng.uniform(30, 180)
    sil.slack_mm += 120
    return f"odometry leaps: {kind}"


def flicker(sil: MutatedSil, rng: random.Random) -> str:
    far = rng.randint(3000, 16000)
    state = {"k": 0}

    def alter(packet: Sip) -> Sip:
        state["k"] += 1
        return dataclasses.replace(packet, x=(packet.x + (far if state["k"] % 2 else 0)) & 0xFFFF)

    sil.lying.alter = alter
    sil.wait(rng.uniform(0.3, 10.0))
    sil.lying.alter = None
    sil.slack_mm += 200
    return f"x flickers by {far}"


def drip(sil: MutatedSil, rng: random.Random) -> str:
    mm, course = rng.uniform(30, 80), rng.uniform(0, 2 * math.pi)
    sil.slack_mm += 200
    for _ in range(rng.randint(5, 20)):
        sil.robot.chassis.odo_x += mm * math.cos(course)
        sil.robot.chassis.odo_y += mm * math.sin(course)
        sil.wait(1.0)
    return f"odometry leaps by {mm:.0f} mm each second"


def slant(sil: MutatedSil, rng: random.Random) -> str:
    units = rng.choice((-1, 1)) * rng.randint(140, 1500)
    sil.lying.alter = lambda packet: dataclasses.replace(packet, th=(packet.th + units) % 4096)
    sil.slack_mm += 200
    return f"headings are off by {units * 360 // 4096} degrees from then on"


def impossible_value(sil: MutatedSil, rng: random.Random) -> str:
    field, value = rng.choice(
        (
            ("battery", 0), ("battery", 255), ("battery_x10", 65535), ("battery_x10", 1), ("left_vel", 32767),
            ("right_vel", -32768), ("th", 30000), ("flags", 0), ("flags", 0xFFFF), ("control", -32768),
        )
    )  # fmt: skip
    changed: dict[str, Any] = {field: value}
    sil.lying.alter = lambda packet: dataclasses.replace(packet, **changed)
    sil.wait(rng.choice((0.1, 0.5, 3.0)))
    sil.lying.alter = None
    sil.slack_mm += 200
    return f"{field} is {value}"


def extreme_reading(sil: MutatedSil, rng: random.Random) -> str:
    sonar, value = rng.randrange(16), rng.choice((0, 1, 99, 100, 5001, 65535))

    def alter(packet: Sip) -> Sip:
        readings = tuple((n, value if n == sonar else mm) for n, mm in packet.sonars)
        return dataclasses.replace(packet, sonars=readings)

    sil.lying.alter = alter
    return f"sonar {sonar} reads {value}"


MUTATIONS: Final[tuple[Mutation, ...]] = (
    reopen, flaps, restart, other_robot, leap, flicker, drip, slant, impossible_value, extreme_reading,
)  # fmt: skip
LINK_FAULTS: Final = ("link-corrupt@{a}s-{b}s:p=0.2", "link-drop@{a}s-{b}s:p=0.2", "link-cut@{a}s-{b}s")


def mission(world: str, rng: random.Random) -> Mission:
    """A mission of some 15 s of driving, some on a bad line."""
    a = rng.randint(3, 15)
    fault = rng.choice(LINK_FAULTS).format(a=a, b=a + rng.randint(1, 6))
    goal = (rng.randint(1200, 2400), rng.randint(-300, 300))
    faults = (fault,) if rng.random() < 0.25 else ()
    return Mission(world, (goal,), faults=faults, seed=rng.randrange(10**6), limit_s=LIMIT_S)


def run_mutant(world: str, seed: int) -> MutatedSil:
    """One link, mutated one to four times."""
    rng = random.Random(f"mutated link {seed}")
    unknown = rng.choice(SUBCLASSES[2:]) if rng.random() < 0.1 else None
    sil = MutatedSil(mission(world, rng), subclass=unknown)
    if unknown is not None:
        sil.said.append(f"subclass {unknown} from the beginning")
    for _ in range(rng.randint(1, 4)):
        sil.wait(rng.uniform(1.0, 12.0))
        if sil.over:
            break
        sil.said.append(f"{sil.now_ms / 1000:.2f} s: {rng.choice(MUTATIONS)(sil, rng)}")
    sil.wait(math.inf)
    sil.look()
    return sil
