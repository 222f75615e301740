# SPDX-License-Identifier: MIT
"""Rule: the demo's drive over CAN ends as over a pty, and its telemetry tells of it, within its share of the bus."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import pytest
from canbus import Drive, Frame, load_dbc, stuffed_bits, worst_bits
from harness import PYTHON, ROOT, run_python

from hil_sim.links.can_spec import TO_HOST_ID, TO_ROBOT_ID

BIT_RATE = 500_000
TELEMETRY_PART, ALL_PART = 0.02, 0.06
DBC = load_dbc()
IDS = {message.frame_id: message for message in DBC.messages}
LINK_IDS = (TO_ROBOT_ID, TO_HOST_ID)
SONARS = 16


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Drive]:
    """The demonstration over CAN: one drive, about which all tests of this file ask."""
    result = Drive(tmp_path_factory.mktemp("drive"))
    yield result
    result.end()


@pytest.fixture(scope="module")
def frames(drive: Drive) -> list[Frame]:
    """Everything that was on the bus, after the drive."""
    return drive.frames()


def decoded(frames: list[Frame], name: str) -> list[tuple[float, dict[str, Any]]]:
    """Time and signals of all frames of one message."""
    message = DBC.get_message_by_name(name)
    found: list[tuple[float, dict[str, Any]]] = []
    for one in frames:
        if one.id == message.frame_id:
            signals: Any = message.decode(one.data)
            found.append((one.t_s, signals))
    return found


def text(value: object) -> str:
    """A signal's value in words."""
    return str(getattr(value, "name", value))


def test_the_judge_is_content(drive: Drive) -> None:
    """The same judge, rules and faults as on a pty."""
    code, said = drive.verdict()
    assert code == 0, f"{said}\n{drive.errors()}"
    verdict: Mapping[str, Any] = json.loads(said)
    assert verdict["passed"], verdict["rules"]
    diagnosis = {finding["fault"]["sonar"]: finding["diagnosed_kind"] for finding in verdict["findings"]}
    assert diagnosis == {3: "off", 6: "wrong"}


def test_every_frame_is_the_links_or_described_by_the_dbc(frames: list[Frame]) -> None:
    known = {*IDS, *LINK_IDS}
    assert {one.id for one in frames} <= known
    for one in frames:
        if one.id in IDS:
            IDS[one.id].decode(one.data)


def test_every_telemetry_id_appears_in_time(frames: list[Frame]) -> None:
    """All but the orders, and the cyclic ones as often as the DBC says; the rear array reports too.

    None of sonars that this robot has not got.
    """
    span_s = frames[-1].t_s - frames[0].t_s
    count = Counter(one.id for one in frames)
    for message in DBC.messages:
        if message.name == "ArgusCommand":
            continue
        sonars = [int(signal.name[1:3]) for signal in message.signals if re.match(r"S\d\d_", signal.name)]
        if min(sonars, default=0) >= SONARS:
            assert count[message.frame_id] == 0, message.name
            continue
        assert count[message.frame_id] > 0, f"{message.name} never came"
        if message.cycle_time:
            assert count[message.frame_id] >= 0.9 * span_s * 1000 / message.cycle_time, message.name


def test_heartbeat(frames: list[Frame]) -> None:
    beats = decoded(frames, "ArgusHeartbeat")
    gaps = [b[0] - a[0] for a, b in pairwise(beats)]
    assert max(gaps) < 1.5, "a receiver would think it dead"
    rolled = [(b["Roll"] - a["Roll"]) % 16 for (_, a), (_, b) in pairwise(beats)]
    assert set(rolled) == {1}
    uptimes = [beat["Uptime"] for _, beat in beats]
    assert uptimes == sorted(uptimes)
    assert len({beat["Nonce"] for _, beat in beats}) == len(beats), "a nonce comes twice"
    # The verdicts may come in the second before the end, so the last beat has to tell of them.
    last = beats[-1][1]
    assert (text(last["State"]), text(last["Failure"]), last["Disabled"]) == ("CLOSED", "IsMinor", 2)
    assert {text(beat["Mode"]) for _, beat in beats} >= {"CHECKING", "DRIVING", "VERIFYING"}


