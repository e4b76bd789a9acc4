"""The studio's server: one page and one WebSocket, on this machine only.

Every request needs the session's token; its Host must be this machine, and its Origin, where it has one, this server.
What a page may ask is bounded in size and number."""
from __future__ import annotations

import asyncio
import hmac
import json
import math
import socket
import time
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any, Optional

import uvicorn
from starlette.applications import Starlette
from starlette.requests import HTTPConnection, Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.websockets import WebSocket, WebSocketDisconnect

from .. import __version__, _core
from ..errors import FileError, PlicaError
from .draft import STARTS
from .messages import problem_of
from .session import Refused, Session

HOST = "127.0.0.1"
MOST_MESSAGE_BYTES = 2_000_000
MOST_CONNECTIONS = 20
STATES_APART_S = 0.15
NAMES = (HOST, "localhost")
PAGE, CARDS = Path(__file__).parent / "page.html", Path(__file__).parent / "cards"
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                               "img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
                               "frame-ancestors http://localhost:* http://127.0.0.1:*",
    "Referrer-Policy": "no-referrer", "X-Content-Type-Options": "nosniff", "Cache-Control": "no-store",
    "Cross-Origin-Resource-Policy": "same-origin",
}


def page_text() -> str:
    """Return the page with the definitions that it shares with reports."""
    try:
        html = PAGE.read_text()
    except FileNotFoundError:
        raise FileError(f"{PAGE}: missing, since plica was built with PLICA_WITH_VIEWER=OFF; "
                        "build with it, or install a wheel") from None
    fields = [{"name": name, "label": field["label"], "unit": "", "on_nodes": field["on_nodes"],
               "scale": field["kind"].replace("_", "-"), "map": field["kind"],
               "low": 0, "high": max(1, len(field["colours"]) - 1) if field["kind"] == "steps" else 1}
              for name, field in _core.colour_fields().items() if name not in ("volume-error", "strength")]
    maps = {field["kind"]: ["#" + "".join(f"{round(255 * part):02x}" for part in colour) for colour in field["colours"]]
            for field in _core.colour_fields().values()}
    data = json.dumps({"version": __version__, "fields": fields, "maps": maps}).replace("<", "\\u003c")
    return html.replace("<!--plica:data-->", f'<script id="data" type="application/json">{data}</script>')


class Page:
    """A connected page: what it waits for, and what it has been sent."""

    def __init__(self, socket_: WebSocket, session: Session) -> None:
        self.socket, self.session = socket_, session
        self.wake, self.wants = asyncio.Event(), dict[int, dict[str, Any]]()
        self._sending = asyncio.Lock()
        self._draft: Any = None
        self._runs, self._runs_at = "", -math.inf

    async def send(self, message: dict[str, Any] | bytes) -> None:
        async with self._sending:
            if isinstance(message, bytes):
                await self.socket.send_bytes(message)
            else:
                await self.socket.send_text(json.dumps(message))

    async def serve(self) -> None:
        """Answer orders until the page goes."""
        await self.send({"schema": self.session.tables})
        self.wake.set()
        pushing = asyncio.create_task(self._push())
        try:
            while True:
                await self._answer(await self.socket.receive_text())
        except (WebSocketDisconnect, KeyError, RuntimeError):
            pass  # KeyError: bytes where text belongs
        finally:
            pushing.cancel()

    async def _answer(self, text: str) -> None:
        number: Any = None
        try:
            message = json.loads(text)
            number, name, given = message.get("id"), message["do"], message.get("with", {})
            if name == "look":
                self.wants[int(given["slot"])] = {"run": int(given["run"]), "field": str(given["field"]), **given}
                self.wake.set()
                return
            answer = await asyncio.to_thread(self.session.order, str(name), given)
            await self.send({"id": number, "ok": answer})
        except (Refused, PlicaError, ValueError, TypeError, KeyError, AttributeError, OSError, RecursionError,
            OverflowError) as error:
            await self.send({"id": number, "problem": problem_of(error)})

    async def _push(self) -> None:
        while True:
            await self.wake.wait()
            self.wake.clear()
            await self._send_states()
            for slot, want in list(self.wants.items()):
                try:
                    messages = await asyncio.to_thread(self.session.frame_messages, want)
                except (OSError, LookupError, TypeError, ValueError):
                    continue  # a run is just being resumed or removed, or nonsense: tried again at the next change
                if messages and self.wants.get(slot) is want:
                    del self.wants[slot]
                    for message in messages:
                        await self.send(message)

    async def _send_states(self) -> None:
        session = self.session
        key = (session.revision, session.rest.version, session.candidate.asked, session.candidate.version)
        if key != self._draft:
            self._draft = key
            await self.send({"draft": session.draft_state()})
        left_s = self._runs_at + STATES_APART_S - time.monotonic()
        if left_s > 0:
            asyncio.get_running_loop().call_later(left_s, self.wake.set)
            return
        runs = json.dumps(session.runs_state())
        if runs != self._runs:
            self._runs, self._runs_at = runs, time.monotonic()
            await self.send({"runs": json.loads(runs)})


