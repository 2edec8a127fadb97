"""Routes over logs: learn a study from a log, report what a study achieved and decides, evaluate others."""

from dataclasses import fields
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request
from fastapi.responses import StreamingResponse
from pydantic import BaseModel, ConfigDict, Field, FiniteFloat

from lifelore.agent.personalise.decision_log import log_parts
from lifelore.agent.personalise.evaluate.evaluate import EvaluateSettings, evaluate
from lifelore.agent.personalise.fitting.fit import FitSettings, fit
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.study_report import report
from lifelore.app.service.bodies import JsonRoute
from lifelore.app.service.service_state import Service
from lifelore.app.service.study_routes import Name, StudyFields
from lifelore.app.service.worker_process import over_memory
from lifelore.memory import Memory

KINDS = {"csv": "text/csv; charset=utf-8", "ndjson": "application/x-ndjson"}
"""Media types of logs."""
Days = Annotated[int, Query(ge=2, le=90, description="Window; 2 days come by hour, more by day.")]
EXAMPLE = "user,policy,outcome\nada,slow,8\nada,fast,2\nben,slow,3\nben,fast,9\n"
LOGGED = "user,policy,outcome,probability\nada,slow,8,0.5\nada,fast,2,0.5\nben,slow,3,0.5\nben,fast,9,0.5\n"


class FitRequest(StudyFields):
    """A log of choices and outcomes, and how to learn from it."""

    model_config = ConfigDict(extra="forbid", json_schema_extra={"example": {"log": EXAMPLE, "types": 2}})
    log: str = Field(description="CSV with the columns user, policy, outcome, and if known type and context.")
    model: Literal["auto", "gaussian", "student-t", "categorical", "joint-normal"] = Field(
        "auto", description="Outcomes' model."
    )
    types: int | None = Field(
        None, ge=1, le=100, description="Number of types; left out: selected by the outcomes."
    )
    features: list[str] = Field([], description="Columns of numbers that are known of a user beforehand.")
    columns: dict[str, str] = Field({}, description="The log's own names of columns, by ours.")
    missing: list[str] = Field([], description="Words that mean a missing value, beside the empty field.")
    missing_outcome: str = Field("leave-out", description="leave-out, refuse, or the number that it means.")
    missing_policy: str = Field("refuse", description="refuse, leave-out, or the policy that it means.")

    @property
    def form(self) -> LogFormat:
        """How the log is written."""
        return LogFormat(
            self.columns, missing=tuple(self.missing), missing_outcome=self.missing_outcome,
            missing_policy=self.missing_policy, features=tuple(self.features),
        )  # fmt: skip


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
    async def fit_study(request: Request, study: Name, document: FitRequest) -> dict[str, Any]:
        options = document.model_dump(include={one.name for one in fields(FitSettings)} - {"name", "seed"})
        settings = FitSettings(study, seed=service.settings.seed, **options)
        fitted = await service.worker.run(
            request, over_memory, service.settings.memory, fit_text, document.log, settings, document.form
        )
        studies.drop(study)
        return fitted

    @routes.get("/studies/{study}/report", summary="Uplift of a study's decisions with 95 % intervals")
    def report_study(
        study: Name,
        split: Annotated[Literal["user", "time", "both"] | None, Query()] = None,
        by: Annotated[Literal["day", "week"] | None, Query(description="Also compare in each period.")] = None,
    ) -> dict[str, Any]:
        return report(memory, studies.get(study), split=split, by=by)

    @routes.get(
        "/studies/{study}/traffic",
        summary="Decisions and outcomes of the last days, and alarms; at most a minute old",
    )
    def traffic(study: Name, days: Days = 14) -> dict[str, Any]:
        return service.watch.traffic(study, days)

    @routes.post("/evaluate", summary="What other policies would have achieved, from a log with probabilities")
    async def evaluate_log(request: Request, document: EvaluateRequest) -> dict[str, Any]:
        options = document.model_dump(exclude={"log", "policies", "rules"})
        settings = EvaluateSettings(
            tuple(document.policies), rules=tuple(document.rules), seed=service.settings.seed, **options
        )
        return await service.worker.run(
            request, over_memory, service.settings.memory, evaluate_text, document.log, settings
        )

    @routes.get(
        "/studies/{study}/log",
        summary="All decisions of a study with their probabilities, as a stream",
        response_class=StreamingResponse,
        responses={200: {"content": {kind: {"schema": {"type": "string"}} for kind in KINDS.values()}}},
    )
    def log(
        study: Name,
        since: Annotated[float | None, Query(description="Seconds since 1970: decisions from then on.")] = None,
        until: Annotated[float | None, Query(description="Seconds since 1970: decisions before.")] = None,
        cursor: Annotated[str | None, Query(description="A decision: only later ones.")] = None,
        limit: Annotated[int | None, Query(ge=1, description="Largest number of decisions.")] = None,
        form: Annotated[Literal["csv", "ndjson"], Query(alias="format")] = "csv",
    ) -> StreamingResponse:
        parts = log_parts(memory, studies.get(study), form, since=since, until=until, cursor=cursor, limit=limit)
        return StreamingResponse(parts, media_type=KINDS[form])

    return routes


def fit_text(memory: Memory, log: str, settings: FitSettings, form: LogFormat) -> dict[str, Any]:
    """`fit` of a log's text."""
    with TemporaryDirectory() as folder:
        return fit([_written(folder, log)], memory, settings, form)


def evaluate_text(memory: Memory, log: str, settings: EvaluateSettings) -> dict[str, Any]:
    """`evaluate` of a log's text."""
    with TemporaryDirectory() as folder:
        return evaluate([_written(folder, log)], settings, memory=memory)


def _written(folder: str, log: str) -> Path:
    path = Path(folder) / "log.csv"
    path.write_bytes(log.encode("utf-8", "replace"))
    return path
