"""The gate: tokens and scopes, this machine alone without tokens, limits, one shape of errors, identifiers."""

import asyncio
import json
import logging

import pytest
from fastapi.responses import StreamingResponse

from lifelore.app.service.admission import WINDOW, RateLimit
from lifelore.app.service.tokens import add_token

JSON = {"Content-Type": "application/json"}


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


def test_errors_of_every_kind_have_one_shape(shared, study):
    put = shared.put("/v1/studies/s", json=study | {"control": 2.0})
    assert error_of(put, 422, "input") == "control must lie between 0 and 1, 1 left out, got 2.0"
    assert "no study 'nobody' in the memory" in error_of(shared.get("/v1/studies/nobody"), 404, "not found")
    error_of(shared.get("/nowhere"), 404, "not found")
    error_of(shared.patch("/v1/studies"), 405, "method")
    error_of(shared.post("/v1/studies/s/outcomes", content=b"{", headers=JSON), 422, "input")
    message = error_of(shared.post("/v1/studies/s/outcomes", json={"decision": "x"}), 422, "input")
    assert message == "outcome: field required"
    error_of(shared.post("/v1/studies/s/decisions", json={"user": "ada", "usr": 1}), 422, "input")


def test_a_defect_shows_no_traceback_and_logs_it(shared, monkeypatch, caplog):

    def broken(memory):
        raise ZeroDivisionError("secret of the inside")

    monkeypatch.setattr("lifelore.app.service.study_routes.study_states", broken)
    with caplog.at_level(logging.INFO, "lifelore.service"):
        answer = shared.get("/v1/studies", headers={"X-Request-ID": "mine-7"})
    message = error_of(answer, 500, "defect")
    assert "secret" not in message
    (record,) = [one for one in caplog.records if one.name == "lifelore.service"]
    assert record.exc_info[0] is ZeroDivisionError
    assert record.fields["request"] == "mine-7"


def test_errors_name_no_file_of_the_server(serve, tmp_path):
    (tmp_path / "secret-folder").mkdir()
    client = serve(str(tmp_path / "secret-folder" / "lifelore.db"))
    assert "secret-folder" not in client.get("/v1/studies/nobody").text


def test_a_request_has_an_identifier(shared):
    for given in ("mine-1", "", "with space", "a" * 101, "line\tbreak"):
        found = shared.get("/healthz", headers={"X-Request-ID": given}).headers["x-request-id"]
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


def test_admin_alone_opens_the_memory_as_a_whole(serve, tmp_path):
    file = str(tmp_path / "tokens")
    user, admin = add_token(file, "user", ["read", "write"]), add_token(file, "admin", ["admin"])
    client = serve(token_file=file)
    for method, path in (
        ("GET", "/v1/memory"),
        ("GET", "/v1/memory/export"),
        ("POST", "/v1/memory/merge"),
        ("DELETE", "/v1/memory/robots?robot=rosie"),
        ("DELETE", "/v1/memory/buildings?building=b7"),
        ("DELETE", "/v1/studies/s"),
    ):
        assert "scope admin" in error_of(client.request(method, path, headers=bearer(user)), 403, "scope"), path
    assert client.get("/v1/memory", headers=bearer(admin)).status_code == 200
    assert client.get("/v1/studies", headers=bearer(admin)).status_code == 200


def test_a_token_of_a_study_opens_no_other(serve, study, tmp_path):
    file = str(tmp_path / "tokens")
    shop, admin = add_token(file, "shop", ["admin"], ["my shop, 2"]), add_token(file, "admin", ["admin"])
    client = serve(token_file=file)
    for name in ("my shop, 2", "other"):
        assert client.put(f"/v1/studies/{name}", json=study, headers=bearer(admin)).status_code == 200
    assert client.get("/v1/studies/my shop, 2", headers=bearer(shop)).status_code == 200
    for path in ("/v1/studies/other", "/v1/studies", "/metrics", "/v1/memory", "/healthz/../metrics"):
        error_of(client.get(path, headers=bearer(shop)), 403, "scope")
    assert client.get("/v1/studies/my shop, 2%2F..%2Fother", headers=bearer(shop)).status_code == 404


def test_a_deleted_token_is_refused_and_a_new_one_is_let_in(serve, tmp_path, monkeypatch):
    monkeypatch.setattr("lifelore.app.service.tokens.FRESH", 0.0)
    file = tmp_path / "tokens"
    first = add_token(str(file), "first", ["read"])
    client = serve(token_file=str(file))
    assert client.get("/v1/studies", headers=bearer(first)).status_code == 200
    file.write_text("")
    second = add_token(str(file), "second", ["read"])
    assert client.get("/v1/studies", headers=bearer(first)).status_code == 401
    assert client.get("/v1/studies", headers=bearer(second)).status_code == 200


