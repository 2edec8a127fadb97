"""Routes of perception: a cloud or a depth image in; scene, contact networks, warnings and PDDL out."""

import base64
import binascii
import json
from collections.abc import Callable, Iterable
from functools import partial
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat
from starlette.concurrency import run_in_threadpool

from lifelore.agent.perceive.perceive import read_region, read_up
from lifelore.agent.perceive.perceive_upload import perceive_upload, perceive_upload_with_points
from lifelore.app.service.bodies import BYTES, JsonRoute, body_of, file_of
from lifelore.app.service.service_state import Service
from lifelore.bridges.planner import solve
from lifelore.core.errors import InputError

PLAN_SECONDS = 10.0
"""Seconds for the planner of a request; goals over a table's objects take less than one."""
LONGEST_CAMERA = 20_000
"""Characters of the file of a camera; files of ROS have some hundred."""
BODY = body_of(BYTES)
"""OpenAPI of a request whose body is a cloud."""
_POINTS: dict[int | str, dict[str, Any]] = {
    200: {"content": {BYTES: {"schema": {"type": "string", "format": "binary"}}}}
}


class SceneOptions(BaseModel):
    """How a scene is read."""

    model_config = ConfigDict(extra="forbid")
    up: str = Field(
        "table",
        max_length=100,
        description="Upward direction: table (its normal), z, or X,Y,Z in the cloud's frame.",
    )
    min_confidence: FiniteFloat | None = Field(None, description="Least probability of facts, in [0, 1].")
    goal: str | None = Field(None, max_length=1000, description="Goal to plan for, such as on(2,3).")
    roi: str | None = Field(
        None, max_length=300, description="Use only points in this box: XMIN,XMAX,YMIN,YMAX,ZMIN,ZMAX in metres."
    )
    max_range: FiniteFloat | None = Field(None, description="Use only points within so many metres of the camera.")
    with_masks: bool = Field(False, description="Whether objects have their pixels, or their points' numbers.")
    plan: bool = Field(False, description="Also find a plan for the goal (extra planning).")

    def settings(self, fields: Iterable[str]) -> dict[str, Any]:
        """Those of the fields that are given, as fields of `PerceiveSettings`."""
        given = self.model_dump(include=set(fields) - {"up", "plan", "roi", "max_range"}, exclude_none=True)
        given["up"] = read_up(self.up)
        given["region"] = read_region(self.roi, self.max_range)
        return given | {"planner": partial(solve, timeout=PLAN_SECONDS)} if self.plan else given


class CloudOptions(SceneOptions):
    """How a cloud is read."""

    format: Literal["pcd", "ply", "npz", "npy"] = Field("pcd", description="Kind of the file.")
    units: Literal["m", "cm", "mm", "inch"] = Field("m", description="Unit of the coordinates.")
    labels: Literal["auto", "plain", "parts"] = Field("auto", description="How labels become objects.")


class Intrinsics(BaseModel):
    """Focal lengths and centre of a pinhole camera, in pixels."""

    model_config = ConfigDict(extra="forbid")
    fx: FiniteFloat
    fy: FiniteFloat
    cx: FiniteFloat
    cy: FiniteFloat
    width: int = Field(ge=1, le=20_000, description="Pixels of a row.")
    height: int = Field(ge=1, le=20_000, description="Number of rows.")


