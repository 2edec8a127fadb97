"""The OpenAPI document with the tokens of the service, and a page that lists all addresses without any script."""

import json
from html import escape
from typing import Any

from fastapi import FastAPI
from fastapi.responses import HTMLResponse

from lifelore.app.service.admission import OPEN_PATHS
from lifelore.app.service.decision_routes import HotRoute, describe

BEARER = {"bearer": {"type": "http", "scheme": "bearer", "description": "A token of `serve --add-token`."}}
HEADERS = {"content-security-policy": "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'"}
_STYLE = (
    "body{font:16px/1.5 system-ui,sans-serif;margin:1.5rem auto;max-width:60rem;padding:0 1rem}"
    "summary{cursor:pointer}pre{overflow:auto;background:#f4f5f6;padding:.6rem}code{overflow-wrap:anywhere}"
)


def document_api(app: FastAPI, tokens: bool, hot: list[HotRoute]) -> None:
    """Add the tokens to the OpenAPI document of an application, and the page ``/docs``.

    Parameters
    ----------
    tokens : bool
        Whether requests need a token.
    hot : list of HotRoute
        Routes that FastAPI does not know.
    """
    plain = app.openapi
    needed: list[dict[str, list[str]]] = [{"bearer": []}] if tokens else [{}, {"bearer": []}]

    def openapi() -> dict[str, Any]:
        document = plain()
        describe(document, hot)
        document["components"]["securitySchemes"] = BEARER
        for path, operations in document["paths"].items():
            for operation in operations.values():
                operation["security"] = [] if path in OPEN_PATHS else needed
        return document

    app.openapi = openapi

    @app.get("/docs", include_in_schema=False)
    def docs() -> HTMLResponse:
        return HTMLResponse(_page(app.openapi()), headers=HEADERS)


def _page(document: dict[str, Any]) -> str:
    sections: dict[str, list[str]] = {}
    for path, operations in document["paths"].items():
        for method, operation in operations.items():
            entry = _entry(method, path, operation)
            sections.setdefault(operation.get("tags", ["other"])[0], []).append(entry)
    body = "".join(f"<h2>{escape(tag)}</h2>{''.join(entries)}" for tag, entries in sections.items())
    schemas = "".join(
        f'<details id="{escape(name)}"><summary><code>{escape(name)}</code></summary>{_json(schema)}</details>'
        for name, schema in document["components"]["schemas"].items()
    )
    title = escape(f"{document['info']['title']} {document['info']['version']}")
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{title}</title>'
        f'<meta name="viewport" content="width=device-width"><style>{_STYLE}</style><h1>{title}</h1>'
        f'<p>For programs: <a href="/openapi.json">/openapi.json</a></p>{body}<h2>schemas</h2>{schemas}</html>'
    )


def _entry(method: str, path: str, operation: dict[str, Any]) -> str:
    parts = {name: operation[name] for name in ("parameters", "requestBody", "responses") if name in operation}
    head = f"<code>{method.upper()} {escape(path)}</code> {escape(operation.get('summary', ''))}"
    return f"<details><summary>{head}</summary>{_json(parts)}</details>"


def _json(part: Any) -> str:
    return f"<pre>{escape(json.dumps(part, indent=1, ensure_ascii=False))}</pre>"
