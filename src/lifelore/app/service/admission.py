"""Who may ask what: hosts, origins, tokens with their scopes and studies, kinds and sizes of bodies, and rates."""

import re
import time
from collections import OrderedDict
from collections.abc import Callable, Collection, Mapping
from functools import lru_cache
from typing import Any

from starlette.exceptions import HTTPException

from lifelore.app.service.settings import ServiceSettings, is_loopback
from lifelore.app.service.tokens import Token, TokenFile

WINDOW = 10.0
"""Seconds of requests that a client may send at once after a pause."""
CLIENTS = 10_000
"""Largest number of clients that are counted; the one not seen for longest is forgotten."""


class RateLimit:
    """A bucket of permits for each client, filled at a constant rate.

    Parameters
    ----------
    rate : float
        Requests per second; 0: no limit.
    clock : callable, optional
        Seconds, for tests.
    window : float
        Seconds of permits in a full bucket.
    """

    def __init__(self, rate: float, clock: Callable[[], float] = time.monotonic, window: float = WINDOW) -> None:
        self.rate, self._clock = rate, clock
        self._full = max(1.0, rate * window)
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def wait_for(self, client: str) -> float:
        """Take a permit of a client: 0, or the seconds until there is one."""
        if not self.rate:
            return 0.0
        now = self._clock()
        level, before = self._buckets.pop(client, (self._full, now))
        level = min(self._full, level + (now - before) * self.rate)
        wait = 0.0 if level >= 1 else (1 - level) / self.rate
        self._buckets[client] = (level if wait else level - 1, now)
        if len(self._buckets) > CLIENTS:
            self._buckets.popitem(last=False)
        return wait


def too_large(largest: int) -> str:
    """The message for a body above the limit."""
    return f"the body must have at most {largest} bytes; send it in parts"


def limited_body(receive: Callable[[], Any], largest: int) -> Callable[[], Any]:
    """`receive` of ASGI that raises an HTTPException with status 413 beyond `largest` bytes."""
    received = 0

    async def limited() -> Any:
        nonlocal received
        message = await receive()
        if message["type"] == "http.request":
            received += len(message.get("body", b""))
            if received > largest:
                raise HTTPException(413, too_large(largest))
        return message

    return limited


HEALTH = "/healthz"
"""Path that has no limit of its rate, so that a busy client does not hide that the service is well."""
OPEN_PATHS = (HEALTH, "/openapi.json", "/docs")
"""Paths that need no token: they tell nothing about the memory."""
OPEN_PREFIX = "/static/"
"""Beginning of the paths of scripts and style sheets, which need no token."""
READING_POSTS = ("/v1/perceive", "/v1/evaluate")
"""Beginnings of paths whose POST stores nothing and needs the scope read only."""
MEMORY = "/v1/memory"
"""Beginning of the paths of the memory as a whole, which need the scope admin."""
STUDIES = "/v1/studies/"
WRONG_TOKENS, MINUTE = 10, 60.0
"""Requests without a right token that an address may send in a minute; more of them get 429 in place of 401."""
JSON = "application/json"
FILES = ("application/octet-stream", "application/vnd.sqlite3", "application/x-ndjson", "text/csv")
"""Kinds of bodies beside JSON. A page of another site can send none of them unasked, in contrast to a form."""

Headers = Mapping[bytes, bytes]
_KINDS = {kind.encode() for kind in (JSON, *FILES)}


class Refused(Exception):
    """A request that may not be answered, with the status and headers of its answer."""

    def __init__(self, status: int, message: str, headers: list[tuple[bytes, bytes]] | None = None) -> None:
        super().__init__(message)
        self.status, self.headers = status, headers or []


