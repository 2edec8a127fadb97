"""The service in this process, over a fresh memory of each kind."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from fastapi.testclient import TestClient

from lifelore.app.service.application import create_app
from lifelore.app.service.settings import ServiceSettings

LIBRARY = {
    "types": ["calm", "lively"], "policies": ["slow", "fast"],
    "means": [[8.0, 2.0], [3.0, 8.5]], "deviations": 2.0,
}  # fmt: skip
STUDY = {"library": LIBRARY, "control": 0.0, "rule": "greedy"}

Places = Callable[[str], str]


@pytest.fixture(params=["sqlite", "postgresql"])
def back_end(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def where(back_end: str, new_place: Places) -> str:
    """A fresh place in each back end."""
    return new_place(back_end)


@pytest.fixture
def serve(new_place: Places) -> Iterator[Callable[..., TestClient]]:
    """Start the application with these settings; by default over a fresh SQLite memory."""
    with ExitStack() as stack:

        def serve(memory: str | None = None, base: str = "http://127.0.0.1:8321", **settings: Any) -> TestClient:
            app = create_app(ServiceSettings(memory or new_place("sqlite"), **settings))
            return stack.enter_context(TestClient(app, base_url=base, raise_server_exceptions=False))

        yield serve


@pytest.fixture
def study() -> dict[str, Any]:
    """The document of a study of two types and two policies, whose choices are greedy."""
    return STUDY


@pytest.fixture
def client(serve: Callable[..., TestClient], where: str) -> TestClient:
    """A client of a service in each back end, with the study `s`."""
    client = serve(where)
    assert client.put("/v1/studies/s", json=STUDY).status_code == 200
    return client
