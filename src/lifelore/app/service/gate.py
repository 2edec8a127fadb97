"""The gate before all routes: identifier, admission, limits, errors, metrics and log of each request.

All requests pass it, so each of its steps is cheap.
"""

import asyncio
import itertools
import re
import secrets
import time
from collections.abc import Collection
from typing import Any

from lifelore.app.service.admission import Admission, Refused, limited_body
from lifelore.app.service.error_documents import error_body, send_json
from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.telemetry import Metrics, log_request
from lifelore.app.service.tokens import TokenFile
from lifelore.app.service.worker_process import ClientLeft

CLIENT_LEFT = 499
"""Status in metrics and log of a request whose client left before the answer, as other servers write it."""
_IDENTIFIER = re.compile(rb"[A-Za-z0-9_.:-]{1,100}")
_HEADERS = [(b"x-content-type-options", b"nosniff"), (b"cache-control", b"no-store")]
_METHODS = {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}


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
        self._app, self._settings, self._metrics = app, settings, metrics
        self._admission = Admission(settings, tokens, open_paths)
        self._running = 0
        metrics.running.set_function(lambda: self._running)
        self._first, self._numbers = secrets.token_hex(5), itertools.count()

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        began = time.perf_counter()
        headers = dict(scope["headers"])
        identifier = self._identifier(headers)
        scope.setdefault("state", {})["request"] = identifier
        added = [(b"x-request-id", identifier.encode()), *_HEADERS]
        status, client, defect = 0, "", None
        loop, limit = asyncio.get_running_loop(), asyncio.timeout(self._settings.seconds)
        self._running += 1

        async def answer(message: Any) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                message["headers"] = [*message.get("headers", ()), *added]
            elif message.get("more_body") and not limit.expired():
                limit.reschedule(loop.time() + self._settings.seconds)
            await send(message)

        async def refuse(code: int, message: str, further: Collection[tuple[bytes, bytes]] = ()) -> None:
            if not status:
                await send_json(answer, code, error_body(code, message, identifier), further)

        try:
            client = self._admission.client_of(scope, headers)
            if b"content-length" not in headers or b"transfer-encoding" in headers:
                receive = limited_body(receive, self._settings.largest_body)
            async with limit:
                await self._app(scope, receive, answer)
        except Refused as refused:
            await refuse(refused.status, str(refused), refused.headers)
        except asyncio.CancelledError:
            await refuse(503, "the service stops; try again")
        except ClientLeft:
            status = status or CLIENT_LEFT
        except Exception as error:
            if limit.expired():
                late = f"the request took longer than {self._settings.seconds:g} s; send less, or try again"
                await refuse(504, late)
            else:
                defect = error
                await refuse(500, "Lifelore failed; the log of the service has the traceback under this request")
        finally:
            self._running -= 1
            self._note(scope, identifier, client, status, time.perf_counter() - began, defect)

    def _identifier(self, headers: dict[bytes, bytes]) -> str:
        """The identifier that the client gave its request, or a new one."""
        given = headers.get(b"x-request-id")
        if given is not None and _IDENTIFIER.fullmatch(given):
            return given.decode()
        return f"{self._first}{next(self._numbers):06x}"

    def _note(
        self, scope: Any, identifier: str, client: str, status: int, seconds: float, defect: Exception | None
    ) -> None:
        found = scope.get("route")
        route = "other" if found is None else getattr(found, "path", "other")
        method = scope["method"] if scope["method"] in _METHODS else "other"
        self._metrics.count(method, route, status, seconds)
        # Requests beyond the rate are counted and not logged, so that a client cannot fill the disk of the log.
        if defect is None and not self._settings.access_log and (status < 400 or status == 429):
            return
        fields = {
            "request": identifier, "client": client, "method": method, "route": route, "status": status,
            "ms": round(1e3 * seconds, 2),
        }  # fmt: skip
        log_request(fields, defect)
