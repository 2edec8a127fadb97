"""The page on deep learning with a prior: its Python runs, only shorter, and its numbers are the benchmark's."""

import json
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from benchmarks.action.deep_worlds import GUIDED, SEVEN, UNIFORM
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.prior_file import load_prior, save_prior

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "deep_rl.md").read_text(encoding="utf-8")
EXPLORES, LIVES, COUNTS, MASKS = re.findall(r"```python\n(.*?)```", PAGE, flags=re.S)


def run(code: str, folder: Path, *shorter: tuple[str, str]) -> str:
    """What the code prints."""
    for long, short in shorter:
        assert long in code
        code = code.replace(long, short)
    command = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.deep
def test_dqn_explores_by_a_prior(tmp_path):
    pytest.importorskip("stable_baselines3")
    said = run(EXPLORES + "print(model.num_timesteps, len(prior))", tmp_path, ("15_000", "600"))
    steps, contexts = map(int, said.splitlines()[-1].split())
    assert steps == 600
    assert contexts == 7
    assert len(load_prior(tmp_path / "ways.npz")) == 7  # the masks below read this file


@pytest.mark.deep
def test_a_life_becomes_the_exploration_of_a_network(tmp_path):
    pytest.importorskip("stable_baselines3")
    said = run(LIVES + "print(model.num_timesteps, len(prior))", tmp_path, ("3_000", "600"))
    steps, contexts = map(int, said.split())
    assert steps == 600
    assert contexts > 1


@pytest.mark.deep
def test_a_network_becomes_a_prior(tmp_path):
    pytest.importorskip("stable_baselines3")
    said = run(COUNTS, tmp_path, ("8_000", "600"), ("episodes=50", "episodes=5"))
    assert re.fullmatch(r"[0-5] of 50 episodes counted\n", said)


@pytest.mark.deep
def test_masks(tmp_path):
    pytest.importorskip("sb3_contrib")
    prior = ActionPrior(3)
    prior.update(np.arange(8), np.eye(3, dtype=bool)[np.arange(8) % 3])
    save_prior(prior, tmp_path / "ways.npz")
    said = run(MASKS + "print(model.num_timesteps)", tmp_path, ("10_000", "300"))
    assert int(said) == 512


@pytest.mark.parametrize("code", [EXPLORES, LIVES, COUNTS, MASKS])
def test_what_a_user_writes_is_short(code):
    assert len([line for line in code.splitlines() if line.strip()]) <= 15


def test_numbers_are_those_of_the_benchmark():
    result = json.loads((ROOT / "results" / "bench_deep.json").read_text(encoding="utf-8"))
    lines = {line.split("|")[1].strip(): line for line in PAGE.splitlines() if line.startswith("| ")}
    worlds = [name.strip(" `") for name in lines[""].split("|")[2:-1]]
    assert worlds == list(result["exploring"])

    def told(start):
        (line,) = [line for name, line in lines.items() if name.startswith(start)]
        return [cell.strip() for cell in line.split("|")[2:-1]]

    for start, who in (("episodes", SEVEN), ("three", UNIFORM), ("prior", GUIDED)):
        shares = [result["exploring"][world][who]["value"] for world in worlds]
        assert told(start) == [f"{100 * share:.1f} %" for share in shares]
    learning = [result["learning"][world] for world in worlds[:2]]
    for start, who in (("goals", "DQN"), ("with prior", "DQN with prior")):
        assert told(start) == [*(f"{np.mean(one['goals'][who]):.0f}" for one in learning), ""]
    ratios = [
        (one["gain"]["threshold_ratio"]["value"], *one["gain"]["threshold_ratio"]["ci95"]) for one in learning
    ]
    assert told("steps until") == [*("{:.2f} ({:.2f}–{:.2f})".format(*ratio) for ratio in ratios), ""]
    assert told("runs of 12") == [
        *(f"{one['gain']['baseline_never']}, {one['gain']['never']}" for one in learning),
        "",
    ]
    assert {len(one["goals"]["DQN"]) for one in learning} == {12}
    speeds = [100 * (goal["measured"] - 1) for goal in result["goals"] if goal["name"].startswith("a step of")]
    assert [float(x) for x in re.findall(r"([\d.]+) %", PAGE.split("A step of DQN")[1])][:3] == [
        round(speed, 1) for speed in speeds
    ]


def test_its_picture_is_small_enough():
    assert (ROOT / "results" / "bench_deep.png").stat().st_size <= 300_000


LAYOUTS = json.loads((ROOT / "results" / "bench_deep_layouts.json").read_text(encoding="utf-8"))
LAYOUT_ROWS = {row["name"]: row for row in LAYOUTS["rows"]}
WORLD = "SimpleCrossingS9N1"
CASES = [
    ("one", "one layout", "MaskablePPO"),
    ("another every episode", "another layout every episode", "MaskablePPO"),
    ("another every episode", "another layout every episode", "DQN"),
]


def shown(name, digits):
    row = LAYOUT_ROWS[f"{WORLD}, {name}"]
    low, high = row["ci95"]
    return f"{row['value']:.{digits}f} [{low:.{digits}f}, {high:.{digits}f}]"


@pytest.mark.parametrize(("words", "layouts", "learner"), CASES)
def test_the_table_of_layouts(words, layouts, learner):
    case = f"{layouts}, {learner}"
    score, goals = "score at the end", "goals reached while learning"
    cells = [
        shown(f"{case} without prior, {score}", 2),
        shown(f"{case} with prior, {score}", 2),
        shown(f"{case}, {score}, gain by prior, mean", 2),
        shown(f"{case} without prior, {goals}", 0),
        shown(f"{case} with prior, {goals}", 0),
    ]
    assert f"| {words} | {learner} | " + " | ".join(cells) + " |" in PAGE


def test_the_number_of_runs():
    assert {row["n"] for row in LAYOUTS["rows"]} == {5}
