"""Pages walked in a fresh checkout: their commands and Python run as printed, in the page's order."""

import ast
import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from lifelore.action.priors.prior_file import load_prior
from tests.page_block import run_block

DOCS = Path(__file__).parents[1] / "docs"
EXPECTED = {
    "start/robots": [
        "20 of 20 runs are new; 20 reached their goal",
        "5 jobs driven in examples/data/office.yaml",
        "lab 2.025,6.475: driven",
        "wrote jobs_new.csv",
        "store (28.8",
        "4 objects",
        "stands_on",
    ],
    "start/learning": [
        "what the thesis says",
        "C3.2 State prior on the lattice",
        "a small run, no evidence",
        "figure.png",
    ],
    "start/personalisation": ["probability"],
    "perception": [
        "objects 2 3 4 5",
        "on(3, 4) 0.",
        "contact points",
        "as the thesis prints it",
        "'on(3, 4)'",
        "4 objects, 0 holes",
        '"contact_points"',
        "2 objects, 0 holes",
        '"source": "examples/data/pair.pcd"',
        '"source": "examples/data/table.pcd"',
        '"source": "incoming/pair.pcd"',
    ],
    "action_priors": [
        "prior: return",
        "learnt contexts",
        "('f0', 'f1', 'f2', 'f3')\n('f0', 'f1', 'f2', 'f3')\n",
        "3 tasks shown in 86 steps",
        '"advise": false',
        '"advise": true',
    ],
    "long_lived": ["points below the best possible return", "task 3, context", "believed in"],
    "fleet": ["karl", "rosie", "contributions: 2 added", "contributions: 0 added"],
}
"""Words of the output of each page that the page itself does not show, in this order."""
NOT_RUN = {
    "ros2 ": "needs ROS 2 and a robot",
    "lifelore scenes --n 800": "takes minutes",
    "lifelore learn-relations scenes": "reads these scenes",
    "lifelore perceive depth.png": "needs a depth image",
    "lifelore perceive organised.pcd": "needs a cloud and masks",
    "lifelore perceive left.pcd": "needs two views",
    "lifelore live --domain tabletop": "takes minutes",
    "dask ": "needs a cluster",
    "lifelore reproduce C3.2 --full --scheduler": "needs a cluster",
    "make ": "installs from the network",
    "python3 -m venv": "an environment for the next command",
    "pip install": "installs from the network",
    "my_env/bin/": "installs from the network",
    ". .venv/bin/activate": "the environment that make creates",
}
"""Beginnings of the commands that are not run, and why."""


def blocks(page: str) -> list[tuple[str, str]]:
    """(language, code) of the blocks of shell and Python, in the order of the page, without what is not run."""
    text = (DOCS / f"{page}.md").read_text("utf-8")
    found = re.findall(r"^```(sh|python)\n(.*?)^```", text, flags=re.S | re.M)
    return [(language, without_not_run(code) if language == "sh" else code) for language, code in found]


def without_not_run(code: str) -> str:
    return "".join(line for line in code.splitlines(keepends=True) if not line.startswith(tuple(NOT_RUN)))


def walk(page: str, folder: Path, home: Path) -> str:
    """The output of a page's blocks; `perceive --watch` runs during the next block, until Ctrl-C."""
    shown, steps = [], iter(blocks(page))
    for language, code in steps:
        if language == "sh" and "perceive --watch" in code:
            shown.append(watched(code, next(steps)[1], folder, home))
            continue
        shown.append(run_block(language, code, folder, home))
    return "".join(shown)


