# SPDX-License-Identifier: MIT
"""Rule: the client of the control socket matches replies with requests, refuses whoever is no argusd, and never waits
for ever."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from argus_tools.monitor import upstream
from argus_tools.monitor.upstream import Address, Upstream, UpstreamError, parse_address
from fake_argusd import FakeArgusd, recorded

Message = dict[str, Any]


def with_fake(
    tmp_path: Path, act: Callable[[FakeArgusd], Awaitable[None]], token: str = "", **more: Any
) -> None:
    async def run() -> None:
        fake = FakeArgusd(tmp_path / "control", token, **more)
        await fake.start()
        try:
            await act(fake)
        finally:
            await fake.stop()

    asyncio.run(run())


def nothing(message: Message) -> None:
    raise AssertionError(f"nobody asked for {message}")


@pytest.mark.parametrize(
    ("text", "address"),
    [
        ("unix:/run/argus/control", Address(path="/run/argus/control")),
        ("tcp:127.0.0.1:8100", Address(host="127.0.0.1", port=8100)),
        ("tcp:[::1]:8100", Address(host="::1", port=8100)),
    ],
)
def test_addresses(text: str, address: Address) -> None:
    assert parse_address(text) == address


@pytest.mark.parametrize(
    "text", ["", "unix:", "tcp:", "tcp:host", "tcp:host:0", "tcp:host:65536", "tcp:::1:9", "/run/x"]
)
def test_no_addresses(text: str) -> None:
    with pytest.raises(ValueError, match="is not unix:PATH or tcp:HOST:PORT"):
        parse_address(text)


def test_streams_arrive_whole_and_in_order(tmp_path: Path) -> None:
    told: list[Message] = []

    async def act(fake: FakeArgusd) -> None:
        client = await Upstream.open(Address(path=str(fake.path)), told.append)
        assert (await client.ask("watch", topics=["state"], period_ms=100))["ok"]
        for message in recorded():
            fake.tell(message)
        assert (await client.ask("watch", topics=["state"], period_ms=100))["ok"]
        await client.close()

    with_fake(tmp_path, act)
    assert told == recorded()


def test_many_requests_at_once_each_get_their_own_reply(tmp_path: Path) -> None:
    async def act(fake: FakeArgusd) -> None:
        client = await Upstream.open(Address(path=str(fake.path)), nothing)
        names = ["watch", "nonsense"] * 20
        answers = await asyncio.gather(*(client.ask(name) for name in names))
        assert [answer["ok"] for answer in answers] == [name == "watch" for name in names]
        assert len({answer["re"] for answer in answers}) == len(names)
        await client.close()

    with_fake(tmp_path, act)


def test_the_token_is_said_and_a_wrong_or_missing_one_is_told(tmp_path: Path) -> None:
    async def act(fake: FakeArgusd) -> None:
        right = await Upstream.open(Address(path=str(fake.path), token="right-right-right"), nothing)
        assert (await right.ask("watch"))["ok"]
        await right.close()
        with pytest.raises(UpstreamError, match="does not take this token"):
            await Upstream.open(Address(path=str(fake.path), token="wrong-wrong-wrong"), nothing)
        with pytest.raises(UpstreamError, match="give --token FILE"):
            await Upstream.open(Address(path=str(fake.path)), nothing)

    with_fake(tmp_path, act, token="right-right-right")


@pytest.mark.parametrize("greeting", [{"control": 2}, {"hello": "world"}])
def test_whoever_is_no_argusd_is_refused(tmp_path: Path, greeting: Message) -> None:
    async def act(fake: FakeArgusd) -> None:
        with pytest.raises(UpstreamError, match="is no argusd"):
            await Upstream.open(Address(path=str(fake.path)), nothing)

    with_fake(tmp_path, act, greeting=greeting)


def test_nobody_listens(tmp_path: Path) -> None:
    with pytest.raises(UpstreamError, match="No such file"):
        asyncio.run(Upstream.open(Address(path=str(tmp_path / "none")), nothing))


def test_a_request_without_reply_ends_in_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(upstream, "REPLY_WITHIN_S", 0.2)

    async def act(fake: FakeArgusd) -> None:
        client = await Upstream.open(Address(path=str(fake.path)), nothing)
        fake.mute = True
        with pytest.raises(UpstreamError, match="does not answer"):
            await client.ask("watch")
        await client.close()

    with_fake(tmp_path, act)


def test_the_end_of_argusd_ends_what_waits(tmp_path: Path) -> None:
    async def act(fake: FakeArgusd) -> None:
        client = await Upstream.open(Address(path=str(fake.path)), nothing)
        fake.mute = True
        waiting = asyncio.create_task(client.ask("watch"))
        await asyncio.sleep(0.05)
        await fake.stop()
        with pytest.raises(UpstreamError, match="closed the connection"):
            await waiting
        assert client.closed.is_set()
        with pytest.raises(UpstreamError, match="closed the connection"):
            await client.ask("watch")

    async def run() -> None:
        fake = FakeArgusd(tmp_path / "control")
        await fake.start()
        await act(fake)

    asyncio.run(run())
