"""Routes of interface adaptation (BEAT): an action set for each step of a user, by the user's moves."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Query
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.personalise.adaptation import (
    forget_adaptation,
    learn_moves,
    open_adaptation,
    register_adaptation,
    select,
)
from lifelore.agent.personalise.registration import described, library_of
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.service_state import Service
from lifelore.app.service.study_routes import LibraryDocument

Name = Annotated[str, Path(description="Name of the adaptation.", min_length=1, max_length=60, examples=["game"])]
User = Annotated[str, Query(description="Name of the user.", min_length=1, max_length=200)]
Signal = int | FiniteFloat | str | list[list[int]]
_LIBRARY = {
    "types": ["steady", "shaky"], "policies": ["slow", "fast"],
    "means": [[0.4, 0.9], [0.8, 0.3]], "deviations": 0.1,
    "signals": [[[0.9, 0.1], [0.8, 0.2]], [[0.6, 0.4], [0.2, 0.8]]], "categories": ["hit", "miss"],
}  # fmt: skip


class AdaptationRequest(BaseModel):
    """A library whose policies are action sets and whose signals are moves."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"library": _LIBRARY, "epsilon": 0.05}}
    )
    library: LibraryDocument
    epsilon: FiniteFloat | Literal["1/n", "by episode"] = Field(0.0, description="Share of exploration.")


class Move(BaseModel):
    """A move of a user."""

    model_config = ConfigDict(extra="forbid")
    action_set: str = Field(description="Action set in force.")
    signal: Signal = Field(
        description="The move as the library's signals: a category, or [[state, action, next]]."
    )


class Moves(BaseModel):
    """Moves of a user in their order."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "example": {"user": "ada", "step": 0, "moves": [{"action_set": "fast", "signal": "miss"}]}
        },
    )
    user: str = Field(description="Name of the user.", min_length=1, max_length=200)
    step: int = Field(ge=0, le=2**62, description="Number of the first move; moves that were stored count once.")
    moves: list[Move] = Field(min_length=1, max_length=10_000)
    ends_episode: bool = Field(False, description="Whether the last move ends an episode.")


def router(service: Service) -> APIRouter:
    """The routes of adaptation."""
    routes = APIRouter(prefix="/v1/adaptations/{name}", tags=["personalise"], route_class=JsonRoute)
    memory = service.memory

    @routes.put("", summary="Register a library of action sets")
    def put(name: Name, document: AdaptationRequest) -> dict[str, Any]:
        made = register_adaptation(memory, name, library_of(document.library.model_dump()), document.epsilon)
        return {"adaptation": name, "epsilon": made.epsilon, **described(made.library)}

    @routes.get("", summary="An adaptation: its library and share of exploration")
    def show(name: Name) -> dict[str, Any]:
        found = open_adaptation(memory, name)
        return {"adaptation": name, "epsilon": found.epsilon, **described(found.library)}

    @routes.get("/user", summary="The action set for the next step of a user, and the belief behind it")
    def next_set(name: Name, user: User) -> dict[str, Any]:
        return select(memory, open_adaptation(memory, name), user, service.settings.seed)

    @routes.post("/moves", summary="Learn from moves of a user, each once")
    def moves(name: Name, document: Moves) -> dict[str, Any]:
        found, listed = open_adaptation(memory, name), [(move.action_set, move.signal) for move in document.moves]
        return learn_moves(memory, found, document.user, document.step, listed, ends_episode=document.ends_episode)

    @routes.delete("/user", summary="Forget all that is stored of a user, for ever")
    def delete(name: Name, user: User) -> dict[str, Any]:
        return {"user": user, "forgotten": forget_adaptation(memory, open_adaptation(memory, name), user)}

    return routes
