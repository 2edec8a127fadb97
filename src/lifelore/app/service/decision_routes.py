"""The routes of decisions and outcomes, and their batches: ASGI with msgspec, for speed.

These four take nearly all requests. They are answered before FastAPI looks for a route, which would take as long
as the answer. What they take and give is declared once, as msgspec types, which check requests and describe the
routes in the OpenAPI document.
"""

import re
from collections.abc import Awaitable, Callable, Sequence
from typing import Annotated, Any, NamedTuple

import msgspec
from msgspec import Meta
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import Request as HttpRequest

from lifelore.agent.personalise.explanation import novelty_of
from lifelore.app.service.admission import STUDIES, Refused
from lifelore.app.service.bodies import parsed
from lifelore.app.service.error_documents import (
    KINDS,
    WRONG_METHOD,
    error_body,
    send_json,
    status_of,
    without_places,
)
from lifelore.app.service.service_state import Service
from lifelore.app.service.writer import PART, WHOLE, Kind
from lifelore.core.errors import InputError, LifeloreError

LARGEST_BATCH = 100_000
Text = Annotated[str, Meta(min_length=1, max_length=200)]
Policy = Annotated[str, Meta(description="Name of the policy.")]


class DecisionRequest(msgspec.Struct, forbid_unknown_fields=True, gc=False):
    """A user who needs a policy now, with the fields of `decisions.Request`."""

    user: Annotated[str, Meta(description="Name of the user.", examples=["ada"])]
    request: Annotated[
        str | None,
        Meta(description="Identifier, unique for the user: the same request again gets the same decision."),
    ] = None
    context: Annotated[str | None, Meta(description="Context of the user, as in the logs of the fit.")] = None
    features: Annotated[dict[str, float] | None, Meta(description="Numbers known of the user beforehand.")] = None
    available: Annotated[
        list[str] | None, Meta(description="Policies that the user can get now; left out: all.")
    ] = None
    novelty: Annotated[bool, Meta(description="Also compute the probability that no known type fits.")] = False


class OutcomeRequest(msgspec.Struct, forbid_unknown_fields=True, gc=False):
    """How a decision ended."""

    decision: Annotated[str, Meta(description="Identifier of the decision.")]
    outcome: Annotated[float, Meta(description="Outcome; larger is better.", examples=[7.5])]

    def row(self) -> tuple[str, float]:
        """The outcome as `observe` takes it."""
        return self.decision, self.outcome


class Decisions(msgspec.Struct, forbid_unknown_fields=True):
    """Users who each need a policy now."""

    items: Annotated[list[DecisionRequest], Meta(max_length=LARGEST_BATCH)]


class Outcomes(msgspec.Struct, forbid_unknown_fields=True):
    """How decisions ended."""

    items: Annotated[list[OutcomeRequest], Meta(max_length=LARGEST_BATCH)]


class ItemError(msgspec.Struct):
    """Why an item of a batch was refused."""

    kind: str
    message: str


class Decision(msgspec.Struct):
    """A stored decision, with the belief before it."""

    decision: Annotated[str, Meta(description="Identifier, by which the outcome is given later: a UUID.")]
    user: str
    policy: Policy
    probability: Annotated[float, Meta(description="Of the policy at this moment.")]
    control: Annotated[bool, Meta(description="Whether the user is of the control group.")]
    repeated: Annotated[bool, Meta(description="Whether the request was answered before.")]
    available: list[str] | None
    context: Annotated[str | None, Meta(description="Context whose prior counts.")]
    features: dict[str, float] | None
    belief: Annotated[dict[str, float], Meta(description="Probability of each type.")]
    expected: Annotated[dict[str, float], Meta(description="Expected outcome of each policy in use.")]
    probabilities: Annotated[dict[str, float], Meta(description="Of the policies in use, by the belief.")]
    novelty: Annotated[float | None, Meta(description="Probability that no known type fits, if asked for.")]


class Outcome(msgspec.Struct):
    """A stored outcome and the belief after it."""

    decision: str
    user: str
    policy: Policy
    control: bool
    outcome: float
    taken: Annotated[bool, Meta(description="False: the same outcome was there already.")]
    belief: dict[str, float]


class DecisionItem(msgspec.Struct):
    """A stored decision, or the error of this item alone."""

    decision: str | msgspec.UnsetType = msgspec.UNSET
    policy: str | msgspec.UnsetType = msgspec.UNSET
    probability: float | msgspec.UnsetType = msgspec.UNSET
    control: bool | msgspec.UnsetType = msgspec.UNSET
    repeated: bool | msgspec.UnsetType = msgspec.UNSET
    error: ItemError | msgspec.UnsetType = msgspec.UNSET


class OutcomeItem(msgspec.Struct):
    """Whether an outcome is new, or the error of this item alone."""

    taken: bool | msgspec.UnsetType = msgspec.UNSET
    policy: str | msgspec.UnsetType = msgspec.UNSET
    control: bool | msgspec.UnsetType = msgspec.UNSET
    error: ItemError | msgspec.UnsetType = msgspec.UNSET


class DecisionItems(msgspec.Struct):
    """Answers in the order of the items."""

    items: list[DecisionItem]


class OutcomeItems(msgspec.Struct):
    """Answers in the order of the items."""

    items: list[OutcomeItem]


class HotRoute(NamedTuple):
    """A route below a study, with the types of its body and answer."""

    name: str
    summary: str
    body: type
    answer: type
    handle: Callable[[str, Any], Awaitable[Any]]

    @property
    def path(self) -> str:
        """Template of the path, for metrics, the log and the OpenAPI document."""
        return f"{STUDIES}{{study}}/{self.name}"


