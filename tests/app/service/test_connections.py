"""Connections whose headers are slow or too large close; the gate judges slow bodies and answers."""

import asyncio
import contextlib
import time
from collections.abc import AsyncIterator

import pytest

pytest.importorskip("uvicorn", reason="needs the extra web")

import uvicorn

from lifelore.app.service import server
from lifelore.app.service.server import PatientProtocol

REQUEST = b"POST / HTTP/1.1\r\nHost: here\r\nContent-Length: 3\r\n\r\n"


async def echo(scope, receive, send):
    body, more = b"", True
    while more:
        message = await receive()
        body, more = body + message.get("body", b""), message.get("more_body", False)
    if body == b"zzz":
        await asyncio.sleep(1.0)
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"3")]})
    await send({"type": "http.response.body", "body": body})


@contextlib.asynccontextmanager
async def connected() -> AsyncIterator[tuple[asyncio.StreamReader, asyncio.StreamWriter]]:
    config = uvicorn.Config(echo, port=0, http=PatientProtocol, lifespan="off", log_config=None)
    server = uvicorn.Server(config)
    serving = asyncio.ensure_future(server._serve())
    while not server.started:
        await asyncio.sleep(0.01)
    port = server.servers[0].sockets[0].getsockname()[1]
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        yield reader, writer
    finally:
        writer.close()
        server.should_exit = True
        await serving


async def trickle(reader: asyncio.StreamReader, writer: asyncio.StreamWriter, data: bytes) -> float:
    """Send a byte each 50 ms until the connection closes; the seconds that took, or infinity."""
    began = time.monotonic()
    with contextlib.suppress(OSError):
        for byte in data:
            writer.write(bytes([byte]))
            await writer.drain()
            try:
                if not await asyncio.wait_for(reader.read(1), 0.05):
                    return time.monotonic() - began
            except TimeoutError:
                continue
        return float("inf")
    return time.monotonic() - began


@pytest.fixture(autouse=True)
def short(monkeypatch):
    monkeypatch.setattr(server, "HEADERS", 0.3)


@pytest.mark.parametrize("before", [b"", REQUEST + b"abc"], ids=["first", "second"])
def test_slow_headers_end(before):
    async def seconds() -> float:
        async with connected() as (reader, writer):
            if before:
                writer.write(before)
                assert (await reader.readuntil(b"\r\n\r\n")).startswith(b"HTTP/1.1 200")
                assert await reader.readexactly(3) == b"abc"
            return await trickle(reader, writer, b"GET / HTTP/1.1\r\nX-Slow: " + b"x" * 200)

    assert 0.2 < asyncio.run(seconds()) < 10.0, "0.3 to 0.6 s on an idle machine"


def test_headers_have_a_largest_size():
    async def closes() -> bool:
        async with connected() as (reader, writer):
            writer.write(b"GET / HTTP/1.1\r\n")
            with contextlib.suppress(OSError):
                for _ in range(100):
                    writer.write(b"X-Header: " + b"x" * 990)
                    await writer.drain()
                return await reader.read(1) == b""
            return True

    assert asyncio.run(asyncio.wait_for(closes(), 20))


@pytest.mark.parametrize("body", [b"abc", b"zzz"], ids=["slow body", "slow answer"])
def test_slow_bodies_and_answers_do_not_end(body):
    async def found() -> bytes:
        async with connected() as (reader, writer):
            writer.write(REQUEST + body[:1])
            await asyncio.sleep(0.0 if body == b"zzz" else 1.0)
            writer.write(body[1:])
            await reader.readuntil(b"\r\n\r\n")
            return await reader.readexactly(3)

    assert asyncio.run(found()) == body


def test_quick_requests_on_one_connection_go_on():
    async def asked() -> None:
        async with connected() as (reader, writer):
            for _ in range(15):  # 1.5 s
                writer.write(REQUEST + b"abc")
                await reader.readuntil(b"\r\n\r\n")
                assert await reader.readexactly(3) == b"abc"
                await asyncio.sleep(0.1)

    asyncio.run(asked())