def test_wrong_tokens_are_limited_and_right_ones_are_not(serve, tmp_path):
    token = add_token(str(tmp_path / "tokens"), "shop", ["read"])
    client = serve(token_file=str(tmp_path / "tokens"))
    found = [client.get("/v1/studies", headers=bearer("wrong")).status_code for _ in range(12)]
    assert found == [401] * 10 + [429] * 2
    assert client.get("/v1/studies", headers=bearer(token)).status_code == 200


def test_without_tokens_only_this_machine_is_answered(shared):
    for host in ("evil.example", "evil.example:8321", "127.0.0.1.evil.example", "localhost.evil.example", ""):
        error_of(shared.get("/healthz", headers={"Host": host}), 403, "scope")
    for host in ("127.0.0.1", "localhost:8321", "[::1]:8321", "127.0.0.2"):
        assert shared.get("/healthz", headers={"Host": host}).status_code == 200, host
        assert shared.get("/healthz", headers={"Host": host, "Origin": f"http://{host}"}).status_code == 200, host
    own = [f"http://{host}" for host in ("127.0.0.1:9999", "127.0.0.1", "localhost:8321")]
    for origin in ("https://evil.example", "null", *own):
        refused = shared.get("/healthz", headers={"Host": "127.0.0.1:8321", "Origin": origin})
        error_of(refused, 403, "scope")


def test_a_form_of_another_page_stores_nothing_and_a_file_comes_as_a_file(shared):
    kinds = ("text/plain", "application/x-www-form-urlencoded", "multipart/form-data", None)
    files = ("/v1/memory/merge", "/v1/perceive/cloud")
    for path in (*files, "/v1/evaluate", "/v1/studies/s/decisions"):
        for kind in kinds:
            answer = shared.post(path, content=b"{}", headers={"Content-Type": kind} if kind else {})
            assert "content-type must be" in error_of(answer, 415, "input")
    for path in files:
        answer = shared.post(path, content=b"{}", headers=JSON)
        assert "application/octet-stream" in error_of(answer, 415, "input")


def test_an_address_names_all_its_methods(shared):
    assert shared.patch("/v1/studies/s").headers["allow"] == "GET, PUT, DELETE"
    assert shared.post("/healthz", json={}).headers["allow"] == "GET, HEAD"


def test_a_large_body_is_refused_with_and_without_its_length(serve, study):
    client = serve(largest_body=1000)
    assert client.put("/v1/studies/s", json=study).status_code == 200
    body = json.dumps({"decision": "0" * 2000, "outcome": 1.0}).encode()
    assert "1000 bytes" in error_of(
        client.post("/v1/studies/s/outcomes", content=body, headers=JSON), 413, "too large"
    )
    pieces = (body[at : at + 100] for at in range(0, len(body), 100))
    assert "1000 bytes" in error_of(
        client.post("/v1/studies/s/outcomes", content=pieces, headers=JSON), 413, "too large"
    )


def test_health_has_no_rate_and_answers_head(serve):
    client = serve(rate=0.2)
    assert {client.get("/healthz").status_code for _ in range(9)} == {200}
    assert (client.head("/healthz").status_code, client.head("/healthz").content) == (200, b"")


def test_a_client_that_asks_too_often_waits(serve):
    client = serve(rate=0.2)
    assert [client.get("/v1/studies").status_code for _ in range(3)] == [200, 200, 429]
    answer = client.get("/v1/studies")
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
    monkeypatch.setattr("lifelore.app.service.study_routes.study_states", lambda memory: time.sleep(0.5))
    assert "0.1 s" in error_of(client.get("/v1/studies"), 504, "time")


def test_metrics_and_log_name_routes_and_not_users(serve, study, caplog):
    client = serve(access_log=True)
    client.put("/v1/studies/s", json=study)
    with caplog.at_level(logging.INFO, "lifelore.service"):
        client.post("/v1/studies/s/decisions", json={"user": "zoe"})
        client.get("/v1/studies/s/user?name=zoe")
        client.get("/nowhere/zoe")
    metrics = client.get("/metrics").text
    route = 'method="POST",route="/v1/studies/{study}/decisions",status="200"'
    assert f"lifelore_requests_total{{{route}}} 1.0" in metrics
    assert 'route="other",status="404"} 1.0' in metrics
    assert "lifelore_study_decisions_total{" in metrics
    assert "zoe" not in metrics
    fields = [record.fields for record in caplog.records if record.name == "lifelore.service"]
    assert [one["status"] for one in fields] == [200, 200, 404]
    assert "zoe" not in json.dumps(fields)


@pytest.mark.parametrize(("pause", "pieces"), [(0.4, 4), (5.0, 1)], ids=["steady", "stalled"])
def test_the_time_of_a_long_answer_counts_between_its_pieces(serve, pause, pieces):
    client = serve(seconds=1.0)

    async def lines():
        for _ in range(4):
            yield b"line\n"
            await asyncio.sleep(pause)

    client.app.add_api_route("/lines", lambda: StreamingResponse(lines()))
    assert client.get("/lines").content == b"line\n" * pieces
