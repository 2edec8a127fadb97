"""Compiled equals plain Python to the bit, and the cache of compiled kernels never answers for older source."""

import ast
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import lifelore
from lifelore.core.compiled.kernel_cache import STALE_DAYS, kernel_cache_dir, kernel_sources, remove_stale
from lifelore.core.compiled.numba_internals import quick_cache

from .fresh_python import run

KERNELS_RUN = Path(__file__).parents[1] / "kernels_run.py"
PACKAGE = Path(lifelore.__file__).parent
MARK = re.compile(rb"@(?:stored_)?kernel")

DRAWING = """
from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform

@kernel(allocates=False)
def draw(state, out):
    for i in range(out.size):
        out[i] = next_uniform(state)
"""
"""A kernel that calls a kernel of another file, and compiles in a tenth of the time of a learner."""

DRAW = """
import sys
import numpy as np
import lifelore
from lifelore.core.drawing import draw
assert lifelore.__file__.startswith(sys.argv[1]), lifelore.__file__
state, out = np.array([1, 2], np.uint64), np.zeros(50)
draw(state, out)
print(out.sum(), state[0])
"""


@pytest.mark.slow
def test_compiled_and_plain_python_agree_to_the_bit(tmp_path):
    run(str(KERNELS_RUN), str(tmp_path / "compiled.npz"), NUMBA_DISABLE_JIT="0")
    run(str(KERNELS_RUN), str(tmp_path / "plain.npz"), NUMBA_DISABLE_JIT="1")
    with np.load(tmp_path / "compiled.npz") as compiled, np.load(tmp_path / "plain.npz") as plain:
        assert set(compiled) == set(plain)
        assert len(compiled.files) > 50
        for name in compiled:
            assert compiled[name].dtype == plain[name].dtype, name
            assert np.array_equal(compiled[name], plain[name]), name
        assert any(compiled[name].any() for name in compiled if name.startswith("ExplorationStrategy"))


@pytest.fixture
def copied(tmp_path):
    """A copy of the package with the kernel `DRAWING`, and what `DRAW` prints with it in a fresh process."""
    package = tmp_path / "lifelore"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
    (package / "core" / "drawing.py").write_text(DRAWING)

    def draw(**environment) -> str:
        paths = {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "NUMBA_DISABLE_JIT": "0"}
        return run("-c", DRAW, str(package), **(paths | environment))

    return package, draw


def edit(path: Path, old: str, new: str) -> None:
    source = path.read_text()
    assert source.count(old) == 1
    path.write_text(source.replace(old, new))


