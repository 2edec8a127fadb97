"""What `lifelore` promises can be imported, and costs nothing until it is used."""

import ast
import inspect
import py_compile
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest

import lifelore

ROOMS = ("core", "perception", "action", "interaction", "domains", "bridges", "figures", "agent", "app")
DOORS = [f"lifelore.{room}" for room in ROOMS]
DOORS += ["lifelore.agent.personalise", "lifelore.domains.tabletop_job", "lifelore.interaction.evaluation"]


def test_every_public_name_exists_and_is_documented():
    for name in lifelore.__all__:
        value = getattr(lifelore, name)
        assert name == "__version__" or inspect.getdoc(value), name
    assert set(dir(lifelore)) == set(lifelore.__all__)


@pytest.mark.parametrize("name", DOORS)
def test_what_a_room_exports_exists_is_documented_and_is_what_the_package_exports(name):
    room = import_module(name)
    exported = set(room.__all__) - {"ENVIRONMENTS"}
    # A name for type checkers alone would be no export.
    imports = next(part for part in ast.parse(inspect.getsource(room)).body if isinstance(part, ast.If)).body
    assert exported == {alias.name for part in imports for alias in part.names}  # pyright: ignore
    for export in exported:
        value = getattr(room, export)
        assert not callable(value) or inspect.getdoc(value), export
        assert getattr(lifelore, export, value) is value, export
    assert set(room.__all__) <= set(dir(room))
    beside = {path.stem for path in Path(room.__path__[0]).iterdir()}
    assert not beside & exported, "a module of the same name hides an export once it is imported"
    with pytest.raises(AttributeError, match="has no attribute 'nothing'"):
        room.nothing  # noqa: B018


def test_every_public_name_has_an_example():
    """A doctest in the docstring of the name itself; pytest runs them with the modules."""
    public = {
        name: getattr(door, name) for door in map(import_module, ["lifelore", *DOORS]) for name in door.__all__
    }
    without = {
        name for name, value in public.items() if callable(value) and ">>>" not in (inspect.getdoc(value) or "")
    }
    assert without == set()


def test_a_room_without_its_source_exports_the_same_names(tmp_path):
    room = tmp_path / "room" / "__init__.py"
    room.parent.mkdir()
    room.write_text(inspect.getsource(import_module("lifelore.bridges")))
    py_compile.compile(str(room), str(room.with_suffix(".pyc")))
    room.unlink()
    code = "import room; print(room.__all__, room.PriorMask.__module__)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=tmp_path, check=True)
    names = import_module("lifelore.bridges").__all__
    assert found.stdout.strip() == f"{names} lifelore.bridges.prior_mask"


def test_importing_the_package_imports_nothing_heavy():
    heavy = ("numba", "numpy", "matplotlib", "sqlite3", "gymnasium", "scipy", "typer")
    rooms = "lifelore.perception, lifelore.action, lifelore.interaction"
    code = f"import sys, {rooms}; print([name for name in {heavy} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "[]"


def test_importing_the_worlds_registers_them_and_imports_nothing_beside_gymnasium():
    code = (
        "import sys, gymnasium; before = set(sys.modules); import lifelore.domains; "
        "assert 'lifelore/Building-v0' in gymnasium.registry; "
        "print({name.split('.')[0] for name in set(sys.modules) - before})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "{'lifelore'}\n"


def test_every_public_method_and_property_is_documented():
    classes = [value for name in lifelore.__all__ if inspect.isclass(value := getattr(lifelore, name))]
    members = [
        (f"{owner.__name__}.{name}", getattr(member, "__func__", getattr(member, "func", member)))
        for owner in classes
        for name, member in vars(owner).items()
        if not name.startswith("_")
    ]
    described = [(name, member) for name, member in members if callable(member) or isinstance(member, property)]
    assert len(described) > 50
    assert not [name for name, member in described if not inspect.getdoc(member)]
