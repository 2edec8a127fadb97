"""The README's Python runs as it stands, only shorter; its make targets, links and pictures exist."""

import json
import re
import shutil
from pathlib import Path

import pytest

from tests.page_block import run_block

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
ROOMS, CLIFF, USER = re.findall(r"```python\n(.*?)```", README, flags=re.S)


@pytest.mark.slow
def test_an_own_gymnasium_world(tmp_path):
    pytest.importorskip("minigrid")
    shorter = ROOMS.replace("tasks=6, episodes=100", "tasks=3, episodes=20")
    assert shorter != ROOMS
    jumpstart = json.loads(run_block("python", shorter, tmp_path).replace("'", '"').replace("None", "null"))
    assert jumpstart["n"] == 1
    assert (tmp_path / "rooms.db").is_file()


@pytest.mark.slow
def test_tasks_with_hidden_types(tmp_path):
    assert len(CLIFF.splitlines()) <= 10
    text = run_block("python", CLIFF, tmp_path)
    taken = re.findall(r"^taken for (.*)$", text, flags=re.M)
    assert taken == ["robot.0, a new type", "robot.1, a new type", "robot.0", "robot.1"]
    assert (tmp_path / "cliff.db").is_file()


@pytest.mark.slow
def test_a_new_user(tmp_path):
    assert re.fullmatch(r"C \[0\.0? +0\.0? +0\.99\]\n", run_block("python", USER, tmp_path))


@pytest.mark.slow
def test_its_commands_run_as_printed(tmp_path):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    commands = re.findall(r"^lifelore .*", README, flags=re.M)
    assert len(commands) == 4
    run_block("sh", "\n".join(commands), tmp_path)
    assert (tmp_path / "scene.png").is_file()


def test_its_make_targets_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = re.findall(r"^make ([a-z-]+)", README, flags=re.M)
    assert targets == ["demo", "test"]
    assert all(re.search(rf"^{target}:", makefile, flags=re.M) for target in targets)


def test_its_links_lead_somewhere():
    links = re.findall(r"\]\(([^)]+)\)", README)
    assert len(links) > 10
    assert not [link for link in links if not (ROOT / link).exists()]


def test_its_pictures_are_small():
    pictures = re.findall(r"!\[.*?\]\((.*?)\)", README)
    assert pictures
    assert all((ROOT / picture).stat().st_size <= 300_000 for picture in pictures)


def test_it_fits_on_a_screen():
    assert len(README.splitlines()) <= 80
