"""A client that sends requests over many connections at once, and measures the time of each."""

import asyncio
import json
import time
from collections.abc import AsyncIterator, Callable
from typing import Any

SCENARIO = Callable[["Connection", int], AsyncIterator[None]]
"""Asks forever over a connection of a number; each item is a finished unit of work."""


class Connection:
    """A connection that sends one request after the other."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer
        self.seconds: list[float] = []

    async def post(self, path: str, document: Any, method: str = "POST") -> bytes:
        """The JSON answer to a POST, or to another method; RuntimeError unless its status is 200.

        It is not parsed: a long one would hold up the other connections of this process.
        """
        body = json.dumps(document).encode()
        head = (
            f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
            f"Content-Length: {len(body)}\r\n\r\n"
        )
        began = time.perf_counter()
        self._writer.write(head.encode() + body)
        lines = (await self._reader.readuntil(b"\r\n\r\n")).split(b"\r\n")
        length = next(int(line.split(b":")[1]) for line in lines if line.lower().startswith(b"content-length"))
        content = await self._reader.readexactly(length)
        self.seconds.append(time.perf_counter() - began)
        if not lines[0].startswith(b"HTTP/1.1 200"):
            raise RuntimeError(f"{path}: {lines[0].decode()} {content[:200].decode()}")
        return content

    def close(self) -> None:
        """Close the connection."""
        self._writer.close()


async def run_load(port: int, scenario: SCENARIO, connections: int, seconds: float) -> tuple[float, list[float]]:
    """Units of work per second over all connections, and the seconds of each request."""
    opened = [Connection(*await asyncio.open_connection("127.0.0.1", port)) for _ in range(connections)]
    began, units = time.perf_counter(), 0

    async def work(number: int) -> None:
        nonlocal units
        async for _ in scenario(opened[number], number):
            units += 1
            if time.perf_counter() - began > seconds:
                return

    await asyncio.gather(*(work(number) for number in range(connections)))
    elapsed = time.perf_counter() - began
    for connection in opened:
        connection.close()
    return units / elapsed, [one for connection in opened for one in connection.seconds]
