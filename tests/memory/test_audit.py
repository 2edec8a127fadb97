"""Each kind of damage inside a readable memory is found."""

import numpy as np
import pytest

from lifelore.core import Record, StoreError
from lifelore.memory import open_memory


@pytest.fixture
def lived(memory):
    for seq in range(3):
        records = [
            Record("k", merge, 1, merge, np.array([1, 2]), np.array([seq, 5])) for merge in ("add", "newest")
        ]
        memory.contribute("a", records, process="p", seq=seq, task={"index": seq})
    assert memory.check() == []
    return memory


CACHE_DAMAGE = [
    "UPDATE lifelore_cells SET value = value + 1 WHERE slot = 1",
    "DELETE FROM lifelore_cells WHERE slot = 2",
    "INSERT INTO lifelore_cells (lore, slot, value, origin) SELECT number, 77, 1, 0 FROM lifelore_lore",
    "INSERT INTO lifelore_cells (lore, slot, value, origin) VALUES (99, 1, 1, 0)",
    "DELETE FROM lifelore_mentions WHERE contribution = 1",
    "DELETE FROM lifelore_lore WHERE key = 'add'",
    "UPDATE lifelore_lore SET about = '[]' WHERE key = 'add'",
    "INSERT INTO lifelore_lore (kind, key, version, merge, about, origin) VALUES ('k', 'x', 1, 'add', '{}', 1)",
]


@pytest.mark.slow
@pytest.mark.parametrize("damage", CACHE_DAMAGE)
def test_a_wrong_cache_is_found_and_rebuilt(lived, damage):
    before = lived.show()
    with lived._store.writing() as conn:
        conn.execute(damage)
    assert lived.check()
    lived.rebuild()
    assert lived.check() == []
    assert lived.show() == before


@pytest.mark.parametrize(
    "damage",
    ["stamp = stamp + 1", "task = '{}'", "robot = 'b'", "seq = 17", "digest = 'no'",
     "blob = (SELECT blob FROM lifelore_contributions WHERE seq = 0)"],
)  # fmt: skip
def test_a_changed_contribution_is_found_and_never_merged(lived, damage, tmp_path):
    with lived._store.writing() as conn:
        conn.execute(f"UPDATE lifelore_contributions SET {damage} WHERE seq = 1")
    (problem,) = lived.check()
    assert "SHA-256" in problem
    with open_memory(tmp_path / "other.db") as other, pytest.raises(StoreError, match="SHA-256"):
        other.merge_from(lived)
    with pytest.raises(StoreError, match="SHA-256"):
        lived.export_to(tmp_path / "export.db")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["other.db"]


def test_a_forgotten_contribution_that_is_there_is_found(lived):
    with lived._store.writing() as conn:
        conn.execute("INSERT INTO lifelore_tombstones VALUES ('a', 'p', 1)")
    assert any("although it was forgotten" in problem for problem in lived.check())
