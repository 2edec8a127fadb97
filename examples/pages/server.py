"""Serves a page of an experiment on this machine alone, in the looks of the pages of `lifelore serve`.

A page is a folder: `page.html` and scripts, below the address ``/page/``. It needs the extra `web`.
"""

from pathlib import Path
from string import Template

import uvicorn
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.middleware.trustedhost import TrustedHostMiddleware
from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse
from starlette.routing import BaseRoute, Mount, Route
from starlette.staticfiles import StaticFiles

from lifelore.app.pages.shell.page_shell import ROOT, SHELL
from lifelore.core.errors import InputError, LifeloreError

HOST = "127.0.0.1"
FRAME = Template("""<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title · Lifelore</title><link rel="icon" href="/static/shell/icon.svg" type="image/svg+xml">
<link rel="stylesheet" href="/static/shell/lifelore.css"></head>
<body><main id="content">
$content
</main></body></html>""")


def page_app(folder: Path, routes: list[BaseRoute]) -> Starlette:
    """The application of a page: its document, its scripts, and the routes that its scripts ask."""
    document = FRAME.substitute(title=folder.name.title(), content=(folder / "page.html").read_text("utf-8"))
    own = [
        Route("/", lambda request: HTMLResponse(document)),
        Mount("/page", StaticFiles(directory=folder)),
        Mount("/static/shell", StaticFiles(directory=str(ROOT / SHELL / "static"))),
    ]
    trusted = Middleware(TrustedHostMiddleware, allowed_hosts=[HOST, "localhost"])
    return Starlette(routes=routes + own, middleware=[trusted], exception_handlers={LifeloreError: _refused})


def serve(app: Starlette, port: int) -> None:
    """Serve until Ctrl-C."""
    print(f"the page is at http://{HOST}:{port} (Ctrl-C stops)", flush=True)
    uvicorn.run(app, host=HOST, port=port, log_level="warning")


async def document_of(request: Request) -> dict:
    """The JSON object of a request; InputError for any other type, which other sites could send from a form."""
    if request.headers.get("content-type") != "application/json":
        raise InputError("the request must be of the type application/json; send an object")
    found = await request.json()
    return found if isinstance(found, dict) else {}


def _refused(request: Request, error: Exception) -> JSONResponse:
    return JSONResponse({"error": {"message": str(error)}}, 422)
