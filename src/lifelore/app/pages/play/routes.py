"""Routes of the page /play: sessions of the study, the record of a player, results, and the socket of a round."""

from typing import Any, Literal

from fastapi import APIRouter, WebSocket
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field

from lifelore.agent.play_study.scripted_player import scripted_others
from lifelore.agent.play_study.study_records import (
    CONSENT,
    export_csv,
    export_session,
    forget_session,
    open_free_session,
    open_new_session,
    open_session,
    store_round,
)
from lifelore.agent.play_study.study_results import study_results
from lifelore.agent.play_study.study_settings import FRAMES_A_SECOND, LENGTHS, StudySettings
from lifelore.app.pages.open_sessions import CsvResponse, Name, OpenSessions, add_record_routes
from lifelore.app.pages.play.live_round import LiveRound
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.service_state import Service
from lifelore.core.errors import InputError, LifeloreError
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from lifelore.domains.ball_game.layouts import SIDE, layout_of

LAYOUT = "s-maze 160"
REFUSED = 4400
"""Code with which a socket closes after an error that its last message explains."""


class SessionRequest(BaseModel):
    """A new session of the study."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"consent": True, "length": "short"}})
    consent: bool = Field(description="Whether the player agrees to the text of `GET /v1/play/game`.")
    length: Literal["short", "medium", "thesis"] = Field(
        "short", description="Number of sizes, speeds and rounds."
    )
    player: Literal["person", "scripted"] = Field("person", description="Who plays; results are shown apart.")
    frames_per_move: int = Field(5, ge=1, le=FRAMES_A_SECOND, description="Frames of 1/30 s that a move takes.")


def router(service: Service) -> APIRouter:
    """The routes of the page."""
    routes = APIRouter(prefix="/v1/play", tags=["play"], route_class=JsonRoute)
    memory, run = service.memory, service.writer.run
    sessions = OpenSessions(memory, open_session)
    playing: set[str] = set()

    @routes.get("/game", summary="The game, the lengths of a session and the text of consent")
    def game() -> dict[str, Any]:
        layout = layout_of(LAYOUT)
        lengths = {name: StudySettings.of_length(name).rounds for name in LENGTHS}
        return {
            "side": SIDE, "polygons": layout.polygons, "start": layout.start, "goal": layout.goal,
            "sizes": SIZES, "speeds": SPEEDS, "lengths": lengths, "consent": CONSENT,
        }  # fmt: skip

    @routes.post("/sessions", summary="Begin a session of the study")
    async def begin(document: SessionRequest) -> Any:
        settings = await run_in_threadpool(
            StudySettings.of_length, document.length, document.player, document.frames_per_move, LAYOUT
        )
        await run_in_threadpool(scripted_others, LAYOUT)
        seed = service.settings.seed
        opened = await run(lambda: open_new_session(memory, settings, consent=document.consent, seed=seed))
        return JSONResponse(sessions.add(opened).view())

    @routes.get("/sessions/{name}", summary="The state of a session")
    def show(name: Name) -> dict[str, Any]:
        return sessions.of(name).view()

    exports = {"": (JSONResponse, export_session), ".csv": (CsvResponse, export_csv)}
    add_record_routes(routes, service, "session", sessions, exports, forget_session)

    @routes.get("/results", summary="Numbers of Figures 4.18-4.20 from the recorded rounds")
    def results() -> dict[str, Any]:
        return study_results(memory)

    @routes.websocket("/sessions/{session}/live")
    async def live(socket: WebSocket, session: str) -> None:
        await socket.accept(subprotocol="lifelore")
        try:
            opened = await run_in_threadpool(sessions.of, session)
            if session in playing:
                raise InputError(
                    "the session is open in another window; close that window, then load this page again"
                )
        except LifeloreError as error:
            await socket.send_json({"kind": "error", "message": str(error)})
            await socket.close(REFUSED)
            return
        playing.add(session)
        try:
            await LiveRound(socket, opened, lambda *round: run(store_round, memory, *round)).serve()
        finally:
            playing.discard(session)

    @routes.websocket("/free/live")
    async def free(socket: WebSocket) -> None:
        await socket.accept(subprotocol="lifelore")
        opened = await run_in_threadpool(open_free_session, memory, LAYOUT)
        await LiveRound(socket, opened, None).serve()

    return routes
