"""Mounts the pages, their scripts and the routes of lives on the application of the service."""

from fastapi import FastAPI
from fastapi.responses import HTMLResponse
from starlette.staticfiles import StaticFiles

from lifelore.app.pages.life.routes import router as lives
from lifelore.app.pages.shell.page_shell import HOME, PAGES, ROOT, SHELL, Page, page_document
from lifelore.app.service.application import create_app
from lifelore.app.service.settings import ServiceSettings

STATIC = "/static/"
HEADERS = {
    "content-security-policy": "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
    "referrer-policy": "no-referrer",
}
"""A page loads nothing from another host, and no other site can show it in a frame."""


def app_with_pages(settings: ServiceSettings) -> FastAPI:
    """The application of the service with all pages, if its settings want pages.

    The documents of pages need no token, for they hold no data.

    Examples
    --------
    >>> app = app_with_pages(ServiceSettings(memory="life.db"))
    >>> {"/", "/see", "/life", "/study"} <= {getattr(route, "path", None) for route in app.routes}
    True
    """
    if "pages" not in settings.only:
        return create_app(settings)
    app = create_app(settings, open_paths={HOME.path, *(page.path for page in PAGES)})
    for page in (HOME, *PAGES):
        _mount_document(app, page)
    app.include_router(lives(app.state.service))
    for folder in (SHELL, *(page.name for page in PAGES)):
        app.mount(STATIC + folder, StaticFiles(directory=str(ROOT / folder / "static")), name=f"{folder} scripts")
    return app


def _mount_document(app: FastAPI, page: Page) -> None:
    @app.get(page.path, include_in_schema=False, response_class=HTMLResponse)
    def document() -> HTMLResponse:
        return HTMLResponse(page_document(page), headers=HEADERS)
