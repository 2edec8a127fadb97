"""Finished cells: found again only where nothing they rest on has changed."""

import pytest

from lifelore.core.errors import StoreError
from reproduction.engine.cell_store import CellStore, write_atomically

CELL = {"run": 3, "schedule": [1.0, 0.98]}


def store(folder, **key):
    return CellStore(folder, {"claim": "C0.0", "seed": 0, **key})


def test_a_kept_cell_is_found_again_and_equals_what_was_put(tmp_path):
    put = store(tmp_path / "cells").put(CELL, {"x": 0.1 + 0.2}, 1.5)
    got = store(tmp_path / "cells").get(dict(reversed(CELL.items())))
    assert got == put == {"cell": CELL, "result": {"x": 0.1 + 0.2}, "seconds": 1.5}


def test_another_seed_or_cell_or_code_finds_nothing(tmp_path):
    store(tmp_path, code="a").put(CELL, {}, 0.0)
    assert store(tmp_path, code="a").get(CELL) is not None
    assert store(tmp_path, code="b").get(CELL) is None
    assert store(tmp_path, code="a", seed=1).get(CELL) is None
    assert store(tmp_path, code="a").get({**CELL, "run": 4}) is None


@pytest.mark.parametrize("text", ["", "{", "[]", '{"cell": {"run": 9}}'])
def test_a_damaged_cell_is_as_good_as_none(tmp_path, text):
    kept = store(tmp_path)
    kept.put(CELL, {}, 0.0)
    kept.path(CELL).write_text(text, encoding="utf-8")
    assert kept.get(CELL) is None


def test_nothing_half_written_is_left_and_the_folder_is_hidden_from_version_control(tmp_path):
    kept = store(tmp_path / "cells")
    kept.put(CELL, {}, 0.0)
    names = {path.name for path in kept.folder.iterdir()}
    assert names == {".gitignore", kept.path(CELL).name}
    assert (kept.folder / ".gitignore").read_text(encoding="utf-8") == "*\n"


def test_a_disk_that_refuses_is_one_line(tmp_path):
    (tmp_path / "cells").write_text("a file where the folder should be", encoding="utf-8")
    with pytest.raises(StoreError, match=r"cannot make .*; choose another place"):
        store(tmp_path / "cells").put(CELL, {}, 0.0)
    with pytest.raises(StoreError, match="cannot write"):
        write_atomically(tmp_path / "cells" / "x.json", "{}")
