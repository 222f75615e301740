# SPDX-License-Identifier: MIT
"""The conformance checks: each drives a client and says what it observed, or what went against its expectation."""

from __future__ import annotations

import itertools
import math
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from hil_sim.arcos import (
    BAUD_OF_CODE,
    COMMAND,
    FLAG,
    SIP,
    TIMING,
    TYPE,
    Command,
    ConfigPac,
    EncoderPac,
    IoPac,
    Packet,
    SimStat,
    Sip,
    SyncEcho,
    SyncReply,
    frame,
)
from hil_sim.conformance.client import PATIENCE_S, QUIET_S, Client, Failed, NotApplicable

Run = Callable[[Client], str]
_TURN: Final = SIP["TURN"]
_PER_ARRAY: Final = TIMING["TRANSDUCERS_PER_ARRAY"]
_ARRAY_FLAGS: Final = (FLAG["SONAR1"], FLAG["SONAR2"])
_ALL_SONAR_FLAGS: Final = FLAG["SONAR1"] | FLAG["SONAR2"] | FLAG["SONAR3"] | FLAG["SONAR4"]


@dataclass(frozen=True)
class Check:
    """One check: its group and name, what it expects, and whether the robot moves or its motors come on."""

    group: str
    name: str
    expects: str
    motion: bool
    run: Run

    @property
    def title(self) -> str:
        """GROUP/NAME, as `--only` takes it."""
        return f"{self.group}/{self.name}"


CHECKS: Final[list[Check]] = []


def check(group: str, motion: bool = False) -> Callable[[Run], Run]:
    """Register a check: its name is the function's, what it expects is its docstring."""

    def register(run: Run) -> Run:
        name, expects = run.__name__.replace("_", "-"), (run.__doc__ or "").rstrip(".")
        CHECKS.append(Check(group, name, expects, motion, run))
        return run

    return register


def require(fine: bool, observed: str) -> str:
    """Return what was observed, or fail with it."""
    if not fine:
        raise Failed(observed)
    return observed


def _framed(name: str, value: int | None = None) -> bytes:
    number = COMMAND[name]
    return frame((Command(number) if value is None else Command.integer(number, value)).data)


def _names(packets: Sequence[Packet]) -> str:
    return ", ".join(f"type 0x{packet.data[0]:02X}" for packet in packets) or "silence"


def _packets(client: Client, seconds: float) -> list[Packet]:
    return [heard.packet for heard in client.hear(seconds)]


def _several(client: Client, count: int) -> list[Packet]:
    """The next `count` packets, or fewer when no more come."""
    found: list[Packet] = []
    while len(found) < count:
        heard = client.hear(PATIENCE_S / 2, lambda _: True)
        if not heard:
            break
        found.append(heard[-1].packet)
    return found


# ---- handshake


@check("handshake")
def silent_before_sync(client: Client) -> str:
    """Nothing is sent before the client speaks."""
    client.fresh()
    packets = _packets(client, 0.5)
    return require(not packets, _names(packets))


@check("handshake")
def three_syncs(client: Client) -> str:
    """SYNC0 and SYNC1 echoed; SYNC2 answered by name, class Pioneer, subclass."""
    client.fresh()
    first, second, third = client.sync("PULSE"), client.sync("OPEN"), client.sync("CLOSE")
    if not isinstance(third, SyncReply):
        raise Failed(_names([packet for packet in (first, second, third) if packet is not None]))
    fine = first == SyncEcho(0) and second == SyncEcho(1) and third.robot_class == b"Pioneer"
    return require(
        fine, " ".join(s.decode("latin-1") for s in (third.name, third.robot_class, third.subclass))
    )


@check("handshake")
def sync0_repeated(client: Client) -> str:
    """SYNC0 repeated is echoed again."""
    client.fresh()
    replies = [client.sync("PULSE") for _ in range(3)]
    return require(replies == [SyncEcho(0)] * 3, f"{sum(r is not None for r in replies)} of 3 echoed")


@check("handshake")
def syncs_in_one_write(client: Client) -> str:
    """Three SYNCs in one write get three answers."""
    client.fresh()
    client.send(_framed("PULSE") + _framed("OPEN") + _framed("CLOSE"))
    packets = _several(client, 3)
    fine = (
        len(packets) == 3 and packets[:2] == [SyncEcho(0), SyncEcho(1)] and isinstance(packets[2], SyncReply)
    )
    return require(fine, _names(packets))


