"""The route of a study's traffic: decisions by day, shares of policies, alarms."""

from typing import Annotated, Any

from fastapi import APIRouter, Query

from lifelore.app.service.service_state import Service
from lifelore.app.service.study_routes import Name

Days = Annotated[int, Query(ge=2, le=90, description="Window; 2 days come by hour, more by day.")]


def router(service: Service) -> APIRouter:
    """The route of traffic."""
    routes = APIRouter(prefix="/v1/studies/{study}", tags=["personalise"])

    @routes.get("/traffic", summary="Decisions and outcomes of the last days, and alarms; at most a minute old")
    def traffic(study: Name, days: Days = 14) -> dict[str, Any]:
        return service.watch.traffic(study, days)

    return routes