@pytest.mark.slow
def test_an_edit_elsewhere_is_never_answered_by_an_older_kernel(copied):
    package, draw = copied
    cache = package.parent / "cache"
    first = draw()
    kept = {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb*")}
    assert kept
    assert draw() == first
    assert {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb*")} == kept  # nothing compiled again
    # A constant of a function that the kernel calls: other draws.
    edit(
        package / "core" / "compiled" / "random_state.py",
        "np.uint64(37), np.uint64(27)",
        "np.uint64(36), np.uint64(28)",
    )
    second = draw()
    assert second != first
    assert second == draw(NUMBA_DISABLE_JIT="1")


def test_the_cache_is_named_after_all_that_kernels_read(tmp_path):
    package = tmp_path / "lifelore"
    (package / "room").mkdir(parents=True)
    files = {
        "room/a.py": "from lifelore.room.b import ONE\nimport numpy\n@kernel\ndef f(): return ONE\n",
        "room/b.py": "import numpy, lifelore.room.c\nONE = 1\n",
        "room/c.py": "def g():\n    from lifelore.room import (\n        x,\n        d,\n    )\n",
        "room/d.py": "",
        "room/stranger.py": "from lifelore.room import a\n",
    }
    for name, source in files.items():
        (package / name).write_text(source)
    found = {path.relative_to(package).as_posix() for path in kernel_sources(package)}
    assert found == {"room/a.py", "room/b.py", "room/c.py", "room/d.py"}
    # The bits of an event are constants that kernels of other files read.
    assert PACKAGE / "core" / "mdp.py" in kernel_sources(PACKAGE)


@pytest.mark.slow
def test_imports_are_found_as_python_finds_them(tmp_path):
    """The quick reading of import statements beside the parser, on this package and on unusual layouts."""

    def parsed(package: Path) -> set[Path]:
        found, waiting = set(), [path for path in kernel_sources(package) if MARK.search(path.read_bytes())]
        while waiting:
            path = waiting.pop()
            if path in found:
                continue
            found.add(path)
            for node in ast.walk(ast.parse(path.read_bytes())):
                names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
                if isinstance(node, ast.ImportFrom) and node.module:
                    names += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
                files = [package.joinpath(*name.split(".")[1:]).with_suffix(".py") for name in names]
                waiting += [file for file in files if file.is_file() and package in file.parents]
        return found

    assert parsed(PACKAGE) == set(kernel_sources(PACKAGE))
    package = tmp_path / "lifelore"
    package.mkdir()
    for name in "bcdef":
        (package / f"{name}.py").write_text("")
    layouts = (
        "from lifelore import (  # the bits (see b)\n    b,\n    c,\n)\n"
        "from lifelore import d, \\\n    e\nimport numpy, lifelore.f\n@kernel\ndef g(): pass\n"
    )
    (package / "a.py").write_text(layouts)
    assert {path.stem for path in kernel_sources(package)} == set("abcdef")
    assert parsed(package) == set(kernel_sources(package))


def test_every_kernel_lies_in_the_cache_folder():
    from lifelore.core.learning import model_learning, q_learning
    from lifelore.core.planning import planning

    for function in (q_learning.learn, model_learning.explore, planning._sweep):
        assert Path(function.stats.cache_path).is_relative_to(kernel_cache_dir())  # type: ignore[attr-defined]


def test_numba_still_has_what_makes_kernels_quick():
    """A failure here means that a Numba release changed its insides: kernels still run, but slower."""
    assert quick_cache() is not None


NO_INTERNALS = """
import sys
import numba.core.caching
del numba.core.caching.CompileResultCacheImpl
from lifelore.core.compiled.numba_internals import quick_cache
assert quick_cache() is None
"""


@pytest.mark.slow
def test_without_the_insides_of_numba_everything_works_the_same(copied):
    package, draw = copied
    plain = draw(NUMBA_DISABLE_JIT="1")
    (package.parent / "fallback.py").write_text(NO_INTERNALS)
    source = f"exec(open({str(package.parent / 'fallback.py')!r}).read()){DRAW}"
    paths = {"PYTHONPATH": str(package.parent), "NUMBA_CACHE_DIR": str(package.parent / "slow")}
    slow = [run("-c", source, str(package), NUMBA_DISABLE_JIT="0", **paths) for _ in range(2)]
    assert slow == [plain, plain]
    assert list((package.parent / "slow").rglob("*.nbc"))


ALLOCATING = """
import numpy as np
from lifelore.core.compiled.jit import kernel

@kernel(allocates=False)
def make(n):
    return np.zeros(n)
make(3)
"""


@pytest.mark.slow
def test_a_kernel_that_makes_an_array_is_refused_where_it_must_not(tmp_path):
    """The compiler holds a kernel to ``allocates=False``."""
    (tmp_path / "allocating.py").write_text(ALLOCATING)
    command = [sys.executable, str(tmp_path / "allocating.py")]
    done = subprocess.run(
        command, env=os.environ | {"NUMBA_DISABLE_JIT": "0"}, capture_output=True, text=True, check=False
    )
    assert done.returncode != 0
    assert "Only accept returning of array passed into the function as argument" in done.stderr


@pytest.mark.slow
def test_compiled_kernels_travel_with_their_folder(copied, tmp_path):
    """Another place, newer files, a folder that cannot be written: the machine code is loaded, not made again."""
    package, draw = copied
    first = draw()
    cache, other = package.parent / "cache", tmp_path / "other"
    shutil.copytree(package, other / "lifelore", ignore=shutil.ignore_patterns("__pycache__"))
    for path in (other / "lifelore").rglob("*.py"):
        os.utime(path)
    kept = {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb*")}
    said = run(
        "-c",
        DRAW + "print(sum(draw.stats.cache_misses.values()))",
        str(other),
        PYTHONPATH=str(other),
        NUMBA_CACHE_DIR=str(cache),
        NUMBA_DISABLE_JIT="0",
    )
    assert said.split() == [*first.split(), "0"]
    assert {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb*")} == kept


@pytest.mark.slow
def test_kernels_run_where_nothing_can_be_kept(copied):
    package, draw = copied
    blocked = package.parent / "blocked"
    blocked.write_text("a file where the folder should be")
    assert draw(NUMBA_CACHE_DIR=str(blocked)) == draw(NUMBA_DISABLE_JIT="1")


def test_folders_of_other_versions_go_after_a_month_without_use(tmp_path):
    month = 24 * 3600 * (STALE_DAYS + 1)
    ages = {"kernels-" + "a" * 16: month, "kernels-" + "b" * 16: 3600, "kernels-mine": month, "other": month}
    for name, age in ages.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "index.nbi").write_text("")
        then = time.time() - age
        os.utime(tmp_path / name, (then, then))
    keep = tmp_path / ("kernels-" + "c" * 16)
    keep.mkdir()
    os.utime(keep, (0, 0))
    remove_stale(tmp_path, keep)
    assert {path.name for path in tmp_path.iterdir()} == {*ages, keep.name} - {"kernels-" + "a" * 16}


def test_a_use_is_noted_and_clears_up(tmp_path, monkeypatch):
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    used = kernel_cache_dir.__wrapped__()
    stale = tmp_path / ("kernels-" + "0" * 16)
    stale.mkdir()
    for folder in (used, stale):
        os.utime(folder, (0, 0))
    assert kernel_cache_dir.__wrapped__() == used
    assert list(tmp_path.iterdir()) == [used]
    assert time.time() - used.stat().st_mtime < 24 * 3600