@check("handshake")
def sync2_repeated(client: Client) -> str:
    """SYNC2 repeated before OPEN is answered again."""
    client.fresh()
    replies = [client.sync(name) for name in ("PULSE", "OPEN", "CLOSE", "CLOSE")]
    return require(
        isinstance(replies[3], SyncReply), f"second answer: {_names([r for r in replies[3:] if r])}"
    )


@check("handshake")
def sync1_first(client: Client) -> str:
    """SYNC1 first is ignored, and the server goes on waiting for SYNC0."""
    client.waiting()
    early = client.sync("OPEN", QUIET_S)
    echo = client.sync("PULSE")
    observed = f"SYNC1: {_names([early] if early else [])}; SYNC0: {_names([echo] if echo else [])}"
    return require(early is None and echo == SyncEcho(0), observed)


@check("handshake")
def sync2_too_early(client: Client) -> str:
    """SYNC2 after SYNC0 is ignored."""
    client.waiting()
    client.sync("PULSE")
    early = client.sync("CLOSE", QUIET_S)
    return require(early is None, _names([early] if early else []))


@check("handshake")
def junk_before(client: Client) -> str:
    """Junk before a packet is skipped (WMS2, header bytes)."""
    client.fresh()
    client.send(b"WMS2\r" + b"\xfa\xfa\x00\xfb" + _framed("PULSE"))
    packets = _several(client, 1)
    return require(packets == [SyncEcho(0)], _names(packets))


@check("handshake")
def byte_by_byte(client: Client) -> str:
    """A packet that comes byte by byte is heard."""
    client.fresh()
    for byte in _framed("PULSE"):
        client.send(bytes((byte,)))
        time.sleep(0.005)
    packets = _several(client, 1)
    return require(packets == [SyncEcho(0)], _names(packets))


@check("handshake")
def bad_checksum(client: Client) -> str:
    """A packet with a bad checksum is ignored, the next one heard."""
    client.fresh()
    client.send(_framed("PULSE")[:-1] + b"\x01")
    bad = _packets(client, QUIET_S)
    echo = client.sync("PULSE")
    return require(
        not bad and echo == SyncEcho(0), f"bad one: {_names(bad)}; next: {_names([echo] if echo else [])}"
    )


@check("handshake")
def open_forms(client: Client) -> str:
    """OPEN is taken with and without argument."""
    for value in (None, 1):
        client.fresh()
        for name in ("PULSE", "OPEN", "CLOSE"):
            client.sync(name)
        client.command("OPEN", value)
        client.in_session = True
        client.sips(2)
    return "SIPs after both"


@check("handshake")
def close_keeps_the_line(client: Client) -> str:
    """CLOSE ends the SIPs, the line stays, and SYNC0 is echoed on it."""
    client.start()
    client.command("CLOSE", 1)
    client.in_session = False
    client.hear(0.2)
    if not client.connected:
        raise Failed("the server closed the connection")
    late = [packet for packet in _packets(client, QUIET_S) if isinstance(packet, Sip)]
    echo = client.sync("PULSE")
    return require(
        not late and echo == SyncEcho(0), f"{len(late)} late SIPs; SYNC0: {_names([echo] if echo else [])}"
    )


@check("handshake")
def second_client(client: Client) -> str:
    """A client that vanished in a session is followed by one that connects."""
    client.start()
    client.in_session = False
    client.start()
    return "connected again"


# ---- the SIP stream


@check("sip")
def rate(client: Client) -> str:
    """The rate is the SIPCYCLE of the CONFIGpac, within 3 %."""
    client.start()
    cycle_ms = _config(client).sip_cycle_ms or TIMING["SIP_CYCLE_MS"]
    # On a slow line the SIPs right after a CONFIGpac come late.
    client.sips(5)
    times = [t for t, _ in client.timed_sips(31)]
    mean = (times[-1] - times[0]) / 30 * 1000
    return require(abs(mean - cycle_ms) <= 0.03 * cycle_ms, f"{mean:.1f} ms of {cycle_ms} ms")


@check("sip")
def jitter(client: Client) -> str:
    """Nine in ten SIPs come within 30 % of a cycle of their time."""
    client.start()
    times = [t * 1000 for t, _ in client.timed_sips(41)]
    gaps = [b - a for a, b in itertools.pairwise(times)]
    off = sorted(abs(gap - statistics.median(gaps)) for gap in gaps)
    limit = 0.3 * statistics.median(gaps)
    return require(off[35] <= limit, f"p50 {off[20]:.1f} ms, p90 {off[35]:.1f} ms, max {off[-1]:.1f} ms")


