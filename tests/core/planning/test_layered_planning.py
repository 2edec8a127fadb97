"""Layer by layer equals sweeps over everything; a corridor by hand; only what is asked for is solved."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lifelore.core import NOTHING, InputError, Tables, optimal_q
from lifelore.core.planning.layered_planning import LayeredPlan, layered_q

seeds = st.integers(0, 10**6)
SIZE = 4


def rows_of(tables: Tables, size: int):
    """The rows of a layer, cut out of the whole tables."""
    return lambda layer: tables._replace(
        **{
            name: getattr(tables, name)[layer * size : (layer + 1) * size]
            for name in ("next_state", "reward", "event")
        }
    )


@pytest.mark.slow
@settings(max_examples=40, deadline=None)
@given(seeds, st.sampled_from([1, 3]), st.sampled_from([0.0, 0.5, 0.95]))
def test_same_as_sweeps_over_all_layers(draw_layers, seed, n_outcomes, discount):
    tables = draw_layers(seed, n_layers=5, size=SIZE, n_outcomes=n_outcomes)
    found, swept = layered_q(tables, SIZE, discount), optimal_q(tables, discount)
    assert found == pytest.approx(swept, abs=1e-9)
    # Values that are zero but for what the sweeps leave have no relative tolerance: ties are told absolutely.
    best, swept_best = (q >= q.max(axis=1, keepdims=True) - 1e-8 for q in (found, swept))
    assert np.array_equal(best, swept_best)
    plan = LayeredPlan(rows_of(tables, SIZE), 5, SIZE, discount)
    for layer in (2, 0, 4, 1, 3):
        here = slice(layer * SIZE, (layer + 1) * SIZE)
        assert plan.values(layer) == pytest.approx(found[here].max(axis=1), abs=1e-9)
        assert plan.q(layer) == pytest.approx(found[here], abs=1e-9)


def test_only_what_is_asked_for_is_solved(draw_layers):
    tables = draw_layers(3, n_layers=8, size=SIZE, reach=1)
    looked = []

    def rows(layer):
        looked.append(layer)
        return rows_of(tables, SIZE)(layer)

    plan = LayeredPlan(rows, 8, SIZE, 0.9)
    plan.values(5)
    assert set(looked) == set(np.flatnonzero(plan.solved)) <= {5, 6, 7}
    looked.clear()
    plan.values(6)
    plan.values(0)
    assert 7 not in looked[1:]  # known already, not looked at again
    assert plan.solved[0]


def test_misuse_is_told(draw_layers):
    tables = draw_layers(1, n_layers=3, size=SIZE)
    with pytest.raises(InputError, match="layer_size must divide the 12 states, got 5"):
        layered_q(tables, 5, 0.9)
    tables.next_state[5, 0, 0], tables.event[5, 0, 0] = 0, NOTHING
    with pytest.raises(InputError, match="state of layer 1 that leads to an earlier one"):
        layered_q(tables, SIZE, 0.9)
    plan = LayeredPlan(rows_of(tables, SIZE), 3, SIZE, 0.9)
    with pytest.raises(InputError, match="state of layer 1 that leads to an earlier one"):
        plan.values(1)
    for wrong in (-1, 3):
        with pytest.raises(InputError, match=r"layer must lie in \[0, 3\)"):
            plan.values(wrong)
