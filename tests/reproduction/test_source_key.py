"""The code a result rests on: all it imports at whatever depth, and not what draws it."""

import shutil

import pytest

from reproduction.engine.source_key import ROOTS, source_key

LATTICE = "reproduction.chapter3.c3_02_lattice_prior.run"
SUBSTRUCTURE = "reproduction.chapter2.c2_09_substructure.run"


MODEL = "perception/relations/models/tabletop.npz"


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("copy") / "lifelore"
    return shutil.copytree(ROOTS["lifelore"], folder, ignore=shutil.ignore_patterns("__pycache__"))


@pytest.mark.parametrize(
    ("name", "changed", "matters"),
    [
        (LATTICE, "core/compiled/random_state.py", True),
        (LATTICE, "domains/grids/grid_world.py", True),
        (LATTICE, "figures/style.py", False),
        (LATTICE, "core/errors.py", True),
        (LATTICE, MODEL, False),
        (SUBSTRUCTURE, MODEL, True),
    ],
)
def test_the_key_changes_with_the_code_and_the_models_it_rests_on(copy, monkeypatch, name, changed, matters):
    before = source_key(name)
    fresh, content = source_key.__wrapped__, (copy / changed).read_bytes()
    monkeypatch.setitem(ROOTS, "lifelore", copy)
    assert fresh(name) == before
    (copy / changed).write_bytes(content + b"# changed\n")
    assert (fresh(name) != before) is matters
    (copy / changed).write_bytes(content)