@check("sip")
def first_sip(client: Client) -> str:
    """A session starts at (0, 0, 0), motors off, sonar on."""
    client.start()
    (sip,) = client.sips(1)
    fine = (sip.x, sip.y, sip.th, sip.flags & 1) == (0, 0, 0, 0) and sip.flags & _ALL_SONAR_FLAGS != 0
    return require(fine, f"x {sip.x} y {sip.y} th {sip.th} flags 0x{sip.flags:04X}")


@check("sip")
def type_at_rest(client: Client) -> str:
    """Type 0x32 at rest."""
    client.start()
    types = {sip.type for sip in client.sips(5)}
    return require(types == {TYPE["SIP_STATIONARY"]}, " ".join(f"0x{kind:02X}" for kind in sorted(types)))


@check("sip")
def length(client: Client) -> str:
    """Fields up to FAULTFLAGS, and no more."""
    client.start()
    (sip,) = client.sips(1)
    count = len(sip.data) + 2 - SIP["SONAR_BYTES"] * len(sip.sonars)
    return require(
        count == SIP["COUNT_BARE"], f"COUNT {count} without readings, {SIP['COUNT_BARE']} expected"
    )


@check("sip")
def ignored_commands(client: Client) -> str:
    """Unknown commands and accessories a P3-DX lacks are ignored, the stream goes on."""
    client.start()
    numbers = [14, 46, 64, 69, 94, 130, 199] + [
        COMMAND[name]
        for name in ("SAY", "GRIPPER", "TCM2", "GYRO", "BATTERYINFO", "PLAYLIST", "LATVEL", "CHARGE")
    ]
    for number in numbers:
        client.send(frame(Command(number).data))
        client.send(frame(Command.integer(number, 1).data))
        client.hear(0.02)
    packets = [heard.packet for heard in client.hear(1.0)]
    others = [packet for packet in packets if not isinstance(packet, Sip)]
    sips = len(packets) - len(others)
    return require(sips >= 8 and not others, f"{sips} SIPs in 1 s, others: {_names(others)}")


# ---- packets on request


def _config(client: Client) -> ConfigPac:
    client.command("CONFIG", 1)
    packet = client.answer(ConfigPac)
    if not isinstance(packet, ConfigPac):
        raise Failed("no CONFIGpac")
    return packet


@check("packets")
def config(client: Client) -> str:
    """CONFIGpac with and without argument: subclass of SYNC2, watchdog, cycles, ceilings above settings."""
    client.start()
    packet = _config(client)
    client.command("CONFIG")
    again = client.answer(ConfigPac)
    subclass = client.identity.subclass if client.identity else b""
    observed = (
        f"{packet.subtype!r} cycles {packet.sip_cycle_ms}/{packet.sonar_cycle_ms} ms, watchdog {packet.watchdog_ms} ms,"
        f" top {packet.trans_vel_top} mm/s {packet.rot_vel_top} deg/s, revcount {packet.rev_count}"
    )
    plausible = bool(
        packet.sip_cycle_ms and packet.sonar_cycle_ms and packet.watchdog_ms and packet.rev_count
    )
    tops = (packet.trans_vel_top or 0) >= (packet.trans_vel_max or 0) > 0
    return require(again == packet and packet.subtype == subclass and plausible and tops, observed)


def _on_request(client: Client, name: str, kind: type[Packet]) -> str:
    client.start()
    client.command(name, 1)
    once = [packet for packet in _packets(client, 0.8) if isinstance(packet, kind)]
    client.command(name, 2)
    client.sips(1)
    stream = client.hear(1.6)
    client.command(name, 0)
    client.hear(0.4)
    after = [packet for packet in _packets(client, 0.6) if isinstance(packet, kind)]
    streamed = sum(isinstance(heard.packet, kind) for heard in stream)
    sips = sum(isinstance(heard.packet, Sip) for heard in stream)
    fine = len(once) == 1 and streamed >= 3 and abs(streamed - sips) <= 2 and not after
    return require(
        fine, f"once {len(once)}, streamed {streamed} with {sips} SIPs, after the end {len(after)}"
    )


@check("packets")
def encoder(client: Client) -> str:
    """ENCODER: 1 once, 2 after each SIP, 0 off."""
    return _on_request(client, "ENCODER", EncoderPac)


@check("packets")
def io_request(client: Client) -> str:
    """IOREQUEST: 1 once, 2 after each SIP, 0 off."""
    return _on_request(client, "IOREQUEST", IoPac)


