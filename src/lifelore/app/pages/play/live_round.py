"""The socket of a player: a task reads what the player does, and a loop sends a frame every 1/30 s.

The player sends ``{"do": "begin"}``, ``{"do": "free", "size": 20}``, ``{"do": "steer", "heading": 0}``,
``{"do": "belief", "show": true}`` or ``{"do": "leave"}``. The service sends documents of the kinds ``scene`` (a
round begins), ``frame``, ``over`` (the round is stored) and ``error``.
"""

import asyncio
import json
from collections.abc import Awaitable, Callable
from typing import Any

import anyio
from fastapi import WebSocket, WebSocketDisconnect
from fastapi.concurrency import run_in_threadpool

from lifelore.agent.play_study.round_result import RoundResult
from lifelore.agent.play_study.study_session import StudySession
from lifelore.agent.play_study.study_settings import FRAMES_A_SECOND
from lifelore.core.errors import InputError, LifeloreError

LARGEST_MESSAGE = 1000
"""Characters of the largest message of a player."""
WISHES = ("begin", "free", "steer", "belief", "leave")
Store = Callable[[StudySession, RoundResult], Awaitable[Any]]


class LiveRound:
    """The rounds of a session over one socket.

    Parameters
    ----------
    socket : WebSocket
        Accepted.
    session : StudySession
    store : async callable, optional
        Stores the result of a round before the page shows it; None where nothing is recorded.
    """

    def __init__(self, socket: WebSocket, session: StudySession, store: Store | None) -> None:
        self._socket, self._session, self._store = socket, session, store
        self._running, self._changing = asyncio.Event(), asyncio.Lock()
        self._shows_belief = False

    async def serve(self) -> None:
        """Play until the player closes the page; a round that is not over then begins again later."""
        try:
            async with anyio.create_task_group() as tasks:
                tasks.start_soon(self._send_frames)
                await self._read()
                tasks.cancel_scope.cancel()
        except* WebSocketDisconnect:
            pass
        finally:
            self._session.leave()

    async def _read(self) -> None:
        while (message := await self._socket.receive())["type"] != "websocket.disconnect":
            try:
                await self._do(_checked(message.get("text") or ""))
            except LifeloreError as error:
                await self._socket.send_json({"kind": "error", "message": str(error)})

    async def _do(self, message: dict[str, Any]) -> None:
        session, wish = self._session, message["do"]
        if wish == "steer":
            session.steer(message.get("heading"))  # pyright: ignore[reportArgumentType]
        elif wish == "belief":
            self._shows_belief = message.get("show") is True
        else:
            async with self._changing:
                self._running.clear()
                session.leave()
                if wish != "leave":
                    size: Any = message.get("size")
                    scene = await run_in_threadpool(
                        lambda: session.begin() if wish == "begin" else session.begin_free(size)
                    )
                    await self._socket.send_json({"kind": "scene", **scene})
                    self._running.set()

    async def _send_frames(self) -> None:
        """Frames at absolute deadlines, so that delays do not add up; a late loop goes on from now."""
        clock, period = asyncio.get_running_loop(), 1 / FRAMES_A_SECOND
        deadline = clock.time()
        while True:
            await self._running.wait()
            async with self._changing:
                if self._running.is_set():
                    await self._send_frame()
            deadline = max(deadline + period, clock.time())
            await asyncio.sleep(deadline - clock.time())

    async def _send_frame(self) -> None:
        frame = self._session.frame()
        belief = {"belief": self._session.belief()} if self._shows_belief and self._session.is_free else {}
        await self._socket.send_json({"kind": "frame", **frame, **belief})
        if frame["over"]:
            self._running.clear()
            try:
                await self._end()
            except LifeloreError as error:
                self._session.leave()
                await self._socket.send_json({"kind": "error", "message": f"the round is not stored: {error}"})

    async def _end(self) -> None:
        session = self._session
        played, result = session.playing, session.result()
        if result is not None and self._store is not None:
            with anyio.CancelScope(
                shield=True
            ):  # a page that closes now does not part the memory from the session
                await self._store(session, result)
                session.accept(result)
        else:
            session.leave()
        await self._socket.send_json(
            {"kind": "over", "moves": len(played.moves), "hits": played.hits, "reached": played.reached,
             "loss": round(played.loss, 4), "recorded": result is not None, "session": session.view()}
        )  # fmt: skip


def _checked(text: str) -> dict[str, Any]:
    try:
        message = json.loads(text) if len(text) <= LARGEST_MESSAGE else None
    except (ValueError, RecursionError):
        message = None
    if not isinstance(message, dict) or message.get("do") not in WISHES:
        raise InputError(f"message must be JSON with do, one of {', '.join(WISHES)}; send one of them")
    return message
