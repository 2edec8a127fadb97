"""`bench deep`: the worlds it explores, a greedy walk by hand, one small run, and the contract of its answer."""

import json
from collections import Counter

import gymnasium
import numpy as np
import pytest
from PIL import Image

from benchmarks.action import deep, deep_learning, deep_speed
from benchmarks.action.deep_learning import greedy_score, learnt
from benchmarks.action.deep_worlds import (
    GUIDED,
    LAYOUTS,
    SEVEN,
    SOURCES,
    UNIFORM,
    crossing_prior,
    excluded_best,
    exploring,
    layout_seed,
    new_world,
    one_layout,
)
from benchmarks.action.figure_deep_curves import draw_deep_curves
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.bridges.minigrid_view import FORWARD, LEFT, RIGHT, solved_layout
from lifelore.core.errors import MissingExtraError
from lifelore.figures.style import save_figure

pytest.importorskip("minigrid")


def test_the_prior_counts_shortest_ways_alone():
    prior, steps = crossing_prior(), 0
    for name in SOURCES:
        env = new_world(name)
        for number in range(LAYOUTS):
            env.reset(seed=layout_seed(name, number))
            layout = solved_layout(env)
            steps += int(layout.best[layout.passed].sum())
    assert prior.counts(prior.contexts).sum() == steps
    # Only the front open: on a shortest way nobody turns round there. Only left, only right: that way.
    assert np.flatnonzero(prior.counts([0b010])[0]).tolist() == [FORWARD]
    assert np.flatnonzero(prior.counts([0b001])[0]).tolist() == [LEFT]
    assert np.flatnonzero(prior.counts([0b100])[0]).tolist() == [RIGHT]


def test_exploring_counts_steps_to_the_goal():
    always = ActionPrior(3, alpha0=1e-9)
    always.update(np.arange(8), np.eye(3, dtype=bool)[[FORWARD] * 8])
    always.update([0b100], [[False, True, False]], weight=1e6)
    found = exploring("Empty-8x8", always, 3)
    assert set(found) == {SEVEN, UNIFORM, GUIDED}
    # Five forward along the wall, a turn at its end (only the right is open there), five forward: always.
    assert found[GUIDED] == [11, 11, 11]
    assert all(len(steps) == 3 and max(steps) <= 4 * 8 * 8 for steps in found.values())


def test_exploring_without_arriving_is_nought():
    turning = ActionPrior(3, alpha0=1e-9)
    turning.update(np.arange(8), np.eye(3, dtype=bool)[[LEFT] * 8])
    assert exploring("Empty-5x5", turning, 2)[GUIDED] == [0, 0]


def test_a_mask_that_excludes_by_hand():
    # On the way from (1, 1) to (3, 3) of the empty room: forward, forward, right, forward, forward.
    turning = ActionPrior(3)
    turning.update([0b110], [[True, False, False]])
    assert excluded_best("Empty-5x5", turning, 2) == pytest.approx(4 / 5)
    assert excluded_best("Empty-5x5", ActionPrior(3), 2) == 0.0


def test_a_layout_stays_and_runs_have_their_own():
    def walls(env):
        return env.unwrapped.grid.encode()[..., 0].tobytes()

    env = one_layout("SimpleCrossingS9N3", layout_seed("x", 1))
    first = [walls(env) for _ in range(3) if env.reset(seed=_)]
    assert len(set(first)) == 1
    others = [one_layout("SimpleCrossingS9N3", layout_seed("x", run)) for run in range(6)]
    assert len({walls(other) for other in others if other.reset()}) > 3


class Walks:
    """A model that takes the moves it was told, one after another."""

    def __init__(self, moves):
        self.moves = iter(moves)

    def predict(self, observation, deterministic):
        assert deterministic
        return np.array(next(self.moves)), None


def test_a_greedy_walk_by_hand():
    env = one_layout("Empty-5x5", 0)
    straight = [FORWARD, FORWARD, RIGHT, FORWARD, FORWARD]
    assert greedy_score(Walks(straight), env, 5) == 1.0
    assert greedy_score(Walks([LEFT, RIGHT, *straight]), env, 5) == pytest.approx(5 / 7)
    assert greedy_score(Walks([LEFT, RIGHT] * 5 + straight), env, 5) == pytest.approx(1 / 3)
    assert greedy_score(Walks([LEFT, RIGHT] * 6 + straight), env, 5) == 0.0


@pytest.mark.deep
def test_a_run_is_the_same_again_and_another_with_the_prior():
    pytest.importorskip("stable_baselines3")
    prior = crossing_prior()
    first, again, guided = (learnt("Empty-5x5", 0, who, 2000, 500) for who in (None, None, prior))
    assert first == again
    assert first != guided
    for one in (first, guided):
        assert one["shortest"] == 5
        assert len(one["scores"]) == 4
        assert one["goals"] > 0
        assert all(0 <= score <= 1 for score in one["scores"])
    assert guided["goals"] > first["goals"]


