"""What the errata page says, shown; the entries' numbers are those of docs/errata.md."""

import re
from pathlib import Path

import numpy as np
import pytest

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.planning.planning import best_actions
from lifelore.domains.grids.lattice import lattice
from reproduction.chapter3.c3_01_useful_actions.run import prior_of

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "errata.md").read_text(encoding="utf-8")


def test_entries_are_numbered_and_name_tests_that_exist():
    numbers = [int(n) for n in re.findall(r"^## E(\d+)\b", PAGE, re.MULTILINE)]
    assert numbers == list(range(1, len(numbers) + 1))
    sections = re.split(r"^## ", PAGE, flags=re.MULTILINE)[1:]
    for section in sections:
        assert all(f"**{part}.**" in section for part in ("Problem", "Here", "Test")), section[:40]
    for path, name in re.findall(r"`(tests/\S+\.py)::(\w+)`", PAGE):
        assert f"def {name}(" in (ROOT / path).read_text(encoding="utf-8"), name


def test_paths_that_entries_name_exist():
    paths = set(re.findall(r"`((?:tests|src|docs|results|examples)/[^`:\s]+)", PAGE))
    assert "tests/perception/reasoning/test_geometric_relations.py" in paths
    assert [path for path in sorted(paths) if not (ROOT / path).exists()] == []


def test_e1_printed_shares_need_nineteen_cells_or_thirty_eight():
    def shares(n_cells):
        return {f"{100 * k / (4 * n_cells):.2f}" for k in range(4 * n_cells + 1)}

    assert [n for n in range(2, 50) if {"55.26", "63.16"} <= shares(n)] == [19, 38]


def test_e2_a_state_prior_tells_cells_apart_that_look_alike():
    world = lattice(9)
    by_state = prior_of(world, np.arange(world.n_states))
    states = np.arange(world.n_states)
    probs = by_state.probs(states)
    alike = [(a, b) for a in states for b in states[:a] if world.percepts[a] == world.percepts[b]]
    assert any(not np.allclose(probs[a], probs[b]) for a, b in alike)
    by_percept = by_state.marginalise(world.percepts[by_state.contexts])
    assert all(np.array_equal(*by_percept.probs(world.percepts[[a, b]])) for a, b in alike)


def test_e5_a_draw_at_every_step_is_the_proportion():
    # 40,000 draws of θ and then of an action: a frequency's standard error is below 0.5 / 200 = 0.0025; 4.5 of
    # them leave a false alarm in 150,000 for each of 4 actions, and the seed is fixed.
    prior = ActionPrior(4, alpha0=0.1)
    prior.update([0, 0, 0], [[True, False, True, False], [True, False, False, False], [False, True, True, False]])
    drawn = prior.sample(np.zeros(40_000, int), np.random.default_rng(0), form="dirichlet")
    frequency = np.bincount(drawn, minlength=4) / 40_000
    np.testing.assert_allclose(frequency, prior.probs([0])[0], atol=4.5 * 0.0025)


def test_e6_softmax_of_counts_loses_what_the_proportion_keeps():
    prior = ActionPrior(2, alpha0=0.1)
    prior.update([0], [[True, True]], weight=60)
    prior.update([0], [[True, False]], weight=40)
    assert prior.probs([0])[0, 1] == pytest.approx(60.1 / 160.2)
    assert prior.probs([0], "softmax")[0, 1] < 1e-17


def test_e9_a_domain_without_traps_cannot_have_fewer():
    world = lattice(7)
    prior = prior_of(world, np.arange(world.n_states))
    assert (prior.counts(np.arange(world.n_states)) > 0).any(axis=1).all()  # no state is futile
    assert ((prior.counts(np.arange(world.n_states)) > 0) == (world.neighbour >= 0)).all()


def test_e10_states_that_look_alike_pool_their_own_best_actions():
    q = np.array([[1.0, 0.0], [0.0, 1.0]])
    prior = ActionPrior(2)
    prior.update([7, 7], best_actions(q))  # one percept, two states, different best actions
    assert prior.counts([7]).tolist() == [[1, 1]]
