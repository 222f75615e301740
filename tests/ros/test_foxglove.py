# SPDX-License-Identifier: MIT
"""Rule: who opens the WebSocket of argus-foxglove gets what argusd says, in the form that each channel declares; and
the layout names no topic and no field that there is not."""

from __future__ import annotations

import asyncio
import json
import re
import signal
import socket
import struct
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import layout_rules
import pytest
import websockets
from argus_tools.control import Client
from argus_tools.foxglove import SCHEMAS, TOPICS
from harness import ROOT
from robots import emulated, minded

BRIDGE = Path(sys.prefix) / "bin/argus-foxglove"
LAYOUT = ROOT / "tools/argus_tools/foxglove_layout.json"
MESSAGE_DATA = 1
HEAD = struct.Struct("<BIQ")
DEAD = 3


@pytest.fixture
def bridged(tmp_path: Path) -> Iterator[tuple[str, str]]:
    """A robot whose sonar 3 gets stuck, argusd, and the bridge: its address, and argusd's control socket."""
    sim, robot = emulated(tmp_path, "--world", "demo", "--fault", f"stuck:{DEAD}@2s:value=0")
    argusd, place = minded(tmp_path, robot, "--passive")
    command = [str(BRIDGE), "--control", place, "--port", "0"]
    bridge = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert bridge.stdout is not None
    try:
        yield bridge.stdout.readline().strip(), place
    finally:
        bridge.send_signal(signal.SIGINT)
        out, err = bridge.communicate(timeout=120)
        argusd.end()
        sim.end()
        assert bridge.returncode == 0, err
        assert out == ""


async def look(address: str, enough: Any, limit_s: float = 90) -> dict[str, list[tuple[str, dict[str, Any]]]]:
    """Subscribe to all channels as Foxglove does; return what came on each topic, with its schema's name."""
    heard: dict[str, list[tuple[str, dict[str, Any]]]] = {}
    channels: dict[int, dict[str, Any]] = {}
    async with (
        asyncio.timeout(limit_s),
        websockets.connect(address, subprotocols=["foxglove.sdk.v1"]) as socket,
    ):
        while not enough(heard):
            data = await socket.recv()
            if isinstance(data, str):
                said = json.loads(data)
                new = said["channels"] if said["op"] == "advertise" else []
                for channel in new:
                    channels[channel["id"]] = channel
                asked = [{"id": channel["id"], "channelId": channel["id"]} for channel in new]
                if asked:
                    await socket.send(json.dumps({"op": "subscribe", "subscriptions": asked}))
                continue
            kind, subscription, _ = HEAD.unpack_from(data)
            if kind == MESSAGE_DATA:
                channel = channels[subscription]
                assert (channel["encoding"], channel["schemaEncoding"]) == ("json", "jsonschema")
                message = json.loads(data[HEAD.size :])
                heard.setdefault(channel["topic"], []).append((channel["schemaName"], message))
    return heard


def test_what_argusd_says_comes_out_of_the_websocket(bridged: tuple[str, str]) -> None:
    address, place = bridged
    pinned = False

    def enough(heard: dict[str, Any]) -> bool:
        nonlocal pinned
        if (
            "/sonar/beams" not in heard
            or heard.get("/ring", [("", {"fault": [""] * 16})])[-1][1]["fault"][DEAD] == ""
        ):
            return False
        if not pinned:  # something that is said while somebody looks on
            with Client(place) as argus:
                argus.take()
                argus.order("pin", sonar=9)
            pinned = True
        return any("SONAR_PINNED" in message["message"] for _, message in heard.get("/events", []))

    heard = asyncio.run(look(address, enough))
    assert {"/sonar/00", "/sonar/15", "/odometry", "/tf", "/robot/state", "/ring", "/events"} <= heard.keys()
    for messages in heard.values():
        for name, message in messages:
            assert message.keys() <= SCHEMAS[name]["properties"].keys()
    readings = [message["range_m"] for _, message in heard["/sonar/00"]]
    assert all(0.4 < value < 0.9 for value in readings), readings
    ring = heard["/ring"][-1][1]
    assert (ring["trusted"], ring["failure"], ring["online"]) == (15, "IsMinor", True)
    assert any("SONAR_PINNED sonar/rear/09" in message["message"] for _, message in heard["/events"])
    name, beams = heard["/sonar/beams"][-1]
    assert name == "foxglove.SceneUpdate"
    assert len(beams["entities"]) == 16