def test_health_shows_the_failed_sonars(frames: list[Frame]) -> None:
    first, last = (decoded(frames, "ArgusHealthFront")[at][1] for at in (3, -1))
    for sonar in range(8):
        health, fault = (text(last[f"S{sonar:02}_{what}"]) for what in ("Health", "Fault"))
        expected = {3: ("DISABLED", "off"), 6: ("DISABLED", "wrong")}.get(sonar, ("HEALTHY", "none"))
        assert (health, fault) == expected, f"sonar {sonar}"
        assert text(first[f"S{sonar:02}_Fault"]) == "none"
    rear = decoded(frames, "ArgusHealthRear")[-1][1]
    assert {text(rear[f"S{sonar:02}_Health"]) for sonar in range(8, 16)} == {"HEALTHY"}


def test_each_edge_has_its_emergency_frame(frames: list[Frame], drive: Drive) -> None:
    edges = [edge for _, edge in decoded(frames, "ArgusEmergency")]
    assert [edge["Roll"] for edge in edges] == [(edges[0]["Roll"] + k) % 256 for k in range(len(edges))]
    disabled = [
        (int(edge["Sonar"]), text(edge["Fault"])) for edge in edges if text(edge["Event"]) == "SONAR_DISABLED"
    ]
    assert disabled == [(3, "off"), (6, "wrong")]
    raised = [event for event in drive.events() if event["event"] == "FAILURE_STATE"]
    assert sum(text(edge["Event"]) == "FAILURE_STATE" for edge in edges) == len(raised)


def test_readings_are_those_of_the_status(frames: list[Frame], drive: Drive) -> None:
    """Each front reading in a STATUS was on the bus before."""
    seen: dict[int, set[int]] = {sonar: set() for sonar in range(16)}
    for name, base in (("00", 0), ("04", 4), ("08", 8), ("12", 12)):
        for _, signals in decoded(frames, f"ArgusReadings{name}"):
            for sonar in range(base, base + 4):
                value = signals[f"S{sonar:02}_Range"]
                seen[sonar].add(int(getattr(value, "value", value)))
    for status in [event for event in drive.events() if event["event"] == "STATUS"][10:-2]:
        for sonar, range_mm in enumerate(status["reading_mm"]):
            assert range_mm in seen[sonar], f"sonar {sonar} read {range_mm} at {status['t']} s"


def test_plan(frames: list[Frame]) -> None:
    plans = [plan for _, plan in decoded(frames, "ArgusPlan")]
    last = plans[-1]
    assert (last["Count"], last["Rotation0"], last["Complete"]) == (1, -20, 1)
    assert [last[f"Blind{k}"] for k in range(1, 7)] == [0, 0, 1, 0, 0, 1]
    assert plans[0]["Count"] == 0


def test_share_of_the_bus(frames: list[Frame]) -> None:
    """In the fullest second and on average, with the bits that stuffing adds at worst; the readings all come."""
    worst: Counter[tuple[bool, int]] = Counter()
    for one in frames:
        assert stuffed_bits(one) <= worst_bits(one)
        worst[one.id in LINK_IDS, int(one.t_s)] += worst_bits(one)
    seconds = {second for _, second in worst}
    telemetry = [worst[False, second] / BIT_RATE for second in seconds]
    together = [(worst[False, second] + worst[True, second]) / BIT_RATE for second in seconds]
    span_s = frames[-1].t_s - frames[0].t_s
    figures = {
        "span_s": round(span_s, 1),
        "frames": len(frames),
        "telemetry_mean_percent": round(100 * sum(telemetry) / span_s, 3),
        "telemetry_fullest_second_percent": round(100 * max(telemetry), 3),
        "all_mean_percent": round(100 * sum(together) / span_s, 3),
        "all_fullest_second_percent": round(100 * max(together), 3),
    }
    folder = ROOT / "build/can"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "load.json").write_text(json.dumps(figures, indent=1) + "\n")
    assert max(telemetry) < TELEMETRY_PART, figures
    assert max(together) < ALL_PART, figures


def test_the_dump_is_a_log(drive: Drive) -> None:
    """argus-log reads the ISO-TP link out of what candump -L wrote: all SIPs that argusd counted."""
    drive.frames()
    done = run_python("-m", "argus_tools.log.cli", "decode", str(drive.dump_file), timeout_s=600)
    assert done.returncode == 0, done.stderr
    sips = sum(" SIP " in line for line in done.stdout.splitlines())
    counted = [event for event in drive.events() if event["event"] == "STATUS"][-1]["sips"]
    assert counted <= sips <= counted + 20, f"{PYTHON}: {sips} SIPs decoded, argusd counted {counted}"
