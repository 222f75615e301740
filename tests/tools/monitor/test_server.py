# SPDX-License-Identifier: MIT
"""Rule: only the page itself gets in (rebinding, other sites, wrong tokens are refused), argusd alone decides who has
control, and what a page drove by hand stops when the page goes."""

from __future__ import annotations

import asyncio
import json
import logging
import re
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, ClientWebSocketResponse, WSMsgType
from argus_tools.monitor import server as server_module
from argus_tools.monitor.hub import SILENT_S, Hub
from argus_tools.monitor.server import NO_TOKEN, TOO_MANY, Server, page_files, why_refused
from argus_tools.monitor.upstream import Address
from fake_argusd import FakeArgusd, recorded

from hil_sim.faults.values import value_words

Message = dict[str, Any]
# A guard against what hangs, not a rule.
PATIENCE_S = 120.0
TOKEN = "this-is-a-secret-of-the-page"


class FakeBreaker:
    """An emulator that notes its orders."""

    def __init__(self) -> None:
        self.broken: dict[str, str] = {}
        self.changed: Callable[[], None] = lambda: None
        self.lines: list[str] = []

    def turn(self, broken: dict[str, str]) -> None:
        self.broken = broken
        self.changed()

    async def order(self, line: str) -> Message:
        self.lines.append(line)
        self.turn({"3": "off"} if line.startswith("break") else {})
        return {"ok": True, "broken": self.broken}


class Page:
    """A page: a websocket with what came on it."""

    def __init__(self, socket: ClientWebSocketResponse) -> None:
        self.socket = socket
        self.got: list[Message] = []
        self._last = 0

    async def until(self, probe: Callable[[Message], Any], within_s: float = PATIENCE_S) -> Message:
        """Wait for a message of which PROBE is true."""
        async with asyncio.timeout(within_s):
            while True:
                message = await self.socket.receive()
                if message.type is not WSMsgType.TEXT:
                    raise ConnectionError(f"closed with {self.socket.close_code}")
                self.got.append(json.loads(message.data))
                if probe(self.got[-1]):
                    return self.got[-1]

    async def ask(self, **request: Any) -> Message:
        self._last += 1
        number = self._last
        await self.socket.send_json(request | {"id": number})
        return await self.until(lambda message: message.get("re") == number)


class Site:
    """A server with a fake argusd behind it, and pages on it."""

    def __init__(self, fake: FakeArgusd, breaker: FakeBreaker | None, hub: Hub, port: int) -> None:
        self.fake = fake
        self.breaker = breaker
        self.hub = hub
        self.port = port
        self.url = f"http://127.0.0.1:{port}"
        self.session = ClientSession()

    async def connect(self, **headers: str) -> ClientWebSocketResponse:
        return await self.session.ws_connect(f"{self.url}/live", headers={"Origin": self.url, **headers})

    async def page(self) -> Page:
        page = Page(await self.connect())
        await page.socket.send_json({"token": TOKEN})
        await page.until(lambda message: "viewers" in message)
        return page


def on_site(
    tmp_path: Path, act: Callable[[Site], Awaitable[None]], breaker: FakeBreaker | None = None
) -> None:
    async def run() -> None:
        fake = FakeArgusd(tmp_path / "control")
        await fake.start()
        hub = Hub(Address(path=str(fake.path)), breaker, world="lab", walls=[[0, 0, 1, 1]])
        server = Server(hub, TOKEN)
        port = await server.start(0)
        watching = asyncio.create_task(hub.run())
        site = Site(fake, breaker, hub, port)
        try:
            while not fake.watchers:
                await asyncio.sleep(0.01)
            await act(site)
        finally:
            await site.session.close()
            watching.cancel()
            await server.stop()
            await fake.stop()

    asyncio.run(run())


# ---- who gets in


