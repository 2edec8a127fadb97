"""The gate: tokens and scopes, this machine alone without tokens, limits, one shape of errors, identifiers."""

import json
import logging

import pytest

from lifelore.app.service.limits import WINDOW, RateLimit
from lifelore.app.service.tokens import add_token


def error_of(answer, status, kind):
    """The message, after a look at the shape."""
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/json"
    document = answer.json()
    assert set(document) == {"error"}
    assert set(document["error"]) == {"kind", "message", "request"}
    assert document["error"]["kind"] == kind
    assert document["error"]["request"] == answer.headers["x-request-id"]
    assert "\n" not in document["error"]["message"]
    return document["error"]["message"]


def bearer(token):
    return {"Authorization": f"Bearer {token}"}


def test_errors_of_every_kind_have_one_shape(serve, study):
    client = serve()
    put = client.put("/v1/studies/s", json=study | {"control": 2.0})
    assert error_of(put, 422, "input") == "control must lie between 0 and 1, 1 left out, got 2.0"
    assert "no study 'nobody' in the memory" in error_of(client.get("/v1/studies/nobody"), 404, "not found")
    error_of(client.get("/nowhere"), 404, "not found")
    error_of(client.patch("/v1/studies"), 405, "method")
    error_of(client.post("/v1/studies/s/outcomes", content=b"{"), 422, "input")
    message = error_of(client.post("/v1/studies/s/outcomes", json={"decision": "x"}), 422, "input")
    assert message == "outcome: field required"
    error_of(client.post("/v1/studies/s/decisions", json={"user": "ada", "usr": 1}), 422, "input")


def test_a_defect_shows_no_traceback_and_logs_it(serve, monkeypatch, caplog):
    client = serve()

    def broken(memory):
        raise ZeroDivisionError("secret of the inside")

    monkeypatch.setattr("lifelore.app.service.health_routes.study_names", broken)
    with caplog.at_level(logging.INFO, "lifelore.service"):
        answer = client.get("/healthz", headers={"X-Request-ID": "mine-7"})
    message = error_of(answer, 500, "defect")
    assert "secret" not in message
    (record,) = [one for one in caplog.records if one.name == "lifelore.service"]
    assert record.exc_info[0] is ZeroDivisionError
    assert record.fields["request"] == "mine-7"


def test_errors_name_no_file_of_the_server(serve, tmp_path):
    client = serve(str(tmp_path / "secret-folder" / "lifelore.db"))
    assert "secret-folder" not in client.get("/v1/studies/nobody").text


@pytest.mark.parametrize("given", ["mine-1", "", "with space", "a" * 101, "line\tbreak"])
def test_a_request_has_an_identifier(serve, given):
    found = serve().get("/healthz", headers={"X-Request-ID": given}).headers["x-request-id"]
    assert (found == given) == (given == "mine-1")
    assert found


def test_tokens_have_scopes(serve, study, tmp_path):
    file = str(tmp_path / "tokens")
    reader, writer = add_token(file, "reader", ["read"]), add_token(file, "writer", ["write"])
    client = serve(token_file=file, base="http://service.example")
    assert "token" in error_of(client.get("/v1/studies"), 401, "token")
    error_of(client.get("/v1/studies", headers=bearer("none of them")), 401, "token")
    error_of(client.get("/v1/studies", headers={"Authorization": f"Basic {reader}"}), 401, "token")
    assert client.get("/v1/studies", headers=bearer(reader)).json() == {"studies": []}
    assert "scope write" in error_of(client.put("/v1/studies/s", json=study, headers=bearer(reader)), 403, "scope")
    assert client.put("/v1/studies/s", json=study, headers=bearer(writer)).status_code == 200
    error_of(client.get("/v1/studies", headers=bearer(writer)), 403, "scope")
    error_of(client.get("/metrics"), 401, "token")
    assert client.get("/healthz").status_code == 200


def test_without_tokens_only_this_machine_is_answered(serve):
    client = serve()
    for host in ("evil.example", "evil.example:8321", "127.0.0.1.evil.example", "localhost.evil.example", ""):
        error_of(client.get("/healthz", headers={"Host": host}), 403, "scope")
    for host in ("127.0.0.1", "localhost:8321", "[::1]:8321", "127.0.0.2"):
        assert client.get("/healthz", headers={"Host": host}).status_code == 200, host
    error_of(client.get("/healthz", headers={"Origin": "https://evil.example"}), 403, "scope")
    error_of(client.get("/healthz", headers={"Origin": "null"}), 403, "scope")
    assert client.get("/healthz", headers={"Origin": "http://127.0.0.1:8321"}).status_code == 200


def test_a_large_body_is_refused_with_and_without_its_length(serve, study):
    client = serve(largest_body=1000)
    assert client.put("/v1/studies/s", json=study).status_code == 200
    body = json.dumps({"decision": "0" * 2000, "outcome": 1.0}).encode()
    assert "1000 bytes" in error_of(client.post("/v1/studies/s/outcomes", content=body), 413, "too large")
    pieces = (body[at : at + 100] for at in range(0, len(body), 100))
    assert "1000 bytes" in error_of(client.post("/v1/studies/s/outcomes", content=pieces), 413, "too large")


def test_a_client_that_asks_too_often_waits(serve):
    client = serve(rate=0.2)
    assert [client.get("/healthz").status_code for _ in range(3)] == [200, 200, 429]
    answer = client.get("/healthz")
    error_of(answer, 429, "rate")
    assert 1 <= int(answer.headers["retry-after"]) <= 6


def test_a_bucket_fills_at_its_rate():
    now = 0.0
    limit = RateLimit(2.0, clock=lambda: now)
    assert [limit.wait_for("ada") for _ in range(int(2 * WINDOW))] == [0.0] * int(2 * WINDOW)
    assert limit.wait_for("ada") == 0.5
    assert limit.wait_for("ben") == 0.0
    now = 0.5
    assert (limit.wait_for("ada"), limit.wait_for("ada")) == (0.0, 0.5)
    assert RateLimit(0.0).wait_for("ada") == 0.0


def test_a_request_that_takes_too_long_is_answered(serve, monkeypatch):
    import time

    client = serve(seconds=0.1)
    monkeypatch.setattr("lifelore.app.service.health_routes.study_names", lambda memory: time.sleep(0.5))
    assert "0.1 s" in error_of(client.get("/healthz"), 504, "time")


def test_metrics_and_log_name_routes_and_not_users(serve, study, caplog):
    client = serve()
    client.put("/v1/studies/s", json=study)
    with caplog.at_level(logging.INFO, "lifelore.service"):
        client.post("/v1/studies/s/decisions", json={"user": "zoe"})
        client.get("/v1/studies/s/users/zoe")
        client.get("/nowhere/zoe")
    metrics = client.get("/metrics").text
    route = 'method="POST",route="/v1/studies/{study}/decisions",status="200"'
    assert f"lifelore_requests_total{{{route}}} 1.0" in metrics
    assert 'route="other",status="404"} 1.0' in metrics
    assert "lifelore_decisions_total 1.0" in metrics
    assert "zoe" not in metrics
    fields = [record.fields for record in caplog.records if record.name == "lifelore.service"]
    assert [one["status"] for one in fields] == [200, 200, 404]
    assert "zoe" not in json.dumps(fields)