def hot_routes(service: Service) -> list[HotRoute]:
    """The routes of decisions and outcomes."""
    writer, encode = service.writer, msgspec.json.Encoder().encode

    async def decide(study: str, document: DecisionRequest) -> Any:
        (answer,) = await writer.store("decisions", study, [document])
        if isinstance(answer, LifeloreError):
            raise answer
        answer["novelty"] = None
        if document.novelty:
            opened = service.studies.get(study)
            answer["novelty"] = await run_in_threadpool(novelty_of, service.memory, opened, document.user)
        return answer

    async def observe(study: str, document: OutcomeRequest) -> Any:
        (answer,) = await writer.store("outcomes", study, [document.row()])
        if isinstance(answer, LifeloreError):
            raise answer
        return answer

    async def decide_many(study: str, document: Decisions) -> Any:
        return await in_parts("decisions", study, document.items)

    async def observe_many(study: str, document: Outcomes) -> Any:
        return await in_parts("outcomes", study, [item.row() for item in document.items])

    async def in_parts(kind: Kind, study: str, rows: Sequence[Any]) -> msgspec.Raw:
        """The answers of a batch, read, stored and encoded a part at a time: other requests get their turns."""
        parts, step = [], WHOLE if len(rows) <= WHOLE else PART
        for at in range(0, len(rows), step):
            answers = await writer.store(kind, study, rows[at : at + step], brief=True)
            listed = [refused(one) if isinstance(one, LifeloreError) else one for one in answers]
            parts.append(encode(listed)[1:-1])
        return msgspec.Raw(b'{"items":[' + b",".join(parts) + b"]}")

    def refused(error: LifeloreError) -> dict[str, Any]:
        message = without_places(str(error), service.memory.location)
        return {"error": {"kind": KINDS[status_of(error)], "message": message}}

    return [
        HotRoute("decisions", "Choose a policy for a user, and store it", DecisionRequest, Decision, decide),
        HotRoute("outcomes", "Store the outcome of a decision, once", OutcomeRequest, Outcome, observe),
        HotRoute("decisions/batch", "Choose for each of many users", Decisions, DecisionItems, decide_many),
        HotRoute("outcomes/batch", "Store outcomes of many decisions", Outcomes, OutcomeItems, observe_many),
    ]


class HotRoutes:
    """ASGI middleware that answers the hot routes and hands all other requests on.

    Parameters
    ----------
    app : ASGI application
    routes : sequence of HotRoute
    location : str
        Of the memory, which messages leave out.
    """

    def __init__(self, app: Any, routes: Sequence[HotRoute], location: str) -> None:
        self._app, self._location, self._encode = app, location, msgspec.json.Encoder().encode
        self._routes = {route.name: (route, msgspec.json.Decoder(route.body).decode) for route in routes}

    async def __call__(self, scope: Any, receive: Any, send: Any) -> None:
        study, found = "", None
        if scope["type"] == "http" and scope["path"].startswith(STUDIES):
            study, _, name = scope["path"].removeprefix(STUDIES).partition("/")
            found = self._routes.get(name)
        if not study or found is None:
            await self._app(scope, receive, send)
            return
        if scope["method"] != "POST":
            raise Refused(405, WRONG_METHOD, [(b"allow", b"POST")])
        route, decode = found
        scope["route"] = route  # for metrics and the log
        try:
            document = await _document(HttpRequest(scope, receive), decode)
            await send_json(send, 200, self._encode(await route.handle(study, document)))
            return
        except LifeloreError as error:
            status, message = status_of(error), without_places(str(error), self._location)
        except HTTPException as error:
            status, message = error.status_code, str(error.detail)
        await send_json(send, status, error_body(status, message, scope["state"]["request"]))


async def _document(request: HttpRequest, decode: Callable[[bytes], Any]) -> Any:
    try:
        return await parsed(await request.body(), decode)
    except (msgspec.ValidationError, msgspec.DecodeError, UnicodeDecodeError) as error:
        raise InputError(_plain(str(error))) from None


def _plain(message: str) -> str:
    """A message of msgspec with its place first, as the other routes have it."""
    text, _, place = message.partition(" - at `$")
    where = place.rstrip("`").lstrip(".")
    if missing := re.fullmatch("Object missing required field `(.*)`", text):
        where, text = f"{where}.{missing[1]}".lstrip("."), "field required"
    return f"{where or 'body'}: {text[:1].lower()}{text[1:]}"


def describe(document: dict[str, Any], routes: list[HotRoute]) -> None:
    """Add the routes to an OpenAPI document."""
    types = [kind for route in routes for kind in (route.body, route.answer)]
    schemas, components = msgspec.json.schema_components(types, ref_template="#/components/schemas/{name}")
    document.setdefault("components", {}).setdefault("schemas", {}).update(components)
    study = {
        "name": "study", "in": "path", "required": True, "description": "Name of the study.",
        "schema": {"type": "string", "minLength": 1, "maxLength": 60},
    }  # fmt: skip
    failed = {"content": {"application/json": {"schema": {"$ref": "#/components/schemas/ErrorDocument"}}}}
    for number, route in enumerate(routes):
        body, answer = schemas[2 * number], schemas[2 * number + 1]
        document["paths"][route.path] = {
            "post": {
                "tags": ["personalise"],
                "summary": route.summary,
                "operationId": route.name.replace("/", "_"),
                "parameters": [study],
                "requestBody": {"required": True, "content": {"application/json": {"schema": body}}},
                "responses": {
                    "200": {"description": "Done.", "content": {"application/json": {"schema": answer}}},
                    "4XX": failed | {"description": "The request breaks a rule."},
                    "5XX": failed | {"description": "The service cannot answer now."},
                },
            }
        }
