"""Routes of the page /teach: a lesson, its steps, learning curves with and without its prior, its record."""

from threading import Lock
from typing import Annotated, Any

from fastapi import APIRouter, Path, Response
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field

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
from lifelore.app.service.service_state import Service
from lifelore.core.errors import StoreError

MOST_OPEN = 200
"""Largest number of lessons held in main memory; others are read again from memory when their person returns."""
Name = Annotated[str, Path(description="Anonymous identifier of the lesson.", min_length=1, max_length=100)]


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
    routes = APIRouter(prefix="/v1/teach", tags=["teach"])
    memory, run = service.memory, service.writer.run
    lessons: dict[str, FactoryLesson] = {}
    stepping = Lock()

    def remember(lesson: FactoryLesson) -> FactoryLesson:
        lessons[lesson.name] = lesson
        while len(lessons) > MOST_OPEN:
            del lessons[next(iter(lessons))]
        return lesson

    def lesson_of(name: str) -> FactoryLesson:
        return lessons.get(name) or remember(open_lesson(memory, name))

    def view(lesson: FactoryLesson) -> dict[str, Any]:
        return {**lesson.view(), "floor": lesson.floor(), "memory": demonstrations_in(memory)}

    @routes.post("/lessons", summary="Begin a lesson")
    async def begin(document: LessonRequest) -> Any:
        seed = service.settings.seed
        return JSONResponse(view(remember(await run(open_new_lesson, memory, document.components, seed))))

    @routes.get("/lessons/{lesson}", summary="The state of a lesson")
    def show(lesson: Name) -> dict[str, Any]:
        return view(lesson_of(lesson))

    @routes.post(
        "/lessons/{lesson}/steps", summary="Take a step; the last step of a task stores its demonstration"
    )
    async def step(lesson: Name, document: Step) -> Any:
        try:
            return JSONResponse(await run(take, lesson, document.action))
        except StoreError:
            lessons.pop(lesson, None)  # it may hold a demonstration that is not stored
            raise

    def take(name: str, action: int) -> dict[str, Any]:
        opened = lesson_of(name)
        with stepping:
            opened.act(action)
            if opened.over:
                shown = opened.demonstration()
                store_demonstration(memory, opened, shown)
                opened.accept(shown)
            return opened.view()

    @routes.post("/lessons/{lesson}/next", summary="Go on to the next task; a task that is not over is dropped")
    def go_on(lesson: Name) -> dict[str, Any]:
        opened = lesson_of(lesson)
        with stepping:
            opened.go_on()
        return view(opened)

    @routes.post("/lessons/{lesson}/curves", summary="Learning curves with and without the prior of the lesson")
    def curves(lesson: Name, document: Learning) -> dict[str, Any]:
        opened = lesson_of(lesson)
        arguments = (opened.name, opened.components, opened.seed, list(opened.shown), document.episodes)
        return service.worker.call(lesson_curves, arguments, service.settings.seconds)

    @routes.get(
        "/lessons/{lesson}/record", summary="The demonstrations of a lesson as JSON lines", response_class=Response
    )
    def record(lesson: Name) -> Response:
        return Response(export_lesson(memory, lesson), media_type="application/jsonl")

    @routes.delete("/lessons/{lesson}", summary="Delete all that is stored of a lesson, for ever")
    async def delete(lesson: Name) -> Any:
        forgotten = await run(forget_lesson, memory, lesson)
        lessons.pop(lesson, None)
        return JSONResponse({"lesson": lesson, "forgotten": forgotten})

    return routes
