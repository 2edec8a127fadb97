"""Bodies of requests: kinds of files, and large JSON documents that hold up no other request.

The parser of JSON holds Python's lock until a document is read: 1 s for 50 MB of small numbers. Beyond `LARGE`
bytes, documents are read on a thread by a parser in Python, which is as fast for long texts, slower for many small
values, and lets the other requests through.
"""

from collections.abc import Callable, Coroutine
from json import scanner
from json.decoder import JSONDecoder
from typing import Any, TypeVar

from fastapi.routing import APIRoute
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

LARGE = 1_000_000
"""Bytes of a document that is read on the event loop, at most; more delays the other requests for longer."""
MOST_VALUES = 1_000_000
"""Largest number of values in a document beyond `LARGE` bytes; it may have texts of any length."""
BYTES, SQLITE = "application/octet-stream", "application/vnd.sqlite3"

T = TypeVar("T")


async def parsed(body: bytes, decoder: Callable[[bytes], T]) -> T:
    """``decoder(body)``, on a thread where the body is large.

    A decoder that holds Python's lock delays other requests from a thread too; a large document of many values
    needs one that is fast (msgspec with a type) or that gives way (`patient_json`).
    """
    return decoder(body) if len(body) <= LARGE else await run_in_threadpool(decoder, body)


def patient_json(body: bytes) -> Any:
    """A JSON document, read so that other threads run meanwhile.

    Raises
    ------
    HTTPException
        Status 413: it has more than `MOST_VALUES` values.
    JSONDecodeError, UnicodeDecodeError, RecursionError
        It is no JSON in UTF-8, or too deep.
    """
    # The decoder takes a scanner in C, which cannot be told how to read arrays and objects.
    decoder: Any = JSONDecoder()
    parse_array, parse_object = decoder.parse_array, decoder.parse_object
    values = 0

    def counted(text: str, at: int) -> Any:
        nonlocal values
        values += 1
        if values > MOST_VALUES:
            raise HTTPException(413, f"the body must have at most {MOST_VALUES} values; send it in parts")
        return scan_value(text, at)

    decoder.parse_array = lambda place, _: parse_array(place, counted)
    decoder.parse_object = lambda place, strict, _, *hooks: parse_object(place, strict, counted, *hooks)
    scan_value = scanner.py_make_scanner(decoder)  # pyright: ignore[reportAttributeAccessIssue]
    decoder.scan_once = counted
    return decoder.decode(body.decode())


class JsonRequest(Request):
    """A request whose document is read by `patient_json` where it is large."""

    async def json(self) -> Any:
        body = await self.body()
        return await super().json() if len(body) <= LARGE else await run_in_threadpool(patient_json, body)


class JsonRoute(APIRoute):
    """A route of FastAPI with a `JsonRequest`: ``APIRouter(route_class=JsonRoute)``."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """The handler of the route."""
        handler = super().get_route_handler()

        async def handle(request: Request) -> Response:
            return await handler(JsonRequest(request.scope, request.receive))

        return handle


async def file_of(request: Request, *kinds: str) -> bytes:
    """The body of a request that is a file; HTTPException with status 415 where it is of another kind."""
    kinds = kinds or (BYTES,)
    given = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if given not in kinds:
        raise HTTPException(415, f"content-type must be {' or '.join(kinds)}, got {given[:60]!r}")
    return await request.body()


def body_of(*kinds: str) -> dict[str, Any]:
    """The OpenAPI of a request whose body is a file."""
    content = {kind: {"schema": {"type": "string", "format": "binary"}} for kind in kinds}
    return {"requestBody": {"required": True, "content": content}}
