"""All pages share one frame; they ask their own service alone, by keyboard and on a phone."""

from collections.abc import Callable

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from axe_playwright_python.sync_playwright import Axe
from fastapi.testclient import TestClient
from playwright.sync_api import Page

from lifelore.app.pages.mount import app_with_pages
from lifelore.app.pages.shell.page_shell import HOME, PAGES
from lifelore.app.service.settings import ServiceSettings
from lifelore.app.service.tokens import add_token

pytestmark = [pytest.mark.browser, pytest.mark.slow]

DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_every_page_is_accessible_and_fits(
    serve_pages: Callable[..., str], open_page: Callable[..., Page], size: dict[str, int]
):
    address = serve_pages()
    for shown in (HOME, *PAGES):
        page = open_page(address + shown.path, size)
        page.wait_for_load_state("networkidle")
        found = Axe().run(page)
        assert found.violations_count == 0, f"{shown.path}: {found.generate_report()}"
        wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide <= 0, f"{shown.path} is {wide} px too wide"


def test_the_keyboard_reaches_the_content(serve_pages: Callable[..., str], open_page: Callable[..., Page]):
    page = open_page(serve_pages() + "/")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Skip to the content"
    page.keyboard.press("Enter")
    page.wait_for_url("**/#content")


def test_documents_need_no_token_and_their_questions_do(tmp_path):
    token = add_token(str(tmp_path / "tokens"), "ada", ["read"])
    settings = ServiceSettings(str(tmp_path / "m.db"), token_file=str(tmp_path / "tokens"))
    with TestClient(app_with_pages(settings), base_url="http://127.0.0.1") as client:
        for page in (HOME, *PAGES):
            answer = client.get(page.path)
            assert answer.status_code == 200
            assert "default-src 'self'" in answer.headers["content-security-policy"]
        assert client.get("/static/shell/shell.js").status_code == 200
        assert client.get("/static/shell/%2e%2e/page_shell.py").status_code == 404
        assert client.get("/v1/studies").status_code == 401
        assert client.get("/v1/studies", headers={"Authorization": f"Bearer {token}"}).status_code == 200
