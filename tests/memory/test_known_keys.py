"""Contributions of a single *newest* record of a known key, which the cache takes in by one statement."""

import numpy as np

from lifelore.core.protocols import Record
from lifelore.memory import open_memory

NAME = "user", "ann", 1


def one(slots: dict[int, int], about: str = "x") -> Record:
    cells = np.array(list(slots.items()), np.int64).reshape(-1, 2)
    return Record(*NAME, "newest", cells[:, 0], cells[:, 1], {"note": about})


def give(memory, seq, record, robot="r"):
    before = memory.statements
    assert memory.contribute(robot, [record], process=f"p{seq}", seq=0, task={})
    return memory.statements - before


def test_only_the_first_contribution_and_another_description_cost_more(memory):
    costs = [give(memory, seq, one({seq: seq, 0: seq}, "xxyyx"[seq])) for seq in range(5)]
    assert costs == [5, 2, 5, 2, 5]
    found = memory.recall(*NAME)
    assert dict(zip(found.slots.tolist(), found.values.tolist(), strict=True)) == {0: 4, 1: 1, 2: 2, 3: 3, 4: 4}
    assert found.about == {"note": "x"}
    assert memory.check() == []


def test_a_merged_contribution_from_in_between_does_not_give_the_description(memory, new_place, back_end):
    """The description is that of the newest contribution, which has not written it again."""
    with open_memory(new_place(back_end)) as other:
        give(memory, 0, one({1: 1}, "new"), "here")
        give(other, 0, one({1: 2, 2: 2}, "old"), "there")
        give(memory, 1, one({1: 3}, "new"), "here")
        memory.merge_from(other)
        assert memory.recall(*NAME).about == {"note": "new"}
        assert memory.recall(*NAME).values.tolist() == [3, 2]
        assert memory.check() == []
        give(other, 1, one({3: 4}, "later"), "there")
        memory.merge_from(other)
        assert memory.recall(*NAME).about == {"note": "later"}
        assert memory.check() == []


def test_forgetting_and_rebuilding_find_every_contribution(memory):
    for seq in range(6):
        give(memory, seq, one({seq: seq, 9: seq}), robot=f"robot {seq % 2}")
    assert memory.forget("robot 1") == 3
    found = memory.recall(*NAME)
    assert dict(zip(found.slots.tolist(), found.values.tolist(), strict=True)) == {0: 0, 2: 2, 4: 4, 9: 4}
    assert memory.check() == []
    assert give(memory, 6, one({6: 6})) == 2
    memory.rebuild()
    assert memory.check() == []
    assert give(memory, 7, one({7: 7})) == 2
    assert memory.forget_records([NAME]) == 5
    assert memory.recall(*NAME) is None
    assert memory.check() == []


def test_a_large_record_and_other_merges_take_the_long_way(memory):
    costs = [give(memory, seq, one(dict.fromkeys(range(40), seq))) for seq in range(2)]
    assert min(costs) > 40
    assert memory.recall(*NAME).values.tolist() == [1] * 40
    for seq in range(2, 4):
        added = Record("prior", "b7", 1, "add", np.array([1]), np.array([5]))
        assert memory.contribute("r", [added], process=f"p{seq}", seq=0, task={})
    assert memory.recall("prior", "b7", 1).values.tolist() == [10]
    assert memory.check() == []
