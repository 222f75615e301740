# SPDX-License-Identifier: MIT
"""Rule: an order is taken once, with its CRC and the nonce of a fresh heartbeat; anything else moves nothing."""

from __future__ import annotations

import binascii
import struct
import time
from collections.abc import Iterator
from typing import Any

import pytest
from canbus import Raw, interface, load_dbc
from harness import PATIENCE_S, Argusd, Bench, Sim, is_at_rest, wait_for
from rules import assert_reached, cruise
from worlds import hall

GOAL_MM = 1400
STILL_S = 2.0
ROBOT = 3
HEARTBEAT_ID, ORDER_ID = 0x500 + 0x10 * ROBOT, 0x200 + ROBOT
DBC = load_dbc()


def crc(data: bytes) -> int:
    """CRC-16/CCITT-FALSE over the id and the first six bytes."""
    return binascii.crc_hqx(struct.pack("<H", ORDER_ID) + data[:6], 0xFFFF)


class Vehicle:
    """Somebody on the bus who gives orders."""

    def __init__(self, bus: str) -> None:
        self.raw = Raw(bus, [HEARTBEAT_ID])
        self.order_message = DBC.get_message_by_name("ArgusCommand")
        self.heartbeat_message = DBC.get_message_by_name("ArgusHeartbeat")
        self.sent: list[bytes] = []

    def nonce(self) -> int:
        """That of the next heartbeat."""
        self.raw.drain()
        beat = self.raw.wait("a heartbeat", lambda one: True)
        decoded: Any = self.heartbeat_message.decode(beat.data)
        return int(decoded["Nonce"])

    def encode(self, order: str, nonce: int, sonar: int = 0) -> bytes:
        """The frame of an order, its CRC right."""
        fields: dict[str, Any] = {"Order": order, "Sonar": sonar, "Nonce": nonce, "Reserved": 0, "Crc": 0}
        data = self.order_message.encode(fields)
        return data[:6] + struct.pack("<H", crc(data))

    def send(self, data: bytes) -> None:
        """Put an order's frame on the bus."""
        self.sent.append(data)
        self.raw.send(ORDER_ID, data)

    def order(self, order: str, sonar: int = 0) -> bytes:
        """Give an order as it should be given."""
        data = self.encode(order, self.nonce(), sonar)
        self.send(data)
        return data


@pytest.fixture
def bus() -> Iterator[str]:
    """A bus of the test's own."""
    with interface("vorders") as name:
        yield name


@pytest.fixture
def vehicle(bus: str) -> Iterator[Vehicle]:
    """Who gives orders."""
    result = Vehicle(bus)
    yield result
    result.raw.close()


def count(argusd: Argusd, what: str) -> int:
    """Orders taken or refused so far."""
    return int(argusd.status.get("can", {}).get(what, 0))


def wait_count(argusd: Argusd, what: str, number: int) -> None:
    """Wait for exactly so many orders taken or refused."""
    wait_for(
        f"{number} {what}, not {argusd.status.get('can')}", lambda: count(argusd, what) >= number, PATIENCE_S
    )
    assert count(argusd, what) == number


def assert_still(sim: Sim) -> None:
    """The robot does not move for a while."""
    rest = sim.wait_rest()
    sim.wait("a while", lambda s: s["t_s"] > rest["t_s"] + STILL_S)
    moved = [s for s in sim.of("state", rest["t_s"]) if not is_at_rest(s)]
    assert not moved, f"it moves: {moved[0]}"


def test_stop_and_go(bench: Bench, bus: str, vehicle: Vehicle) -> None:
    """The one drive of this file: each way of being wrong is tried on a robot that stands and would like to drive."""
    sim = bench.sim(bench.world(**hall()), link=["--can", f"{bus},robot={ROBOT}"])
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", link=f"can:{bus},robot={ROBOT}")
    cruise(sim, 100)
    vehicle.order("STOP")
    wait_count(argusd, "taken", 1)
    sim.wait_rest()
    go = vehicle.order("GO")
    wait_count(argusd, "taken", 2)
    sim.wait("it drives on", lambda s: s["v_mm_s"] > 50)
    vehicle.order("STOP")
    wait_count(argusd, "taken", 3)
    sim.wait_rest()

    late = vehicle.encode("GO", vehicle.nonce())
    fresh = vehicle.encode("GO", vehicle.nonce())
    wrong: list[tuple[str, bytes]] = [
        ("replayed", go),
        ("bad CRC", fresh[:6] + bytes((fresh[6] ^ 1, fresh[7]))),
        ("CRC of another robot", fresh[:6] + struct.pack("<H", crc_of(ORDER_ID + 1, fresh))),
        ("too short", fresh[:7]),
        ("empty", b""),
        ("a nonce that never was", vehicle.encode("GO", 0xFFFF & ~struct.unpack_from("<H", fresh, 2)[0])),
        ("all zero", bytes(8)),
        ("all one", b"\xff" * 8),
    ]
    for number, (_, data) in enumerate(wrong, 1):
        vehicle.send(data)
        wait_count(argusd, "refused", number)
    time.sleep(2.2)
    vehicle.send(late)
    wait_count(argusd, "refused", len(wrong) + 1)
    assert_still(sim)
    assert count(argusd, "taken") == 3

    stuck = vehicle.encode("GO", vehicle.nonce())
    refused = count(argusd, "refused")
    for _ in range(20):
        vehicle.send(stuck)
    wait_count(argusd, "taken", 4)
    wait_count(argusd, "refused", refused + 19)
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)


def crc_of(number: int, data: bytes) -> int:
    """The CRC that an order with another id would have."""
    return binascii.crc_hqx(struct.pack("<H", number) + data[:6], 0xFFFF)


def test_a_passive_argusd_obeys_active_and_passive(bench: Bench, bus: str, vehicle: Vehicle) -> None:
    bench.sim("lab", link=["--can", f"{bus},robot={ROBOT}"])
    argusd = bench.argusd(link=f"can:{bus},robot={ROBOT}", active=False)
    argusd.wait("SESSION_OPEN")
    vehicle.order("GO")
    wait_count(argusd, "taken", 1)
    assert not argusd.status["active"], "GO does not make a passive one active"
    vehicle.order("ACTIVE")
    argusd.wait("ACTIVE")
    vehicle.order("PASSIVE")
    argusd.wait("PASSIVE", after_t=argusd.named("ACTIVE")[0]["t"])
    wait_count(argusd, "taken", 3)
    assert count(argusd, "refused") == 0


def test_an_order_for_another_robot_is_not_ours(bench: Bench, bus: str, vehicle: Vehicle) -> None:
    bench.sim("lab", link=["--can", f"{bus},robot={ROBOT}"])
    argusd = bench.argusd(link=f"can:{bus},robot={ROBOT}", active=False)
    argusd.wait("SESSION_OPEN")
    data = vehicle.encode("ACTIVE", vehicle.nonce())
    vehicle.raw.send(ORDER_ID + 1, data[:6] + struct.pack("<H", crc_of(ORDER_ID + 1, data)))
    vehicle.order("RETEST", sonar=2)
    wait_count(argusd, "taken", 1)
    assert count(argusd, "refused") == 0
    assert not argusd.named("ACTIVE")
