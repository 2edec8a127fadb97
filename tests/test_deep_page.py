"""The page on deep learning with a prior: its Python runs, only shorter."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.prior_file import load_prior, save_prior

PAGE = (Path(__file__).parents[1] / "docs" / "deep_rl.md").read_text(encoding="utf-8")
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
