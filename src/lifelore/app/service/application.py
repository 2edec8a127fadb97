"""The factory of the application: routes over one open memory, behind the gate.

Pages are mounted on the application that `create_app` returns; they pass the same gate.
"""

from collections.abc import AsyncIterator, Collection
from contextlib import asynccontextmanager
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.routing import Match

from lifelore import __version__
from lifelore.app.service.decision_routes import HotRoutes, hot_routes
from lifelore.app.service.documentation import document_api
from lifelore.app.service.error_documents import (
    WRONG_METHOD,
    ErrorDocument,
    error_body,
    status_of,
    validation_message,
    without_places,
)
from lifelore.app.service.gate import Gate
from lifelore.app.service.service_state import Service
from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.tokens import TokenFile
from lifelore.core.errors import LifeloreError
from lifelore.memory import open_memory

DESCRIPTION = """Personalise, perceive and remember over HTTP; the memory is that of the command line."""
ERRORS: dict[int | str, dict[str, Any]] = {
    "4XX": {"model": ErrorDocument, "description": "The request breaks a rule."},
    "5XX": {"model": ErrorDocument, "description": "The service cannot answer now."},
}


def create_app(settings: ServiceSettings, open_paths: Collection[str] = ()) -> FastAPI:
    """The application over the memory of the settings, which it opens now and closes when it stops.

    `open_paths` need no token. Routes find the shared state as ``app.state.service``.

    Raises
    ------
    StoreError, InputError, NotFoundError
        The memory or the token file cannot be opened.
    """
    from lifelore.app.service import (
        adaptation_routes,
        health_routes,
        log_routes,
        memory_routes,
        perceive_routes,
        study_routes,
    )

    tokens: TokenFile | None = None if settings.token_file is None else TokenFile(settings.token_file)
    service = Service(settings, open_memory(settings.memory, durable=True))

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        yield
        service.worker.stop()
        service.writer.stop()
        service.memory.close()

    app = FastAPI(
        title="Lifelore", version=__version__, description=DESCRIPTION, lifespan=lifespan, responses=ERRORS,
        docs_url=None, redoc_url=None, separate_input_output_schemas=False,
        telemetry={"tracing": False, "metrics": False, "logs": False},
    )  # fmt: skip
    app.state.service = service
    _answer_errors(app, service)
    # A request is compared with the routes in this order; those that are asked most come first.
    for group, routes in (
        ("personalise", study_routes),
        (None, health_routes),
        ("personalise", adaptation_routes),
        ("personalise", log_routes),
        ("perceive", perceive_routes),
        ("memory", memory_routes),
    ):
        if group is None or group in settings.only:
            app.include_router(routes.router(service))
    hot = hot_routes(service) if "personalise" in settings.only else []
    document_api(app, tokens is not None, hot)
    app.add_middleware(HotRoutes, routes=hot, location=service.memory.location)
    app.add_middleware(Gate, settings=settings, tokens=tokens, metrics=service.metrics, open_paths=open_paths)
    return app


def _answer_errors(app: FastAPI, service: Service) -> None:
    def answer(request: Request, status: int, message: str, headers: Any = None) -> Response:
        body = error_body(status, without_places(message, service.memory.location), request.state.request)
        return Response(body, status, headers, "application/json")

    @app.exception_handler(LifeloreError)
    def refused(request: Request, error: LifeloreError) -> Response:
        return answer(request, status_of(error), str(error))

    @app.exception_handler(RequestValidationError)
    def invalid(request: Request, error: RequestValidationError) -> Response:
        return answer(request, 422, validation_message(error.errors()))

    @app.exception_handler(HTTPException)
    def http(request: Request, error: HTTPException) -> Response:
        messages = {
            404: "there is no such address; /openapi.json lists all",
            405: WRONG_METHOD,
        }
        headers = {"allow": _allowed(app, request)} if error.status_code == 405 else error.headers
        return answer(request, error.status_code, messages.get(error.status_code, str(error.detail)), headers)


def _allowed(app: FastAPI, request: Request) -> str:
    """The methods that the address of a request takes; each of its routes knows its own alone."""
    methods = ("GET", "HEAD", "POST", "PUT", "PATCH", "DELETE")
    scopes = {method: {**request.scope, "method": method} for method in methods}
    return ", ".join(
        method
        for method, scope in scopes.items()
        if any(route.matches(scope)[0] == Match.FULL for route in app.router.routes)
    )