@pytest.mark.parametrize(
    ("host", "origin", "site", "path", "allowed"),
    [
        ("127.0.0.1:8642", None, None, "/", True),
        ("localhost:8642", None, "none", "/", True),
        ("[::1]:8642", None, "same-origin", "/main.js", True),
        ("127.0.0.1:8642", "http://127.0.0.1:8642", "same-origin", "/live", True),
        ("127.0.0.1:9000", "http://127.0.0.1:9000", None, "/live", True),
        ("127.0.0.1:8642", None, "cross-site", "/", True),
        ("evil.example:8642", None, None, "/", False),
        ("127.0.0.1.evil.example:8642", None, None, "/", False),
        ("localhost.evil.example", None, None, "/", False),
        ("evil.example@127.0.0.1:8642", None, None, "/", False),
        ("", None, None, "/", False),
        ("192.168.1.5:8642", None, None, "/", False),
        ("127.0.0.1:8642", "http://evil.example", None, "/live", False),
        ("127.0.0.1:8642", "http://127.0.0.1:8643", None, "/live", False),
        ("127.0.0.1:8642", "https://127.0.0.1:8642", None, "/live", False),
        ("127.0.0.1:8642", "null", None, "/live", False),
        ("127.0.0.1:8642", "http://localhost:8642", None, "/live", False),
        ("127.0.0.1:8642", None, None, "/live", False),
        ("127.0.0.1:8642", None, "cross-site", "/main.js", False),
        ("127.0.0.1:8642", "http://127.0.0.1:8642", "same-site", "/live", False),
    ],
)
def test_who_may_come_in(host: str, origin: str | None, site: str | None, path: str, allowed: bool) -> None:
    assert (why_refused(host, origin, site, path) == "") is allowed


@pytest.mark.parametrize(
    ("host", "origin", "allowed"),
    [
        ("robot.example", "https://robot.example", True),
        ("127.0.0.1:8642", "https://robot.example", True),  # a proxy that names us
        ("robot.example", "https://evil.example", False),
        ("robot.example", "http://robot.example:81", False),
        ("evil.example", "https://robot.example", False),
        ("robot.example.evil.example", None, False),
    ],
)
def test_behind_a_proxy_only_its_name_may_come_in(host: str, origin: str | None, allowed: bool) -> None:
    why = why_refused(host, origin, "same-origin", "/live", ("https://robot.example",))
    assert (why == "") is allowed


