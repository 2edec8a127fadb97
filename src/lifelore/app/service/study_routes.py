"""Routes of studies: register a library, learn one from a log, evaluate, retire and add policies."""

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.personalise.library_document import library_of
from lifelore.agent.personalise.registration import StudySettings, register, study_document
from lifelore.agent.personalise.decisions import add, retire
from lifelore.agent.personalise.study import study_names
from lifelore.app.service.service_state import Service

Name = Annotated[str, Path(description="Name of the study.", min_length=1, max_length=60, examples=["playlists"])]
Rows = list[list[FiniteFloat]]


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


class StudyRequest(BaseModel):
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


class PolicyState(BaseModel):
    """Whether a policy is in use."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"state": "retired"}})
    state: Literal["active", "retired"]


def router(service: Service) -> APIRouter:
    """The routes of studies."""
    routes = APIRouter(prefix="/v1/studies", tags=["personalise"])
    memory, studies = service.memory, service.studies

    @routes.get("", summary="Names of the studies in memory")
    def names() -> dict[str, list[str]]:
        return {"studies": study_names(memory)}

    @routes.get("/{study}", summary="A study: its library, states of policies and settings")
    def show(study: Name) -> dict[str, Any]:
        return study_document(studies.get(study))

    @routes.put("/{study}", summary="Register a policy library as a study")
    def put(study: Name, document: StudyRequest) -> dict[str, Any]:
        library = library_of(document.library.model_dump())
        settings = StudySettings(**document.model_dump(exclude={"library"}))
        registered = register(memory, study, library, settings)
        studies.drop(study)
        return study_document(registered)

    @routes.put("/{study}/policies/{policy}", summary="Retire a policy, or bring it in")
    def state(study: Name, policy: str, document: PolicyState) -> dict[str, Any]:
        change = retire if document.state == "retired" else add
        changed = change(memory, studies.get(study), policy)
        studies.drop(study)
        return {"study": study, "policy": policy, "state": changed.states[policy]}

    return routes
