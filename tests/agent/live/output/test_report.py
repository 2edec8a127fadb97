"""A portfolio holds all it promises, every file whole, and reads back."""

import csv
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from lifelore.agent.live.baselines import AGENTS
from lifelore.agent.live.life import Life, live
from lifelore.agent.live.output.known_building import NAV2_FILES
from lifelore.agent.live.output.report import FILES, check_folder, write_portfolio
from lifelore.core.errors import InputError, StoreError
from lifelore.figures.style import colour_of

from ..flat_settings import flat_settings

PNG = b"\x89PNG\r\n\x1a\n"
GRID_FILES = [name for name in FILES if name not in NAV2_FILES]
"""Files of a life in a world without a map."""
_QUICK = {"tasks": 3, "jobs": 1}


@pytest.fixture(scope="module")
def life(tmp_path_factory) -> Life:
    return live(flat_settings(**_QUICK, memory=str(tmp_path_factory.mktemp("life") / "memory.db")))


@pytest.fixture(scope="module")
def folder(life, tmp_path_factory) -> Path:
    """The portfolio of `life`, to be read only."""
    out = tmp_path_factory.mktemp("portfolio") / "deep" / "out"
    assert write_portfolio(life, str(out)) == [str(out / name) for name in GRID_FILES]
    return out


def _life(tmp_path: Path, **settings) -> Life:
    return live(flat_settings(**_QUICK | settings, memory=str(tmp_path / "memory.db")))


def _no_constant(name: str):
    raise AssertionError(f"{name} is not JSON")


@pytest.mark.slow
def test_everything_is_written_and_nothing_else_is_left(life, folder):
    assert sorted(path.name for path in folder.iterdir()) == sorted(GRID_FILES)
    for name in GRID_FILES:
        content = (folder / name).read_bytes()
        if name.endswith(".png"):
            assert content.startswith(PNG)
            assert 5_000 < len(content) <= 300_000
    text = (folder / "summary.json").read_text(encoding="utf-8")
    assert json.loads(text, parse_constant=_no_constant) == json.loads(json.dumps(life.report))


@pytest.mark.slow
def test_paths_walk_from_cell_to_cell_and_end_at_their_goal(life, folder):
    with (folder / "paths.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    paths: dict[tuple[int, int], list] = {}
    for row in rows:
        path = paths.setdefault((int(row["task"]), int(row["path"])), [])
        assert int(row["step"]) == len(path)
        path.append((float(row["x"]), float(row["y"])))
    goals = {task["index"]: task["goal"] for task in life.report["tasks"]}
    assert {task for task, _ in paths} == set(goals)
    for (task, _), path in paths.items():
        goal = life.world.positions(np.array([life.world.state_of[tuple(goals[task])]]))[0]
        assert path[-1] == pytest.approx(tuple(goal), abs=1e-3)
        assert np.abs(np.diff(path, axis=0)).sum(axis=1) == pytest.approx(life.world.frame.cell, abs=1e-3)


def test_a_life_without_a_task_leaves_its_report(life, tmp_path):
    empty = replace(life, report=life.report | {"tasks": [], "summary": {}}, results=[])
    assert write_portfolio(empty, str(tmp_path)) == [str(tmp_path / "summary.json")]


def test_a_report_that_is_not_json_leaves_the_folder_as_it_was(life, tmp_path):
    (tmp_path / "summary.json").write_text("of an earlier life")
    broken = replace(life, report=life.report | {"seconds": float("nan")})
    with pytest.raises(ValueError, match="JSON"):
        write_portfolio(broken, str(tmp_path))
    assert [path.name for path in tmp_path.iterdir()] == ["summary.json"]
    assert (tmp_path / "summary.json").read_text() == "of an earlier life"


def test_every_agent_has_its_colour():
    assert len({colour_of(name) for name in AGENTS}) == len(AGENTS)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("settings", "has_prior"),
    [
        ({"agent": "scratch", "tasks": 1, "start": (1, 1), "episodes": 1, "max_steps": 5}, False),
        ({"agent": "model", "tasks": 2}, False),
        ({"domain": "noise", "tasks": 2}, True),
    ],
    ids=["one capped task from one start", "no prior", "noise"],
)
def test_other_lives_have_a_prior_or_no_picture_of_one(tmp_path, settings, has_prior):
    out = tmp_path / "out"
    out.mkdir()
    (out / "prior.png").write_text("of an earlier life")
    written = write_portfolio(_life(tmp_path, **settings), str(out))
    assert written == [str(out / name) for name in GRID_FILES if has_prior or name != "prior.png"]
    assert (out / "prior.png").exists() == has_prior


def test_a_folder_is_made_and_left_empty(tmp_path):
    check_folder(str(tmp_path / "a" / "b"))
    assert list((tmp_path / "a" / "b").iterdir()) == []


@pytest.mark.parametrize(
    ("path", "error", "words"),
    [
        ("", InputError, r"^out must name a folder.*$"),
        ("a\0b", InputError, r"^out must name a folder.*$"),
        ("file", InputError, r"^out must name a folder.*$"),
        ("file/below", InputError, r"^out must name a folder.*$"),
        ("/proc/lifelore", StoreError, r"^cannot write into .*choose another folder.*$"),
        (".", InputError, r"world\.png"),
    ],
)
def test_folders_that_cannot_be_written_are_refused(tmp_path, monkeypatch, path, error, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("")
    (tmp_path / "world.png").mkdir()
    with pytest.raises(error, match=words):
        check_folder(path)
