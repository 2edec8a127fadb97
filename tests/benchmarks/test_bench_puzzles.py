"""Puzzles from cloud to goal: a real planner and physics on one, and how endings are counted."""

import json

import pytest

from benchmarks.perception import puzzles, solved_puzzle
from benchmarks.perception.solved_puzzle import NO_BLOCK, NO_PLAN, NOT_FOUND, SOLVED, Ending
from lifelore.bridges.planner import Step
from lifelore.domains.tabletop.pick_and_place import COVERED

pytest.importorskip("mujoco")


@pytest.fixture(autouse=True)
def other_puzzles(monkeypatch):
    """Not those that the benchmark judges."""
    monkeypatch.setattr(solved_puzzle, "SEED", 99)


@pytest.mark.planning
@pytest.mark.slow
def test_a_puzzle_is_solved_from_its_cloud():
    end = solved_puzzle.solved_puzzle(2, labels=True, pictures=True)
    assert (end.outcome, end.looks) == (SOLVED, 1)
    assert [step.action for step in end.steps[::2]] == ["pick-up"] * (len(end.steps) // 2)
    assert len(end.clouds) == 1 + len(end.steps) // 2
    # The steps are carried out: from the same start, without them, the goal does not hold.
    puzzle, hand = solved_puzzle.started(2)
    assert not all(hand.holds(relation, *blocks) for relation, blocks in puzzle.wishes())


def test_goals_name_what_was_perceived():
    puzzle, _ = solved_puzzle.started(2)
    names = {block: f"o{block + 7}" for block in range(len(puzzle.cubes))}
    (lowest, *_), *_ = puzzle.goal
    assert solved_puzzle.goal_text(puzzle, names).startswith(f"on-table(o{lowest + 7}) and ")


def test_wrong_steps_end_a_puzzle(monkeypatch):
    puzzle, _ = solved_puzzle.started(2)
    tower = next(tower for tower in puzzle.start if len(tower) > 1)
    names = {f"o{block}": block for block in range(len(puzzle.cubes))}
    for step, fault in ((Step("pick-up", (f"o{tower[0]}",)), COVERED), (Step("pick-up", ("o99",)), NO_BLOCK)):
        monkeypatch.setattr(solved_puzzle, "_planned", lambda *_, step=step: (NO_PLAN, ((step,), names)))
        end = solved_puzzle.solved_puzzle(2, labels=True)
        assert (end.outcome, end.steps) == (fault, ())
    # A plan that does nothing ends where the puzzle began.
    monkeypatch.setattr(solved_puzzle, "_planned", lambda *_: (NO_PLAN, ((), names)))
    assert solved_puzzle.solved_puzzle(2, labels=True).outcome == solved_puzzle.NOT_REACHED
    monkeypatch.setattr(solved_puzzle, "_planned", lambda *_: (NOT_FOUND, None))
    assert solved_puzzle.solved_puzzle(2, labels=True) == Ending(NOT_FOUND, solved_puzzle.LOOKS, ())


def test_endings_are_counted(monkeypatch, tmp_path):
    steps = (Step("pick-up", ("o2",)), Step("put-on-table", ("o2",)))
    given = [
        Ending(SOLVED, 1, steps),
        Ending(SOLVED, 2, steps * 2),
        Ending(COVERED, 1, steps),
        Ending(NO_PLAN, 3, ()),
    ]
    monkeypatch.setattr(puzzles, "PUZZLES", 2)
    monkeypatch.setattr(
        puzzles, "solved_puzzle", lambda number, labels: given[number] if labels else Ending(NOT_FOUND, 3, ())
    )
    told = []
    result = puzzles.bench_puzzles(2, lambda *at: told.append(at), tmp_path)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert len(told) == 4
    values = {row["name"]: row["value"] for row in result["rows"]}
    assert values["labels given: solved"] == 0.5
    assert values["labels given: solved at the first look"] == 0.25
    assert values["labels given: puzzles with a plan"] == 3
    assert values["labels given: steps of a solved puzzle"] == 3
    assert values[f"labels given: not solved, {COVERED}"] == 1
    assert values[f"without labels: not solved, {NOT_FOUND}"] == 4
    assert [goal["met"] for goal in result["goals"]] == [False, False]
    assert not list(tmp_path.iterdir()), "no puzzle was solved without labels, so none is drawn"


def test_a_solved_puzzle_is_drawn(monkeypatch, tmp_path):
    end = Ending(SOLVED, 1, (Step("pick-up", ("o2",)), Step("put-on", ("o2", "o3"))) * 3)
    _, hand = solved_puzzle.started(2)
    photo = hand.photograph(solved_puzzle.stream(0, "test"))
    assert photo is not None
    shown = Ending(SOLVED, 1, end.steps, (photo.cloud,) * 4)
    monkeypatch.setattr(puzzles, "solved_puzzle", lambda *_, **__: shown)
    monkeypatch.setattr(puzzles, "PUZZLES", 1)
    puzzles.bench_puzzles(2, lambda *_: None, tmp_path)
    assert (tmp_path / "bench_puzzles.png").read_bytes().startswith(b"\x89PNG")