class Server:
    """Server of one session, at `url`."""

    def __init__(self, folder: Path, token: str, *, port: int = 0, threads: Optional[int] = None) -> None:
        self.token = token
        self.socket = _bound(port)
        self.port = int(self.socket.getsockname()[1])
        self.pages: set[Page] = set()
        self.loop: Optional[asyncio.AbstractEventLoop] = None
        self.session = Session(folder, self._told, threads)
        page = page_text()

        async def show(_: Request) -> Response:
            return Response(page, media_type="text/html", headers=HEADERS)

        routes = [Route("/", self._guarded(show)), Route("/take/{number:int}/{name}", self._guarded(self._take)),
                  Route("/card/{name}", self._guarded(self._card)), WebSocketRoute("/ws", self._connect)]
        self.app = Starlette(routes=routes)
        config = uvicorn.Config(self.app, log_level="error", ws="websockets-sansio", ws_max_size=MOST_MESSAGE_BYTES,
                                ws_per_message_deflate=False, lifespan="off", timeout_graceful_shutdown=1)
        self.server = uvicorn.Server(config)

    @property
    def url(self) -> str:
        return f"http://{HOST}:{self.port}/?token={self.token}"

    def run(self) -> None:
        """Serve until interrupted."""
        try:
            self.server.run(sockets=[self.socket])
        finally:
            self.session.close()

    def stop(self) -> None:
        self.server.should_exit = True

    def _told(self) -> None:
        """Wake the pages, from any thread."""
        if self.loop is not None and not self.loop.is_closed():
            self.loop.call_soon_threadsafe(self._wake)

    def _wake(self) -> None:
        for page in self.pages:
            page.wake.set()

    # Who may ask

    def _allowed(self, request: HTTPConnection) -> bool:
        hosts = [f"{name}:{self.port}" for name in NAMES]
        origin = request.headers.get("origin")
        has_token = hmac.compare_digest(request.query_params.get("token", "").encode(), self.token.encode())
        is_ours = origin is None or origin in [f"http://{host}" for host in hosts]
        is_here = request.headers.get("host", "") in hosts and is_ours
        return has_token and is_here

    def _guarded(self, show: Callable[[Request], Awaitable[Response]]) -> Callable[[Request], Awaitable[Response]]:
        async def guarded(request: Request) -> Response:
            if not self._allowed(request):
                return PlainTextResponse("Refused: open the address that plica studio printed.\n", 403, HEADERS)
            return await show(request)
        return guarded

    async def _card(self, request: Request) -> Response:
        """Give the picture of a scenario of the gallery."""
        name = request.path_params["name"]
        if name not in (*STARTS, *_core.scenarios) or not (CARDS / f"{name}.png").is_file():
            return PlainTextResponse(f"{name[:60]}: no such picture\n", 404, HEADERS)
        return Response((CARDS / f"{name}.png").read_bytes(), media_type="image/png", headers=HEADERS)

    async def _take(self, request: Request) -> Response:
        """Give the scenario or the script of a run as a file."""
        number, name = request.path_params["number"], request.path_params["name"]
        texts = {"scenario.toml": self.session.scenario_text, "run.py": self.session.script_text}
        try:
            text = await asyncio.to_thread(texts[name], number)
        except (KeyError, Refused) as error:
            return PlainTextResponse(f"{name}: {error}\n", 404, HEADERS)
        return Response(text, media_type="text/plain",
            headers={**HEADERS, "Content-Disposition": f'attachment; filename="{name}"'})

    async def _connect(self, socket_: WebSocket) -> None:
        if not self._allowed(socket_) or socket_.headers.get("origin") is None or len(self.pages) >= MOST_CONNECTIONS:
            await socket_.close(4403)
            return
        self.loop = asyncio.get_running_loop()
        await socket_.accept()
        page = Page(socket_, self.session)
        self.pages.add(page)
        try:
            await page.serve()
        finally:
            self.pages.discard(page)


def _bound(port: int) -> socket.socket:
    """Return a socket on this port, or on a free one if it is taken. A browser that is faster than the server waits."""
    made = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        made.bind((HOST, port))
    except OSError:
        made.bind((HOST, 0))
    made.listen()
    return made
