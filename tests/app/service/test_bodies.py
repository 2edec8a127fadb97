"""Large bodies: the same documents as by the standard parser, and no other request waits for them."""

import asyncio
import json
import threading
import time
from importlib import import_module

import pytest
from hypothesis import given
from hypothesis import strategies as st
from starlette.exceptions import HTTPException

from lifelore.app.service import bodies
from lifelore.app.service.bodies import JsonRoute, parsed, patient_json

VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=20,
)


@given(value=VALUES, spaced=st.booleans(), ascii_only=st.booleans())
def test_a_document_is_that_of_the_standard_parser(value, spaced, ascii_only):
    body = json.dumps(value, indent=1 if spaced else None, ensure_ascii=ascii_only).encode("utf-8", "replace")
    assert patient_json(body) == json.loads(body)


@given(body=st.text(alphabet='[]{}",:1 ntrue', max_size=12).map(str.encode))
def test_what_the_standard_parser_refuses_is_refused(body):
    assert read_by(patient_json, body) == read_by(json.loads, body)


def read_by(reader, body):
    """A document, or the message and place of the error."""
    try:
        return reader(body)
    except json.JSONDecodeError as error:
        return error.msg, error.pos


def test_values_are_counted_at_every_depth(monkeypatch):
    monkeypatch.setattr(bodies, "MOST_VALUES", 7)
    assert patient_json(b'{"a": [1, [2, "x"]], "b": {}}') == {"a": [1, [2, "x"]], "b": {}}
    with pytest.raises(HTTPException, match="413"):
        patient_json(b'{"a": [1, [2, "x"]], "b": {"c": 3}}')


def test_a_large_body_is_decoded_on_another_thread():
    def where(body: bytes) -> threading.Thread:
        return threading.current_thread()

    async def found(size: int) -> bool:
        return await parsed(bytes(size), where) is threading.current_thread()

    assert asyncio.run(found(bodies.LARGE))
    assert not asyncio.run(found(bodies.LARGE + 1))


@pytest.mark.parametrize("name", ["adaptation", "log", "perceive"])
def test_all_routes_with_documents_take_large_ones(serve, name):
    service = serve().app.state.service
    routes = import_module(f"lifelore.app.service.{name}_routes").router(service).routes
    with_documents = [route for route in routes if getattr(route, "body_field", None)]
    assert all(isinstance(route, JsonRoute) for route in with_documents)
    assert with_documents


@pytest.mark.parametrize(
    "body",
    [
        b'{"log": [' + b",".join([b"1"] * 25_000_000) + b"]}",
        b'{"log": "' + b"ada,slow,8,0.5\\n" * 3_000_000 + b'"x}',
        b'{"log": {' + b",".join([b'"a":1'] * 8_000_000) + b"}}",
    ],
    ids=["numbers", "text", "names"],
)
def test_a_large_document_delays_nobody(serve, body):
    """50 MB to a route of FastAPI; S1 of the trial: /healthz waited for 9.7 s."""
    client, longest, answers = serve(), 0.0, []
    client.get("/healthz")

    def send() -> None:
        headers = {"Content-Type": "application/json"}
        answers.append(client.post("/v1/evaluate", content=body, headers=headers).status_code)

    sender = threading.Thread(target=send)
    sender.start()
    while sender.is_alive():
        began = time.perf_counter()
        assert client.get("/healthz").status_code == 200
        longest = max(longest, time.perf_counter() - began)
        time.sleep(0.01)
    sender.join()
    assert answers[0] in (413, 422)
    assert longest < 4.0, "0.03 to 0.12 s on an idle machine; 9.7 s with the standard parser"
