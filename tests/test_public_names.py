"""What `lifelore` promises can be imported, and costs nothing until it is used."""

import inspect
import subprocess
import sys
from importlib import import_module

import pytest

import lifelore


def test_every_public_name_exists_and_is_documented():
    for name in lifelore.__all__:
        value = getattr(lifelore, name)
        assert name == "__version__" or inspect.getdoc(value), name
    assert set(dir(lifelore)) == set(lifelore.__all__)


ROOMS = {
    "action": {"ActionPrior", "prior_rows", "Advisor", "reachable_states", "independent_features"},
    "core": {"Tables", "optimal_q", "best_actions", "QLearning"},
    "interaction": {"PolicyLibrary", "BayesianPolicyReuse", "Beat", "ProbabilisticPolicyReuse"},
    "perception": {"LabelledCloud", "perceived_scene", "contact_networks", "RelationClassifier", "read_cloud"},
}


@pytest.mark.parametrize("name", ROOMS)
def test_what_a_room_exports_exists_is_documented_and_is_what_the_package_exports(name):
    room = import_module(f"lifelore.{name}")
    assert set(room.__all__) >= ROOMS[name]
    assert set(room.__all__) == set(room._HOME)
    for public in room.__all__:
        assert inspect.getdoc(getattr(room, public)), public
        assert getattr(lifelore, public, getattr(room, public)) is getattr(room, public), public
    assert set(room.__all__) <= set(dir(room))


def test_importing_the_package_imports_nothing_heavy():
    heavy = ("numba", "numpy", "matplotlib", "sqlite3", "gymnasium", "scipy", "typer")
    rooms = ", ".join(f"lifelore.{name}" for name in ROOMS)
    code = f"import sys, {rooms}; print([name for name in {heavy} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "[]"


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
