# SPDX-License-Identifier: MIT
"""Rule: the robot's link takes one ARCOS packet per message, counts what goes wrong, and goes on, on both stacks."""

from __future__ import annotations

import random
import time
from collections.abc import Callable, Iterator

import pytest
from canbus import (
    CONTINUE,
    OVERFLOW,
    PULSE,
    WAIT,
    End,
    Raw,
    Served,
    consecutive,
    first_frame,
    flow_control,
    interface,
    ip,
    packet,
    tc,
)
from harness import PATIENCE_S, wait_for

from hil_sim.arcos import frame
from hil_sim.errors import LinkError
from hil_sim.links.can import PACKET_MAX, CanLink
from hil_sim.links.can_spec import TO_HOST_ID, TO_ROBOT_ID, parse_spec

SIZES = (6, 7, 8, 13, 14, 55, 89, 200, PACKET_MAX)
STACKS = ("kernel", "user")
BUS = "vlink"


@pytest.fixture(params=STACKS)
def stack(request: pytest.FixtureRequest) -> str:
    """Whose ISO-TP it is."""
    return str(request.param)


@pytest.fixture(scope="module")
def bus() -> Iterator[str]:
    """A bus of this file's own; who breaks it mends it."""
    with interface(BUS) as name:
        yield name


@pytest.fixture
def served(bus: str, stack: str) -> Iterator[Served]:
    """A link with the defaults."""
    link = CanLink(parse_spec(f"{bus},stack={stack}"))
    link.open()
    result = Served(link)
    try:
        yield result
    finally:
        result.end()


@pytest.fixture
def host(bus: str, served: Served) -> Iterator[End]:
    """The other end."""
    end = End.host(bus)
    try:
        yield end
    finally:
        end.close()


def assert_works(served: Served, host: End) -> None:
    """Packets pass both ways."""
    tag = random.randbytes(20)
    out, back = frame(tag), frame(tag[::-1])
    assert host.send(out), "the link sends no flow control"
    served.wait_packet(out)
    host.heard.clear()
    served.send(back)
    host.pump(10, lambda: back in host.heard)
    assert back in host.heard


def test_packets_of_every_size_pass_both_ways(served: Served, host: End) -> None:
    for size in SIZES:
        data = packet(size)
        host.send(data)
        served.wait_packet(data)
        served.send(data)
        assert host.receive() == data
    assert not served.link.errors
    assert not served.link.refused


BAD = {
    "longer than any packet": b"\xfa\xfb" + bytes((PACKET_MAX - 3,)) + bytes(PACKET_MAX - 2),
    "much longer": packet(PACKET_MAX) * 4,  # within what a socket holds
    "two packets": PULSE + PULSE,
    "a cut packet": packet(40)[:-1],
    "a packet and a byte": packet(40) + b"\0",
    "no packet": b"hello, robot",
    "a byte": b"\xfa",
    "the header alone": b"\xfa\xfb",
}


@pytest.mark.parametrize("what", BAD)
def test_a_message_that_is_not_one_packet_is_refused_and_counted(
    served: Served, host: End, what: str
) -> None:
    assert host.send(BAD[what])
    wait_for("it is counted", lambda: served.link.refused == 1, PATIENCE_S)
    assert not served.got
    assert_works(served, host)
    assert served.link.refused == 1


NAMES = {
    "sequence": {"kernel": "EILSEQ", "user": "WrongSequenceNumberError"},
    "lost": {"kernel": "ETIMEDOUT", "user": "ConsecutiveFrameTimeoutError"},
    "overflow": {"kernel": "EMSGSIZE", "user": "OverflowError"},
    "silent": {"kernel": "ECOMM", "user": "FlowControlTimeoutError"},
}


def test_wrong_sequence(served: Served, host: End, stack: str) -> None:
    host.manners.wrong = 1
    host.send(packet(50))
    served.wait_error(NAMES["sequence"][stack])
    assert_works(served, host)


def test_lost_consecutive_frame(served: Served, host: End, stack: str) -> None:
    """The last one; the loss of an earlier one is a wrong sequence."""
    host.manners.skip = 1
    host.send(packet(12))
    served.wait_error(NAMES["lost"][stack])
    assert_works(served, host)
    assert len(served.got) == 1


def test_flow_control_overflow(served: Served, host: End, stack: str) -> None:
    host.manners.answers = [OVERFLOW]
    served.send(packet(50))
    host.pump(10, lambda: bool(served.link.errors))
    served.wait_error(NAMES["overflow"][stack])
    assert_works(served, host)
    assert packet(50) not in host.heard


def test_no_flow_control(served: Served, host: End, stack: str) -> None:
    """As when nobody is there: the packets that wait meanwhile are lost, those after it are not."""
    host.manners.answers = [None]
    served.send(packet(50))
    served.send(packet(60))
    host.pump(10, lambda: bool(served.link.errors))
    served.wait_error(NAMES["silent"][stack])
    assert served.link.lost_packets
    assert_works(served, host)
    assert not host.heard or packet(60) not in host.heard


def test_two_talkers_on_one_id(served: Served, host: End, bus: str) -> None:
    """A second host breaks into messages: some are lost, which is counted, and none is made of two."""
    second = Raw(bus, [TO_HOST_ID])
    good = packet(89)
    try:
        for k in range(20):
            host.raw.send(TO_ROBOT_ID, first_frame(len(good), good))
            second.send(TO_ROBOT_ID, consecutive(5, b"\xee" * 7))
            for number, at in enumerate(range(6, len(good), 7), 1):
                host.raw.send(TO_ROBOT_ID, consecutive(number, good[at:]))
                if k % 2 and number == 4:
                    second.send(TO_ROBOT_ID, first_frame(30, b"\xee" * 6))
            host.pump(0.02)
    finally:
        second.close()
    wait_for("an error is counted", lambda: served.link.errors, PATIENCE_S)
    assert all(got == good for got in served.got)
    # The second talker's begun message would swallow what comes next.
    host.pump(1.2)
    assert_works(served, host)


