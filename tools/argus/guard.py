# SPDX-License-Identifier: MIT
"""A guard port of argusd from Python: drive by wheels, as an old client does, and be kept from running into things.

    with argus.connect_guard("tcp:127.0.0.1:8101") as robot:
        robot.drive(200, turn_deg_s=5)
        for sip in robot.sips(5.0):
            print(sip.x, sip.y, sip.sonars)

argusd slows, holds or stops what is ordered here where the robot would meet something, and withholds the readings of
sonars that it does not trust (docs/guardian.md). A robot's own port speaks the same protocol, without that care.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from types import TracebackType
from typing import Any, Final, Self

from hil_sim.arcos import ConfigPac, Sip, SyncReply
from hil_sim.conformance.client import Client, Failed, Target, parse_target
from hil_sim.errors import LinkError, SimError

__all__ = ["GuardError", "GuardedRobot", "connect_guard"]

DEFAULT_PLACE: Final = "tcp:127.0.0.1:8101"
_SIP_S: Final = 5.0
_STANDS_S: Final = 20.0
_LEAST_S: Final = 0.001
_MOST: Final = 32767


class GuardError(Exception):
    """The port cannot be reached, or what is there does not answer as a robot; the message is one line."""


def _wire(value: float) -> int:
    number = round(value)
    if abs(number) > _MOST:
        raise ValueError(f"{value:g} is beyond what a command carries: -{_MOST} to {_MOST}")
    return number


class GuardedRobot:
    """A session at a guard port; a context manager, made by `connect_guard`.

    While something of this object waits, the session is kept alive. A program that does something else for longer than
    the robot's watchdog (2 s) is stopped by argusd, which takes it for hung: call `sip` or `sips` meanwhile.
    """

    def __init__(self, client: Client, place: str) -> None:
        self._client = client
        self._place = place
        self._readings: dict[int, int] = {}

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Stop the robot and end the session; the robot's own session, which is argusd's, goes on."""
        if self._client.in_session and self._client.connected:
            self._client.halt()
        self._client.close()

    @property
    def identity(self) -> tuple[str, str, str]:
        """Name, class and subclass of the robot behind the port."""
        reply = self._client.identity
        assert isinstance(reply, SyncReply)  # of every session
        words = (reply.name, reply.robot_class, reply.subclass)
        return tuple(word.decode("ascii", "replace") for word in words)  # type: ignore[return-value]

    @property
    def readings(self) -> dict[int, int]:
        """The latest reading of each sonar that argusd trusts, mm; 5000: no echo. A SIP lists the new ones only."""
        return dict(self._readings)

    def _order(self, name: str, value: int | None = None) -> None:
        if not self._client.connected:
            raise GuardError(f"{self._place}: argusd has closed the connection")
        self._client.command(name, value)

    def drive(self, mm_s: float, turn_deg_s: float = 0.0) -> None:
        """Go ahead (back where negative) and turn (left where positive) until something else is ordered."""
        self._order("VEL", _wire(mm_s))
        self._order("RVEL", _wire(turn_deg_s))

    def turn(self, deg: float) -> None:
        """Turn by so much on the spot, left where positive; `until_it_stands` waits for the end."""
        self._order("DHEAD", _wire(deg))

    def stop(self) -> None:
        """Stop, and forget what was ordered."""
        self._order("STOP")

    def configuration(self, timeout_s: float = _SIP_S) -> ConfigPac:
        """Return the robot's CONFIGpac."""
        self._order("CONFIG")
        packet = self._client.answer(ConfigPac, timeout_s)
        if not isinstance(packet, ConfigPac):
            raise GuardError(f"{self._place}: no CONFIGpac came in {timeout_s:g} s")
        return packet

    def sip(self, timeout_s: float = _SIP_S) -> Sip:
        """Return the next SIP: pose, battery, and the readings of the sonars that argusd trusts."""
        packet = self._client.answer(Sip, max(timeout_s, _LEAST_S))
        if isinstance(packet, Sip):
            self._readings |= dict(packet.sonars)
            return packet
        if not self._client.connected:
            raise GuardError(f"{self._place}: argusd has closed the connection")
        raise TimeoutError(f"{self._place}: no SIP for {timeout_s:g} s")

    def sips(self, seconds: float) -> Iterator[Sip]:
        """Yield the SIPs of so many seconds; orders may be given meanwhile."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            try:
                yield self.sip(min(left, _SIP_S))
            except TimeoutError:
                if time.monotonic() < until:
                    raise

    def until_it_stands(self, timeout_s: float = _STANDS_S) -> Sip:
        """Wait until the wheels have stood for three SIPs; return the last of them."""
        until = time.monotonic() + timeout_s
        still = 0
        while time.monotonic() < until:
            sip = self.sip()
            still = 0 if sip.left_vel or sip.right_vel else still + 1
            if still == 3:
                return sip
        raise TimeoutError(f"{self._place}: it still moves after {timeout_s:g} s")


def connect_guard(
    place: str = DEFAULT_PLACE, *, motors: bool = True, timeout_s: float = _SIP_S
) -> GuardedRobot:
    """Open a session at PLACE, tcp:HOST:PORT or serial:PATH[@BAUD] (a guard's pty), and put its motors on.

    Where another client has the port, or argusd is not yet there, GuardError.
    """
    try:
        target: Target = parse_target(place)
    except SimError:
        raise GuardError(f"{place}: give tcp:HOST:PORT or serial:PATH[@BAUD]") from None
    client = Client(target, timeout_s)
    problem: Any = None
    try:
        client.start(motors=motors)
    except LinkError as error:
        problem = error
    except Failed as error:
        problem = f"{place}: {error}; is a guard port of argusd there, and no other client at it?"
    if problem is not None:
        client.close()
        raise GuardError(str(problem))
    return GuardedRobot(client, place)
