"""The service answers as its OpenAPI document says: requests that schemathesis makes up, on both back ends."""

from collections.abc import Iterator

import pytest

pytest.importorskip("schemathesis", reason="needs the extra test")

import schemathesis
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, given, settings
from schemathesis.specs.openapi.checks import positive_data_acceptance

from lifelore.app.service.application import create_app
from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.tokens import add_token

EXAMPLES = 6
"""Requests for each route."""


@pytest.fixture(scope="module")
def token_file(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, str]:
    """A file of tokens, and a token in it."""
    file = str(tmp_path_factory.mktemp("tokens") / "tokens")
    return file, add_token(file, "schemathesis", ["admin"])


@pytest.fixture(params=["sqlite", "postgresql"])
def api(request: pytest.FixtureRequest, new_place, token_file) -> Iterator[schemathesis.BaseSchema]:
    app = create_app(ServiceSettings(new_place(request.param), token_file=token_file[0], rate=0.0))
    with TestClient(app):
        yield schemathesis.openapi.from_asgi("/openapi.json", app)


def test_every_route_answers_as_documented(api, token_file):
    # The library has rules that a schema cannot say: names are printable, priors sum to 1.
    # Through its strategies: the plug-in of schemathesis does not run under every pytest.
    for found in api.get_all_operations():

        @given(case=found.ok().as_strategy())
        @settings(max_examples=EXAMPLES, derandomize=True, database=None, suppress_health_check=list(HealthCheck))
        def answers(case):
            headers = {"Authorization": f"Bearer {token_file[1]}"}
            case.call_and_validate(headers=headers, excluded_checks=[positive_data_acceptance])

        answers()