def test_a_page_is_told_the_time_here(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        before = time.time()
        answer = await page.ask(do="clock")
        assert answer["ok"]
        assert before <= answer["unix"] <= time.time()

    on_site(tmp_path, act)


def test_an_argusd_that_holds_its_tongue_is_reported_within_two_seconds(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        down = await page.until(lambda message: "link" in message and not message["link"]["up"])
        assert down["link"]["why"] == "argusd reports nothing"
        assert SILENT_S < 2.0
        await page.until(lambda message: "link" in message and message["link"]["up"])  # it tries again

    on_site(tmp_path, act)


def test_a_name_led_to_this_machine_and_other_sites_get_403(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}):
            for path in ("/", "/main.js", "/live"):
                async with site.session.get(site.url + path, headers=headers) as answer:
                    assert answer.status == 403, (headers, path)
                    assert "frame-ancestors 'none'" in answer.headers["Content-Security-Policy"]
        async with site.session.get(f"{site.url}/live") as answer:
            assert answer.status == 403

    on_site(tmp_path, act)


def test_it_listens_on_loopback_only(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        listening = Path("/proc/net/tcp").read_text() + Path("/proc/net/tcp6").read_text()
        ours = [line.split()[1] for line in listening.splitlines() if f":{site.port:04X} 0" in line]
        assert ours == [f"0100007F:{site.port:04X}"]

    on_site(tmp_path, act)


def test_files_of_the_page_and_no_other(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        for path, (body, kind) in page_files().items():
            async with site.session.get(site.url + path) as answer:
                assert (answer.status, answer.content_type, await answer.read()) == (200, kind, body)
                assert answer.headers["Cache-Control"] == "no-store"
                assert answer.headers["X-Content-Type-Options"] == "nosniff"
        for path in ("/server.py", "/../server.py", "/%2e%2e/server.py", "/static/main.js", "/index.html"):
            async with site.session.get(site.url + path) as answer:
                assert answer.status == 404
                assert "Content-Security-Policy" in answer.headers
        async with site.session.post(f"{site.url}/", data=b"x") as answer:
            assert answer.status == 405

    on_site(tmp_path, act)


@pytest.mark.parametrize(
    "first",
    [
        '{"token":"wrong"}',
        "{}",
        "[]",
        "not json",
        "",
        '{"token":1}',
        '{"token":"ü"}',
        '{"token":"\\ud800"}',
        '{"token":"\\u0000"}',
        '{"token":null}',
        '{"token":[{"token":""}]}',
        '{"token":NaN}',
        '{"token":1e999}',
        '"token"',
        "-Infinity",
        "1" * 4090,
        "[" * 4000,
    ],
)
def test_without_the_token_nothing_is_told(
    tmp_path: Path, first: str, caplog: pytest.LogCaptureFixture
) -> None:
    async def act(site: Site) -> None:
        socket = await site.connect()
        await socket.send_str(first)
        message = await socket.receive(timeout=PATIENCE_S)
        assert message.type is WSMsgType.CLOSE
        assert socket.close_code == NO_TOKEN
        assert site.hub.viewers == 0

    on_site(tmp_path, act)
    assert [record for record in caplog.records if record.exc_info or record.levelno >= logging.ERROR] == []


def test_a_page_that_says_nothing_is_closed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server_module, "TOKEN_WITHIN_S", 0.2)

    async def act(site: Site) -> None:
        socket = await site.connect()
        assert (await socket.receive(timeout=PATIENCE_S)).type is WSMsgType.CLOSE
        assert socket.close_code == NO_TOKEN

    on_site(tmp_path, act)


def test_the_token_is_in_no_log_and_no_answer(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    caplog.set_level(logging.DEBUG)
    got: list[str] = []

    async def act(site: Site) -> None:
        page = await site.page()
        await page.ask(do="take")
        await page.ask(do="nonsense")
        async with site.session.get(f"{site.url}/?{TOKEN}") as answer:
            got.append(await answer.text())
        got.append(json.dumps(page.got))

    on_site(tmp_path, act)
    out, err = capfd.readouterr()
    ours = [record.getMessage() for record in caplog.records if record.name != "asyncio"]
    assert TOKEN not in "".join([*got, out, err, *ours])


def test_too_many_pages_are_turned_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server_module, "VIEWERS_MAX", 2)

    async def act(site: Site) -> None:
        pages = [await site.page() for _ in range(2)]
        socket = await site.connect()
        await socket.send_json({"token": TOKEN})
        while (await socket.receive(timeout=PATIENCE_S)).type is not WSMsgType.CLOSE:
            pass
        assert socket.close_code == TOO_MANY
        await pages[0].socket.close()
        while site.hub.viewers > 1:
            await asyncio.sleep(0.01)
        await site.page()

    on_site(tmp_path, act)


# ---- what pages see


def test_a_page_sees_the_drive_and_one_that_comes_late_its_story(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        early = await site.page()
        for message in recorded():
            site.fake.tell(message)
            await asyncio.sleep(0)
        last = [message for message in recorded() if message.get("event") == "STATUS"][-1]
        await early.until(lambda message: message == last)
        late = Page(await site.connect())
        await late.socket.send_json({"token": TOKEN})
        await late.until(lambda message: message == last)
        told = {key for message in late.got for key in message}
        assert {"about", "robot", "link", "trail"} <= told
        events = [m for m in recorded() if "event" in m and m["event"] != "STATUS"]
        shown = [m | {"shown": value_words(m["event"], m["value"])} for m in events]
        assert [m for m in late.got if "event" in m and m["event"] != "STATUS"] == shown

    on_site(tmp_path, act)


def test_a_lost_argusd_is_told_and_found_again(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        await site.fake.stop()
        down = await page.until(lambda m: m.get("link", {}).get("up") is False)
        assert "closed the connection" in down["link"]["why"]
        assert (await page.ask(do="order", order="stop"))["ok"] is False
        await site.fake.start()
        await page.until(lambda m: m.get("link", {}).get("up") is True)
        assert (await page.ask(do="order", order="stop"))["ok"] is True

    on_site(tmp_path, act)


# ---- control


def test_one_page_has_control_another_may_take_it_by_force(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        first, second = await site.page(), await site.page()
        answer = await first.ask(do="order", order="go")
        assert (answer["ok"], answer["why"]) == (False, "not_in_control")
        assert (await first.ask(do="take"))["ok"]
        for _ in range(3):
            assert (await first.ask(do="order", order="turn", deg=20))["ok"]
        assert (await second.ask(do="take"))["why"] == "taken"
        assert (await second.ask(do="take", force=True))["ok"]
        await first.until(lambda message: message.get("control") == "lost")
        assert (await first.ask(do="order", order="go"))["why"] == "not_in_control"
        assert (await second.ask(do="order", order="go"))["ok"]
        assert site.fake.orders == [{"order": "turn", "deg": 20}] * 3 + [{"order": "go"}]

    on_site(tmp_path, act)


def test_whoever_looks_on_may_stop(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        first, second = await site.page(), await site.page()
        assert (await first.ask(do="take"))["ok"]
        assert (await second.ask(do="order", order="stop"))["ok"]
        assert site.fake.orders == [{"order": "stop"}]
        assert (await first.ask(do="order", order="go"))["ok"], "the first is still in control"

    on_site(tmp_path, act)


def test_stop_waits_for_no_order_before_it(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        await page.ask(do="take")
        for number in range(100, 120):
            await page.socket.send_json({"do": "order", "order": "recheck", "id": number})
        await page.socket.send_json({"do": "order", "order": "stop", "id": 7})
        seen: list[int] = []
        while 7 not in seen:
            seen.append((await page.until(lambda message: "re" in message))["re"])
        assert len(seen) < 20

    on_site(tmp_path, act)


@pytest.mark.parametrize("order", [{"order": "turn", "deg": 90}, {"order": "step", "way": "ahead"}])
def test_what_a_page_drove_by_hand_stops_when_it_goes(tmp_path: Path, order: Message) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        await page.ask(do="take")
        await page.ask(do="order", **order)
        await page.socket.close()
        async with asyncio.timeout(20):
            while not site.fake.stopped_for_lost_controller:
                await asyncio.sleep(0.01)

    on_site(tmp_path, act)


def test_release_gives_control_back(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        first, second = await site.page(), await site.page()
        await first.ask(do="take")
        await first.ask(do="release")
        async with asyncio.timeout(20):
            while site.fake.grant:
                await asyncio.sleep(0.01)
        assert (await second.ask(do="take"))["ok"]

    on_site(tmp_path, act)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "x",
        "[]",
        "{}",
        "null",
        '{"do":5}',
        '{"do":"order","order":"quit"}',
        '{"do":"order","order":"fail"}',
        '{"do":"order"}',
        '{"do":"break","sonar":3,"kind":"off; rm"}',
        '{"do":"break","sonar":3,"kind":["off"]}',
        '{"do":"break","sonar":"3","kind":"off"}',
        '{"do":"mend","sonar":true}',
        '{"do":"mend","sonar":16}',
        '{"do":"mend","sonar":1e999}',
        '{"do":"break","sonar":3,"kind":"\\ud800"}',
        '{"do":"\\ud800"}',
        '{"do":"order","order":"turn","deg":1e999}',
        '{"do":"order","order":"turn","deg":NaN}',
        '{"do":"order","order":"step","way":"\\ud800"}',
        '{"do":"order","order":"goto","x_mm":[0],"y_mm":{"a":0}}',
    ],
)
def test_what_no_page_may_ask_is_refused_and_the_page_stays(tmp_path: Path, text: str) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        await page.ask(do="take")
        await page.socket.send_str(text)
        answer = await page.until(lambda message: "re" in message)
        assert (answer["ok"], answer["why"]) == (False, "refused")
        assert (await page.ask(do="order", order="go"))["ok"]
        assert site.fake.orders == [{"order": "go"}]

    on_site(tmp_path, act)


def test_a_message_beyond_the_bound_ends_the_page(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        await page.socket.send_str("x" * 5000)
        with pytest.raises(ConnectionError):
            await page.until(lambda message: False)

    on_site(tmp_path, act)


# ---- faults


def test_in_simulation_faults_go_to_the_emulator(tmp_path: Path) -> None:
    breaker = FakeBreaker()

    async def act(site: Site) -> None:
        page = await site.page()
        assert (await page.ask(do="break", sonar=3, kind="off"))["why"] == "not_in_control"
        await page.ask(do="take")
        assert (await page.ask(do="break", sonar=3, kind="wrong"))["ok"]
        assert {"broken": {"3": "off"}} in page.got
        assert (await page.ask(do="mend", sonar=3))["ok"]
        assert {"broken": {}} in page.got
        assert breaker.lines == ["break wrong:3:scale=0.5", "mend 3"]
        assert site.fake.orders == []

    on_site(tmp_path, act, breaker)


def test_a_fault_that_begins_and_ends_by_itself_is_told(tmp_path: Path) -> None:
    breaker = FakeBreaker()
    breaker.broken = {"5": "stuck"}

    async def act(site: Site) -> None:
        page = await site.page()
        assert {"broken": {"5": "stuck"}} in page.got, "what is broken from the start"
        breaker.turn({"5": "stuck", "3": "off"})
        await page.until(lambda message: message == {"broken": {"5": "stuck", "3": "off"}})
        breaker.turn({"5": "stuck"})
        await page.until(lambda message: message == {"broken": {"5": "stuck"}})

    on_site(tmp_path, act, breaker)


def test_on_a_robot_faults_go_to_argusd_and_end(tmp_path: Path) -> None:
    async def act(site: Site) -> None:
        page = await site.page()
        await page.ask(do="take")
        assert (await page.ask(do="break", sonar=3, kind="stuck"))["ok"]
        assert (await page.ask(do="mend", sonar=3))["ok"]
        first, second = site.fake.orders
        assert (first["order"], first["sonar"], first["kind"]) == ("fail", 3, "stuck")
        assert 1000 <= first["for_ms"] <= 600_000
        assert second["kind"] == "ok"

    on_site(tmp_path, act)


# ---- the files


def test_the_page_loads_nothing_from_elsewhere() -> None:
    for path, (body, _) in page_files().items():
        text = body.decode()
        found = re.findall(
            r"(?:https?:)?//[\w.-]+\.[a-z]+[^\s\"']*", text.replace("http://www.w3.org/2000/svg", "")
        )
        assert found == [], f"{path}: {found}"
        assert "innerHTML" not in text
        assert " style=" not in text


def test_every_file_that_the_page_names_is_there() -> None:
    files = page_files()
    named = {
        name
        for body, _ in files.values()
        for name in re.findall(r"[\"'](?:\./)?([\w-]+\.(?:js|css|svg))[\"']", body.decode())
    }
    # None begins with a slash: behind a proxy the page may lie in a folder.
    assert {f"/{name}" for name in named} == files.keys() - {"/"}
    assert not [path for path, (body, _) in files.items() if re.search(rb"[\"']/\w+\.(js|css|svg)", body)]
