"""Routes of the users of a study: explain, forget, their past in other systems. Names travel in query or body."""

from typing import Annotated, Any

from fastapi import APIRouter, Query
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.personalise.decisions import forget
from lifelore.agent.personalise.explanation import explain
from lifelore.agent.personalise.past import Line, add_lines
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.decision_routes import LARGEST_BATCH
from lifelore.app.service.service_state import Service
from lifelore.app.service.study_routes import Name

Word = Annotated[str, Field(min_length=1, max_length=200)]
User = Annotated[str, Query(alias="name", description="Name of the user.", min_length=1, max_length=200)]


class PastLine(BaseModel):
    """An outcome that a user had in another system."""

    model_config = ConfigDict(extra="forbid")
    id: Word | None = Field(None, description="Identifier of the line; left out: its user, policy and time.")
    user: Word
    policy: Word
    outcome: FiniteFloat
    time: FiniteFloat | None = Field(None, description="Seconds since 1970.", ge=0, le=2**36)
    context: Word | None = None


class Past(BaseModel):
    """Outcomes of another system, each counted once."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "example": {"items": [{"user": "ada", "policy": "slow", "outcome": 7.5, "time": 1.7e9}]}
        },
    )
    items: list[PastLine] = Field(min_length=1, max_length=LARGEST_BATCH)


class Forgotten(BaseModel):
    """A user of whom nothing is stored any more."""

    user: str
    forgotten: int = Field(description="Number of decisions and lines of the past that were deleted.")


def router(service: Service) -> APIRouter:
    """The routes of users."""
    routes = APIRouter(prefix="/v1/studies/{study}", tags=["personalise"], route_class=JsonRoute)
    memory, studies = service.memory, service.studies

    @routes.get("/user", summary="Belief about a user, and the evidence behind it")
    def show(study: Name, name: User) -> dict[str, Any]:
        return explain(memory, studies.get(study), name)

    @routes.delete("/user", summary="Forget all that is stored of a user, for ever")
    def delete(study: Name, name: User) -> Forgotten:
        return Forgotten(user=name, forgotten=forget(memory, studies.get(study), name))

    @routes.post("/past", summary="Store outcomes that users had in another system, each line once")
    def past(study: Name, document: Past) -> dict[str, Any]:
        lines = [
            Line(one.user, one.policy, one.outcome, int(1000 * (one.time or 0)), one.id or "", one.context)
            for one in document.items
        ]
        return add_lines(memory, studies.get(study), lines)

    return routes
