"""Routes that observe the service: health and metrics."""

from typing import Literal

from fastapi import APIRouter, Response
from pydantic import BaseModel

from lifelore import __version__
from lifelore.agent.personalise.study import study_names
from lifelore.app.service.service_state import Service
from lifelore.app.service.telemetry import CONTENT_TYPE_LATEST


class Health(BaseModel):
    """The state of the service."""

    status: Literal["ok"] = "ok"
    version: str = __version__


def router(service: Service) -> APIRouter:
    """The routes of health and metrics."""
    routes = APIRouter(tags=["observe"])

    @routes.get("/healthz", summary="Whether the service runs and its memory answers")
    def healthz() -> Health:
        study_names(service.memory)
        return Health()

    @routes.get("/metrics", summary="Metrics in the text format of Prometheus", response_class=Response)
    def metrics() -> Response:
        return Response(service.metrics.text(), media_type=CONTENT_TYPE_LATEST)

    return routes
