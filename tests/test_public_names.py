"""What `lifelore` promises can be imported, and costs nothing until it is used."""

import inspect
import subprocess
import sys

import lifelore


def test_every_public_name_exists_and_is_documented():
    for name in lifelore.__all__:
        value = getattr(lifelore, name)
        assert name == "__version__" or inspect.getdoc(value), name
    assert set(dir(lifelore)) == set(lifelore.__all__)


def test_importing_the_package_imports_nothing_heavy():
    heavy = ("numba", "numpy", "matplotlib", "sqlalchemy", "gymnasium", "scipy", "typer")
    code = f"import sys, lifelore; print([name for name in {heavy} if name in sys.modules])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.strip() == "[]"
