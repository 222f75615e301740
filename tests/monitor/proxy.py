# SPDX-License-Identifier: MIT
"""A reverse proxy as one puts before the page: TLS, a folder in the path, WebSockets; it can stop carrying anything."""

from __future__ import annotations

import asyncio
import ssl
import subprocess
import threading
from pathlib import Path
from typing import Any

from aiohttp import ClientSession, WSMsgType, WSServerHandshakeError, web
from yarl import URL

PATIENCE_S = 60.0


def certificate(folder: Path) -> ssl.SSLContext:
    """Make a certificate that nobody has signed."""
    key, cert = folder / "key.pem", folder / "cert.pem"
    command = [
        "openssl",
        "req",
        "-x509",
        "-newkey",
        "rsa:2048",
        "-nodes",
        "-days",
        "2",
        "-subj",
        "/CN=localhost",
    ]
    subprocess.run([*command, "-keyout", key, "-out", cert], check=True, capture_output=True)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(cert, key)
    return context


class Proxy:
    """Serves https://localhost:PORT + `path` from another port of this machine, in a thread."""

    def __init__(self, folder: Path, path: str = "/") -> None:
        self.path = path
        self.backend = 0
        self.seen: list[str] = []
        self._carries = asyncio.Event()
        self._context = certificate(folder)
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self._sockets: set[web.WebSocketResponse] = set()
        self.port = int(self._do(self._start()))

    @property
    def origin(self) -> str:
        """The origin of the page."""
        return f"https://localhost:{self.port}"

    def carry(self, carries: bool) -> None:
        """Whether anything goes through; connections stand in either case."""
        self._loop.call_soon_threadsafe(self._carries.set if carries else self._carries.clear)

    def cut(self) -> None:
        """Break all WebSockets."""

        async def close() -> None:
            for socket in set(self._sockets):
                await socket.close()

        self._do(close())

    def close(self) -> None:
        """End it."""
        self.carry(True)
        self._do(self._runner.cleanup())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(PATIENCE_S)

    def _do(self, task: Any) -> Any:
        return asyncio.run_coroutine_threadsafe(task, self._loop).result(PATIENCE_S)

    async def _start(self) -> int:
        self._carries.set()
        app = web.Application()
        app.router.add_get("/{rest:.*}", self._serve)
        self._runner = web.AppRunner(app, access_log=None, shutdown_timeout=1.0)
        await self._runner.setup()
        await web.TCPSite(self._runner, "127.0.0.1", 0, ssl_context=self._context).start()
        return int(self._runner.addresses[0][1])

    async def _serve(self, request: web.Request) -> web.StreamResponse:
        self.seen.append(request.path)
        if not request.path.startswith(self.path):
            return web.Response(status=404)
        url = URL(f"http://127.0.0.1:{self.backend}/{request.path[len(self.path) :]}")
        kept = ("Origin", "Sec-Fetch-Site", "Cookie")
        headers = {name: request.headers[name] for name in kept if name in request.headers}
        headers["Host"] = request.headers["Host"]
        async with ClientSession() as session:
            if request.headers.get("Upgrade", "").lower() == "websocket":
                return await self._live(request, session, url, headers)
            await self._carries.wait()
            async with session.get(url, headers=headers) as answer:
                passed = {
                    k: v for k, v in answer.headers.items() if k.startswith(("Content-Security", "Cross"))
                }
                body = await answer.read()
                return web.Response(
                    status=answer.status, body=body, headers=passed, content_type=answer.content_type
                )

    async def _live(
        self, request: web.Request, session: ClientSession, url: URL, headers: dict[str, str]
    ) -> web.StreamResponse:
        try:
            far = await session.ws_connect(url, headers=headers, origin=headers.get("Origin"))
        except WSServerHandshakeError as error:
            return web.Response(status=error.status)
        near = web.WebSocketResponse(autoping=True)
        await near.prepare(request)
        self._sockets.add(near)
        try:
            pumps = [asyncio.create_task(self._pump(a, b)) for a, b in ((near, far), (far, near))]
            await asyncio.wait(pumps, return_when=asyncio.FIRST_COMPLETED)
            for pump in pumps:
                pump.cancel()
        finally:
            self._sockets.discard(near)
            await far.close()
        return near

    async def _pump(self, source: Any, sink: Any) -> None:
        async for message in source:
            await self._carries.wait()
            if message.type is WSMsgType.TEXT:
                await sink.send_str(message.data)