class Admission:
    """The rules that a request must keep before its body is read.

    Parameters
    ----------
    settings : ServiceSettings
    tokens : TokenFile, optional
        Without it only requests that name this machine as their host, and no other page as their origin, pass.
    open_paths : collection of str
        Further paths that need no token; those below ``/static/`` never do.
    """

    def __init__(
        self, settings: ServiceSettings, tokens: TokenFile | None, open_paths: Collection[str] = ()
    ) -> None:
        self._largest, self._tokens = settings.largest_body, tokens
        self._open = {*OPEN_PATHS, *open_paths}
        self._rate = RateLimit(settings.rate)
        self._rule = f"rate must be at most {settings.rate:g} requests per second"
        self._failures = RateLimit(WRONG_TOKENS / MINUTE if settings.rate else 0.0, window=MINUTE)

    def client_of(self, scope: Mapping[str, Any], headers: Headers) -> str:
        """The name of the client, by its token or else its address; `Refused` where it may not do this."""
        path, method = scope["path"], scope["method"]
        client = scope["client"][0] if scope.get("client") else "unknown"
        if self._tokens is None:
            _refuse_strangers(headers)
        elif path not in self._open and not path.startswith(OPEN_PREFIX):
            client = self._named(self._tokens, client, method, path, headers)
        if path == HEALTH:
            return client
        _refuse_above(self._rate, client, self._rule)
        if method in ("POST", "PUT", "PATCH"):
            _refuse_forms(headers)
        length = headers.get(b"content-length", b"0")
        if not length.isdigit():
            raise Refused(400, "content-length must be a whole number")
        if int(length) > self._largest:
            raise Refused(413, too_large(self._largest))
        return client

    def _named(self, tokens: TokenFile, address: str, method: str, path: str, headers: Headers) -> str:
        kind, _, given = headers.get(b"authorization", b"").decode("latin-1").partition(" ")
        token = tokens.find(given.strip()) if kind.lower() == "bearer" else None
        if token is None:
            _refuse_above(self._failures, address, f"wrong tokens must be at most {WRONG_TOKENS} in a minute")
            message = "the token is none of this service; ask for one"
            if kind.lower() != "bearer" or not given:
                message = "the request needs a token; add the header 'Authorization: Bearer TOKEN'"
            raise Refused(401, message, [(b"www-authenticate", b"Bearer")])
        _refuse_beyond(token, method, path)
        return token.name


def needed_scope(method: str, path: str) -> str:
    """The scope that a request needs: read, write or admin."""
    whole_study = path.startswith(STUDIES) and path.count("/") == STUDIES.count("/")
    if path.startswith(MEMORY) or (method == "DELETE" and whole_study):
        return "admin"
    if method in ("GET", "HEAD", "OPTIONS") or path.startswith(READING_POSTS):
        return "read"
    return "write"


def _refuse_beyond(token: Token, method: str, path: str) -> None:
    needed = needed_scope(method, path)
    if needed not in token.scopes:
        has = ", ".join(sorted(token.scopes))
        raise Refused(403, f"the token must have the scope {needed}, it has {has}")
    if token.studies is None:
        return
    study = path.removeprefix(STUDIES).partition("/")[0] if path.startswith(STUDIES) else None
    if study not in token.studies:
        raise Refused(403, f"the token is for {STUDIES}… of {', '.join(sorted(token.studies))} alone")


def _refuse_above(limit: RateLimit, client: str, rule: str) -> None:
    if (wait := limit.wait_for(client)) > 0:
        again = [(b"retry-after", str(int(wait) + 1).encode())]
        raise Refused(429, f"{rule}; try again in {wait:.2g} s", again)


def _refuse_forms(headers: Headers) -> None:
    """Refuse bodies of kinds that a page of another site can send without being asked."""
    given = headers.get(b"content-type", b"")
    if given in _KINDS:
        return
    kind = given.partition(b";")[0].strip().lower()
    if kind in _KINDS or (kind.startswith(b"application/") and kind.endswith(b"+json")):
        return
    if not kind and b"transfer-encoding" not in headers and headers.get(b"content-length", b"0") == b"0":
        return
    raise Refused(
        415, f"content-type must be {JSON}, or that of a file where the address takes one, got {ascii(kind)[1:60]}"
    )


def _refuse_strangers(headers: Headers) -> None:
    """Refuse pages of other sites and other ports in a browser on this machine, also where they rename it."""
    host = headers.get(b"host", b"")
    if not _is_own(host):
        raise Refused(403, "without tokens the host must be this machine; start the service with --token-file")
    origin = headers.get(b"origin")
    if origin is not None and origin.lower() != b"http://" + host.lower():
        raise Refused(
            403, "without tokens a page of another site may not ask; start the service with --token-file"
        )


@lru_cache(100)
def _is_own(host: bytes) -> bool:
    """Whether the host of a request, with or without a port, is this machine."""
    name = host.decode("latin-1")
    return is_loopback(name.rpartition(":")[0] if re.search(r":\d+$", name) else name)
