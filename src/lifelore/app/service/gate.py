"""The gate before all routes: identifier, token, limits, errors, metrics and log of each request."""

import asyncio
import re
import secrets
import time
from collections.abc import Collection
from typing import Any

from lifelore.app.service.error_documents import error_body
from lifelore.app.service.limits import RateLimit, limited_body, too_large
from lifelore.app.service.settings import ServiceSettings, is_loopback
from lifelore.app.service.telemetry import Metrics, log_request
from lifelore.app.service.tokens import TokenFile

OPEN_PATHS = ("/healthz", "/openapi.json")
"""Paths that need no token: they tell nothing about the memory."""
OPEN_PREFIX = "/static/"
"""Beginning of the paths of scripts and style sheets, which need no token."""
READING_POSTS = ("/v1/perceive", "/v1/evaluate")
"""Beginnings of paths whose POST stores nothing and needs the scope read only."""
_IDENTIFIER = re.compile(rb"[A-Za-z0-9_.:-]{1,100}")
_HEADERS = [(b"x-content-type-options", b"nosniff"), (b"cache-control", b"no-store")]


class _Refused(Exception):
    def __init__(self, status: int, message: str, headers: list[tuple[bytes, bytes]] | None = None) -> None:
        super().__init__(message)
        self.status, self.headers = status, headers or []


class Gate:
    """ASGI middleware around the whole application.

    Parameters
    ----------
    app : ASGI application
    settings : ServiceSettings
    tokens : TokenFile, optional
        Without it only requests that name this machine as their host pass.
    metrics : Metrics
    open_paths : collection of str
        Further paths that need no token; those below ``/static/`` never do.
    """

    def __init__(
        self,
        app: Any,
        settings: ServiceSettings,
        tokens: TokenFile | None,
        metrics: Metrics,
        open_paths: Collection[str] = (),
    ) -> None:
        self._app, self._settings, self._tokens, self._metrics = app, settings, tokens, metrics
        self._open = {*OPEN_PATHS, *open_paths}
        self._rate = RateLimit(settings.rate)

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] == "websocket":
            await self._pass_socket(scope, receive, send)
            return
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began = time.perf_counter()
        headers = dict(scope["headers"])
        given = headers.get(b"x-request-id", b"")
        identifier = given.decode() if _IDENTIFIER.fullmatch(given) else secrets.token_hex(8)
        scope.setdefault("state", {})["request"] = identifier
        status, client, defect = 0, "", None

        async def answer(message: Any) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                message["headers"] = [
                    *message.get("headers", ()), (b"x-request-id", identifier.encode()), *_HEADERS
                ]  # fmt: skip
            await send(message)

        self._metrics.running.inc()
        try:
            client = self._admit(scope, headers)
            async with asyncio.timeout(self._settings.seconds):
                await self._app(scope, limited_body(receive, self._settings.largest_body), answer)
        except _Refused as refused:
            await _refuse(answer, refused.status, str(refused), identifier, refused.headers)
        except TimeoutError:
            if not status:
                message = f"the request took longer than {self._settings.seconds:g} s; send less, or try again"
                await _refuse(answer, 504, message, identifier)
        except Exception as error:
            defect = error
            if not status:
                message = "Lifelore failed; the log of the service has the traceback under this request"
                await _refuse(answer, 500, message, identifier)
        finally:
            self._metrics.running.dec()
            self._note(scope, identifier, client, status, time.perf_counter() - began, defect)

    async def _pass_socket(self, scope: Any, receive: Any, send: Any) -> None:
        """A web socket has no headers of its own: its token is a subprotocol ``bearer.TOKEN``."""
        headers = dict(scope["headers"])
        protocols = [name.strip() for name in headers.get(b"sec-websocket-protocol", b"").split(b",")]
        token = next((name[7:] for name in protocols if name.startswith(b"bearer.")), None)
        if token is not None:
            headers[b"authorization"] = b"Bearer " + token
        try:
            self._admit(scope | {"method": "POST"}, headers)
        except _Refused:
            await send({"type": "websocket.close", "code": 1008})  # refused with 403 before it opens
            return
        await self._app(scope, receive, send)

    def _admit(self, scope: Any, headers: dict[bytes, bytes]) -> str:
        """The name of the client; `_Refused` where it may not do this."""
        path = scope["path"]
        client = scope["client"][0] if scope.get("client") else "unknown"
        if self._tokens is None:
            _refuse_strangers(headers)
        elif path not in self._open and not path.startswith(OPEN_PREFIX):
            client = self._token_of(scope["method"], path, headers)
        if (wait := self._rate.wait_for(client)) > 0:
            message = (
                f"rate must be at most {self._settings.rate:g} requests per second; try again in {wait:.2g} s"
            )
            raise _Refused(429, message, [(b"retry-after", str(int(wait) + 1).encode())])
        length = headers.get(b"content-length", b"0")
        if not length.isdigit():
            raise _Refused(400, "content-length must be a whole number")
        if int(length) > self._settings.largest_body:
            raise _Refused(413, too_large(self._settings.largest_body))
        return client

    def _token_of(self, method: str, path: str, headers: dict[bytes, bytes]) -> str:
        kind, _, token = headers.get(b"authorization", b"").decode("latin-1").partition(" ")
        challenge = [(b"www-authenticate", b"Bearer")]
        if kind.lower() != "bearer" or not token:
            raise _Refused(
                401, "the request needs a token; add the header 'Authorization: Bearer TOKEN'", challenge
            )
        found = self._tokens.find(token.strip()) if self._tokens else None
        if found is None:
            raise _Refused(401, "the token is none of this service; ask for one", challenge)
        reads = method in ("GET", "HEAD", "OPTIONS") or path.startswith(READING_POSTS)
        needed = "read" if reads else "write"
        if needed not in found.scopes:
            raise _Refused(
                403, f"the token must have the scope {needed}, it has {', '.join(sorted(found.scopes))}"
            )
        return found.name

    def _note(
        self, scope: Any, identifier: str, client: str, status: int, seconds: float, defect: Exception | None
    ) -> None:
        route = getattr(scope.get("route"), "path", "other")
        method = scope["method"] if scope["method"] in _METHODS else "other"
        self._metrics.count(method, route, status, seconds)
        fields = {
            "request": identifier, "client": client, "method": method, "route": route, "status": status,
            "ms": round(1e3 * seconds, 2),
        }  # fmt: skip
        log_request(fields, defect)


_METHODS = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS")


def _refuse_strangers(headers: dict[bytes, bytes]) -> None:
    """Refuse pages of other sites in a browser on this machine, also where they rename this machine."""
    host = _host_of(headers.get(b"host", b"").decode("latin-1"))
    if not is_loopback(host):
        raise _Refused(403, "without tokens the host must be this machine; start the service with --token-file")
    origin = headers.get(b"origin")
    if origin is not None and not is_loopback(_host_of(origin.decode("latin-1").partition("://")[2])):
        raise _Refused(
            403, "without tokens a page of another site may not ask; start the service with --token-file"
        )


def _host_of(name: str) -> str:
    return name.rpartition(":")[0] if re.search(r":\d+$", name) and not name.endswith("]") else name


async def _refuse(
    answer: Any, status: int, message: str, identifier: str, headers: list[tuple[bytes, bytes]] | None = None
) -> None:
    body = error_body(status, message, identifier)
    lines = [
        (b"content-type", b"application/json"), (b"content-length", str(len(body)).encode()), *(headers or [])
    ]  # fmt: skip
    await answer({"type": "http.response.start", "status": status, "headers": lines})
    await answer({"type": "http.response.body", "body": body})
