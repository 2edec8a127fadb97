"""The three start pages, walked in a fresh checkout: commands and Python run as printed, in the page's order."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
START = ROOT / "docs" / "start"
EXPECTED = {
    "robots": [
        "30 tasks in examples/data/office.yaml",
        "recognised as office",
        "this robot has finished 36 tasks in all",
        "m from dock to lab over",
        "20 of 20 runs are new; 20 reached their goal",
        "4 objects",
        "Relation(a=3, b=4, relation='on'",
        "stands_on",
    ],
    "learning": ["what the thesis reports", "C3.2 (quick)"],
    "personalisation": ["3 types found", "probability", "uplift"],
}
"""Words of the output of each page, in this order."""


def blocks(page: str) -> list[tuple[str, str]]:
    """(language, code) of the blocks of shell and Python, in the order of the page."""
    return re.findall(r"^```(sh|python)\n(.*?)^```", (START / f"{page}.md").read_text("utf-8"), flags=re.S | re.M)


def run(language: str, code: str, folder: Path, home: Path) -> str:
    """The output of a block, run with the program of this environment and a memory of its own."""
    command = ["bash", "-euc", code] if language == "sh" else [sys.executable, "-W", "error", "-c", code]
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    environment = os.environ | {"PATH": path, "XDG_DATA_HOME": str(home), "COLUMNS": "120"}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{code}\n{done.stderr}"
    return done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("page", EXPECTED)
def test_a_start_page_is_walked_from_a_fresh_checkout(page, tmp_path):
    checkout = tmp_path / "checkout"
    shutil.copytree(ROOT / "examples", checkout / "examples")
    shown = "".join(run(language, code, checkout, tmp_path / "home") for language, code in blocks(page))
    print(shown)
    at = 0
    for words in EXPECTED[page]:
        assert words in shown[at:], f"{words!r} is missing, or comes too early"
        at = shown.index(words, at)
    assert {path.name for path in START.glob("*.md")} == {f"{name}.md" for name in EXPECTED}
