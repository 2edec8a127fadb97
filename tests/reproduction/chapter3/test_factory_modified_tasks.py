"""Tasks of the modified factory and priors from their exact policies."""

import numpy as np

from lifelore.domains.factory.factory import RAW
from reproduction.chapter3.factory.learning import contexts_of
from reproduction.chapter3.factory.modified_tasks import exact_priors, problem_of

SETTINGS = {"discount": 0.99, "components": 1, "policies": [3, 1]}
NAMES = (3, "tasks", "training")


def test_a_problem_is_solved_from_start_to_end():
    problem = problem_of({"discount": 0.99, "components": 2}, (5, "C3.7"))
    n_cells = problem.task.factory.n_cells
    assert problem.way[0] == problem.tables.starts[0] == problem.task.factory.start
    assert (problem.task.stages[problem.way[0] // n_cells] == RAW).all()
    # Two items procured and assembled pay 40 and completion 100; every other step of the way costs 2.
    assert problem.optimal == 140 - 2 * (len(problem.way) - 4)
    assert not problem.best[problem.task.completed].any()
    assert problem.best[~problem.task.completed].any(axis=1).all()
    # φ2 is four of the 3×3 cells, each of four kinds.
    assert contexts_of(problem, "phi2").max() < 4**4


def test_pooled_counts_by_a_slow_tally():
    tally = {}
    for i in range(3):
        problem = problem_of(SETTINGS, (*NAMES, i))
        codes = contexts_of(problem, "phi3")
        for state in np.flatnonzero(~problem.task.completed):
            row = tally.setdefault(int(codes[state]), np.zeros(6))
            row += problem.best[state]
    prior = exact_priors(SETTINGS, NAMES, ["phi3"])["phi3", 3]
    assert prior.contexts.tolist() == sorted(tally)
    np.testing.assert_array_equal(prior.counts(sorted(tally)), [tally[code] for code in sorted(tally)])