async def status_for(address: str, origin: str | None) -> int:
    """What the bridge answers to a page of that origin: 101 lets it in."""
    try:
        async with websockets.connect(
            address, subprotocols=["foxglove.sdk.v1"], origin=websockets.Origin(origin) if origin else None
        ):
            return 101
    except websockets.InvalidStatus as error:
        return int(error.response.status_code)


def test_pages_of_other_sites_do_not_look_on(bridged: tuple[str, str]) -> None:
    address, _ = bridged
    for status, origin in (
        (101, None),
        (101, "https://app.foxglove.dev"),
        (101, "http://localhost:8080"),
        (403, "https://evil.example"),
        (403, "null"),
    ):
        assert asyncio.run(status_for(address, origin)) == status, origin
    host, port = re.findall(r"ws://(.*):(\d+)", address)[0]
    with socket.create_connection((host, int(port)), 120) as caller:  # a name that is led here
        caller.sendall(b"GET / HTTP/1.1\r\nHost: evil.example\r\nUpgrade: websocket\r\n\r\n")
        assert caller.recv(100).startswith(b"HTTP/1.1 403 ")


def test_bad_arguments_are_told_in_a_line() -> None:
    for arguments, word in (
        (["--host", "0.0.0.0"], "--beyond-loopback"),
        (["--port", "70000"], "65535"),
        (["--allow-origin", "*"], "no origin"),
    ):
        done = subprocess.run([BRIDGE, *arguments], capture_output=True, text=True, check=False)
        assert done.returncode == 2
        assert word in done.stderr


def paths_of(value: Any) -> Iterator[str]:
    """All message paths and topics that a layout names."""
    if isinstance(value, dict):
        for key, item in value.items():
            if key in ("topicPath", "value", "path") and isinstance(item, str) and item.startswith("/"):
                yield item
            elif key == "topics" and isinstance(item, dict):
                yield from item
            else:
                yield from paths_of(item)
    elif isinstance(value, list):
        for item in value:
            yield from paths_of(item)


def test_the_layout_fits_the_topics() -> None:
    layout = json.loads(LAYOUT.read_text())
    named = list(paths_of(layout["configById"]))
    assert len(named) > 15
    for path in named:
        topic, *fields = re.split(r"\.", path)
        assert topic in TOPICS, path
        known = TOPICS[topic]
        if fields:
            assert re.sub(r"\[.*\]", "", fields[0]) in SCHEMAS[known]["properties"], path
    panels = set(re.findall(r'"([A-Za-z0-9]+![a-z0-9]+)"', json.dumps(layout["layout"])))
    assert panels == set(layout["configById"])


def test_each_panel_is_told_what_it_knows() -> None:
    layout = json.loads(LAYOUT.read_text())
    assert layout_rules.LAYOUT(layout)
    wrong = [
        name
        for name, config in layout["configById"].items()
        if not layout_rules.PANELS[name.partition("!")[0]](config)
    ]
    assert wrong == []


def test_a_panel_that_is_told_something_else_is_found() -> None:
    config = json.loads(LAYOUT.read_text())["configById"]["Plot!front"]
    plot = layout_rules.PANELS["Plot"]
    assert not plot({**config, "title": "?"}), "a member that there is not"
    assert not plot({**config, "legendDisplay": "right"})
    assert not plot({key: item for key, item in config.items() if key != "isSynced"})
    assert not plot({**config, "paths": [{"value": "/ring.trusted"}]})