def test_noise_on_the_id(served: Served, host: End, bus: str) -> None:
    """Random frames of any kind and length on the link's own id."""
    rng = random.Random(5)
    raw = Raw(bus, [0x7FF])
    try:
        for _ in range(400):
            raw.send(TO_ROBOT_ID, rng.randbytes(rng.randrange(9)))
    finally:
        raw.close()
    host.pump(1.3)
    host.raw.drain()
    assert all(len(got) == got[2] + 3 for got in served.got)
    assert_works(served, host)


def test_wait_frames_do_no_harm(served: Served, host: End) -> None:
    host.manners.answers = [WAIT]
    served.send(packet(50))
    host.pump(1.5)
    host.heard.clear()
    assert_works(served, host)


def test_interface_down_and_up(served: Served, host: End, bus: str) -> None:
    ip("link", "set", bus, "down")
    served.send(packet(50))
    wait_for("it is noticed", lambda: served.link.errors, PATIENCE_S)
    wait_for("the packet is lost, not kept", lambda: served.link.lost_packets, PATIENCE_S)
    ip("link", "set", bus, "up")
    assert_works(served, host)


def test_interface_gone_and_back(served: Served, host: End, bus: str) -> None:
    ip("link", "del", bus)
    served.send(packet(50))
    wait_for("it is noticed", lambda: served.link.errors, PATIENCE_S)
    time.sleep(0.5)
    ip("link", "add", bus, "type", "vcan")
    ip("link", "set", bus, "up")
    again = End.host(bus)
    try:
        wait_for("the link is back", lambda: again.send(PULSE) and PULSE in served.got, PATIENCE_S)
        assert_works(served, again)
    finally:
        again.close()


def test_queue_of_the_interface_full(served: Served, host: End, bus: str) -> None:
    tc("qdisc", "add", "dev", bus, "root", "bfifo", "limit", "1")
    served.send(PULSE)
    served.wait_error("ENOBUFS")
    tc("qdisc", "del", "dev", bus, "root")
    # The kernel gives up a message of which a frame was lost only after a second.
    host.pump(1.2)
    assert_works(served, host)


@pytest.mark.parametrize("options", ["pad=none", "pad=0x55", "stmin=2,bs=3", "tx=0x123,rx=0x321", "robot=7"])
def test_options_reach_the_bus(bus: str, stack: str, options: str) -> None:
    spec = parse_spec(f"{bus},{options},stack={stack}")
    link = CanLink(spec)
    link.open()
    served = Served(link)
    end = End(bus, spec.rx_id, spec.tx_id)
    spy = Raw(bus, [spec.tx_id, spec.rx_id])
    try:
        assert_works(served, end)
        sent = [one for one in spy.drain() if one.id == spec.tx_id]
    finally:
        served.end()
        end.close()
        spy.close()
    control = next(one.data for one in sent if one.data[0] >> 4 == 3)
    assert tuple(control[1:3]) == (spec.bs, spec.stmin)
    last = max((one.data for one in sent if one.data[0] >> 4 == 2), key=lambda data: data[0])
    if spec.pad is None:
        assert len(control) == 3
        assert len(last) < 8
    else:
        assert control[3:] == bytes((spec.pad,)) * 5
        assert len(last) == 8
        assert last[-1] == spec.pad


def test_block_size_makes_the_robot_wait(served: Served, host: End) -> None:
    """A host may ask for a flow control after every two frames."""
    data = packet(50)
    served.send(data)
    got = host.raw.wait("a first frame", lambda one: one.data[0] >> 4 == 1)
    body = got.data[2:]
    while len(body) < len(data):
        host.raw.send(TO_ROBOT_ID, flow_control(CONTINUE, blocksize=2))
        for _ in range(2):
            if len(body) < len(data):
                body += host.raw.wait("a consecutive frame", lambda one: one.data[0] >> 4 == 2).data[1:]
        assert host.raw.receive(0.05) is None, "it did not wait"
    assert body[: len(data)] == data


@pytest.fixture
def reason(stack: str) -> Callable[[str], str]:
    """Why a link cannot be opened."""

    def ask(spec: str) -> str:
        link = CanLink(parse_spec(f"{spec},stack={stack}"))
        with pytest.raises(LinkError) as caught:
            link.open()
        link.close()
        return str(caught.value)

    return ask


def test_missing_interface_is_named_with_the_command(reason: Callable[[str], str]) -> None:
    assert "no interface vcan9" in reason("vcan9")
    assert "make it: ip link add vcan9 type vcan && ip link set vcan9 up" in reason("vcan9")
    assert "plug the adapter in" in reason("can0")


def test_an_interface_that_is_no_bus(reason: Callable[[str], str]) -> None:
    assert "lo is no CAN interface" in reason("lo")


def test_fd_on_a_classic_bus(reason: Callable[[str], str]) -> None:
    with interface("vclassic", "mtu", "16") as bus:
        assert "classic CAN only" in reason(f"{bus},fd")


def test_an_interface_that_is_down_is_waited_for(bus: str, stack: str) -> None:
    ip("link", "set", bus, "down")
    link = CanLink(parse_spec(f"{bus},stack={stack}"))
    link.open()
    served = Served(link)
    host = End.host(bus)
    try:
        ip("link", "set", bus, "up")
        assert_works(served, host)
    finally:
        served.end()
        host.close()
