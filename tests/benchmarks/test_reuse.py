"""The benchmark of policy reuse: like work by all, and its contract without the outside programs."""

import json

import numpy as np
import pytest

from benchmarks import reuse, reuse_users
from benchmarks.peers import reuse_loops
from benchmarks.peers.bandits import BOTORCH, MABWISER, BoTorchUCB, installed, mabwiser_ucb1
from benchmarks.reserve import HORIZON, LargeReserve, Reserve
from benchmarks.reuse import bench_reuse
from lifelore.core.errors import LifeloreError
from lifelore.interaction.beliefs.belief import entropy
from lifelore.interaction.selection import (
    BeliefEntropy,
    ExpectedImprovement,
    InformationDirected,
    KnowledgeGradient,
)
from lifelore.interaction.selection.support import supported_types
from lifelore.interaction.selection.type_classes import type_classes


@pytest.fixture
def short(monkeypatch):
    """Sizes at which the whole benchmark takes seconds, and no outside program."""
    monkeypatch.setattr(reuse, "SIGNALS", 6)
    monkeypatch.setattr(reuse, "SIZES", ((12, 5), (16, 5)))
    monkeypatch.setattr(reuse, "TASKS", 1)
    monkeypatch.setattr(reuse_users, "USERS", 3000)
    monkeypatch.setattr(reuse_users, "AT_ONCE", 1000)
    monkeypatch.setattr(reuse_loops, "POINTS", 4)
    monkeypatch.setattr(reuse, "installed", lambda name: False)


def test_loops_give_the_rules_own_scores(monkeypatch):
    case = Reserve(6)
    library, flat = case.library, case.flat
    monkeypatch.setattr(case, "flat", np.random.default_rng(0).dirichlet(np.full(68, 0.3)))
    belief = case.flat
    scores = BeliefEntropy(n_bins=6, mass=1.0).scores(library, belief)
    span = np.ptp(case.mean)
    assert case.looped("belief entropy") == pytest.approx(scores - span * entropy(belief), rel=1e-9)
    scores = InformationDirected(n_bins=6, mass=1.0).scores(library, belief)
    assert case.looped("information-directed") == pytest.approx(-(scores**2), rel=1e-6)
    scores = KnowledgeGradient(n_bins=6, mass=1.0).scores(library, belief, episodes_left=HORIZON)
    assert case.looped("knowledge gradient") == pytest.approx(scores, rel=1e-9)
    monkeypatch.setattr(reuse_loops, "POINTS", 10)
    scores = ExpectedImprovement(of="outcome").scores(library, belief)
    assert case.looped("expected improvement") == pytest.approx(scores, rel=0.03, abs=0.03 * scores.max())
    assert flat is library.prior


def test_unlike_work_is_refused(monkeypatch):
    monkeypatch.setattr(reuse_loops, "POINTS", 4)
    case = Reserve(6)
    case.check()
    monkeypatch.setattr(reuse_loops, "knowledge_gradient", lambda belief, mean, *_: belief @ mean)
    with pytest.raises(LifeloreError, match="knowledge gradient must select what"):
        case.check()
    monkeypatch.undo()
    monkeypatch.setattr(reuse_loops, "POINTS", 4)
    monkeypatch.setattr(reuse_loops, "updated", lambda belief, *_: belief)
    with pytest.raises(LifeloreError, match="an update must be the loop's"):
        Reserve(6).check()


def test_the_answer_keeps_its_contract_without_the_outside_programs(short):
    told = []
    result = bench_reuse(2, lambda *at: told.append(at))
    assert json.loads(json.dumps(result, allow_nan=False)) == result
    names = [line["name"] for line in result["rows"]]
    assert len(names) == len(set(names))
    assert [done for done, _, _ in told] == sorted(done for done, _, _ in told)
    assert told[-1][:2] == (5, 5)
    empty = {line["name"] for line in result["rows"] if line["value"] is None}
    assert all("MABWiser" in name or "BoTorch" in name for name in empty)
    assert len(empty) == 8
    for line in result["rows"]:
        assert line["ratio_to"] is None or line["ratio_to"] in names
        assert (line["ratio"] is None) == (line["ratio_to"] is None or line["value"] is None)
    undecided = {goal["name"] for goal in result["goals"] if goal["met"] is None}
    assert undecided == {goal["name"] for goal in result["goals"] if goal["measured"] is None}
    assert len(undecided) == 4
    assert all("MABWiser" in name or "BoTorch" in name for name in undecided)
    assert len(result["goals"]) == 27
    assert sum("settled belief" in name for name in names) == 9
    assert sum("knowledge gradient, flat" in name for name in names) == 3
    assert sum("learnt models" in name for name in names) == 5 + 9
    assert {line["name"]: line["value"] for line in result["rows"]}["memory a user"] == 272


def test_regrets_are_compared_on_the_tasks_that_both_played():
    regrets = {"a": [1.0, 50.0, 3.0, 50.0], "b": [2.0, 6.0]}
    assert reuse._share(regrets, "a", "b") == pytest.approx(4 / 8)
    assert reuse._share(regrets, "a", "c") is None


def test_tasks_are_the_same_for_all_and_differ_among_themselves():
    case = Reserve(6)
    type_, returns = case.task(3)
    again, same = case.task(3)
    assert type_ == again
    assert np.array_equal(returns, same)
    assert not np.array_equal(returns, case.task(4)[1])
    # 3400 draws of deviation 20: the mean's own is 0.34, five of them.
    assert (returns - case.mean[type_]).mean() == pytest.approx(0, abs=1.7)


def test_a_large_reserve_is_as_it_says():
    case = LargeReserve(200, 7)
    assert case.library.table(7).probs.shape == (200, 200, 7)
    assert case.library.table(7).probs.dtype == np.float32
    assert case.settled.sum() == pytest.approx(1)
    assert len(supported_types(case.settled, 0.999)[0]) == 104
    assert (case.library.performance.mean.argmax(axis=1) == np.arange(200)).all()
    assert type_classes(case.library.table(7)).few
    learnt = LargeReserve(200, 7, learnt=True)
    assert np.array_equal(learnt.library.performance.mean, case.library.performance.mean)
    assert type_classes(learnt.library.table(7)).number.mean() > 190


@pytest.mark.skipif(not installed(MABWISER), reason="MABWiser is not installed")
def test_mabwiser_learns():
    select, update = mabwiser_ucb1(np.array([1.0, 2.0, 0.0]), 0.1)
    assert select() == 1
    for _ in range(5):
        update(1, -50.0)
    assert select() == 0


@pytest.mark.skipif(not installed(BOTORCH), reason="BoTorch is not installed")
def test_botorch_learns():
    places = np.linspace(0, 1, 8)[:, None] * np.ones(2)
    process = BoTorchUCB(places, 0, refit=2)
    for _ in range(12):
        policy = process.select()
        process.update(policy, -float((policy - 5) ** 2))
    assert process.policies[0] == 0
    assert abs(max(set(process.policies), key=process.policies.count) - 5) <= 1
