"""Routes of the page /teach: a lesson, its steps, learning curves with and without its prior, its record."""

from threading import Lock
from typing import Any

from fastapi import APIRouter, Request
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field
from starlette.concurrency import run_in_threadpool

from lifelore.agent.factory_lesson.lesson import FactoryLesson
from lifelore.agent.factory_lesson.lesson_learners import EPISODES, lesson_curves
from lifelore.agent.factory_lesson.lesson_records import (
    demonstrations_in,
    export_lesson,
    forget_lesson,
    open_lesson,
    open_new_lesson,
    store_demonstration,
)
from lifelore.agent.factory_lesson.lesson_task import MOST_COMPONENTS
from lifelore.app.pages.open_sessions import JsonLinesResponse, Name, OpenSessions, add_record_routes
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.service_state import Service
from lifelore.core.errors import StoreError


class LessonRequest(BaseModel):
    """A new lesson."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"components": 2}})
    components: int = Field(2, ge=1, le=MOST_COMPONENTS, description="Number of components that a task assembles.")


class Step(BaseModel):
    """A step of the person."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"action": 4}})
    action: int = Field(ge=0, le=5, description="0 north, 1 south, 2 east, 3 west, 4 procure, 5 assemble.")


class Learning(BaseModel):
    """How far the curves shall go."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"episodes": 20}})
    episodes: int = Field(ge=1, le=EPISODES, description="Number of episodes from the first on.")


def router(service: Service) -> APIRouter:
    """The routes of the page."""
    routes = APIRouter(prefix="/v1/teach", tags=["teach"], route_class=JsonRoute)
    memory, run = service.memory, service.writer.run
    lessons = OpenSessions(memory, open_lesson)
    stepping = Lock()

    def view(lesson: FactoryLesson) -> dict[str, Any]:
        return {**lesson.view(), "floor": lesson.floor(), "memory": demonstrations_in(memory)}

    @routes.post("/lessons", summary="Begin a lesson")
    async def begin(document: LessonRequest) -> Any:
        seed = service.settings.seed
        return JSONResponse(view(lessons.add(await run(open_new_lesson, memory, document.components, seed))))

    @routes.get("/lessons/{name}", summary="The state of a lesson")
    def show(name: Name) -> dict[str, Any]:
        return view(lessons.of(name))

    @routes.post("/lessons/{name}/steps", summary="Take a step; the last step of a task stores its demonstration")
    async def step(name: Name, document: Step) -> Any:
        try:
            return JSONResponse(await run(take, name, document.action))
        except StoreError:
            lessons.close(name)  # it may hold a demonstration that is not stored
            raise

    def take(name: str, action: int) -> dict[str, Any]:
        opened = lessons.of(name)
        with stepping:
            opened.act(action)
            if opened.over:
                shown = opened.demonstration()
                store_demonstration(memory, opened, shown)
                opened.accept(shown)
            return opened.view()

    @routes.post("/lessons/{name}/next", summary="Go on to the next task; a task that is not over is dropped")
    def go_on(name: Name) -> dict[str, Any]:
        opened = lessons.of(name)
        with stepping:
            opened.go_on()
        return view(opened)

    @routes.post("/lessons/{name}/curves", summary="Learning curves with and without the prior of the lesson")
    async def curves(request: Request, name: Name, document: Learning) -> dict[str, Any]:
        opened = await run_in_threadpool(lessons.of, name)
        arguments = (opened.name, opened.components, opened.seed, list(opened.shown), document.episodes)
        return await service.worker.run(request, lesson_curves, *arguments)

    exports = {"": (JsonLinesResponse, export_lesson)}
    add_record_routes(routes, service, "lesson", lessons, exports, forget_lesson)
    return routes
