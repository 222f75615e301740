# SPDX-License-Identifier: MIT
"""Checks of the sonars: which fire, when, and what is reported."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from hil_sim.arcos import (
    COMMAND,
    TIMING,
    Command,
    Sip,
    frame,
)
from hil_sim.conformance.ask import ARRAY_FLAGS, config_of
from hil_sim.conformance.check import Group, require
from hil_sim.conformance.client import Client, NotApplicable

CHECKS: Final = Group()


_PER_ARRAY: Final = TIMING["TRANSDUCERS_PER_ARRAY"]
_ALL_SONAR_FLAGS: Final = sum(ARRAY_FLAGS)


def _arrays(client: Client) -> list[int]:
    """Start a session; the fitted arrays, at least one, all firing."""
    client.start()
    client.command("SONAR", 1)
    client.sips(3)
    flags = client.sips(1)[0].flags
    fitted = [k for k, flag in enumerate(ARRAY_FLAGS) if flags & flag]
    if not fitted:
        raise NotApplicable("no sonar array is on after SONAR 1")
    return fitted


def _fired(sips: Sequence[Sip]) -> list[list[int]]:
    """The sonar numbers of each array, in the order they came."""
    numbers = [number for sip in sips for number, _ in sip.sonars]
    return [[n for n in numbers if n // _PER_ARRAY == array] for array in range(len(ARRAY_FLAGS))]


def is_cyclic(fired: Sequence[int], order: Sequence[int]) -> bool:
    """Whether `fired` is `order` repeated, begun anywhere in it.

    >>> is_cyclic([3, 1, 2, 3], [1, 2, 3]), is_cyclic([1, 3], [1, 2, 3])
    (True, False)
    """
    size = len(order)
    return any(
        all(number == order[(at + shift) % size] for at, number in enumerate(fired)) for shift in range(size)
    )


def _default_order(array: int) -> list[int]:
    return list(range(_PER_ARRAY * array, _PER_ARRAY * (array + 1)))


def _cycle_ms(client: Client) -> int:
    return config_of(client).sonar_cycle_ms or 40


@CHECKS.check("sonar")
def only_new_readings(client: Client) -> str:
    """A SIP holds only new readings: one per array and SONARCYCLE."""
    fitted = _arrays(client)
    per_sip = TIMING["SIP_CYCLE_MS"] / _cycle_ms(client)
    sips = client.sips(20)
    counts = [len(_fired(sips)[array]) for array in fitted]
    fine = all(abs(count - 20 * per_sip) <= 3 for count in counts)
    sizes = sorted({len(sip.sonars) for sip in sips})
    return require(fine, f"{counts} readings in 20 SIPs, {sizes} a SIP; {20 * per_sip:g} expected")


@CHECKS.check("sonar")
def default_order(client: Client) -> str:
    """Each array fires its transducers in the order of their numbers."""
    fitted = _arrays(client)
    fired = _fired(client.sips(12))
    return require(all(is_cyclic(fired[k], _default_order(k)) for k in fitted), f"{fired[fitted[0]][:12]}")


@CHECKS.check("sonar")
def ranges(client: Client) -> str:
    """Ranges are 100 to 5000 mm."""
    _arrays(client)
    found = [range_mm for sip in client.sips(10) for _, range_mm in sip.sonars]
    return require(
        bool(found) and min(found) >= 100 and max(found) <= 5000, f"{min(found)} to {max(found)} mm"
    )


@CHECKS.check("sonar")
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


def _switched(client: Client, argument: int) -> tuple[list[int], list[int]]:
    """The arrays that fire, and those of which FLAGS say so, after a SONAR command."""
    client.command("SONAR", argument)
    client.sips(3)
    sips = client.sips(4)
    firing = [k for k, numbers in enumerate(_fired(sips)) if numbers]
    return firing, [k for k, flag in enumerate(ARRAY_FLAGS) if sips[-1].flags & flag]


@CHECKS.check("sonar")
def array_bits(client: Client) -> str:
    """SONAR is a bit field: 2 x array + on."""
    fitted = _arrays(client)
    if len(fitted) < 2:
        raise NotApplicable("one array only")
    seen = []
    for array in fitted:
        for on in (False, True):
            argument = 2 * (array + 1) + on
            firing, flagged = _switched(client, argument)
            seen.append(f"{argument}: {firing}")
            left = [k for k in fitted if on or k != array]
            require(firing == flagged == left, f"SONAR {argument}: arrays {firing} fire, {flagged} flagged")
    return "; ".join(seen)


@CHECKS.check("sonar")
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


@CHECKS.check("sonar")
def polling(client: Client) -> str:
    """POLLING: the readings follow the order asked for, an array not named keeps its own."""
    fitted = _arrays(client)
    for numbers, *orders in _POLLED:
        client.send(frame(Command.string(COMMAND["POLLING"], bytes(numbers)).data))
        client.sips(3)
        fired = _fired(client.sips(10))
        for array in fitted:
            order = [n - 1 for n in orders[array]] if array < len(orders) else _default_order(array)
            right = len(fired[array]) > 5 and is_cyclic(fired[array], order)
            require(right, f"POLLING {numbers}: array {array + 1} fired {fired[array][:12]}")
    return f"{len(_POLLED)} sequences"


@CHECKS.check("sonar")
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
