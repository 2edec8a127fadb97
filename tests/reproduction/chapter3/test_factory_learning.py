"""Learners in the factory: numbers by hand on a floor of three cells, and streams that are shared."""

import numpy as np
import pytest

from lifelore.domains.factory.contexts import state_contexts
from lifelore.domains.factory.layout import factory
from reproduction.chapter3.factory import learning
from reproduction.chapter3.factory.learning import exact_prior, greedy_return, solved
from reproduction.engine.registry import claim_of

SETTINGS = {**claim_of("C3.5").sizes["full"], "max_steps": 300}
THREE_CELLS = """
#####
#S1a#
#####
"""


@pytest.fixture
def corridor(monkeypatch):
    """The only task of a corridor: start, procurement point, assembly point."""
    small = factory(THREE_CELLS, discount=0.9)
    monkeypatch.setattr(learning, "floor", lambda discount: small)
    return solved.__wrapped__((0,), 0.9)


def test_a_corridor_solved_by_hand(corridor):
    # East -2, Procure 10, East -2, Assemble 10 and 100.
    assert corridor.optimal == 116
    assert corridor.optimal_return == pytest.approx(-2 + 0.9 * 10 - 0.81 * 2 + 0.729 * 110)
    assert corridor.way.tolist() == [0, 1, 4, 5]
    east, west, procure, assemble = 2, 3, 4, 5
    only = [np.flatnonzero(row).tolist() for row in corridor.best]
    # Raw: east, Procure, back west; procured: east, east, Assemble; completed rows are empty.
    assert only == [[east], [procure], [west], [east], [east], [assemble], [], [], []]


def test_what_has_learnt_the_exact_values_earns_the_optimal_return(corridor):
    problem = corridor._replace(stream=(0, "hand"))
    q = corridor.task.optimal_q()
    assert greedy_return(problem, q) == pytest.approx(corridor.optimal_return)
    assert greedy_return(problem, np.zeros_like(q)) == 0.0
    # Back and forth between the first two cells for ever: east for -2, west onto the route for -1.
    shuttles = np.zeros_like(q)
    shuttles[0, 2] = shuttles[1, 3] = 1.0
    assert greedy_return(problem, shuttles) == pytest.approx((-2 - 0.9) / (1 - 0.81))


@pytest.mark.parametrize("encoding", ["global", "left", "listed", "phase"])
def test_prior_counts_as_a_plain_loop_does(encoding):
    known = [solved(components, 0.99) for components in [(0,), (4,), (0,)]]
    counts = {}
    for one in known:
        for code, best in zip(state_contexts(one.task, encoding).tolist(), one.best, strict=True):
            counts[code] = counts.get(code, 0) + best.astype(int)
    prior = exact_prior(known, encoding, 0.1)
    acting = [code for code, count in counts.items() if count.any()]
    assert len(prior) == len(acting)
    np.testing.assert_array_equal(prior.counts(acting), [counts[code] for code in acting])
