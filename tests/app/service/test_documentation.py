"""The OpenAPI document names tokens and answers; /docs lists all addresses and asks no other host."""

import re

import pytest
from fastapi.testclient import TestClient

from lifelore.app.pages.mount import app_with_pages
from lifelore.app.service.settings import GROUPS, ServiceSettings
from lifelore.app.service.tokens import add_token
from lifelore.core.errors import InputError

OWN = ("/healthz", *(f"/v1/{path}" for path in ("memory", "memory/merge", "memory/robots", "perceive/cloud",
                                              "perceive/depth")))  # fmt: skip
GROUP_OF = {
    "/v1/studies": "personalise", "/v1/adaptations/{name}": "personalise", "/v1/evaluate": "personalise",
    "/v1/perceive/cloud": "perceive", "/v1/memory": "memory", "/v1/lives": "pages",
}  # fmt: skip


def test_tokens_are_documented(serve, shared, tmp_path):
    add_token(str(tmp_path / "tokens"), "shop", ["read"])
    document = serve(token_file=str(tmp_path / "tokens")).get("/openapi.json").json()
    assert document["components"]["securitySchemes"]["bearer"]["scheme"] == "bearer"
    assert document["paths"]["/v1/memory"]["get"]["security"] == [{"bearer": []}]
    assert document["paths"]["/healthz"]["get"]["security"] == []
    tokenless = shared.get("/openapi.json").json()
    assert tokenless["paths"]["/v1/memory"]["get"]["security"] == [{}, {"bearer": []}]


def test_answers_are_typed(shared):
    document = shared.get("/openapi.json").json()
    for operation in (one for path in OWN for one in document["paths"][path].values()):
        schema = operation["responses"]["200"]["content"]["application/json"]["schema"]
        assert "properties" in document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]


def test_docs_list_all_and_load_nothing(serve, tmp_path):
    add_token(str(tmp_path / "tokens"), "shop", ["read"])
    client = serve(token_file=str(tmp_path / "tokens"))
    page = client.get("/docs")
    for path, operations in client.get("/openapi.json").json()["paths"].items():
        for method in operations:
            assert f"<code>{method.upper()} {path}</code>" in page.text
    assert "default-src 'none'" in page.headers["content-security-policy"]
    assert not re.search(r"<script|src=|<link|url\(|@import", page.text)
    assert re.findall(r'href="([^"]*)"', page.text) == ["/openapi.json"]


@pytest.mark.parametrize("group", GROUPS)
def test_a_group_can_be_served_alone(tmp_path, group):
    app = app_with_pages(ServiceSettings(str(tmp_path / "m.db"), only=(group,)))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        paths = client.get("/openapi.json").json()["paths"]
        assert {path for path in GROUP_OF if path in paths} == {
            path for path, its in GROUP_OF.items() if its == group
        }
        assert {"/healthz", "/metrics"} <= set(paths)
        assert (client.get("/life").status_code == 200) == (group == "pages")


def test_an_unknown_group_is_refused():
    with pytest.raises(InputError, match=r"only must be some of personalise, .* got 'personalize'"):
        ServiceSettings(only=("personalize",))
