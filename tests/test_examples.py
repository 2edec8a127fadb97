"""The scripts in `examples/` run without a warning, print what their pages show, and stay short."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.page_block import run_block

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))
SERVED = ("personalise_client",)
"""Examples that need a running service: `tests/bridges/test_study_client.py` runs them."""


def numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(r"-?\d+\.\d+", text)]


def lore_needs_fewer_steps(lines: list[str]) -> bool:
    steps = [tuple(map(int, re.findall(r"\d+", line)[1:])) for line in lines[1:]]
    return len(steps) == 10 and sum(lore for lore, _ in steps[1:]) < sum(scratch for _, scratch in steps[1:]) / 2


def the_prior_starts_better(lines: list[str]) -> bool:
    uniform, prior = (numbers(line)[0] for line in lines)
    return prior > uniform + 20


def choosing_for_each_user_pays(lines: list[str]) -> bool:
    *interactions, single, best = (numbers(line)[0] for line in lines)
    return len(interactions) == 5 and single < interactions[-1] < best


def known_types_do_better(lines: list[str]) -> bool:
    full, scratch = (numbers(line)[0] for line in lines)
    return full < 1 < scratch - 2


def lakes_are_told_apart(lines: list[str]) -> bool:
    full, textbook = (numbers(line) for line in lines[-2:])
    return full[0] > textbook[0] + 0.3 and full[1] > textbook[1] + 0.2


HOLDS = {
    "cloud_to_relations": lambda lines: {"on(3, 2)", "adjacent(2, 4)", "on(2, 1)", "on(4, 1)"} == set(lines),
    "courier_in_an_office": lore_needs_fewer_steps,
    "long_lived_agent": lakes_are_told_apart,
    "minigrid_partial_view": lambda lines: numbers(lines[0])[0] > 0.1,
    "many_users": choosing_for_each_user_pays,
    "one_user": lambda lines: len(lines) == 4 and "'bold': 0.99" in lines[-1],
    "own_agent_beside": lambda lines: numbers(lines[0])[0] > numbers(lines[0])[2],
    "own_family": known_types_do_better,
    "own_matrices": lambda lines: numbers(lines[1])[0] < numbers(lines[0])[0] / 2,
    "own_gymnasium_world": lambda lines: [numbers(line)[0] > 0 for line in lines] == [True] * 2,
    "prior_guides_learning": the_prior_starts_better,
}


@pytest.mark.slow
@pytest.mark.parametrize(
    "example", [path for path in EXAMPLES if path.stem not in SERVED], ids=lambda path: path.stem
)
def test_an_example_runs_and_shows_its_point(example, tmp_path):
    said = run_block("python", example.read_text(encoding="utf-8"), tmp_path)
    assert HOLDS[example.stem](said.splitlines()), said


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_short_and_stands_on_a_page(example):
    # Two classes and the planner of a family are longer: 40 lines of code, and what explains them.
    most = 65 if example.stem == "own_family" else 40
    assert len(example.read_text(encoding="utf-8").splitlines()) <= most
    pages = [*(ROOT / "docs" / "start").glob("*.md"), ROOT / "docs" / "long_lived.md"]
    assert any(f"examples/{example.name}" in page.read_text(encoding="utf-8") for page in pages)


@pytest.mark.slow
def test_the_example_data_can_be_made_again(tmp_path):
    pytest.importorskip("mujoco")
    pytest.importorskip("rosbags")
    data = ROOT / "examples" / "data"
    subprocess.run([sys.executable, str(data / "make.py"), str(tmp_path)], check=True)
    shipped = {path.name for path in data.iterdir() if path.is_file() and path.name != "make.py"}
    assert {path.name for path in tmp_path.iterdir()} == shipped
    texts = ("office.yaml", "office_new.yaml", "jobs.csv", "courier.csv", "log.csv", "ways.jsonl", "steps.jsonl")
    for name in (*texts, "keys.txt"):
        assert (tmp_path / name).read_text() == (data / name).read_text()
    assert sum((data / name).stat().st_size for name in shipped) < 1_100_000
