"""Routes of /play and /teach answer as their OpenAPI document says: requests that schemathesis makes up."""

import pytest

pytest.importorskip("schemathesis", reason="needs the extra test")

import schemathesis
from fastapi.testclient import TestClient
from hypothesis import HealthCheck, given, settings
from schemathesis.specs.openapi.checks import positive_data_acceptance

from lifelore.app.pages.mount import app_with_pages
from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.tokens import add_token

EXAMPLES = 10
"""Requests for each route."""


@pytest.mark.slow
def test_every_route_answers_as_documented(tmp_path):
    token = add_token(str(tmp_path / "tokens"), "schemathesis", ["read", "write"])
    app = app_with_pages(ServiceSettings(str(tmp_path / "m.db"), token_file=str(tmp_path / "tokens"), rate=0.0))
    tried = 0
    with TestClient(app):
        for found in schemathesis.openapi.from_asgi("/openapi.json", app).get_all_operations():
            operation = found.ok()  # pyright: ignore[reportAttributeAccessIssue]
            if not operation.path.startswith(("/v1/play", "/v1/teach")):
                continue
            tried += 1

            @given(case=operation.as_strategy())
            @settings(
                max_examples=EXAMPLES, derandomize=True, database=None, deadline=None,
                suppress_health_check=list(HealthCheck),  # pyright: ignore[reportArgumentType]
            )  # fmt: skip
            def answers(case):
                headers = {"Authorization": f"Bearer {token}"}
                case.call_and_validate(headers=headers, excluded_checks=[positive_data_acceptance])

            answers()
    assert tried == 14
