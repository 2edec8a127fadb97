"""The factory: by hand, against a robot that keeps sets of what it has done, and solved exactly."""

import numpy as np
import pytest

from lifelore.core import COLLISION, NOTHING, TERMINAL, InputError, best_actions, optimal_q
from lifelore.domains.factory.factory import ASSEMBLE, ASSEMBLED, PROCURE
from lifelore.domains.factory.layout import factory

NORTH, SOUTH, EAST, WEST = range(4)
LINE = """
########
#S+12.a#
###b####
########
"""
"""Cells 0 to 5 from S to a, and 6, the b under the 1."""


def test_the_printed_rewards_one_by_one():
    world = factory(LINE)
    task = world.task([0])
    story = [
        (NORTH, -100.0, COLLISION),
        (ASSEMBLE, -10.0, NOTHING),
        (PROCURE, -10.0, NOTHING),
        (EAST, -1.0, NOTHING),  # onto the express route
        (WEST, -1.0, NOTHING),  # the start lies on it as well
        (EAST, -1.0, NOTHING),
        (EAST, -2.0, NOTHING),
        (PROCURE, 10.0, NOTHING),
        (PROCURE, -10.0, NOTHING),  # procured already
        (EAST, -2.0, NOTHING),
        (PROCURE, -10.0, NOTHING),  # not on the list
        (EAST, -2.0, NOTHING),
        (EAST, -2.0, NOTHING),
        (ASSEMBLE, 110.0, TERMINAL),
    ]
    state = int(task.starts[0])
    for action, reward, event in story:
        state, *what = task.domain.step(task.params, state, action, 0.0)
        assert what == [reward, event], (action, what)
    assert state == 2 * world.n_cells + 5
    # At the assembly point with nothing procured.
    assert task.domain.step(task.params, 5, ASSEMBLE, 0.0) == (5, -10.0, NOTHING)
    # It is over: whatever one does now ends at once, for nothing.
    assert [task.domain.step(task.params, state, a, 0.0) for a in range(6)] == [(state, 0.0, TERMINAL)] * 6


@pytest.mark.slow
@pytest.mark.parametrize("components", [[4], [0, 8], [1, 3, 5]])
def test_layer_by_layer_same_as_sweeps_over_everything(components):
    task = factory().task(components)
    tables = task.tables()
    found, swept, plan = task.optimal_q(tables), optimal_q(tables, 0.99), task.plan()
    assert found == pytest.approx(swept, abs=1e-9)
    best = best_actions(found)
    assert np.array_equal(best, best_actions(swept))
    for configuration in (task.n_configurations - 2, 1, 0):
        here = slice(configuration * task.factory.n_cells, (configuration + 1) * task.factory.n_cells)
        assert np.array_equal(plan.q(configuration), found[here])
        assert np.array_equal(best_actions(plan.q(configuration)), best[here])


def test_nine_components_on_demand():
    task = factory().task(range(9))
    # All assembled but two, which are procured: either, then the other, and what follows that is the end.
    configuration = 3**9 - 1 - 3**0 - 3**8
    plan = task.plan()
    values = plan.values(configuration)
    assert plan.solved.sum() == 3
    small = task.factory.task([0, 8])
    assert values == pytest.approx(small.plan().values(1 + 3), abs=1e-12)


def test_leaving_out_what_is_not_on_the_list_changes_no_value():
    """The thesis's state holds all components; one that is not listed may be procured there, for -10."""
    world = factory(LINE.replace("#S+12.a#", "#S+1..a#").replace("###b####", "###2.b##"))
    task, both = world.task([0]), world.task([0, 1])
    n = world.n_cells
    tables = both.tables()
    next_state, reward, event = (table.copy() for table in tables[:3])
    reward[(reward == 110.0) | (reward == 10.0)] = 10.0
    for s, a in np.ndindex(9 * n, 6):
        before, after = s // n, next_state[s, a, 0] // n
        event[s, a] &= 255 - TERMINAL
        if after - before in (3, 6):  # the other component
            reward[s, a] = -10.0
        if after % 3 == ASSEMBLED:
            reward[s, a], event[s, a] = (0.0, TERMINAL) if before % 3 == ASSEMBLED else (110.0, TERMINAL)
    full = optimal_q(tables._replace(reward=reward, event=event), 0.99).reshape(3, 3, n, 6)
    local = task.optimal_q().reshape(3, n, 6)
    for other in range(3):
        assert full[other].max(axis=-1) == pytest.approx(local.max(axis=-1), abs=1e-9)


def test_misuse_is_told():
    world = factory()
    for wrong in ([], [1, 1], [9], [-1]):
        with pytest.raises(InputError, match=r"components must be distinct and lie in \[0, 9\)"):
            world.task(wrong)
    for wrong in ([], [275], [-1]):
        with pytest.raises(InputError, match=r"starts must be cells in \[0, 275\)"):
            world.task([0], starts=wrong)
    assert world.task([0], starts=[3, 4]).starts.tolist() == [3, 4]