class DepthImage(SceneOptions):
    """A depth image with its camera; images in base64."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "example": {
                "depth": "iVBORw0KGgo=", "depth_scale": 0.001,
                "intrinsics": {"fx": 525, "fy": 525, "cx": 319.5, "cy": 239.5, "width": 640, "height": 480},
            }
        },
    )  # fmt: skip
    depth: str = Field(description="PNG of 16 bits, or an npy file.")
    colour: str | None = Field(None, description="PNG or JPEG of the same size.")
    masks: str | None = Field(None, description="Masks of the objects: a label image (PNG), npz or npy.")
    intrinsics: Intrinsics | Annotated[str, Field(max_length=LONGEST_CAMERA)] = Field(
        description="The numbers of the camera, or the text of its file: camera_info YAML or JSON."
    )
    depth_scale: FiniteFloat | None = Field(None, description="Metres for each unit of depth.")


class Planning(BaseModel):
    """The planning problem of a scene."""

    domain: str = Field(description="Domain in PDDL.")
    problem: str = Field(description="Problem in PDDL.")


class SceneFrame(BaseModel):
    """The camera's frame, in which the cloud was read, and the scene's."""

    model_config = ConfigDict(extra="allow")
    name: str | None = Field(description="Name of the camera's frame.")
    stamp: float | None = Field(description="Seconds.")
    scene_from_camera: list[list[float]] = Field(description="4 × 4 motion, metres.")
    camera_from_scene: list[list[float]] = Field(description="Its inverse.")


class Box(BaseModel):
    """A box around the visible points of an object."""

    centre: list[float] = Field(description="Metres.")
    axes: list[list[float]] = Field(description="Three unit vectors.")
    size: list[float] = Field(description="Metres along the axes.")


class SceneObject(BaseModel):
    """An object of a scene."""

    model_config = ConfigDict(extra="allow")
    id: int
    n_points: int
    centroid: list[float] = Field(description="Metres, in the scene's frame.")
    box: Box
    box_camera: Box = Field(description="The box in the camera's frame.")
    contact_points: list[dict[str, Any]] = Field(description="Places where it touches others.")


class SceneRelation(BaseModel):
    """How an object lies to another one, or to the table."""

    model_config = ConfigDict(extra="allow")
    a: int | str
    b: int | str
    relation: str
    confidence: float | None = None


class SceneWarning(BaseModel):
    """What may be wrong with a scene."""

    model_config = ConfigDict(extra="allow")
    code: str
    message: str


class PlanStep(BaseModel):
    """A step of a plan."""

    action: str = Field(description="pick-up, put-on, put-on-table or put-beside.")
    objects: list[dict[str, Any]] = Field(
        description="The object that is moved, then its new place: id and where seen."
    )
    confidence: float = Field(description="Probability that what the step relies on is true.")


class Plan(BaseModel):
    """A plan for the goal."""

    steps: list[PlanStep]
    confidence: float | None = Field(description="Probability that what all steps rely on is true.")
    reason: str | None = Field(description="Why there is no plan; null where there is one.")


class SceneDocument(BaseModel):
    """A perceived scene."""

    model_config = ConfigDict(extra="allow")
    frame: SceneFrame
    objects: list[SceneObject]
    relations: list[SceneRelation]
    facts: list[str] = Field(description="Relations that are stated, as logical facts.")
    warnings: list[SceneWarning]
    pddl: Planning
    plan: Plan | None = Field(None, description="Asked for by `plan`.")
    dot: str = Field(description="The scene graph for Graphviz.")
    seconds: float = Field(description="Time to perceive it.")


def router(service: Service) -> APIRouter:
    """The routes of perception."""
    routes = APIRouter(prefix="/v1/perceive", tags=["perceive"], route_class=JsonRoute)

    async def of_cloud(function: Callable[..., Any], request: Request, options: CloudOptions) -> Any:
        content = await file_of(request)
        given = options.settings(set(CloudOptions.model_fields) - {"format"})
        return await service.worker.run(request, function, options.format, {"cloud": content}, given)

    @routes.post(
        "/cloud", summary="Perceive the scene of a point cloud", openapi_extra=BODY,
        response_model=SceneDocument, response_model_exclude_unset=True,
    )  # fmt: skip
    async def cloud(request: Request, options: Annotated[CloudOptions, Query()]) -> dict[str, Any]:
        return await of_cloud(perceive_upload, request, options)

    @routes.post(
        "/points", summary="As /cloud, with the points of the scene before the document, as bytes",
        openapi_extra=BODY, response_class=Response, responses=_POINTS,
    )  # fmt: skip
    async def points(request: Request, options: Annotated[CloudOptions, Query()]) -> Response:
        return Response(await of_cloud(perceive_upload_with_points, request, options), media_type=BYTES)

    async def of_depth(function: Callable[..., Any], request: Request, document: DepthImage) -> Any:
        parts = await run_in_threadpool(_parts, document)
        given = document.settings(SceneOptions.model_fields)
        return await service.worker.run(request, function, "depth", parts, given, document.depth_scale)

    @routes.post(
        "/depth", summary="Perceive the scene of a depth image",
        response_model=SceneDocument, response_model_exclude_unset=True,
    )  # fmt: skip
    async def depth(request: Request, document: DepthImage) -> dict[str, Any]:
        return await of_depth(perceive_upload, request, document)

    @routes.post(
        "/depth/points", summary="As /depth, with the points of the scene before the document, as bytes",
        response_class=Response, responses=_POINTS,
    )  # fmt: skip
    async def depth_points(request: Request, document: DepthImage) -> Response:
        return Response(await of_depth(perceive_upload_with_points, request, document), media_type=BYTES)

    return routes


def _parts(document: DepthImage) -> dict[str, bytes]:
    camera = document.intrinsics
    text = camera if isinstance(camera, str) else json.dumps(camera.model_dump())
    parts = {"depth": _decoded("depth", document.depth), "intrinsics": text.encode("utf-8", "replace")}
    for name in ("colour", "masks"):
        image = getattr(document, name)
        if image is not None:
            parts[name] = _decoded(name, image)
    return parts


def _decoded(name: str, text: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        raise InputError(f"{name} must be an image in base64, got {text[:40]!r}") from None
