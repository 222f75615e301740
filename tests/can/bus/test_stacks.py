# SPDX-License-Identifier: MIT
"""Rule: the kernel's ISO-TP and can-isotp's in user space are the same on the bus, frame by frame, in every pairing."""

from __future__ import annotations

import itertools
import random
import time

import pytest
from canbus import Raw, Served, interface, packet

from hil_sim.links.can import PACKET_MAX, CanLink
from hil_sim.links.can_spec import TO_HOST_ID, TO_ROBOT_ID, parse_spec

SIZES = (6, 7, 8, 13, 14, 20, 55, 62, 63, 64, 89, 200, PACKET_MAX)
LAST = bytes.fromhex("FAFB03010001")  # like none of the packets before it: to wait for it is to wait for all
PAIRS = tuple(itertools.product(("kernel", "user"), repeat=2))


def served(text: str) -> Served:
    """A link in a thread."""
    link = CanLink(parse_spec(text))
    link.open()
    return Served(link)


def traffic(bus: str, options: str, robot: str, host: str) -> list[tuple[int, bytes, bool]]:
    """Frames of one conversation: each packet to the robot and back, on the stacks named."""
    spy = Raw(bus, [TO_HOST_ID, TO_ROBOT_ID], fd=True)
    robot_end = served(f"{bus},{options}stack={robot}")
    host_end = served(f"{bus},{options}tx=0x{TO_ROBOT_ID:X},rx=0x{TO_HOST_ID:X},stack={host}")
    try:
        for size in SIZES:
            for sender, taker in ((host_end, robot_end), (robot_end, host_end)):
                sender.send(packet(size))
                taker.wait_packet(packet(size))
                taker.got.clear()
        assert not robot_end.link.errors
        assert not host_end.link.errors
    finally:
        robot_end.end()
        host_end.end()
    frames = [(one.id, one.data, one.fd) for one in spy.drain()]
    spy.close()
    return frames


@pytest.mark.parametrize("options", ["", "pad=none,", "bs=4,stmin=1,", "fd,"])
def test_every_pairing_puts_the_same_frames_on_the_bus(options: str) -> None:
    with interface("vstacks") as bus:
        seen = {pair: traffic(bus, options, *pair) for pair in PAIRS}
    expected = seen["kernel", "kernel"]
    assert len(expected) > 2 * len(SIZES)
    assert all(fd == ("fd" in options) for _, _, fd in expected)
    for pair, frames in seen.items():
        different = [(a, b) for a, b in itertools.zip_longest(expected, frames) if a != b]
        assert not different, f"{pair}: {len(different)} frames differ, first {different[0]}"


def test_a_stack_takes_what_the_other_calls_wrong() -> None:
    """Random frames: whatever messages the two make of them, they are the same."""
    rng = random.Random(11)
    with interface("vstacks") as bus:
        ends = {stack: served(f"{bus},stack={stack}") for stack in ("kernel", "user")}
        raw = Raw(bus, [0x7FE])
        try:
            for _ in range(100):
                good = packet(rng.choice(SIZES[:8]))
                if len(good) <= 7:
                    frames = [bytes((len(good),)) + good]
                else:
                    frames = [bytes((0x10, len(good))) + good[:6]]
                    frames += [
                        bytes((0x20 | n & 15,)) + good[at : at + 7]
                        for n, at in enumerate(range(6, len(good), 7), 1)
                    ]
                if rng.random() < 0.3:
                    frames.pop(rng.randrange(len(frames)))
                for data in frames:
                    raw.send(TO_ROBOT_ID, data)
                time.sleep(0.01)  # a socket holds some 300 frames, and drops the rest
            raw.send(TO_ROBOT_ID, bytes((len(LAST),)) + LAST)
            for end in ends.values():
                end.wait_packet(LAST)
        finally:
            raw.close()
            for end in ends.values():
                end.end()
    assert ends["kernel"].got == ends["user"].got
    assert len(ends["kernel"].got) > 50
    assert sum(ends["kernel"].link.errors.values()) > 2