def watched(code: str, during: str, folder: Path, home: Path) -> str:
    """The line that a watching command prints for the cloud that the second block gives it."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    with subprocess.Popen(
        ["bash", "-euc", f"exec {code}"], cwd=folder, env=os.environ | {"PATH": path, "XDG_DATA_HOME": str(home)},
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as child:  # fmt: skip
        assert "Ctrl-C stops" in child.stderr.readline()
        run_block("sh", during, folder)
        line = child.stdout.readline()
        child.send_signal(signal.SIGINT)
        child.communicate()
    assert child.returncode == 130
    return line


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], tuple[str, Path]]:
    """A function from a page to its output and the checkout it was walked in; each page is walked once."""

    @cache
    def walked(page: str) -> tuple[str, Path]:
        folder = tmp_path_factory.mktemp("fresh")
        shutil.copytree(DOCS.parent / "examples", folder / "checkout" / "examples")
        return walk(page, folder / "checkout", folder / "home"), folder / "checkout"

    return walked


@pytest.mark.slow
@pytest.mark.parametrize("page", EXPECTED)
def test_a_page_is_walked_from_a_fresh_checkout(page, walked):
    if page == "perception":
        pytest.importorskip("rosbags")
    shown, _ = walked(page)
    print(shown)
    at = 0
    for words in EXPECTED[page]:
        assert words in shown[at:], f"{words!r} is missing, or comes too early"
        at = shown.index(words, at) + len(words)


@pytest.mark.slow
def test_the_page_for_robots_shows_what_its_commands_print(walked):
    shown, checkout = walked("start/robots")
    page = (DOCS / "start" / "robots.md").read_text("utf-8")
    told = [line for line in re.findall(r"^    (.*)", page, flags=re.M) if line not in code_of(page)]
    assert len(told) == 10
    assert not [line for line in told if line not in shown]
    assert (checkout / "jobs_new.csv").read_text().startswith("time,name,x,y\n09:00,lab,5.821,2.356\n")
    assert len(page.split()) <= 900


@pytest.mark.slow
def test_a_prior_is_learnt_kept_and_explored_by(walked):
    shown, checkout = walked("action_priors")
    text = (DOCS / "action_priors.md").read_text("utf-8")
    found = re.findall(r"^(?:uniform|prior): return (\S+), (\d+) collisions", shown, flags=re.M)
    assert len(found) == 2
    for earned, collisions in found:
        assert earned.replace("-", "−") in text
        assert f" {collisions}" in text
    (numbers,) = re.findall(r"^<ActionPrior: 4 actions, 83 contexts.*?(\{.*\})$", shown, flags=re.M)
    excluded = ast.literal_eval(numbers)["exclusion_rate"]
    assert f"{excluded:.1%}".replace("%", " %") + " of the cells" in text
    assert len(load_prior(checkout / "percepts.npz")) > 10
    (code,) = re.findall(r"^(\d+) learnt contexts ", shown, flags=re.M)
    assert 0 <= int(code) < 32


@pytest.mark.slow
def test_an_outcome_comes_by_the_identifier_that_the_choice_printed(tmp_path):
    (line,) = re.findall(
        r"^    (lifelore reuse update .*)", (DOCS / "start" / "personalisation.md").read_text("utf-8"), flags=re.M
    )
    log = DOCS.parent / "examples" / "data" / "log.csv"
    run_block("sh", f"lifelore reuse fit {log}", tmp_path)
    made = run_block("sh", "lifelore reuse choose --user ann", tmp_path)
    (decision,) = re.findall(r"^decision (\S+) ", made, flags=re.M)
    line, replaced = re.subn(r"(?<=--decision )\S+", decision, line)
    assert replaced == 1
    stored = run_block("sh", line, tmp_path)
    assert f"outcome 41.5 of {made.splitlines()[0]} stored; ann is" in stored


@pytest.mark.slow
def test_the_first_page_of_personalisation_shows_what_its_commands_print(walked):
    shown, _ = walked("start/personalisation")
    page = (DOCS / "start" / "personalisation.md").read_text("utf-8")
    told = [line for line in re.findall(r"^    (.*)", page, flags=re.M) if line not in code_of(page)]
    results = [line for line in told if not line.startswith(("decision ", "lifelore "))]
    assert len(results) == 9
    assert not [line for line in results if line not in shown]


def code_of(page: str) -> str:
    """The code of a page's blocks."""
    return "".join(re.findall(r"^```.*?^```", page, flags=re.S | re.M))


def test_every_page_with_commands_is_walked():
    names = {path.relative_to(DOCS).with_suffix("").as_posix() for path in DOCS.rglob("*.md")}
    with_commands = {name for name in names if any(language == "sh" and code for language, code in blocks(name))}
    with_own_tests = {"fashion_shop", "log_to_choices", "service", "pages", "nav2", "ros2"}
    assert with_commands <= {*EXPECTED, *with_own_tests, "install", "index"}
    assert {name for name in names if name.startswith("start/")} <= set(EXPECTED)


def test_every_reason_not_to_run_a_command_has_its_command():
    text = "".join(path.read_text("utf-8") for path in DOCS.rglob("*.md"))
    for start in NOT_RUN:
        assert re.search(rf"^{re.escape(start)}", text, flags=re.M), start
