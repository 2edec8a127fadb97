"""Routes of advice: experts' walks in a named world, and advice for agents that seem lost, step by step."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.advise.advice_desk import AdviceDesk, register_desk
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.service_state import Service

Name = Annotated[str, Path(description="Name of the desk.", min_length=1, max_length=60, examples=["hall"])]
Agent = Annotated[str, Path(description="Name of the agent.", min_length=1, max_length=200, examples=["visitor"])]
State = int | Annotated[list[int], Field(min_length=2, max_length=2)]


class Step(BaseModel):
    """The move that an agent tried in a state."""

    model_config = ConfigDict(extra="forbid")
    state: State = Field(description="Number of the state, or its cell [row, column].")
    action: int | str | None = Field(description="north, south, east, west, its number, or null: no move.")
    class_: str | None = Field(
        None,
        alias="class",
        min_length=1,
        max_length=60,
        description="With method classes: the class of an expert, or that a watched agent shows from here on.",
    )


class ExpertStep(Step):
    """A step of an expert, who knows the way."""

    agent: int | str = Field(description="Name or number of the expert.")


class DeskRequest(BaseModel):
    """A world, walks of experts in it, and when to advise."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "example": {
                "world": "advice:3",
                "experts": [
                    {"agent": 0, "state": 0, "action": "east"},
                    {"agent": 0, "state": 1, "action": "east"},
                ],
            }
        },
    )
    world: str = Field(description="A map that is served, or NAME:SEED of a world of the thesis.")
    experts: list[ExpertStep] = Field(min_length=1, description="Steps of the experts in their order.")
    goals: list[State] | None = Field(None, description="States of the goals; left out: the ends of the walks.")
    method: Literal["better", "thesis", "classes"] = Field(
        "better", description="One goal at a time, one prior over all, or one goal at a time by class of agent."
    )
    kappa: FiniteFloat = Field(0.5, description="Least gain of advice in nats.")
    window: int = Field(300, ge=1, le=100_000, description="Last steps of an agent that count as evidence.")
    share: FiniteFloat | None = Field(None, description="Largest share of an agent's steps that are advised.")
    cell: FiniteFloat | None = Field(None, description="Side of a map's cell in metres.")
    robot_radius: FiniteFloat | None = Field(None, ge=0, le=10, description="Radius of the robot in metres.")


class StepsRequest(BaseModel):
    """Steps of an agent in their order."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"step": 0, "steps": [{"state": 0, "action": "north"}]}}
    )
    step: int = Field(ge=0, le=2**40, description="Number of the first step; stored steps count once.")
    steps: list[Step] = Field(min_length=1, max_length=10_000)


def router(service: Service) -> APIRouter:
    """The routes of advice."""
    routes = APIRouter(prefix="/v1/advice/{name}", tags=["advise"], route_class=JsonRoute)
    memory, maps, desks = service.memory, service.settings.maps, service.desks

    def desk(name: str) -> AdviceDesk:
        if name not in desks:
            desks[name] = AdviceDesk(memory, name, maps)
        return desks[name]

    def described(one: AdviceDesk) -> dict[str, Any]:
        session = one.session
        return {
            "desk": one.name,
            "goals": session.goals,
            "experts": session.n_experts,
            "states": session.world.n_states,
            "classes": session.classes,
        }

    @routes.put("", summary="Register walks of experts in a world")
    def put(name: Name, document: DeskRequest) -> dict[str, Any]:
        # Without classes a document is what it was before steps had one: the same desk again changes nothing.
        unread = None if document.method == "classes" else {"experts": {"__all__": {"class_"}}}
        desks[name] = register_desk(memory, name, document.model_dump(by_alias=True, exclude=unread), maps)
        return described(desks[name])

    @routes.get("", summary="A desk: goals, classes, number of experts' walks and of states")
    def show(name: Name) -> dict[str, Any]:
        return described(desk(name))

    @routes.post("/agents/{agent}/steps", summary="Take in steps of an agent, and advise it where the rule fires")
    async def steps(name: Name, agent: Agent, document: StepsRequest) -> dict[str, Any]:
        return await service.writer.run(advise, name, agent, document)

    def advise(name: str, agent: str, document: StepsRequest) -> dict[str, Any]:
        return desk(name).answer(agent, document.step, [step.model_dump(by_alias=True) for step in document.steps])

    return routes
