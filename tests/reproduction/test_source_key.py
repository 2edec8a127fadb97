"""The key changes with the code and the models that results rest on."""

import shutil

import pytest

from reproduction.engine.provenance import ROOTS, source_key


@pytest.mark.parametrize("changed", ["core/errors.py", "perception/relations/models/tabletop.npz"])
def test_the_key_changes_with_code_and_models(tmp_path, monkeypatch, changed):
    copy = shutil.copytree(ROOTS["lifelore"], tmp_path / "copy", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setitem(ROOTS, "lifelore", copy)
    fresh = source_key.__wrapped__
    assert fresh() == source_key()
    (copy / changed).write_bytes((copy / changed).read_bytes() + b"# changed\n")
    assert fresh() != source_key()
