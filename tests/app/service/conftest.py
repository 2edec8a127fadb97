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


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def back_end(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def where(back_end: str, new_place: Places) -> str:
    """A fresh place in each back end."""
    return new_place(back_end)


def opened(memory: str, base: str = "http://127.0.0.1:8321", **settings: Any) -> TestClient:
    """The application with these settings, not yet started."""
    app = create_app(ServiceSettings(memory, **settings))
    return TestClient(app, base_url=base, raise_server_exceptions=False)


@pytest.fixture
def serve(new_place: Places) -> Iterator[Callable[..., TestClient]]:
    """Start the application with these settings; by default over a fresh SQLite memory."""
    with ExitStack() as stack:
        yield lambda memory=None, **own: stack.enter_context(opened(memory or new_place("sqlite"), **own))


@pytest.fixture(scope="module")
def shared(new_place: Places) -> Iterator[TestClient]:
    """A service over one SQLite memory for the tests of a module that do not mind what others have stored."""
    with opened(new_place("sqlite")) as client:
        yield client


@pytest.fixture
def study() -> dict[str, Any]:
    """The document of a study of two types and two policies, whose choices are greedy."""
    return STUDY


@pytest.fixture(scope="module")
def place(back_end: str, new_place: Places) -> str:
    """The place of the memory of `client` in each back end."""
    return new_place(back_end)


@pytest.fixture(scope="module")
def running(place: str) -> Iterator[TestClient]:
    with opened(place) as client:
        yield client


@pytest.fixture
def client(running: TestClient) -> TestClient:
    """A client of a service in each back end, with the new study `s`; the tests of a module share the service."""
    running.delete("/v1/studies/s")
    assert running.put("/v1/studies/s", json=STUDY).status_code == 200
    return running
