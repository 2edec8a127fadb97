"""The pages in a real Chromium, served by a thread of this process; a module shares one server over one memory."""

import os
import shutil
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

import uvicorn
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import Browser, Page, expect, sync_playwright

from lifelore.app import ServiceSettings, app_with_pages

# A page on a loaded machine may take long to draw; a passing test waits no longer than before.
expect.set_options(timeout=60_000)

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--use-gl=angle",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
]  # fmt: skip
PICTURES = Path(os.environ["LIFELORE_PICTURES"]).absolute() if os.environ.get("LIFELORE_PICTURES") else None
MOST_BYTES = 300_000
"""Bytes of the largest picture of the documentation."""
DESKTOP, PHONE = {"width": 1280, "height": 800}, {"width": 390, "height": 844}


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """A headless Chromium; of a module, because its event loop would be in the way of other tests."""
    if CHROMIUM is None:
        if os.environ.get("CI"):
            pytest.fail("Chromium is missing; apt-get install chromium")
        pytest.skip("needs Chromium")
    with sync_playwright() as playwright:
        found = playwright.chromium.launch(executable_path=CHROMIUM, headless=True, args=FLAGS)
        yield found
        found.close()


@contextmanager
def served(memory: Path, **settings: str) -> Iterator[str]:
    """Serve the pages over a memory; their address."""
    listening = socket.create_server(("127.0.0.1", 0))
    app = app_with_pages(ServiceSettings(str(memory), rate=0.0, **settings))  # pyright: ignore[reportArgumentType]
    server = uvicorn.Server(uvicorn.Config(app, log_level="error"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    try:
        yield f"http://127.0.0.1:{listening.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Pages over an empty memory that no test changes."""
    with served(tmp_path_factory.mktemp("pages") / "m.db") as found:
        yield found


@pytest.fixture
def serve_pages() -> Iterator[Callable[..., str]]:
    """Serve the pages over a memory of the test's own; their address."""
    with ExitStack() as stack:
        yield lambda memory, **settings: stack.enter_context(served(memory, **settings))


@pytest.fixture
def open_page(browser: Browser) -> Iterator[Callable[..., Page]]:
    """Open an address; the test fails where the page logs an error or asks another host."""
    defects: list[str] = []
    with ExitStack() as stack:

        def open_page(address: str, size: dict[str, int] = DESKTOP) -> Page:
            host = "/".join(address.split("/")[:3])
            context = browser.new_context(viewport=size)  # pyright: ignore[reportArgumentType]
            stack.callback(context.close)
            page = context.new_page()
            page.on("pageerror", lambda error: defects.append(str(error)))
            page.on("console", lambda line: defects.append(line.text) if line.type == "error" else None)
            page.on("request", lambda asked: _note_strangers(asked.url, host, defects))
            page.goto(address)
            return page

        yield open_page
    assert not defects, defects


def _note_strangers(url: str, host: str, defects: list[str]) -> None:
    if not url.startswith((host, host.replace("http", "ws", 1), "data:", "blob:")):
        defects.append(f"asked {url}")


@pytest.fixture
def check_page(tmp_path: Path) -> Callable[..., None]:
    """Check that a page fits its window and is accessible, on light and dark ground.

    With a name, draw the picture of the page guide;
    `LIFELORE_PICTURES=docs/pictures python -m pytest tests/app/pages` makes the pictures again.
    """
    folder = PICTURES or tmp_path

    def check_page(page: Page, picture: str | None = None, height: int = 0) -> None:
        wide = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
        assert wide <= 0, f"{page.url} is {wide} px too wide"
        for scheme in ("dark", "light"):
            page.emulate_media(color_scheme=scheme)
            found = Axe().run(page)
            assert found.violations_count == 0, f"{page.url}, {scheme}: {found.generate_report()}"
        if picture is not None:
            page.set_viewport_size({"width": 1280, "height": height})
            page.evaluate("scrollTo(0, 0)")
            page.screenshot(path=folder / f"page_{picture}.png")
            assert (folder / f"page_{picture}.png").stat().st_size < MOST_BYTES

    return check_page
