"""A factory learnt with the configurations met only: the same as with all; nine components in little room."""

import numpy as np
import pytest

from lifelore.core.learning.layered_learning import LayeredLearning
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.learning.q_learning import uniform_rows
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import state_contexts
from lifelore.domains.factory.layout import factory


def streams():
    return {"world": stream(3, "world"), "own": stream(3, "own")}


def test_same_as_on_the_tables_of_the_whole_task():
    task = factory().task([0, 4, 8])
    random = np.random.default_rng(0)
    by_code = random.dirichlet(np.ones(6), 3**9)
    tables, plan = task.tables(), QLearning(episodes=60, max_steps=1000, epsilon_decay=0.95)

    def explore_of(configurations):
        return by_code[state_contexts(task, "global", configurations) // 400]

    rows = uniform_rows(tables, explore_of(np.arange(27)))
    whole, curve = plan.learn(tables, 0.99, **streams(), rows=rows)
    part = LayeredLearning(
        task.configuration_tables,
        task.n_configurations,
        task.factory.n_cells,
        explore_of=lambda configuration: explore_of([configuration]),
        **streams(),
    )
    for met, known in zip(part.learn(plan, 0.99), curve, strict=True):
        assert np.array_equal(met, known)
    assert np.array_equal(np.concatenate([part.q(i) for i in range(27)]), whole.q)
    assert curve.reached.any()


@pytest.mark.slow
def test_nine_components_are_learnt_among_the_configurations_met():
    task = factory().task(range(9))
    part = LayeredLearning(task.configuration_tables, 3**9, task.factory.n_cells, **streams())
    curve = part.learn(QLearning(episodes=400, max_steps=5000, epsilon_decay=0.95), 0.99)
    assert curve.reached[-20:].mean() > 0.5 > curve.reached[:20].mean()
    assert len(part.layers) < 3**9 / 8
    # What it holds grows with the configurations met: far below the 700 MB of all tables and Q.
    held = sum(array.nbytes for array in part._arrays.values())
    assert held < 150e6
