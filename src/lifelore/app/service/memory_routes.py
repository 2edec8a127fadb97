"""Routes of the memory: show, export, merge, forget."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, cast

from fastapi import APIRouter, Query, Request, Response
from starlette.concurrency import run_in_threadpool
from typing_extensions import TypedDict

from lifelore.agent.live.buildings.building_memory import buildings_in, forget_building
from lifelore.agent.live.buildings.merged_buildings import merge_memories
from lifelore.app.service.bodies import BYTES, SQLITE, body_of, file_of
from lifelore.app.service.service_state import Service
from lifelore.core.errors import InputError, StoreError

Text = Annotated[str, Query(min_length=1, max_length=200)]
_FILE: dict[int | str, dict[str, Any]] = {
    200: {"content": {SQLITE: {"schema": {"type": "string", "format": "binary"}}}}
}


class Robot(TypedDict):
    robot: str
    tasks: int
    first: str
    last: str


class Lore(TypedDict):
    kind: str
    key: str
    version: int
    merge: str
    slots: int
    sum: int


class Building(TypedDict):
    name: str
    key: str
    maps: int
    grids: int


class Content(TypedDict):
    schema: int
    robots: list[Robot]
    lore: list[Lore]
    forgotten: int
    forgotten_records: int
    buildings: list[Building]


class MergedBuilding(TypedDict):
    building: str
    joined: str | None
    reason: str | None
    walls: float | None
    pose: list[float] | None
    names: list[str]


class Merged(TypedDict):
    added: int
    already_there: int
    forgotten: int
    buildings: list[MergedBuilding]


class ForgottenRobot(TypedDict):
    robot: str
    forgotten: int


class ForgottenBuilding(TypedDict):
    building: str
    records: int
    contributions: int


def router(service: Service) -> APIRouter:
    """The routes of the memory."""
    routes = APIRouter(prefix="/v1/memory", tags=["memory"])
    memory = service.memory

    @routes.get("", summary="Robots, buildings and records of the memory")
    def show() -> Content:
        document: Any = {name: value for name, value in memory.show().items() if name != "location"}
        return document | {"buildings": buildings_in(memory)}

    @routes.get(
        "/export", summary="All contributions as one portable file", response_class=Response, responses=_FILE
    )
    def export() -> Response:
        with TemporaryDirectory() as folder:
            path = Path(folder) / "export.db"
            memory.export_to(path)
            return Response(path.read_bytes(), media_type=SQLITE)

    def merged(content: bytes) -> Any:
        with TemporaryDirectory() as folder:
            path = Path(folder) / "upload.db"
            path.write_bytes(content)
            try:
                (counts,), buildings = merge_memories(memory, [path])
                return counts | {"buildings": buildings}
            except StoreError as error:
                if str(path) not in str(error):
                    raise
                raise InputError(str(error).replace(f"memory {path}", "the upload")) from None

    @routes.post("/merge", summary="Add an exported file, all or none", openapi_extra=body_of(BYTES, SQLITE))
    async def merge(request: Request) -> Merged:
        counts = await run_in_threadpool(merged, await file_of(request, BYTES, SQLITE))
        service.studies.drop_all()
        return counts

    @routes.delete("/robots", summary="Forget all contributions of a robot, for ever")
    def forget_robot(robot: Text) -> ForgottenRobot:
        count = memory.forget(robot)
        service.studies.drop_all()
        return {"robot": robot, "forgotten": count}

    @routes.delete("/buildings", summary="Forget the map and the transitions of a building, for ever")
    def forget_map(building: Text) -> ForgottenBuilding:
        return cast(Any, forget_building(memory, building))

    return routes
