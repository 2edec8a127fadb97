"""Routes of the page /life: the lives in memory, their tasks, and what they know; all of them only read."""

from typing import Annotated, Any

from fastapi import APIRouter, Query

from lifelore.agent.watch_life.known_family import known_family
from lifelore.agent.watch_life.known_map import known_map
from lifelore.agent.watch_life.lives import lives_in, task_of, tasks_of
from lifelore.app.service.service_state import Service

Name = Annotated[str, Query(min_length=1, max_length=200)]
Number = Annotated[int, Query(ge=0, lt=1 << 53)]


def router(service: Service) -> APIRouter:
    """The routes of lives."""
    routes = APIRouter(prefix="/v1/lives", tags=["lives"])
    memory = service.memory

    @routes.get("", summary="The lives in memory, by robot and domain")
    def lives() -> dict[str, Any]:
        return {"revision": memory.revision(), "lives": lives_in(memory)}

    @routes.get("/revision", summary="A text that differs after each change of the memory")
    def revision() -> dict[str, str]:
        return {"revision": memory.revision()}

    @routes.get("/tasks", summary="The tasks of a life in short")
    def tasks(robot: Name, domain: Name) -> dict[str, Any]:
        return {"robot": robot, "domain": domain, "tasks": tasks_of(memory, robot, domain)}

    @routes.get("/task", summary="A task of a life, and why the agent acted so")
    def task(robot: Name, domain: Name, number: Number) -> dict[str, Any]:
        return task_of(memory, robot, domain, number)

    @routes.get("/map", summary="The known part of a map, and the prior over its moves; null where none is known")
    def map(world: Name, row: Number | None = None, column: Number | None = None) -> dict[str, Any]:
        return {"map": known_map(memory, world, None if row is None or column is None else (row, column))}

    @routes.get("/family", summary="Types of a domain, what is expected of its contexts, and curiosity")
    def family(domain: Name, seed: Number = 0) -> dict[str, Any]:
        return known_family(memory, domain, seed)

    return routes
