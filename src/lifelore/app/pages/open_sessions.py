"""Sessions of people that a page holds open, and the routes by which people download and delete what is theirs."""

from collections.abc import Callable, Mapping
from typing import Annotated, Any, Generic, Protocol, TypeVar

from fastapi import APIRouter, Path, Response
from fastapi.responses import JSONResponse

from lifelore.app.service.service_state import Service
from lifelore.memory import Memory

MOST_OPEN = 200
"""Largest number of sessions held in main memory; others are read again from memory when their person returns."""
Name = Annotated[str, Path(description="Anonymous identifier.", min_length=1, max_length=100)]


class Named(Protocol):
    """A session with an anonymous identifier."""

    @property
    def name(self) -> str:
        """The identifier."""
        ...


S = TypeVar("S", bound=Named)


class OpenSessions(Generic[S]):
    """The sessions of a page by name; at most `MOST_OPEN` stay in main memory.

    Parameters
    ----------
    memory : Memory
    open_session : callable
        The session of a name in a memory; NotFoundError where there is none.
    """

    def __init__(self, memory: Memory, open_session: Callable[[Memory, str], S]) -> None:
        self._memory, self._open = memory, open_session
        self._sessions: dict[str, S] = {}

    def of(self, name: str) -> S:
        """The session of a name, read from memory where it is not open."""
        return self._sessions.get(name) or self.add(self._open(self._memory, name))

    def add(self, session: S) -> S:
        """Hold a session open, and close the oldest ones; the session."""
        self._sessions[session.name] = session
        while len(self._sessions) > MOST_OPEN:
            del self._sessions[next(iter(self._sessions))]
        return session

    def close(self, name: str) -> None:
        """Close a session; the next question reads it again from memory."""
        self._sessions.pop(name, None)


class CsvResponse(Response):
    """A table as comma-separated values."""

    media_type = "text/csv"


class JsonLinesResponse(Response):
    """A JSON document a line."""

    media_type = "application/jsonl"


def add_record_routes(
    routes: APIRouter,
    service: Service,
    noun: str,
    sessions: OpenSessions[Any],
    exports: Mapping[str, tuple[type[Response], Callable[[Memory, str], Any]]],
    forget: Callable[[Memory, str], int],
) -> None:
    """Add the routes that show and delete all that is stored of a session: ``/NOUNs/{NOUN}`` and ``…/record``.

    Parameters
    ----------
    routes : APIRouter
    service : Service
    noun : str
        What the page calls a session.
    sessions : OpenSessions
    exports : mapping
        By the suffix of the record's address, the kind of its answer and the content in memory of a name.
    forget : callable
        Deletes from memory what is stored of a name; the number of contributions removed.
    """
    path = f"/{noun}s/{{name}}"

    def add_export(suffix: str, response: type[Response], export: Callable[[Memory, str], Any]) -> None:
        summary = f"The record of a {noun}{f' as {suffix[1:].upper()}' if suffix else ''}"

        # With `response` as the class, FastAPI would document errors in its media type too.
        documented: dict[int | str, dict[str, Any]] = {200: {"content": {str(response.media_type): {}}}}

        @routes.get(f"{path}/record{suffix}", summary=summary, response_class=Response, responses=documented)
        def record(name: Name) -> Response:
            return response(export(service.memory, name))

    for suffix, (response, export) in exports.items():
        add_export(suffix, response, export)

    @routes.delete(path, summary=f"Delete all that is stored of a {noun}, for ever")
    async def delete(name: Name) -> Any:
        forgotten = await service.writer.run(forget, service.memory, name)
        sessions.close(name)
        return JSONResponse({noun: name, "forgotten": forgotten})
