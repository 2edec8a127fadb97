"""The code a result rests on: all it imports at whatever depth, and not what draws it."""

import shutil

import pytest

from reproduction.engine.source_key import ROOTS, source_key

LATTICE = "reproduction.chapter3.c3_02_lattice_prior.run"
SUBSTRUCTURE = "reproduction.chapter2.c2_09_substructure.run"


@pytest.fixture
def copy(tmp_path, monkeypatch):
    shutil.copytree(ROOTS["lifelore"], tmp_path / "lifelore", ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setitem(ROOTS, "lifelore", tmp_path / "lifelore")
    return tmp_path / "lifelore"


@pytest.mark.parametrize(
    ("changed", "matters"),
    [
        ("core/compiled/random_state.py", True),
        ("domains/grids/grid_world.py", True),
        ("figures/style.py", False),
        ("core/errors.py", True),
    ],
)
def test_the_key_changes_with_the_code_it_rests_on(copy, changed, matters):
    fresh = source_key.__wrapped__
    before = fresh(LATTICE)
    assert before == source_key(LATTICE)
    with (copy / changed).open("a", encoding="utf-8") as file:
        file.write("# changed\n")
    assert (fresh(LATTICE) != before) is matters


@pytest.mark.parametrize(("name", "matters"), [(LATTICE, False), (SUBSTRUCTURE, True)])
def test_the_key_changes_with_the_trained_model_it_rests_on(copy, name, matters):
    fresh = source_key.__wrapped__
    before = fresh(name)
    with (copy / "perception" / "relations" / "models" / "tabletop.npz").open("ab") as file:
        file.write(b"more")
    assert (fresh(name) != before) is matters
