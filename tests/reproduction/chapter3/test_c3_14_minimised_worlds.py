"""Tasks of one factory domain: paid and ended by their own list, transitions shared."""

import numpy as np

from lifelore.core.mdp import TERMINAL
from lifelore.domains.factory.factory import ASSEMBLE, PROCURE
from lifelore.domains.factory.layout import factory
from reproduction.chapter3.c3_14_minimised_domains.minimised_worlds import with_list


def test_a_list_within_a_larger_domain_by_hand():
    floor = factory()
    whole = floor.task([0, 1])
    base = whole.tables()
    tables, ended = with_list(base, whole.stages, [0])
    n = floor.n_cells

    def outcome(configuration, cell, action):
        s = configuration * n + cell
        return tables.next_state[s, action, 0] // n, tables.reward[s, action, 0], tables.event[s, action, 0]

    procure, assemble = floor.procure_at, floor.assemble_at
    assert outcome(0, procure[0], PROCURE) == (1, 10.0, 0)  # raw to procured, the task's own
    assert outcome(0, procure[1], PROCURE) == (3, -10.0, 0)  # another's: it works, and is no use
    assert outcome(1, assemble[0], ASSEMBLE) == (2, 110.0, TERMINAL)
    assert outcome(0, procure[0], ASSEMBLE) == (0, -10.0, 0)
    assert outcome(7, assemble[0], ASSEMBLE) == (8, 110.0, TERMINAL)  # 1 was assembled before
    assert np.flatnonzero(ended.reshape(-1, n)[:, 0]).tolist() == [2, 5, 8]
    assert (tables.event[ended] == TERMINAL).all()
    assert not tables.reward[ended].any()
    assert (tables.next_state == base.next_state).all()


def test_the_whole_list_is_the_factorys_own_task():
    floor = factory()
    whole = floor.task([2, 5])
    base = whole.tables()
    tables, ended = with_list(base, whole.stages, [0, 1])
    for name in ("next_state", "reward", "event", "starts"):
        np.testing.assert_array_equal(getattr(tables, name), getattr(base, name))
    assert (ended == whole.completed).all()
