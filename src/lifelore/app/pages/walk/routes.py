"""Routes of the page `/walk`: buildings, the beginning of a walk, its steps, and a walk that goes on."""

import threading
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Query
from pydantic import BaseModel, ConfigDict, Field
from starlette.concurrency import run_in_threadpool

from lifelore.agent.advise.advice_desk import AdviceDesk
from lifelore.agent.advise.guided_walk import begin_walk, resume_walk, take_step, walk_desk, walk_desk_name
from lifelore.agent.advise.walk_building import WalkBuilding, walk_building, walk_buildings
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.service_state import Service

Walk = Annotated[str, Path(description="Name of the walk.", min_length=1, max_length=60, examples=["walk-1"])]
Building = Annotated[str, Field(description="Name of the building.", min_length=1, max_length=40)]


class BeginRequest(BaseModel):
    """A person who begins to walk."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"building": "advice:3"}})
    building: Building
    advice: bool = Field(True, description="Whether the person can get advice.")


class MoveRequest(BeginRequest):
    """A move that the person tried."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={"example": {"building": "advice:3", "step": 1, "state": 0, "move": "east"}},
    )
    step: int = Field(ge=1, le=2**40, description="Number of the move, from 1; a stored move counts once.")
    state: int = Field(ge=0, le=2**31, description="State in which the person tried the move.")
    move: Literal["north", "south", "east", "west"]


def router(service: Service) -> APIRouter:
    """The routes of walks."""
    routes = APIRouter(prefix="/v1/walks", tags=["walk"], route_class=JsonRoute)
    maps, open_buildings, opening = service.settings.maps, {}, threading.Lock()

    def building_of(name: str) -> WalkBuilding:
        with opening:
            if name not in open_buildings:
                open_buildings[name] = walk_building(name, maps, service.memory)
            return open_buildings[name]

    def desk_of(building: WalkBuilding, advice: bool) -> AdviceDesk:
        name = walk_desk_name(building, advice)
        if name not in service.desks:
            service.desks[name] = walk_desk(service.memory, building, advice, maps)
        return service.desks[name]

    def prepare(document: BeginRequest) -> None:
        desk_of(building_of(document.building), document.advice)

    def find(document: BeginRequest) -> None:
        """As `prepare`, but a desk that is new is not found: to look stores nothing."""
        name = walk_desk_name(building_of(document.building), document.advice)
        if name not in service.desks:
            service.desks[name] = AdviceDesk(service.memory, name, maps)

    def begun(walk: str, document: BeginRequest) -> dict[str, Any]:
        building = building_of(document.building)
        return begin_walk(building, desk_of(building, document.advice), walk)

    def resumed(walk: str, document: BeginRequest) -> dict[str, Any]:
        building = building_of(document.building)
        return resume_walk(building, desk_of(building, document.advice), walk)

    def stepped(walk: str, document: MoveRequest) -> dict[str, Any]:
        building = building_of(document.building)
        desk = desk_of(building, document.advice)
        return take_step(building, desk, walk, document.step, document.state, document.move)

    @routes.get("", summary="Buildings that a person can walk in")
    def buildings() -> dict[str, Any]:
        return {"buildings": walk_buildings(maps)}

    @routes.put("/{walk}", summary="Begin a walk: its errand, and what is in sight")
    async def begin(walk: Walk, document: BeginRequest) -> dict[str, Any]:
        # The first walk in a building takes seconds, which must not hold up the thread that stores.
        await run_in_threadpool(prepare, document)
        return await service.writer.run(begun, walk, document)

    @routes.get("/{walk}", summary="A walk that has begun: its errand, its way so far, and all that was in sight")
    async def resume(walk: Walk, document: Annotated[BeginRequest, Query()]) -> dict[str, Any]:
        await run_in_threadpool(find, document)
        return await service.writer.run(resumed, walk, document)

    @routes.post("/{walk}/steps", summary="Take a step: what is in sight then, and advice where the rule fires")
    async def step(walk: Walk, document: MoveRequest) -> dict[str, Any]:
        return await service.writer.run(stepped, walk, document)

    return routes
