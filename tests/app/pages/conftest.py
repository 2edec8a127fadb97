"""The pages in a real Chromium, served by a process of their own over a fresh memory."""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")
pytest.importorskip("playwright", reason="needs the extra browser")

from playwright.sync_api import Browser, Page, expect, sync_playwright

# A page on a loaded machine may take long to draw; a passing test waits no longer than before.
expect.set_options(timeout=60_000)

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage", "--use-gl=angle",
    "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
]  # fmt: skip
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


@pytest.fixture
def serve_pages(tmp_path: Path) -> Iterator[Callable[..., str]]:
    """Start `lifelore serve` with further arguments over a fresh memory; the address of its pages."""
    with ExitStack() as stack:

        def serve_pages(*arguments: str, memory: Path | None = None) -> str:
            where = memory or tmp_path / "pages.db"
            command = [
                sys.executable, "-m", "lifelore.app.command_line", "serve", "--json", "--port", "0", "--rate", "0",
                "--memory", str(where), *arguments,
            ]  # fmt: skip
            log = stack.enter_context((tmp_path / "serve.log").open("w"))
            process = stack.enter_context(subprocess.Popen(command, stdout=subprocess.PIPE, stderr=log, text=True))
            stack.callback(process.terminate)
            assert process.stdout is not None
            return json.loads(process.stdout.readline())["url"]

        yield serve_pages


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
