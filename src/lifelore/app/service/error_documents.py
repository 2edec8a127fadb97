"""Errors as JSON documents of one shape, with the words of the library.

    {"error": {"kind": "input", "message": "outcome must be a finite number, got nan", "request": "f3a…"}}

A message never names a file of the server: the location of the memory and temporary folders are left out.
"""

import json
import re
import tempfile
from collections.abc import Awaitable, Callable, Iterable
from typing import Any

from pydantic import BaseModel, Field

from lifelore.core.errors import InputError, LifeloreError, MissingExtraError, NotFoundError, StoreError

STATUS = {InputError: 422, NotFoundError: 404, MissingExtraError: 501, StoreError: 503}
KINDS = {
    400: "input", 401: "token", 403: "scope", 404: "not found", 405: "method", 406: "input", 411: "input",
    413: "too large", 415: "input", 422: "input", 429: "rate", 500: "defect", 501: "missing extra", 503: "store",
    504: "time",
}  # fmt: skip
"""The kind of an error by its HTTP status."""


WRONG_METHOD = "the address does not take this method; /openapi.json lists all"


class ErrorFields(BaseModel):
    kind: str = Field(description="Kind of the error; the HTTP status follows from it.", examples=["input"])
    message: str = Field(
        description="The argument, the rule, the value and the next step.",
        examples=["outcome must be a finite number of at most 1e+150 in size, got inf"],
    )
    request: str = Field(description="Identifier of the request, as in the log of the service.")


class ErrorDocument(BaseModel):
    """The answer to a request that failed."""

    error: ErrorFields


def status_of(error: LifeloreError) -> int:
    """The HTTP status of an error of the library."""
    return next((status for kind, status in STATUS.items() if isinstance(error, kind)), 500)


def error_body(status: int, message: str, request: str) -> bytes:
    """The JSON document of an error."""
    fields = {"kind": KINDS.get(status, "input"), "message": " ".join(message.split()), "request": request}
    return json.dumps({"error": fields}).encode()


async def send_json(
    send: Callable[[Any], Awaitable[None]], status: int, body: bytes, headers: Iterable[tuple[bytes, bytes]] = ()
) -> None:
    """Answer a request of ASGI with a JSON document."""
    lines = [(b"content-type", b"application/json"), (b"content-length", str(len(body)).encode()), *headers]
    await send({"type": "http.response.start", "status": status, "headers": lines})
    await send({"type": "http.response.body", "body": body})


def without_places(message: str, location: str) -> str:
    """A message without the location of the memory or its server, and without temporary folders."""
    message = message.replace(location, "the memory")
    message = re.sub(r'server at "[^"]*"(?: \([^)]*\))?, port \d+', "the server", message)
    return re.sub(re.escape(tempfile.gettempdir()) + r"/[^/\s'\"]+/?", "", message)


def validation_message(errors: Any) -> str:
    """One line from the first error of a request that does not fit its schema."""
    first = errors[0]
    place = ".".join(str(part) for part in first["loc"][1:]) or str(first["loc"][0])
    got = "" if first["type"] in ("missing", "json_invalid") else f", got {_short(first.get('input'))}"
    more = f"; {len(errors) - 1} more errors" if len(errors) > 1 else ""
    return f"{place}: {first['msg'][:1].lower()}{first['msg'][1:]}{got}{more}"


def _short(value: Any) -> str:
    """A value in some 60 characters; a large one is never written as a whole."""
    if isinstance(value, list | dict):
        return f"{len(value)} items" if len(value) > 5 else ascii(value)[:60]
    return ascii(value[:60] if isinstance(value, str) else value)[:60]
