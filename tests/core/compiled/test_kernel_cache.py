"""The cache of compiled kernels never answers for older source, and works where nothing can be stored."""

import ast
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

import lifelore
from lifelore.core.compiled import kernel_cache
from lifelore.core.compiled.kernel_cache import STALE_DAYS, cache_folder, kernel_folder, kernel_sources

PACKAGE = Path(lifelore.__file__).parent

DRAWING = """
from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform

@kernel
def draw(state, out):
    for i in range(out.size):
        out[i] = next_uniform(state)
"""
"""A kernel that calls a kernel of another file, and compiles in a tenth of the time of a learner."""

DRAW = """
import sys
from threading import Thread
import numpy as np
import lifelore
from lifelore.core.drawing import draw
assert lifelore.__file__.startswith(sys.argv[1]), lifelore.__file__
state, out = np.array([1, 2], np.uint64), np.zeros(50)
thread = Thread(target=draw, args=(state, out))
thread.start()
thread.join()
print(out.sum(), state[0])
"""


@pytest.fixture
def copied(tmp_path):
    """A copy of the package with the kernel `DRAWING`, and the output of `DRAW` with it in a fresh process."""
    package = tmp_path / "lifelore"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    (package / "core" / "drawing.py").write_text(DRAWING)

    def draw(**environment) -> str:
        paths = {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "NUMBA_DISABLE_JIT": "0"}
        done = subprocess.run(
            [sys.executable, "-W", "error", "-c", DRAW, str(package)],
            env=os.environ | paths | environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout

    return package, draw


def edit(path: Path, old: str, new: str) -> None:
    source = path.read_text()
    assert source.count(old) == 1
    path.write_text(source.replace(old, new))


def stored(cache: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb*")}


@pytest.mark.slow
def test_an_edit_of_a_called_function_compiles_again(copied):
    package, draw = copied
    cache = package.parent / "cache"
    first = draw()
    before = stored(cache)
    assert before
    assert draw() == first
    assert stored(cache) == before  # nothing compiled again
    # A constant of a function that the kernel calls: other draws.
    edit(
        package / "core" / "compiled" / "random_state.py",
        "np.uint64(37), np.uint64(27)",
        "np.uint64(36), np.uint64(28)",
    )
    second = draw()
    assert second != first


@pytest.mark.slow
def test_kernels_run_where_nothing_can_be_stored(copied):
    package, draw = copied
    blocked = package.parent / "blocked"
    blocked.write_text("a file where the folder should be")
    assert draw(NUMBA_CACHE_DIR=str(blocked)) == draw(NUMBA_DISABLE_JIT="1")
    assert not stored(package.parent)


def kernel_files() -> list[Path]:
    return [path for path in PACKAGE.rglob("*.py") if b"\n@kernel" in path.read_bytes()]


def test_imports_are_found_as_python_finds_them():
    """The sources of every file with kernels beside those that a parser finds."""

    def parsed(source: Path) -> set[Path]:
        found, waiting = set(), [source]
        while waiting:
            path = waiting.pop()
            if path in found or not path.is_file():
                continue
            found.add(path)
            for node in ast.walk(ast.parse(path.read_bytes())):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
                if isinstance(node, ast.ImportFrom):
                    assert not node.level, f"{path} has a relative import"
                    names += [f"{node.module}{end}" for end in ("", ".__init__")]
                    names += [f"{node.module}.{alias.name}" for alias in node.names]
                places = [name.split(".") for name in names if name.startswith(f"{PACKAGE.name}.")]
                waiting += [PACKAGE.joinpath(*place[1:]).with_suffix(".py") for place in places if len(place) > 1]
        return found

    files = kernel_files()
    assert len(files) > 30
    for source in files:
        assert parsed(source) - kernel_sources(source) == set(), source
    # The bits of an event are constants that kernels of other files read.
    assert PACKAGE / "core" / "mdp.py" in kernel_sources(PACKAGE / "core" / "planning" / "planning.py")


def test_every_kernel_lies_in_the_folder_of_its_file():
    from lifelore.core.learning import model_learning, q_learning
    from lifelore.core.planning import planning

    for function in (q_learning.learn, model_learning.explore, planning._sweep):
        folder = kernel_folder(Path(function.__code__.co_filename))
        assert folder.parent == cache_folder()
        assert Path(function.stats.cache_path).is_relative_to(folder)  # type: ignore[attr-defined]


def test_the_folder_changes_with_any_source_and_old_ones_go_after_a_month(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    source = tmp_path / "area.py"
    folders = []
    for line in ("one = 1", "two = 2", "three = 3"):
        source.write_text(line)
        for cached in (kernel_cache.kernel_folder, kernel_cache._source):
            cached.cache_clear()
        folders.append(kernel_folder(source))
        if line == "one = 1":
            old = time.time() - (STALE_DAYS + 1) * 24 * 3600
            os.utime(folders[0], (old, old))
    assert len(set(folders)) == 3
    assert [folder.is_dir() for folder in folders] == [False, True, True]
