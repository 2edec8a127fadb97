"""The hand-made priors of Fig. 3.7 and the invariances of §3.4.2."""

import numpy as np
import pytest

from lifelore.domains.factory.contexts import TO_PROCURE, items_flag
from lifelore.domains.factory.factory import ASSEMBLE, PROCURE
from lifelore.domains.factory.layout import factory
from lifelore.domains.factory.modified_factory import modified_factory
from reproduction.chapter3.c3_04_factory_priors.knowledge import (
    distances,
    expert_actions,
    incorrect_actions,
    invariances,
)

EAST, WEST = 2, 3
WORLDS = {"thesis": factory(), "modified": modified_factory(np.random.default_rng(4))}
EVERY = pytest.mark.parametrize("world", WORLDS.values(), ids=WORLDS)


def line():
    return factory("###########\n#.1.2S+.ab#\n###########")


def test_the_expert_on_a_line_by_hand():
    task = line().task([0, 1])
    raw = expert_actions(task).reshape(9, 9, 6)[0]
    advised = [np.flatnonzero(row).tolist() for row in raw]
    # The area of procurement is 1 to 3 (from the point 1 to the point 2); to it from both sides, within it freely.
    assert advised == [[EAST], [EAST, PROCURE], [EAST, WEST], [WEST, PROCURE], *[[WEST]] * 5]
    procured = expert_actions(task).reshape(9, 9, 6)[4]
    advised = [np.flatnonzero(row).tolist() for row in procured]
    assert advised == [*[[EAST]] * 7, [EAST, ASSEMBLE], [WEST, ASSEMBLE]]
    wrong = incorrect_actions(task).reshape(9, 9, 6)
    assert np.array_equal(wrong[0], procured)
    assert np.array_equal(wrong[4], raw)
    assert not wrong[8].any()


@EVERY
def test_advice_leads_to_the_area_and_into_no_wall(world):
    task = world.task([1, 6, 7])
    n = task.n_configurations
    flags = items_flag(task)
    refused = np.tile(world.floor.neighbour < 0, (n, 1))
    for advise, swapped in ((expert_actions, False), (incorrect_actions, True)):
        advice = advise(task)
        assert advice.shape == (task.domain.n_states, 6)
        assert not (advice[:, :4] & refused).any()
        assert np.array_equal(advice.any(axis=1), ~task.completed)
        by_configuration = advice.reshape(n, world.n_cells, 6)
        for configuration in (0, 13):
            procuring = (flags[configuration] == TO_PROCURE) != swapped
            area = world.procure_area if procuring else world.assemble_area
            here = by_configuration[configuration]
            assert (here[~area].sum(axis=1) == 1).all()
            cell, walked = world.start, 0
            while not area[cell]:
                cell, walked = world.floor.neighbour[cell, here[cell].argmax()], walked + 1
            assert walked == distances(world, area)[world.start] or area[world.start]


def test_invariances_by_hand_on_a_line():
    task = line().task([0])
    rules = invariances(task)
    flat = np.full((27, 6), 1 / 6)
    # North and south are walls everywhere, west at the left end, east at the right: 2 of 6, and 2 cells with 3.
    assert rules["wall moves"].mass(flat) == pytest.approx((7 * 2 + 2 * 3) / 9 / 6)
    # Two points of one kind and two of the other: of 18 uses in 9 cells 4 are in place.
    assert rules["uses elsewhere"].mass(flat) == pytest.approx(14 / 9 / 6)
    # A choice between the route, S and +, and a free cell: on the two and on either side of them.
    assert np.flatnonzero(rules["express routes"].states[:9]).tolist() == [3, 4, 5, 6]
    chosen = [np.flatnonzero(row).tolist() for row in rules["express routes"].actions[3:7]]
    assert chosen == [[EAST], [EAST], [WEST], [WEST]]
    assert np.flatnonzero(rules["procurement first"].states).tolist() == [0, 4, 5, 6, 7, 8]
    assert np.flatnonzero(rules["then assembly"].states).tolist() == [9 + cell for cell in range(7)]