@pytest.mark.deep
def test_both_sides_of_a_timed_case_do_their_own_work():
    pytest.importorskip("sb3_contrib")
    for case in (deep_speed.SELDOM, deep_speed.ALWAYS, deep_speed.MASKS):
        told = Counter()
        times = deep_speed.measured(case, lambda who, told=told: told.update([who]), rounds=1)
        assert told == {deep_speed.PLAIN: 1, deep_speed.PRIOR: 1}
        assert all(0 < one < 1e6 for each in times.values() for one in each)
    from lifelore.bridges.sb3 import PriorDQN, PriorMask

    prior = ActionPrior(3)
    for make, is_ours in (
        (lambda: deep_speed._exploring(prior, 1.0), lambda model: isinstance(model, PriorDQN)),
        (lambda: deep_speed._masked(prior), lambda model: model.get_env().envs[0].env.__class__ is PriorMask),
    ):
        models = make()
        assert [is_ours(models[who]) for who in (deep_speed.PLAIN, deep_speed.PRIOR)] == [False, True]


@pytest.mark.deep
def test_the_answer_keeps_its_contract(monkeypatch, tmp_path):
    pytest.importorskip("sb3_contrib")
    for module, name, small in (
        (deep, "EXPLORED", ("Empty-5x5", "Empty-6x6")),
        (deep, "LEARNT", ("Empty-5x5",)),
        (deep, "EPISODES", 4),
        (deep, "LEAST_RUNS", 3),
        (deep_speed, "ROUNDS", 1),
        (deep_learning, "STEPS", 1000),
    ):
        monkeypatch.setattr(module, name, small)
    told = []
    result = deep.bench_deep(3, lambda *at: told.append(at), tmp_path)
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    assert [(done, of) for done, of, _ in told] == [(i + 1, 14) for i in range(14)]
    names = [line["name"] for line in result["rows"]]
    assert len(set(names)) == len(names)
    assert all(line["ratio_to"] in [*names, None] for line in result["rows"])
    assert len(result["goals"]) == 3 + 1 + 2
    curves = result["learning"]["Empty-5x5"]["curves"]
    assert curves[deep.PLAIN]["steps"] == [500, 1000]
    assert len(list((tmp_path / "deep" / "cells").glob("*.json"))) == 6 + 2
    with Image.open(tmp_path / "bench_deep.png") as picture:
        assert min(picture.size) > 300
    # A second time nothing is learnt anew.
    monkeypatch.setattr(deep_learning, "learnt", lambda *at: pytest.fail("learnt anew"))
    monkeypatch.setattr(deep, "exploring", lambda *at: pytest.fail("explored anew"))
    assert deep.bench_deep(3, lambda *at: None, tmp_path)["learning"] == result["learning"]


def test_without_the_library_the_extra_is_named(monkeypatch, tmp_path):
    import sys

    monkeypatch.delitem(sys.modules, "lifelore.bridges.sb3", raising=False)
    monkeypatch.setitem(sys.modules, "stable_baselines3", None)
    with pytest.raises(MissingExtraError, match=r"lifelore\[deep\]"):
        deep.bench_deep(1, lambda *at: None, tmp_path)


def test_gains_by_hand():
    scores = {deep.PLAIN: [[0, 0, 1], [0, 1, 1], [0, 0, 0]], deep.PRIOR: [[0, 1, 1], [1, 1, 1], [0, 1, 1]]}
    gain = deep._gain(scores)
    # To 0.8 in 2, 1 and 2 evaluations against 3, 2 and never, which counts as 3.
    assert gain.threshold_ratio.value == pytest.approx(5 / 8)
    assert (gain.never, gain.baseline_never) == (0, 1)
    rows = deep._learning_rows("w", {"scores": scores, "goals": {deep.PLAIN: [1, 3], deep.PRIOR: [4, 8]}}, gain)
    assert [(line["value"], line["ratio"]) for line in rows[2:4]] == [(2.0, None), (6.0, 3.0)]
    assert rows[1]["ratio"] == pytest.approx(7 / 3)


def test_the_figure_from_plain_data(tmp_path):
    share = {"value": 0.5, "ci95": [0.4, 0.6]}
    never = {"value": 0.0, "ci95": None}
    curve = {"steps": [500, 1000], "mean": [0.1, 0.9], "ci95": [[0.0, 0.2], [0.8, 1.0]]}
    learning = {"w": {"curves": {"a": curve, "b": curve}, "goals": {"a": [1, 2, 3], "b": [1, 2, 3]}}}
    names = {"a": "scratch", "b": "prior", "guided": "prior"}
    figure = draw_deep_curves({"w": {"blind": never, "guided": share}}, learning, names)
    path = save_figure(figure, tmp_path / "figure.png")
    assert path.stat().st_size <= 300_000
    assert "3 layouts" in figure._supxlabel.get_text()
    assert len(figure.axes) == 2


def test_gymnasium_makes_the_worlds_by_name():
    assert isinstance(new_world("Empty-5x5"), gymnasium.Env)
