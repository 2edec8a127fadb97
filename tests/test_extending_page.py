"""The page on extending: its programs run as printed and print what the page shows."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
SECTIONS = dict(re.findall(r"^## (.*?)\n(.*?)(?=^## |\Z)", PAGE, flags=re.S | re.M))


def blocks(section: str) -> list[tuple[str, str]]:
    return re.findall(r"^```(\w+)\n(.*?)^```", SECTIONS[section], flags=re.S | re.M)


@pytest.mark.slow
@pytest.mark.parametrize("section", SECTIONS)
def test_a_section_prints_what_it_shows(section, tmp_path):
    if section == "A page":
        pytest.importorskip("fastapi", reason="needs the extra web")
    ran = 0
    for (language, code), (_, following) in zip(blocks(section), [*blocks(section)[1:], ("", "")], strict=True):
        named = re.match(r"# file: (\S+)\n", code)
        if named:
            (tmp_path / named[1]).parent.mkdir(exist_ok=True)
            (tmp_path / named[1]).write_text(code, encoding="utf-8")
        elif language == "python":
            command = [sys.executable, "-W", "error", "-c", code]
            path = {**os.environ, "PYTHONPATH": str(ROOT)}  # claims belong to a checkout
            done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, env=path)
            assert done.returncode == 0, done.stderr
            assert done.stdout == following
            ran += 1
    assert ran == 1


def test_it_shows_each_way_to_extend():
    assert list(SECTIONS) == ["A world", "A selection rule", "A relation", "A claim", "A page"]
