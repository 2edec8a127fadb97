"""`Memory.together`: many contributions in one transaction, all that succeed or none."""

import threading

import numpy as np
import pytest

from lifelore.core import InputError, Record, StoreError
from lifelore.memory import open_memory


def weights(value, merge="add", key="k"):
    return Record("action_prior", key, 1, merge, slots=np.array([1]), values=np.array([value]))


def contribute(memory, robot, value, seq=0, **options):
    return memory.contribute(robot, [weights(value, **options)], process="p", seq=seq, task={})


def total(memory):
    record = memory.recall("action_prior", "k", 1)
    return 0 if record is None else int(record.values.sum())


def test_contributions_are_stored_when_the_block_ends(memory, where):
    with open_memory(where) as other:
        with memory.together():
            assert contribute(memory, "rosie", 2)
            assert contribute(memory, "robby", 3)
            assert not contribute(memory, "robby", 3)
            assert (total(memory), total(other)) == (5, 0)
        assert total(other) == 5
    assert memory.check() == []


def test_an_error_that_leaves_the_block_undoes_all(memory):
    def block():
        with memory.together():
            contribute(memory, "rosie", 2)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        block()
    assert (total(memory), memory.robots()) == (0, [])
    assert contribute(memory, "rosie", 2)


def test_a_refused_contribution_leaves_the_others(memory):
    with memory.together():
        contribute(memory, "rosie", 2)
        with pytest.raises(StoreError):
            contribute(memory, "robby", 3, merge="newest")
        with pytest.raises(InputError):
            contribute(memory, "", 3)
        contribute(memory, "robby", 5)
    assert total(memory) == 7
    assert memory.check() == []


def test_other_threads_are_not_in_the_block(memory):
    seen = []
    with memory.together():
        contribute(memory, "rosie", 2)
        reader = threading.Thread(target=lambda: seen.append(total(memory)))
        reader.start()
        reader.join()
    assert seen == [0]
    assert total(memory) == 2