@check("packets")
def sim_stat(client: Client) -> str:
    """SIM_STAT gives the true pose (simulators only)."""
    client.start()
    client.command("SIM_STAT", 1)
    packet = client.answer(SimStat, 1.0)
    if not isinstance(packet, SimStat):
        raise NotApplicable("no SIMSTAT: not a simulator")
    return f"{packet.x_mm} mm, {packet.y_mm} mm, {packet.th_deg} deg"


@check("packets")
def adsel(client: Client) -> str:
    """ADSEL shows as ANPORT."""
    client.start()
    client.command("ADSEL", 3)
    sip = client.until("ANPORT 3", lambda sip: sip.anport == 3, 6)
    client.command("ADSEL", 0)
    return f"ANPORT {sip.anport}"


@check("packets")
def digout(client: Client) -> str:
    """DIGOUT: high byte mask, low byte values, shown as DIGOUT."""
    client.start()
    before = client.sips(1)[0].digout or 0
    client.command("DIGOUT", 0x0F05)
    try:
        sip = client.until("DIGOUT xxxx0101", lambda sip: (sip.digout or 0) == before & 0xF0 | 5, 6)
    finally:
        client.command("DIGOUT", 0x0F00 | before & 0x0F)
    return f"DIGOUT 0x{before:02X} then 0x{sip.digout:02X}"


@check("packets")
def host_baud(client: Client) -> str:
    """HOSTBAUD changes the rate until CLOSE (serial only)."""
    if client.target.is_tcp:
        raise NotApplicable("a TCP link has no rate")
    code = 2 if client.target.baud != BAUD_OF_CODE[2] else 0
    client.start()
    client.command("HOSTBAUD", code)
    client.hear(0.1)
    try:
        client.set_baud(BAUD_OF_CODE[code])
        client.hear(0.3)
        client.sips(5)
    finally:
        client.command("CLOSE", 1)
        client.in_session = False
        client.hear(0.2)
        client.set_baud(client.target.baud)
    client.start()
    return f"SIPs at {BAUD_OF_CODE[code]}, then again at {client.target.baud}"


# ---- sonar


def _arrays(client: Client) -> list[int]:
    """Start a session; the fitted arrays among the first two, at least one, all firing."""
    client.start()
    client.command("SONAR", 1)
    client.sips(3)
    flags = client.sips(1)[0].flags
    fitted = [k for k, flag in enumerate(_ARRAY_FLAGS) if flags & flag]
    if not fitted:
        raise NotApplicable("no sonar array is on after SONAR 1")
    return fitted


