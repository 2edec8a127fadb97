"""Routes of studies and their users: register, archive, delete, policies; explain, forget, and past outcomes."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Query
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.personalise.decisions import forget
from lifelore.agent.personalise.explanation import explain, stranger_table
from lifelore.agent.personalise.past import Line, add_lines
from lifelore.agent.personalise.registration import add, library_of, register, retire, study_document
from lifelore.agent.personalise.study import study_states
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.decision_routes import LARGEST_BATCH
from lifelore.app.service.service_state import Service
from lifelore.memory.studies import ACTIVE, ARCHIVED

Name = Annotated[str, Path(description="Name of the study.", min_length=1, max_length=60, examples=["playlists"])]
Rows = list[list[FiniteFloat]]
Word = Annotated[str, Field(min_length=1, max_length=200)]
User = Annotated[str, Query(alias="name", description="Name of the user.", min_length=1, max_length=200)]


class LibraryDocument(BaseModel):
    """A policy library: means and deviations by type (rows) and policy (columns), or a library file."""

    model_config = ConfigDict(extra="forbid")
    types: list[str] | None = Field(None, description="Names of the types.")
    policies: list[str] | None = Field(None, description="Names of the policies.")
    means: Rows | None = Field(None, description="Mean outcome of each type under each policy.")
    deviations: FiniteFloat | Rows | None = Field(None, description="Standard deviations, above 0.")
    counts: FiniteFloat | Rows | None = Field(
        None, description="Number of runs behind each mean; left out: exact."
    )
    prior: list[FiniteFloat] | None = Field(None, description="Probability of each type; sums to 1.")
    signals: list[Rows] | None = Field(None, description="Probabilities of signals by type, policy and category.")
    categories: list[str] | None = Field(None, description="Names of the signals' categories.")
    file: str | None = Field(
        None, description="A file of PolicyLibrary.save in base64, in place of the other fields."
    )


class StudyFields(BaseModel):
    """How a study chooses."""

    control: FiniteFloat = Field(0.1, description="Share of users in the control group, in [0, 1).")
    incumbent: str | None = Field(None, description="Policy of the control group; left out: each policy alike.")
    rule: str = Field("information-directed", description="Selection rule.", examples=["sampling"])
    explore: FiniteFloat = Field(0.0, description="Share of choices that are drawn from all policies, in [0, 1].")
    change: FiniteFloat | Literal["learnt"] = Field(
        "learnt", description="Probability that a user's type changes between two choices, or how often is learnt."
    )
    models: Literal["uncertain", "plug-in"] = Field(
        "uncertain", description="Whether models of few runs learn too."
    )


class StudyRequest(StudyFields):
    """A library and how to choose from it."""

    model_config = ConfigDict(
        extra="forbid",
        json_schema_extra={
            "example": {
                "library": {
                    "types": ["calm", "lively"], "policies": ["slow", "fast"],
                    "means": [[8.0, 2.0], [3.0, 9.0]], "deviations": 2.0, "counts": 40,
                },
                "control": 0.1,
            }
        },
    )  # fmt: skip
    library: LibraryDocument


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


class PolicyState(BaseModel):
    """Whether a policy is in use."""

    model_config = ConfigDict(
        extra="forbid", json_schema_extra={"example": {"policy": "slow", "state": "retired"}}
    )
    policy: str = Field(description="Name of the policy.", min_length=1, max_length=200)
    state: Literal["active", "retired"]


class ChangedPolicy(BaseModel):
    """The state of a policy: a new one is a pilot until a fit knows it."""

    study: str
    policy: str
    state: Literal["active", "pilot", "retired"]


class StudyState(BaseModel):
    """Whether a study takes decisions."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"state": "archived"}})
    state: Literal["active", "archived"]


class StudyEntry(BaseModel):
    """A study in the list of all."""

    name: str
    state: Literal["active", "archived"]


class StudyList(BaseModel):
    """All studies in memory."""

    studies: list[StudyEntry]


def router(service: Service) -> APIRouter:
    """The routes of studies and users; names of users travel in query or body."""
    routes = APIRouter(prefix="/v1/studies", tags=["personalise"], route_class=JsonRoute)
    memory, studies = service.memory, service.studies

    # Requests are compared with the routes in this order; those that are asked most come first.
    @routes.get("/{study}/user", summary="Belief about a user, and the evidence behind it")
    def show_user(study: Name, name: User) -> dict[str, Any]:
        return explain(memory, studies.get(study), name)

    @routes.delete("/{study}/user", summary="Forget all that is stored of a user, for ever")
    def forget_user(study: Name, name: User) -> Forgotten:
        return Forgotten(user=name, forgotten=forget(memory, studies.get(study), name))

    @routes.post("/{study}/past", summary="Store outcomes that users had in another system, each line once")
    def past(study: Name, document: Past) -> dict[str, Any]:
        lines = [
            Line(one.user, one.policy, one.outcome, int(1000 * (one.time or 0)), one.id or "", one.context)
            for one in document.items
        ]
        return add_lines(memory, studies.get(study), lines)

    @routes.get("", summary="The studies in memory")
    def listed() -> StudyList:
        entries = sorted(study_states(memory).items())
        return StudyList(studies=[StudyEntry(name=name, state=state) for name, state in entries])  # pyright: ignore

    @routes.get("/{study}", summary="A study: its library, states of policies and settings")
    def show(study: Name) -> dict[str, Any]:
        return study_document(studies.get(study))

    @routes.put("/{study}", summary="Register a policy library as a study")
    def put(study: Name, document: StudyRequest) -> dict[str, Any]:
        library = library_of(document.library.model_dump())
        registered = register(memory, study, library, **document.model_dump(exclude={"library"}))
        studies.drop(study)
        return study_document(registered)

    @routes.delete("/{study}", summary="Delete a study with its users, decisions and outcomes, for ever")
    def delete(study: Name) -> StudyEntry:
        state = ARCHIVED if studies.get(study).archived else ACTIVE
        memory.studies.delete(study)
        studies.drop(study)
        return StudyEntry(name=study, state=state)

    @routes.put("/{study}/state", summary="Archive a study, so that it takes no more decisions, or make it active")
    def archive(study: Name, document: StudyState) -> StudyEntry:
        studies.get(study)
        memory.studies.set_state(study, document.state)
        studies.drop(study)
        return StudyEntry(name=study, state=document.state)

    @routes.put("/{study}/policies", summary="Retire a policy, or bring it in")
    def state(study: Name, document: PolicyState) -> ChangedPolicy:
        change = retire if document.state == "retired" else add
        changed = change(memory, studies.get(study), document.policy)
        studies.drop(study)
        found: Any = changed.states[document.policy]
        return ChangedPolicy(study=study, policy=document.policy, state=found)

    @routes.get("/{study}/table", summary="What users get of whom nothing but the context is known")
    def table(study: Name) -> dict[str, Any]:
        return stranger_table(studies.get(study))

    return routes
