"""Routes of panels: very many users of a study, decided and observed in batches."""

from typing import Any

from fastapi import APIRouter
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.app.service.service_state import Service
from lifelore.app.service.study_routes import Name
from lifelore.app.service.user_routes import Answer

MANY = 100_000
"""Largest number of users in a request."""


class PanelDecisions(BaseModel):
    """Users who each need a policy now."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"users": ["ada", "ben"], "request": "monday"}}
    )
    users: list[str] = Field(max_length=MANY, description="Names of the users.")
    available: list[str] | None = Field(None, description="Policies that all of them can get now; left out: all.")
    masks: list[list[bool]] | None = Field(
        None, max_length=MANY, description="For each user, whether each policy in use can be had now."
    )
    request: str | None = Field(None, description="Identifier: sent again, it gets the same decisions.")


class PanelOutcomes(BaseModel):
    """How decisions of a batch ended."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"batch": "0123456789abcdef.0", "outcomes": [7.5, 3.0]}}
    )
    batch: str = Field(description="Identifier of the batch of decisions.")
    outcomes: list[FiniteFloat] = Field(max_length=MANY, description="Outcomes; larger is better.")
    places: list[int] | None = Field(
        None, max_length=MANY, description="Places of the decisions in the batch; left out: all, in order."
    )


class PanelUsers(BaseModel):
    """Users whose beliefs are asked for."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"users": ["ada"]}})
    users: list[str] = Field(max_length=MANY)


def router(service: Service) -> APIRouter:
    """The routes of panels."""
    routes = APIRouter(prefix="/v1/studies/{study}/panel", tags=["personalise"])
    panels, metrics, run = service.panels, service.metrics, service.writer.run

    @routes.post(
        "/decisions",
        response_model=Answer,
        summary="Choose a policy for each of very many users, and store the decisions",
    )
    async def decisions(study: Name, document: PanelDecisions) -> Any:
        return JSONResponse(await run(decide, study, document))

    def decide(study: str, document: PanelDecisions) -> Answer:
        answer = panels.get(study).decide(
            document.users, available=document.available, masks=document.masks, request=document.request
        )
        if not answer["repeated"]:
            metrics.decisions.inc(len(answer["chosen"]))
        return answer

    @routes.post("/outcomes", response_model=Answer, summary="Store outcomes of a batch of decisions, each once")
    async def outcomes(study: Name, document: PanelOutcomes) -> Any:
        return JSONResponse(await run(observe, study, document))

    def observe(study: str, document: PanelOutcomes) -> Answer:
        answer = panels.get(study).observe(document.batch, document.outcomes, document.places)
        metrics.outcomes.inc(answer["taken"])
        return answer

    @routes.post("/beliefs", summary="Beliefs about users of the panel")
    def beliefs(study: Name, document: PanelUsers) -> dict[str, Any]:
        return {"beliefs": panels.get(study).belief(document.users)}

    @routes.get("", summary="Size of the panel")
    def show(study: Name) -> dict[str, Any]:
        panel = panels.get(study)
        return {"study": study, "users": panel.n_users, "policies": panel.study.active}

    return routes
