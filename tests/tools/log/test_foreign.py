# SPDX-License-Identifier: MIT
"""Rule: of a healthy robot in a plant that is not ours `argus-log faults` names no sonar, in at most 10 lines, wherever
the log ends; and it is not that it would name none there: one that is made to fail in the same drive is found."""

from __future__ import annotations

import gzip
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

import pytest
from argus_tools.log.cli import main
from argus_tools.log.summary import Summary

from hil_sim.arcos import Unframer, frame
from hil_sim.core.library import Core

FOREIGN: Final = Path(__file__).resolve().parents[3] / "tests" / "data" / "foreign"
CAPTURES: Final = ("argusd_aml_cone.rec.gz", "argusd_office_cone.rec.gz", "wander_corridor_ray.jsonl.gz")
LINES_MAX: Final = 10
NAMED: Final = re.compile(r"sonar/(front|rear)/\d\d|disabled|suspects at once")
EVERY_SIPS: Final = 20
SIPS_MIN: Final = 3000
FAILS_S: Final = 120.0
SIP_TYPES: Final = (0x32, 0x33)
SONARS_AT: Final = 19
Alter = Callable[[int], int]


@pytest.mark.parametrize("name", CAPTURES)
def test_nothing_is_named_and_little_is_printed(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["faults", str(FOREIGN / name)]) == 0
    out = capsys.readouterr().out
    assert len(out.splitlines()) <= LINES_MAX
    assert not NAMED.search(out), out


@pytest.mark.parametrize("name", CAPTURES)
def test_the_diagnosis_itself_names_none(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["faults", "--json", str(FOREIGN / name)]) == 0
    events = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [event for event in events if event["event"] in ("SONAR_NAMED", "SONAR_DISABLED")] == []
    assert events[-1]["kind"] == [""] * 16


@pytest.mark.parametrize("name", CAPTURES)
def test_no_sonar_is_named_wherever_the_log_ends(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The lines that would be printed if the log ended there, each two seconds."""
    said: list[str] = []
    sips = 0
    cores: list[Core] = []
    see, receive = Summary.see, Core.receive

    def seen(self: Summary, t: float | None, is_sip: bool) -> None:
        nonlocal sips
        see(self, t, is_sip)
        sips += is_sip
        if cores and is_sip and sips % EVERY_SIPS == 0:
            said.extend(self.lines(cores[-1].status(), 0))

    def received(self: Core, now_ms: int, data: bytes) -> None:
        cores[:] = [self]
        receive(self, now_ms, data)

    monkeypatch.setattr(Summary, "see", seen)
    monkeypatch.setattr(Core, "receive", received)
    assert main(["faults", str(FOREIGN / name)]) == 0
    capsys.readouterr()
    assert sips > SIPS_MIN
    assert len(said) >= sips // EVERY_SIPS - 1
    assert [line for line in said if NAMED.search(line)] == []


def altered(packet: bytes, sonar: int, alter: Alter) -> bytes:
    """A SIP in which one sonar reads something else; any other packet as it is."""
    data = bytearray(packet)
    if data[0] not in SIP_TYPES:
        return packet
    for at in range(SONARS_AT + 1, SONARS_AT + 1 + 3 * data[SONARS_AT], 3):
        if data[at] == sonar:
            mm = alter(int.from_bytes(data[at + 1 : at + 3], "little"))
            data[at + 1 : at + 3] = mm.to_bytes(2, "little")
    return bytes(data)


def failing(sonar: int, alter: Alter) -> Iterator[str]:
    """The lines of the drive, one sonar failing in it after two minutes."""
    unframer = Unframer()
    with gzip.open(FOREIGN / "wander_corridor_ray.jsonl.gz", "rt") as file:
        for line in file:
            row = json.loads(line)
            if row["dir"] == "r2c":
                packets = unframer.feed(bytes.fromhex(row["hex"]), row["t"] * 1000)
                late = row["t"] >= FAILS_S
                row["hex"] = b"".join(frame(altered(p, sonar, alter) if late else p) for p in packets).hex()
            if row["hex"]:
                yield json.dumps(row)


@pytest.mark.tour(2)
@pytest.mark.parametrize(
    ("sonar", "alter", "kind"),
    [
        (3, lambda _mm: 5000, "off"),
        (3, lambda mm: mm // 2, "wrong"),
        # Where it would read beyond the longest it reads none: gaps, too.
        (12, lambda mm: mm + 400, "(?:wrong|intermittent)"),
        (12, lambda _mm: 100, "stuck"),
        (3, lambda _mm: 65535, "off"),
    ],
    ids=["off", "half", "longer", "least", "most"],
)
def test_one_that_fails_there_is_found_and_no_other(
    tmp_path: Path, sonar: int, alter: Alter, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "failing.jsonl"
    path.write_text("\n".join(failing(sonar, alter)) + "\n")
    assert main(["faults", str(path)]) == 1
    out = capsys.readouterr().out
    (line,) = (line for line in out.splitlines() if NAMED.search(line))
    where = "front" if sonar < 8 else "rear"
    assert re.match(rf"sonar/{where}/{sonar:02}\s+disabled as {kind} at \+\d", line), out
    assert "15 of 16 sonars healthy" in out
