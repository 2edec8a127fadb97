"""Bare Starlette routes as the limit of the service: one stores a row in each transaction, one many that wait.

POST /row      an insert and a commit to the disk for each request
POST /group    inserts of the requests that wait at the same moment share a commit
"""

import asyncio
import sqlite3
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import msgspec
import uvicorn
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import Response
from starlette.routing import Route

INSERT = "INSERT INTO bare (body) VALUES (?)"


def bare_app(path: Path) -> Starlette:
    """The routes over a file of SQLite with ``synchronous=FULL``."""
    store = sqlite3.connect(path, isolation_level=None, check_same_thread=False)
    store.executescript("PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; CREATE TABLE bare (body TEXT)")
    waiting: list[tuple[bytes, asyncio.Future[None]]] = []
    encode, decode = msgspec.json.encode, msgspec.json.decode

    async def row(request: Request) -> Response:
        body = await request.body()
        decode(body)
        store.execute(INSERT, (body,))
        return answer({"stored": 1})

    async def group(request: Request) -> Response:
        body = await request.body()
        decode(body)
        loop = asyncio.get_running_loop()
        future = loop.create_future()
        waiting.append((body, future))
        if len(waiting) == 1:
            loop.call_soon(store_waiting)
        await future
        return answer({"stored": 1})

    def store_waiting() -> None:
        store.execute("BEGIN")
        store.executemany(INSERT, [(body,) for body, _ in waiting])
        store.execute("COMMIT")
        for _, future in waiting:
            future.set_result(None)
        waiting.clear()

    def answer(document: Any) -> Response:
        return Response(encode(document), media_type="application/json")

    return Starlette(routes=[Route("/row", row, methods=["POST"]), Route("/group", group, methods=["POST"])])


if __name__ == "__main__":
    with TemporaryDirectory() as folder:
        app = bare_app(Path(folder) / "bare.db")
        uvicorn.run(app, port=int(sys.argv[1]), log_level="warning", loop="uvloop", http="httptools")
