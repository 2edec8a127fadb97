"""Forgetting records by key: exact in any order of merges, and replay-safe."""

import numpy as np
import pytest

from lifelore.core import NotFoundError, Record
from lifelore.memory import Memory, open_memory


def record(kind: str, key: str, value: int) -> Record:
    return Record(kind, key, 1, "newest", np.array([1]), np.array([value]))


def test_forgotten_records_go_for_good_and_the_others_stay(memory):
    both = [record("place", "a", 1), record("skill", "s", 2)]
    memory.contribute("rosie", both, process="p", seq=0, task={})
    assert memory.forget_records([("place", "a", 1)]) == 1
    assert memory.recall("place", "a", 1) is None
    assert memory.recall("skill", "s", 1).values.tolist() == [2]
    assert memory.show()["forgotten_records"] == 1
    assert not memory.contribute("rosie", both, process="p", seq=0, task={})  # a replay restores nothing
    assert memory.check() == []
    memory.rebuild()
    assert memory.recall("place", "a", 1) is None
    memory.contribute("rosie", [record("place", "a", 3)], process="p", seq=1, task={})  # learnt anew
    assert memory.recall("place", "a", 1).values.tolist() == [3]
    assert memory.check() == []
    with pytest.raises(NotFoundError, match="place/b"):
        memory.forget_records([("place", "b", 1)])


def test_forgotten_records_stay_forgotten_through_merges_in_any_order(tmp_path):
    def life(name: str) -> Memory:
        return open_memory(tmp_path / f"{name}.db")

    with life("home") as home, life("away") as away, life("late") as late:
        home.contribute("a", [record("place", "x", 1), record("skill", "s", 1)], process="p", seq=0, task={})
        away.merge_from(home)
        away.contribute("b", [record("place", "x", 5), record("place", "y", 6)], process="p", seq=0, task={})
        away.forget_records([("place", "y", 1)])
        home.forget_records([("place", "x", 1)])
        late.contribute("c", [record("place", "x", 7)], process="p", seq=0, task={})
        sources = {"home": home, "away": away, "late": late}
        found = []
        for order in (("home", "away", "late"), ("late", "away", "home"), ("away", "home", "late")):
            with life("-".join(order)) as union:
                for name in order:
                    union.merge_from(sources[name])
                assert union.check() == []
                # What was contributed before the forgetting is gone, also from memories that had not heard of it.
                assert union.recall("place", "y", 1) is None
                assert union.recall("place", "x", 1).values.tolist() == [7]
                assert union.recall("skill", "s", 1).values.tolist() == [1]
                with union._store.reading() as conn:
                    rows = conn.execute("SELECT robot, stamp, digest FROM lifelore_contributions")
                    found.append(sorted(tuple(row) for row in rows))
        with life("at-once") as union:
            union.merge_many([away, late, home])
            assert union.recall("place", "x", 1).values.tolist() == [7]
        assert found[0] == found[1] == found[2]
