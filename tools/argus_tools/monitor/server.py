# SPDX-License-Identifier: MIT
"""The web server on loopback: the page's files, its websocket, and the requests that are turned away."""

from __future__ import annotations

import asyncio
import hmac
import json
import re
from collections.abc import Awaitable, Callable, Collection, Mapping
from importlib import resources
from typing import Final

from aiohttp import WSCloseCode, WSMsgType, web

from argus_tools.monitor.hub import Hub, Outbox
from argus_tools.monitor.viewer import Viewer

LOOPBACK: Final = "127.0.0.1"
VIEWERS_MAX: Final = 16
MESSAGE_MAX: Final = 4096
TOKEN_WITHIN_S: Final = 5.0
HEARTBEAT_S: Final = 5.0
_REQUESTS_MAX: Final = 32
NO_TOKEN: Final = 4401
"""Closes a websocket whose first message is not the token; the page then asks for it."""
TOO_MANY: Final = 4429
_PAGE: Final = re.compile(r"https?://([a-z0-9.:\[\]_-]+)")
_HOST: Final = re.compile(r"(127\.0\.0\.1|localhost|\[::1\])(:\d{1,5})?")
_TYPES: Final[Mapping[str, str]] = {
    "html": "text/html",
    "css": "text/css",
    "js": "text/javascript",
    "svg": "image/svg+xml",
}
_HEADERS: Final[Mapping[str, str]] = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


def why_refused(
    host: str, origin: str | None, site: str | None, path: str, allowed: Collection[str] = ()
) -> str:
    """Tell why a request may not come in, from its headers; empty for one that may.

    A name that is led to this machine (DNS rebinding) shows in Host, another site's page in Origin or Sec-Fetch-Site.
    `allowed`: origins under which a proxy serves the page.
    """
    names = [found[1] for page in allowed if (found := _PAGE.fullmatch(page))]
    if not _HOST.fullmatch(host) and host not in names:
        return "this server answers to 127.0.0.1 and localhost only; --allow-origin allows a proxy's name"
    if origin is not None and origin not in (f"http://{host}", *allowed):
        return "requests of other sites are refused"
    if path == "/live" and origin is None:
        return "a websocket names the page that it is of"
    if path != "/" and site not in (None, "none", "same-origin"):
        return "requests of other sites are refused"
    return ""


ALLOWED: Final = web.AppKey("allowed", frozenset[str])


@web.middleware
async def guard(request: web.Request, handler: Handler) -> web.StreamResponse:
    """Turn away what did not come from the page, and say of every answer what it may do."""
    headers = request.headers
    allowed: frozenset[str] = request.app[ALLOWED]
    why = why_refused(
        headers.get("Host", ""),
        headers.get("Origin"),
        headers.get("Sec-Fetch-Site"),
        request.path,
        allowed,
    )
    if why:
        return web.Response(status=403, text=f"{why}\n", headers=_HEADERS)
    try:
        response = await handler(request)
    except web.HTTPException as error:
        error.headers.update(_HEADERS)
        raise
    if not response.prepared:
        response.headers.update(_HEADERS)
    return response


def page_files() -> dict[str, tuple[bytes, str]]:
    """Return the files of the page by path, with the type of each; read once, so no path leads out of them."""
    folder = resources.files("argus_tools.monitor") / "static"
    files = {}
    for file in folder.iterdir():
        kind = _TYPES.get(file.name.rpartition(".")[2])
        if kind is not None:
            files["/" if file.name == "index.html" else f"/{file.name}"] = (file.read_bytes(), kind)
    return files


class Server:
    """Serves one hub."""

    def __init__(self, hub: Hub, token: str, allowed: Collection[str] = ()) -> None:
        """`allowed`: origins under which a proxy serves the page, as https://HOST."""
        self._hub = hub
        self._allowed = frozenset(allowed)
        self._token = token.encode()
        self._files = page_files()
        self._sockets: set[web.WebSocketResponse] = set()
        self._runner: web.AppRunner | None = None

    async def start(self, port: int) -> int:
        """Listen on loopback; return the port. OSError when it is taken."""
        app = web.Application(middlewares=[guard], client_max_size=MESSAGE_MAX)
        app[ALLOWED] = self._allowed
        for path in self._files:
            app.router.add_get(path, self._file)
        app.router.add_get("/live", self._live)
        self._runner = web.AppRunner(app, access_log=None, shutdown_timeout=1.0)
        await self._runner.setup()
        site = web.TCPSite(self._runner, LOOPBACK, port)
        await site.start()
        return int(self._runner.addresses[0][1])

    async def stop(self) -> None:
        """Say goodbye to every page and end."""
        for socket in set(self._sockets):
            await socket.close(code=WSCloseCode.GOING_AWAY)
        if self._runner is not None:
            await self._runner.cleanup()

    async def _file(self, request: web.Request) -> web.StreamResponse:
        body, kind = self._files[request.path]
        return web.Response(body=body, content_type=kind, charset="utf-8")

    async def _live(self, request: web.Request) -> web.StreamResponse:
        socket = web.WebSocketResponse(heartbeat=HEARTBEAT_S, max_msg_size=MESSAGE_MAX)
        await socket.prepare(request)
        self._sockets.add(socket)
        try:
            if not await self._knows_token(socket):
                await socket.close(code=NO_TOKEN, message=b"token")
            elif self._hub.viewers >= VIEWERS_MAX:
                await socket.close(code=TOO_MANY, message=b"too many viewers")
            else:
                await self._serve(socket)
        finally:
            self._sockets.discard(socket)
        return socket

    async def _knows_token(self, socket: web.WebSocketResponse) -> bool:
        try:
            first = await socket.receive(timeout=TOKEN_WITHIN_S)
            said = json.loads(first.data) if first.type is WSMsgType.TEXT else None
        except (TimeoutError, ValueError, RecursionError):
            return False
        token = said.get("token") if isinstance(said, dict) else None
        # Half a surrogate pair is no UTF-8: it is told from the token like any other wrong text.
        return isinstance(token, str) and hmac.compare_digest(
            token.encode("utf-8", "surrogatepass"), self._token
        )

    async def _serve(self, socket: web.WebSocketResponse) -> None:
        box = self._hub.join()
        viewer = Viewer(self._hub, box)
        tasks = [asyncio.create_task(_send(socket, box))]
        requests: asyncio.Queue[str] = asyncio.Queue(_REQUESTS_MAX)
        tasks.append(asyncio.create_task(_handle(viewer, requests)))
        try:
            async for message in socket:
                if message.type is not WSMsgType.TEXT:
                    break
                if is_stop(message.data):  # it waits for no order before it
                    await viewer.handle(message.data)
                elif requests.full():
                    break
                else:
                    requests.put_nowait(message.data)
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            await viewer.close()
            self._hub.leave(box)


def is_stop(text: str) -> bool:
    """Tell whether a page wants the robot to stop."""
    try:
        request = json.loads(text)
    except (ValueError, RecursionError):
        return False
    return isinstance(request, dict) and (request.get("do"), request.get("order")) == ("order", "stop")


async def _handle(viewer: Viewer, requests: asyncio.Queue[str]) -> None:
    while True:
        await viewer.handle(await requests.get())


async def _send(socket: web.WebSocketResponse, box: Outbox) -> None:
    while True:
        for message in await box.take():
            await socket.send_str(json.dumps(message, separators=(",", ":")))
