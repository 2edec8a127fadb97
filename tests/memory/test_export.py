import numpy as np
import pytest

from lifelore.core import InputError, Record, StoreError
from lifelore.memory import open_memory


@pytest.fixture
def lived(memory):
    for seq, robot in enumerate("abab"):
        records = [Record("k", "y", 1, "add", np.array([seq, 9]), np.array([1, 2]), {"unit": "m"})]
        memory.contribute(robot, records, process="p", seq=seq, task={})
    memory.forget("b")
    return memory


def shown(memory):
    return {name: part for name, part in memory.show().items() if name != "location"}


def test_an_export_is_itself_a_memory(lived, tmp_path):
    with pytest.raises(StoreError, match=r"memory: the folder .*/out does not exist"):
        lived.export_to(tmp_path / "out" / "export.db")
    (tmp_path / "out").mkdir()
    assert lived.export_to(tmp_path / "out" / "export.db") == 2
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["export.db"]
    with open_memory(tmp_path / "out" / "export.db") as copy:
        assert shown(copy) == shown(lived)
        assert copy.check() == []
        assert not copy.contribute("b", [], process="p", seq=1, task={})


def test_importing_an_export_is_merging_it(lived, tmp_path):
    lived.export_to(tmp_path / "export.db")
    content = (tmp_path / "export.db").read_bytes()
    with open_memory(tmp_path / "other.db") as other:
        assert other.merge_from(tmp_path / "export.db") == {"added": 2, "already_there": 0, "forgotten": 0}
        assert other.merge_from(str(tmp_path / "export.db")) == {"added": 0, "already_there": 2, "forgotten": 0}
        assert shown(other) == shown(lived)
    assert (tmp_path / "export.db").read_bytes() == content
    assert sorted(path.name for path in tmp_path.iterdir()) == ["export.db", "other.db"]


def test_an_earlier_export_is_replaced_but_never_a_memory_in_use(lived, tmp_path):
    lived.export_to(tmp_path / "export.db")
    lived.contribute("c", [], process="p", seq=0, task={})
    assert lived.export_to(tmp_path / "export.db") == 3
    open_memory(tmp_path / "export.db").close()
    before = (tmp_path / "export.db").read_bytes()
    with pytest.raises(InputError, match="in use"):
        lived.export_to(tmp_path / "export.db")
    (tmp_path / "diary.txt").write_text("dear diary")
    with pytest.raises(StoreError, match="not a Lifelore memory"):
        lived.export_to(tmp_path / "diary.txt")
    assert (tmp_path / "export.db").read_bytes() == before
    assert (tmp_path / "diary.txt").read_text() == "dear diary"


def test_an_export_goes_to_a_file(lived):
    with pytest.raises(InputError, match="file"):
        lived.export_to("postgresql://localhost/lore")
