"""The page on deep learning with a prior: its Python runs, only shorter."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = (Path(__file__).parents[1] / "docs" / "deep_rl.md").read_text(encoding="utf-8")
LIVES, COUNTS, MASKS = re.findall(r"```python\n(.*?)```", PAGE, flags=re.S)
SHORT = ("3_000", "600")


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
def test_a_life_becomes_the_exploration_of_a_network(tmp_path):
    pytest.importorskip("stable_baselines3")
    said = run(LIVES + "print(model.num_timesteps, len(prior))", tmp_path, SHORT)
    steps, contexts = map(int, said.split())
    assert steps == 600
    assert contexts > 1


@pytest.mark.deep
def test_a_network_becomes_a_prior(tmp_path):
    pytest.importorskip("stable_baselines3")
    run(LIVES + COUNTS + "assert earned == 0 or len(learnt)", tmp_path, SHORT, ("range(50)", "range(5)"))


@pytest.mark.deep
def test_masks(tmp_path):
    pytest.importorskip("sb3_contrib")
    assert run(LIVES + MASKS + "print(model.num_timesteps)", tmp_path, SHORT, ("10_000", "300")).strip() == "512"


@pytest.mark.parametrize("code", [LIVES, COUNTS, MASKS])
def test_what_a_user_writes_is_short(code):
    assert len([line for line in code.splitlines() if line.strip()]) <= 15