def _fired(sips: Sequence[Sip]) -> list[list[int]]:
    """The sonar numbers of each of the first two arrays, in the order they came."""
    numbers = [number for sip in sips for number, _ in sip.sonars]
    return [[n for n in numbers if n // _PER_ARRAY == array] for array in (0, 1)]


def is_cyclic(fired: Sequence[int], order: Sequence[int]) -> bool:
    """Whether `fired` is `order` repeated, begun anywhere in it.

    >>> is_cyclic([3, 1, 2, 3], [1, 2, 3]), is_cyclic([1, 3], [1, 2, 3])
    (True, False)
    """
    size = len(order)
    return any(
        all(number == order[(at + shift) % size] for at, number in enumerate(fired)) for shift in range(size)
    )


def _cycle_ms(client: Client) -> int:
    return _config(client).sonar_cycle_ms or 40


@check("sonar")
def only_new_readings(client: Client) -> str:
    """A SIP holds only new readings: one per array and SONARCYCLE."""
    fitted = _arrays(client)
    per_sip = TIMING["SIP_CYCLE_MS"] / _cycle_ms(client)
    sips = client.sips(20)
    counts = [len(_fired(sips)[array]) for array in fitted]
    fine = all(abs(count - 20 * per_sip) <= 3 for count in counts)
    sizes = sorted({len(sip.sonars) for sip in sips})
    return require(fine, f"{counts} readings in 20 SIPs, {sizes} a SIP; {20 * per_sip:g} expected")


@check("sonar")
def default_order(client: Client) -> str:
    """Each array fires its transducers in the order of their numbers."""
    fitted = _arrays(client)
    fired = _fired(client.sips(12))
    orders = [list(range(_PER_ARRAY * k, _PER_ARRAY * (k + 1))) for k in (0, 1)]
    return require(all(is_cyclic(fired[k], orders[k]) for k in fitted), f"{fired[fitted[0]][:12]}")


@check("sonar")
def ranges(client: Client) -> str:
    """Ranges are 100 to 5000 mm."""
    _arrays(client)
    found = [range_mm for sip in client.sips(10) for _, range_mm in sip.sonars]
    return require(
        bool(found) and min(found) >= 100 and max(found) <= 5000, f"{min(found)} to {max(found)} mm"
    )


@check("sonar")
def all_off_and_on(client: Client) -> str:
    """SONAR 0 silences all and clears FLAGS, SONAR 1 brings them back."""
    _arrays(client)
    client.command("SONAR", 0)
    client.sips(2)
    off = client.sips(3)
    client.command("SONAR", 1)
    client.sips(2)
    on = client.sips(3)
    flags = [sip.flags & _ALL_SONAR_FLAGS for sip in (off[-1], on[-1])]
    readings = [sum(len(sip.sonars) for sip in sips) for sips in (off, on)]
    return require(flags[0] == readings[0] == 0 and flags[1] > 0 and readings[1] > 0, f"{flags}, {readings}")


@check("sonar")
def array_bits(client: Client) -> str:
    """SONAR is a bit field: 2 x array + on."""
    fitted = _arrays(client)
    if len(fitted) < 2:
        raise NotApplicable("one array only")
    seen = []
    for argument, left in ((2, [1]), (3, [0, 1]), (4, [0]), (5, [0, 1])):
        client.command("SONAR", argument)
        client.sips(3)
        sips = client.sips(4)
        firing = [array for array in (0, 1) if _fired(sips)[array]]
        flagged = [array for array in (0, 1) if sips[-1].flags & _ARRAY_FLAGS[array]]
        seen.append(f"{argument}: {firing}")
        require(firing == flagged == left, f"SONAR {argument}: arrays {firing} fire, {flagged} flagged")
    return "; ".join(seen)


@check("sonar")
def sonar_cycle(client: Client) -> str:
    """SONARCYCLE 80 halves the readings, 20 doubles them."""
    fitted = _arrays(client)
    seen = []
    for cycle_ms in (80, 20):
        client.command("SONAR_CYCLE", cycle_ms)
        client.sips(2)
        count = len(_fired(client.sips(16))[fitted[0]])
        wanted = 16 * TIMING["SIP_CYCLE_MS"] / cycle_ms
        seen.append(f"{cycle_ms} ms: {count} of {wanted:g}")
        require(abs(count - wanted) <= 0.08 * wanted + 2, seen[-1])
    return "; ".join(seen)


_POLLED: Final = (
    ((1, 3, 5, 7), (1, 3, 5, 7), range(9, 17)),
    ((2, 2, 4), (2, 2, 4), range(9, 17)),
    ((16, 9, 8, 1, 9), (8, 1), (16, 9, 9)),
    ((6,), (6,), (16, 9, 9)),
)


@check("sonar")
def polling(client: Client) -> str:
    """POLLING: the readings follow the order asked for, an array not named keeps its own."""
    fitted = _arrays(client)
    for numbers, *orders in _POLLED:
        client.send(frame(Command.string(COMMAND["POLLING"], bytes(numbers)).data))
        client.sips(3)
        fired = _fired(client.sips(10))
        for array in fitted:
            order = [number - 1 for number in orders[array]]
            right = len(fired[array]) > 5 and is_cyclic(fired[array], order)
            require(right, f"POLLING {numbers}: array {array + 1} fired {fired[array][:12]}")
    return f"{len(_POLLED)} sequences"


@check("sonar")
def polling_empty(client: Client) -> str:
    """POLLING with an empty string silences the sonars, the next one brings them back."""
    _arrays(client)
    client.send(frame(Command.string(COMMAND["POLLING"], b"").data))
    client.sips(3)
    silent = sum(len(sip.sonars) for sip in client.sips(5))
    client.send(frame(Command.string(COMMAND["POLLING"], bytes((4,))).data))
    client.sips(3)
    fired = _fired(client.sips(5))[0]
    return require(silent == 0 and set(fired) == {3}, f"{silent} readings, then {fired[:6]}")


# ---- motion


def _moved(a: Sip, b: Sip) -> tuple[float, float]:
    """Distance in units of the SIP and turn in degrees from one SIP to another."""
    half = 1 << SIP["POSITION_BITS"] - 1

    def delta(new: int, old: int) -> int:
        return ((new - old + half) & 2 * half - 1) - half

    turn = ((b.th - a.th + _TURN // 2) % _TURN - _TURN // 2) * 360 / _TURN
    return math.hypot(delta(b.x, a.x), delta(b.y, a.y)), turn


def _speed(sip: Sip) -> float:
    return (sip.left_vel + sip.right_vel) / 2


def _at_rest(sip: Sip) -> bool:
    return abs(sip.left_vel) < 2 and abs(sip.right_vel) < 2


def _rest(client: Client) -> Sip:
    """Stop and return a SIP of the robot at rest."""
    client.command("VEL", 0)
    client.command("RVEL", 0)
    client.until("at rest after VEL 0, RVEL 0", _at_rest, 40)
    return client.sips(1)[0]


def _settle(client: Client, sips: int) -> Sip:
    """Wait until a motion has begun and ended; the SIP at its end."""
    client.until("the motion begins", lambda sip: not _at_rest(sip), 12)
    client.until("the motion ends", _at_rest, sips)
    return client.sips(1)[0]


def _percent(value: float, wanted: float) -> float:
    return abs(value - wanted) / abs(wanted) * 100


@check("drive", motion=True)
def enable(client: Client) -> str:
    """ENABLE shows in FLAGS bit 0."""
    client.start(motors=True)
    client.command("ENABLE", 0)
    client.until("FLAGS bit 0 clear after ENABLE 0", lambda sip: not sip.flags & 1, 10)
    return "on and off"


@check("drive", motion=True)
def motors_off(client: Client) -> str:
    """Without ENABLE the motors are off, and VEL moves nothing."""
    client.start()
    client.command("VEL", 100)
    sips = client.sips(8)
    client.command("VEL", 0)
    return require(all(map(_at_rest, sips)), f"fastest {max(abs(_speed(sip)) for sip in sips):g} mm/s")


@check("drive", motion=True)
def vel(client: Client) -> str:
    """VEL +-150: both wheels within 10 %, type 0x33, STALL clear."""
    client.start(motors=True)
    seen = []
    for wanted in (150, -150):
        client.command("VEL", wanted)
        client.sips(12)
        (sip,) = client.sips(1)
        seen.append(f"{wanted}: {sip.left_vel}/{sip.right_vel} type 0x{sip.type:02X}")
        right = _percent(sip.left_vel, wanted) < 10 and _percent(sip.right_vel, wanted) < 10
        require(right and sip.type == TYPE["SIP_MOVING"], seen[-1])
    _rest(client)
    return "; ".join(seen)


@check("drive", motion=True)
def odometry(client: Client) -> str:
    """Odometry grows as the wheel speeds say, within 5 %."""
    client.start(motors=True)
    client.command("VEL", 150)
    client.sips(12)
    sips = client.sips(11)
    way, _ = _moved(sips[0], sips[-1])
    summed = sum(_speed(sip) for sip in sips[1:]) * TIMING["SIP_CYCLE_MS"] / 1000
    client.command("VEL", -150)
    client.sips(18)
    _rest(client)
    return require(_percent(way, summed) < 5, f"{way:g} mm, speeds give {summed:.0f} mm")


@check("drive", motion=True)
def move(client: Client) -> str:
    """MOVE +-200 ends at rest 200 mm on, within 10 mm."""
    client.start(motors=True)
    seen = []
    for distance in (200, -200):
        before = _rest(client)
        client.command("MOVE", distance)
        way, _ = _moved(before, _settle(client, 60))
        seen.append(f"{distance}: {way:.0f} mm")
        require(abs(way - abs(distance)) <= 10, seen[-1])
    return "; ".join(seen)


@check("drive", motion=True)
def setv(client: Client) -> str:
    """SETV caps VEL, within 5 %."""
    client.start(motors=True)
    client.command("SETV", 120)
    client.command("VEL", 400)
    client.sips(12)
    (sip,) = client.sips(1)
    client.command("VEL", -400)
    client.sips(16)
    _rest(client)
    return require(_percent(_speed(sip), 120) < 5, f"{_speed(sip):g} mm/s")


@check("drive", motion=True)
def seta(client: Client) -> str:
    """SETA +100 -400: the speed grows by 100 mm/s in a second and falls four times as fast."""
    client.start(motors=True)
    client.command("SETA", 100)
    client.command("SETA", -400)
    client.command("VEL", 200)
    up = [_speed(sip) for sip in client.sips(24)]
    client.command("VEL", 0)
    down = [_speed(sip) for sip in client.sips(16)]
    rises = [b - a for a, b in itertools.pairwise(up) if a > 10 and b < 190]
    falls = [a - b for a, b in itertools.pairwise(down) if a < 195 and b > 2]
    if not rises or not falls:
        raise Failed(f"speeds {up[:8]} and {down[:8]}")
    rise, fall = statistics.mean(rises), statistics.mean(falls)
    cycle_s = TIMING["SIP_CYCLE_MS"] / 1000
    observed = f"{rise / cycle_s:.0f} mm/s2 up, {fall / cycle_s:.0f} mm/s2 down"
    client.command("SETA", 300)
    client.command("MOVE", -250)
    _settle(client, 60)
    return require(_percent(rise / cycle_s, 100) < 15 and _percent(fall / cycle_s, 400) < 20, observed)


@check("drive", motion=True)
def stop(client: Client) -> str:
    """STOP brakes as SETA says and leaves the motors on."""
    client.start(motors=True)
    client.command("VEL", 200)
    client.sips(12)
    client.command("STOP")
    sips = client.sips(14)
    ways = [_speed(sip) for sip in sips]
    client.command("MOVE", -220)
    _settle(client, 60)
    braking = sum(5 < speed < 195 for speed in ways)
    return require(_at_rest(sips[-1]) and braking >= 3 and bool(sips[-1].flags & 1), f"speeds {ways[:10]}")


@check("drive", motion=True)
def e_stop(client: Client) -> str:
    """E_STOP stands still within three SIPs, whatever SETA says."""
    client.start(motors=True)
    client.command("SETA", -50)
    client.command("VEL", 200)
    client.sips(12)
    client.command("E_STOP")
    speeds = [_speed(sip) for sip in client.sips(4)]
    client.command("SETA", -300)
    client.command("MOVE", -180)
    _settle(client, 60)
    return require(abs(speeds[-1]) < 10, f"speeds {speeds}")


@check("drive", motion=True)
def seto(client: Client) -> str:
    """SETO makes odometry (0, 0, 0)."""
    client.start(motors=True)
    client.command("MOVE", 120)
    far = _settle(client, 60)
    client.command("SETO")
    sip = client.until("x, y and th 0 after SETO", lambda sip: (sip.x, sip.y, sip.th) == (0, 0, 0), 6)
    client.command("MOVE", -120)
    _settle(client, 60)
    return f"x {far.x} then {sip.x}"


@check("turn", motion=True)
def rvel(client: Client) -> str:
    """RVEL +-30: ROTVEL and the heading agree within 10 %, + is left."""
    client.start(motors=True)
    seen = []
    for wanted in (30, -30):
        client.command("RVEL", wanted)
        client.sips(10)
        sips = client.sips(11)
        turn = sum(_moved(a, b)[1] for a, b in itertools.pairwise(sips))
        rate = (sips[-1].rotvel or 0) / 10
        seen.append(f"{wanted}: ROTVEL {rate:g}, turned {turn:.1f} in 1 s")
        require(_percent(turn, wanted) < 10 and _percent(rate, wanted) < 10, seen[-1])
        require((sips[-1].right_vel > sips[-1].left_vel) == (wanted > 0), seen[-1])
    _rest(client)
    return "; ".join(seen)


@check("turn", motion=True)
def rotate(client: Client) -> str:
    """ROTATE is a speed: it goes on."""
    client.start(motors=True)
    client.command("ROTATE", 25)
    client.sips(25)
    rate = (client.sips(1)[0].rotvel or 0) / 10
    _rest(client)
    return require(_percent(rate, 25) < 10, f"{rate:g} deg/s after 2.5 s")


@check("turn", motion=True)
def setrv(client: Client) -> str:
    """SETRV caps RVEL, within 5 %."""
    client.start(motors=True)
    client.command("SETRV", 20)
    client.command("RVEL", 90)
    client.sips(10)
    rate = (client.sips(1)[0].rotvel or 0) / 10
    _rest(client)
    return require(_percent(rate, 20) < 5, f"{rate:g} deg/s")


@check("turn", motion=True)
def setra(client: Client) -> str:
    """SETRA +50: the turn rate grows by 50 deg/s in a second."""
    client.start(motors=True)
    client.command("SETRA", 50)
    client.command("RVEL", 60)
    rates = [(sip.rotvel or 0) / 10 for sip in client.sips(18)]
    _rest(client)
    rises = [b - a for a, b in itertools.pairwise(rates) if a > 3 and b < 57]
    if not rises:
        raise Failed(f"rates {rates[:8]}")
    rise = statistics.mean(rises) * 1000 / TIMING["SIP_CYCLE_MS"]
    return require(_percent(rise, 50) < 15, f"{rise:.0f} deg/s2")


@check("turn", motion=True)
def head(client: Client) -> str:
    """HEAD 60, -170, 170: the shortest way to the heading, within 2 degrees."""
    client.start(motors=True)
    seen = []
    for wanted in (60, 170, -170, 0):
        client.command("HEAD", wanted)
        end = _settle(client, 60)
        angle = (end.th * 360 / _TURN + 180) % 360 - 180
        seen.append(f"{wanted}: {angle:.1f}")
        require(abs((angle - wanted + 180) % 360 - 180) <= 2, seen[-1])
    return "; ".join(seen)


@check("turn", motion=True)
def dhead(client: Client) -> str:
    """DHEAD +-45 turns by 45 degrees from here, within 2."""
    client.start(motors=True)
    seen = []
    for wanted in (45, -45):
        before = _rest(client)
        client.command("DHEAD", wanted)
        _, turn = _moved(before, _settle(client, 40))
        seen.append(f"{wanted}: {turn:.1f}")
        require(abs(turn - wanted) <= 2, seen[-1])
    return "; ".join(seen)


@check("turn", motion=True)
def dchead(client: Client) -> str:
    """DCHEAD turns relative to the heading set point."""
    client.start(motors=True)
    before = _rest(client)
    client.command("DHEAD", 40)
    client.command("DCHEAD", -20)
    _, turn = _moved(before, _settle(client, 40))
    return require(abs(turn - 20) <= 2, f"{turn:.1f} degrees after DHEAD 40, DCHEAD -20")


@check("turn", motion=True)
def vel2(client: Client) -> str:
    """VEL2: left wheel in the high byte, right in the low, 20 mm/s; both encodings; VEL ends it."""
    client.start(motors=True)
    seen = []
    raw = frame(Command(COMMAND["VEL2"], bytes((0x3B, 3, 0xFB))).data)
    for data in (frame(Command.pair(COMMAND["VEL2"], -5, 3).data), raw):
        client.send(data)
        client.sips(10)
        (sip,) = client.sips(1)
        seen.append(f"{sip.left_vel}/{sip.right_vel}")
        require(abs(sip.left_vel + 100) <= 10 and abs(sip.right_vel - 60) <= 10, seen[-1])
        _rest(client)
    return "; ".join(seen)


@check("safety", motion=True)
def watchdog(client: Client) -> str:
    """The watchdog stops the robot 2 s after the last packet, SIPs go on; a PULSE resumes."""
    client.start(motors=True)
    client.command("VEL", 100)
    client.sips(8)
    client.pulses = False
    client.command("PULSE")
    # The limit of the check: watchdog, braking from 100 mm/s at 300 mm/s2, and half a second for the link.
    sips = client.sips(30)
    client.pulses = True
    moving = [k for k, sip in enumerate(sips) if abs(_speed(sip)) > 50]
    observed = f"last above 50 mm/s {(moving[-1] + 1) / 10 if moving else 0:.1f} s after the last packet"
    require(_at_rest(sips[-1]) and bool(moving) and 17 <= moving[-1] + 1 <= 25, observed)
    client.command("PULSE")
    client.until("the robot takes up its set point again", lambda sip: _speed(sip) > 80, 15)
    client.command("MOVE", -350)
    _settle(client, 60)
    return observed


@check("safety", motion=True)
def close_in_motion(client: Client) -> str:
    """CLOSE in motion: at rest and motors off at the next session."""
    client.start(motors=True)
    client.command("VEL", 150)
    client.sips(8)
    client.start()
    (sip,) = client.sips(1)
    flags = f"speed {_speed(sip):g}, flags 0x{sip.flags:04X}"
    client.command("ENABLE", 1)
    client.command("MOVE", -120)
    _settle(client, 60)
    return require(_at_rest(sip) and not sip.flags & 1, flags)


@check("safety", motion=True)
def defaults_after_close(client: Client) -> str:
    """Run-time settings return to their defaults with CLOSE."""
    client.start()
    before = _config(client)
    client.command("SETV", 111)
    client.command("SETA", 77)
    client.command("SONAR_CYCLE", 60)
    changed = _config(client)
    client.start()
    after = _config(client)
    observed = f"SETV {before.trans_vel_max}, {changed.trans_vel_max}, {after.trans_vel_max}"
    fine = changed.trans_vel_max == 111 and changed.trans_acc == 77 and after == before
    return require(fine, observed)


GROUPS: Final = tuple(dict.fromkeys(item.group for item in CHECKS))
