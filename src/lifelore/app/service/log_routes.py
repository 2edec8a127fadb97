"""Routes over logs: learn a study from a log, report what a study achieved, evaluate other policies off-policy."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.reuse.evaluate import EvaluateSettings, evaluate
from lifelore.agent.reuse.fit import FitSettings, fit
from lifelore.agent.reuse.log_format import LogFormat
from lifelore.agent.reuse.report import report
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.service_state import Service
from lifelore.app.service.study_routes import Name

EXAMPLE = "user,policy,outcome\nada,slow,8\nada,fast,2\nben,slow,3\nben,fast,9\n"
LOGGED = "user,policy,outcome,probability\nada,slow,8,0.5\nada,fast,2,0.5\nben,slow,3,0.5\nben,fast,9,0.5\n"


class FitRequest(BaseModel):
    """A log of choices and outcomes, and how to learn from it."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"log": EXAMPLE, "types": 2}})
    log: str = Field(description="CSV with the columns user, policy, outcome, and if known type and context.")
    model: Literal["auto", "gaussian", "student-t", "categorical", "joint-normal"] = Field(
        "auto", description="Outcomes' model."
    )
    types: int | None = Field(
        None, ge=1, le=100, description="Number of types; left out: selected by the outcomes."
    )
    control: FiniteFloat = Field(0.1, description="Share of users in the control group, in [0, 1).")
    incumbent: str | None = Field(None, description="Policy of the control group; left out: each policy alike.")
    rule: str = Field("information-directed", description="Selection rule.")
    explore: FiniteFloat = Field(0.0, description="Share of choices that are drawn from all policies, in [0, 1].")
    change: FiniteFloat | Literal["learnt"] = Field(
        "learnt", description="Probability that a user's type changes between two choices, or how often is learnt."
    )
    models: Literal["uncertain", "plug-in"] = Field(
        "uncertain", description="Whether models of few runs learn too."
    )
    features: list[str] = Field([], description="Columns of numbers that are known of a user beforehand.")


class EvaluateRequest(BaseModel):
    """A log with probabilities, and the policies to evaluate."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"log": LOGGED, "policies": ["slow"]}})
    log: str = Field(description="CSV with the columns user, policy, outcome and probability.")
    policies: list[str] = Field(
        [], description="Single policies; left out with the other targets: all of the log."
    )
    rules: list[str] = Field([], description="Selection rules that learn from the log.")
    study: str | None = Field(None, description="A study in memory to replay.")
    first: int | None = Field(None, ge=1, description="Evaluate the first so many decisions of each user.")
    model: Literal["means", "library"] = Field("means", description="Model of the doubly robust estimate.")
    types: int | None = Field(None, ge=1, le=100, description="Number of types of libraries learnt from the log.")
    explore: FiniteFloat = Field(0.0, description="Share of exploration of the rules, in [0, 1].")
    group: str | None = Field(None, description="Group of the log to read; all: every row.")


def router(service: Service) -> APIRouter:
    """The routes over logs."""
    routes = APIRouter(prefix="/v1", tags=["personalise"], route_class=JsonRoute)
    memory, studies = service.memory, service.studies

    @routes.post("/studies/{study}/fit", summary="Learn types of users and outcomes of policies from a log")
    def fit_study(study: Name, document: FitRequest) -> dict[str, Any]:
        options = document.model_dump(exclude={"log", "features"})
        settings = FitSettings(study, seed=service.settings.seed, **options)
        with TemporaryDirectory() as folder:
            fitted = fit(
                [_written(folder, document.log)], memory, settings, LogFormat(features=tuple(document.features))
            )
        studies.drop(study)
        return fitted

    @routes.get("/studies/{study}/report", summary="Uplift of a study's decisions with 95 % intervals")
    def report_study(
        study: Name, split: Annotated[Literal["user", "time", "both"] | None, Query()] = None
    ) -> dict[str, Any]:
        return report(memory, studies.get(study), split=split)

    @routes.post("/evaluate", summary="What other policies would have achieved, from a log with probabilities")
    def evaluate_log(document: EvaluateRequest) -> dict[str, Any]:
        options = document.model_dump(exclude={"log", "policies", "rules"})
        settings = EvaluateSettings(
            tuple(document.policies), rules=tuple(document.rules), seed=service.settings.seed, **options
        )
        with TemporaryDirectory() as folder:
            return evaluate([_written(folder, document.log)], settings, memory=memory)

    @routes.get(
        "/studies/{study}/log", summary="All decisions of a study with their probabilities, as CSV in a field"
    )
    def log(study: Name) -> dict[str, str]:
        with TemporaryDirectory() as folder:
            path = Path(folder) / "log.csv"
            report(memory, studies.get(study), log=path)
            return {"log": path.read_text(encoding="utf-8")}

    return routes


def _written(folder: str, log: str) -> Path:
    path = Path(folder) / "log.csv"
    path.write_bytes(log.encode("utf-8", "replace"))
    return path
