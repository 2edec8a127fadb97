"""The page about the pages: its commands serve every page, and each page has a section and a picture."""

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path
from urllib.request import urlopen

import pytest

pytest.importorskip("fastapi", reason="needs the extra web")

from lifelore.app.pages.shell.page_shell import PAGES

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "docs" / "pages.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^lifelore (serve.*)$", TEXT, flags=re.M)


def test_every_page_has_a_section_with_a_small_picture():
    sections = dict(re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", TEXT, flags=re.S | re.M))
    assert PAGES
    for page in PAGES:
        assert f"`{page.path}`" in sections[page.title]
        picture = ROOT / "docs" / "pictures" / f"page_{page.name}.png"
        assert f"(pictures/{picture.name})" in sections[page.title]
        assert picture.stat().st_size <= 300_000


@pytest.mark.slow
def test_its_last_commands_serve_the_pages_with_tokens(tmp_path):
    program = [sys.executable, "-m", "lifelore.app.command_line"]
    *_, add_token, serve = (shlex.split(command, comments=True) for command in COMMANDS)
    done = subprocess.run([*program, *add_token], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert len(done.stdout.split()) == 1
    options = ["--json", "--port", "0", "--memory", str(tmp_path / "m.db")]
    command = [*program, *serve, *options]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as served:
        try:
            url = json.loads(served.stdout.readline())["url"].replace("0.0.0.0", "127.0.0.1")
            for page in PAGES:
                with urlopen(url + page.path) as answer:
                    assert f"<title>{page.title} · Lifelore</title>".encode() in answer.read()
        finally:
            served.terminate()
