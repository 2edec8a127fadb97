"""Runs every kernel of the core on small worlds and saves all arrays: ``python kernels_run.py OUT.npz``.

Started by the tests in processes of their own, compiled and as plain Python.
"""

import importlib.util
import sys
from pathlib import Path

import numpy as np


def _twins():
    spec = importlib.util.spec_from_file_location("twins", Path(__file__).with_name("conftest.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def all_arrays() -> dict[str, np.ndarray]:
    """Every array that the kernels leave behind, by name."""
    from lifelore.core.compiled.random_state import next_uniform, random_state
    from lifelore.core.learning.curve import new_curve
    from lifelore.core.learning.known_world import WorldModel, best_known_actions, unknown_world
    from lifelore.core.learning.model_learning import ExplorationStrategy, StateInfo, explore, new_model_learner
    from lifelore.core.learning.q_learning import Schedule, learn, new_learner, uniform_rows
    from lifelore.core.learning.sight_search import explore_by_sight, new_sight_search
    from lifelore.core.learning.tour_search import KnownTour
    from lifelore.core.planning.layered_planning import LayeredPlan, layered_q
    from lifelore.core.planning.planning import optimal_q, policy_values
    from lifelore.core.streams import stream

    twins, out = _twins(), {}
    random_world = twins.random_world
    state = random_state(stream(0, "state"))
    out["uniforms"] = np.array([next_uniform(state) for _ in range(50)])
    for n_outcomes in (1, 3):
        tables = random_world(n_outcomes, n_states=8, n_actions=3, n_outcomes=n_outcomes)
        random = np.random.default_rng(n_outcomes)
        rows = uniform_rows(tables, random.dirichlet(np.ones(3), 8), random.uniform(0.5, 2, (8, 3)))
        who, curve = new_learner(8, 3, stream(1, "w"), stream(1, "o")), new_curve(20)
        plan = Schedule(np.full(20, 0.3), np.full(20, 0.4), 30, 0.9)
        while learn(tables, rows, plan, who, curve, 100):
            pass
        q = optimal_q(tables, 0.9)
        values = policy_values(tables, random.integers(-1, 3, 8), 0.9)
        out |= _named(f"q-learning {n_outcomes}", (*who, *curve, q, values))
        tables = twins.random_layers(n_outcomes, n_layers=4, size=3, n_outcomes=n_outcomes)
        plan = LayeredPlan(_rows_of(tables, 3), 4, 3, 0.9)
        out |= _named(f"layers {n_outcomes}", (layered_q(tables, 3, 0.9), *(plan.q(i) for i in range(4))))
    tables = random_world(1, n_states=15, n_actions=3)
    seen = StateInfo(np.arange(15), np.zeros(15, np.int32), np.array([[0.0, 1.0, 4.0]]))
    for strategy in (
        ExplorationStrategy(),
        ExplorationStrategy(planned=False),
        ExplorationStrategy(exhaustive=True),
        ExplorationStrategy(senses=True),
    ):
        model, explorer = unknown_world(15, 3), new_model_learner(15, 3, stream(2, "w"), stream(2, "o"))
        curve = new_curve(12)
        while explore(tables, model, seen, strategy, explorer, curve, 30, 0.9, 50):
            pass
        best = best_known_actions(model, explorer.place)
        out |= _named(f"{strategy}", (*model, *explorer, *curve, best))
    visible = np.random.default_rng(3).random((15, 15)) < 0.2
    visible |= visible.T | np.eye(15, dtype=bool)
    begin, states = np.r_[0, np.cumsum(visible.sum(axis=1))], np.nonzero(visible)[1].astype(np.int32)
    for exhaustive in (False, True):
        model, explorer = unknown_world(15, 3), new_model_learner(15, 3, stream(2, "w"), stream(2, "o"))
        curve, search = new_curve(12), new_sight_search(begin, states, tables, model)
        strategy = ExplorationStrategy(exhaustive=exhaustive)
        while explore_by_sight(tables, model, seen, strategy, explorer, search, curve, 30, 0.9, 50):
            pass
        out |= _named(f"by sight {exhaustive}", (*model, *explorer, *search, *curve))
    square = np.arange(36).reshape(6, 6)
    moves = np.stack([square[[0, 0, 1, 2, 3, 4]], square[[1, 2, 3, 4, 5, 5]]], axis=-1)
    moves = np.concatenate(
        [moves, np.stack([square[:, [0, 0, 1, 2, 3, 4]], square[:, [1, 2, 3, 4, 5, 5]]], -1)], -1
    )
    cells = np.argwhere(square >= 0)
    known = KnownTour.of(WorldModel(moves.reshape(36, 4).astype(np.int32), np.zeros(36, np.int64)), cells)
    looked = (np.arange(36) % 5 == 0).astype(np.int8)
    out |= _named("tour", (*known.near, known.tour, known.order(looked, 7)))
    return out


def _rows_of(tables, size):
    """The rows of one layer of `size` states."""

    def rows(layer):
        here = slice(layer * size, (layer + 1) * size)
        return type(tables)(*(table[here] for table in tables[:3]), *tables[3:])

    return rows


def _named(name: str, arrays) -> dict[str, np.ndarray]:
    return {f"{name} {i}": array for i, array in enumerate(arrays)}


if __name__ == "__main__":
    np.savez(sys.argv[1], **all_arrays())  # type: ignore[arg-type]
