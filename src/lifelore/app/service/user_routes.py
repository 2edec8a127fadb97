"""Routes of the users of a study: decide, observe, explain, forget; one user or many in one request."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Path
from fastapi.responses import JSONResponse
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.personalise.explanation import explain
from lifelore.agent.reuse.availability import checked_available
from lifelore.agent.personalise.decisions import choose, forget, update
from lifelore.app.service.error_documents import KINDS, status_of, without_places
from lifelore.app.service.service_state import Service
from lifelore.app.service.study_routes import Name
from lifelore.core.errors import LifeloreError

LARGEST_BATCH = 1000
Answer = dict[str, Any]
User = Annotated[str, Path(description="Name of the user.", min_length=1, max_length=200, examples=["ada"])]


class DecisionRequest(BaseModel):
    """A user who needs a policy now."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"user": "ada", "request": "2024-05-01/17"}}
    )
    user: str = Field(description="Name of the user.")
    request: str | None = Field(
        None, description="Identifier of the request, unique for the user: sent again, it gets the same decision."
    )
    context: str | None = Field(None, description="Context of the user, as in the logs of the fit.")
    features: dict[str, FiniteFloat] | None = Field(None, description="Numbers known of the user beforehand.")
    available: list[str] | None = Field(None, description="Policies that the user can get now; left out: all.")
    novelty: bool = Field(False, description="Also compute the probability that no known type fits.")


class OutcomeRequest(BaseModel):
    """How a decision ended."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"decision": "0123456789abcdef-0", "outcome": 7.5}}
    )
    decision: str = Field(description="Identifier of the decision.")
    outcome: FiniteFloat = Field(description="Outcome; larger is better.")


class Decisions(BaseModel):
    """Several users, each of whom needs a policy now."""

    model_config = ConfigDict(extra="forbid")
    items: list[DecisionRequest] = Field(max_length=LARGEST_BATCH)


class Outcomes(BaseModel):
    """How several decisions ended."""

    model_config = ConfigDict(extra="forbid")
    items: list[OutcomeRequest] = Field(max_length=LARGEST_BATCH)


def router(service: Service) -> APIRouter:
    """The routes of users."""
    routes = APIRouter(prefix="/v1/studies/{study}", tags=["personalise"])
    memory, studies, run = service.memory, service.studies, service.writer.run

    def decide(study: str, document: DecisionRequest) -> dict[str, Any]:
        opened = studies.get(study)
        available = None if document.available is None else checked_available(opened, document.available)
        answer = choose(
            memory, opened, document.user, context=document.context, features=document.features,
            available=available, seed=service.settings.seed, novelty=document.novelty, request=document.request,
        )  # fmt: skip
        if not answer.get("repeated"):
            service.metrics.decisions.inc()
        return answer

    def observe(study: str, document: OutcomeRequest) -> dict[str, Any]:
        answer = update(memory, studies.get(study), document.decision, document.outcome)
        if answer["taken"]:
            service.metrics.outcomes.inc()
        return answer

    def each(make: Callable[[str, Any], dict[str, Any]], study: str, items: list[Any]) -> dict[str, Any]:
        """An answer to each item, or the error of this item alone."""
        studies.get(study)
        return {"items": [answer_or_error(make, study, item) for item in items]}

    def answer_or_error(make: Callable[[str, Any], dict[str, Any]], study: str, item: Any) -> dict[str, Any]:
        try:
            return make(study, item)
        except LifeloreError as error:
            message = without_places(str(error), memory.location)
            return {"error": {"kind": KINDS[status_of(error)], "message": message}}

    @routes.post(
        "/decisions",
        response_model=Answer,
        summary="Choose a policy for a user, and store the decision and its probability",
    )
    async def decisions(study: Name, document: DecisionRequest) -> Any:
        return JSONResponse(await run(decide, study, document))

    @routes.post(
        "/outcomes", response_model=Answer, summary="Store the outcome of a decision, once, at any later time"
    )
    async def outcomes(study: Name, document: OutcomeRequest) -> Any:
        return JSONResponse(await run(observe, study, document))

    @routes.post("/decisions/batch", response_model=Answer, summary="Choose a policy for each of several users")
    async def decisions_batch(study: Name, document: Decisions) -> Any:
        return JSONResponse(await run(each, decide, study, document.items))

    @routes.post("/outcomes/batch", response_model=Answer, summary="Store the outcomes of several decisions")
    async def outcomes_batch(study: Name, document: Outcomes) -> Any:
        return JSONResponse(await run(each, observe, study, document.items))

    @routes.get("/users/{user}", summary="Belief about a user, and the evidence behind it")
    def show(study: Name, user: User) -> dict[str, Any]:
        return explain(memory, studies.get(study), user)

    @routes.delete("/users/{user}", summary="Forget all that is stored of a user, for ever")
    def delete(study: Name, user: User) -> dict[str, Any]:
        return {"user": user, "forgotten": forget(memory, studies.get(study), user)}

    return routes
