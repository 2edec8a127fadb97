"""All pages share one frame; they ask their own service alone, by keyboard and on a phone."""

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from fastapi.testclient import TestClient

from lifelore.app import ServiceSettings, app_with_pages
from lifelore.app.pages.shell.page_shell import HOME, PAGES
from lifelore.app.service.tokens import add_token

pytestmark = [pytest.mark.browser, pytest.mark.slow]

DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}


@pytest.mark.parametrize("size", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_the_first_page_leads_to_all_others(address, open_page, check_page, size: dict[str, int]):
    page = open_page(address, size)
    cards = page.get_by_role("main").get_by_role("link")
    assert cards.all_inner_texts() == [one.title for one in PAGES]
    check_page(page)
    for one in PAGES:
        page.goto(address)
        page.get_by_role("navigation").get_by_role("link", name=one.title).click()
        page.wait_for_url(f"**{one.path}")
        check_page(page)  # as it is without any data, too


def test_the_keyboard_reaches_the_content(address, open_page):
    page = open_page(address)
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
