"""Compiled equals plain Python to the bit, and the cache of compiled kernels never answers for older source."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lifelore
from lifelore.core import jit

KERNELS_RUN = Path(__file__).with_name("kernels_run.py")
PACKAGE = Path(lifelore.__file__).parent

DRAW = """
import sys
import numpy as np
from lifelore.core.curve import new_curve
from lifelore.core.mdp import Tables
from lifelore.core.q_learning import Schedule, learn, new_learner, uniform_rows
import lifelore
assert lifelore.__file__.startswith(sys.argv[1]), lifelore.__file__
tables = Tables(
    np.zeros((1, 2, 1), np.int32), np.zeros((1, 2, 1)), np.full((1, 2, 1), 2, np.uint8), np.ones(1),
    np.zeros(1, np.int32),
)
who, curve = new_learner(1, 2, np.random.default_rng(0), np.random.default_rng(1)), new_curve(1)
learn(tables, uniform_rows(tables), Schedule(np.ones(1), np.ones(1), 50, 0.9), who, curve, 50)
print(who.visits[0, 0], who.own_random[0])
"""


def run(*arguments, **environment) -> str:
    """What a fresh Python prints, warnings being errors."""
    done = subprocess.run(
        [sys.executable, "-W", "error", *arguments],
        env=os.environ | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_compiled_and_plain_python_agree_to_the_bit(tmp_path):
    run(str(KERNELS_RUN), str(tmp_path / "compiled.npz"), NUMBA_DISABLE_JIT="0")
    run(str(KERNELS_RUN), str(tmp_path / "plain.npz"), NUMBA_DISABLE_JIT="1")
    with np.load(tmp_path / "compiled.npz") as compiled, np.load(tmp_path / "plain.npz") as plain:
        assert set(compiled) == set(plain)
        assert len(compiled.files) > 50
        for name in compiled:
            assert compiled[name].dtype == plain[name].dtype, name
            assert np.array_equal(compiled[name], plain[name]), name
        assert any(compiled[name].any() for name in compiled if name.startswith("Manner"))


@pytest.fixture
def copied(tmp_path):
    """A copy of the package, and what `DRAW` prints with it in a fresh process."""
    package = tmp_path / "lifelore"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))

    def draw(**environment) -> str:
        paths = {"PYTHONPATH": str(tmp_path), "NUMBA_CACHE_DIR": str(tmp_path / "cache"), "NUMBA_DISABLE_JIT": "0"}
        return run("-c", DRAW, str(package), **(paths | environment))

    return package, draw


def edit(path: Path, old: str, new: str) -> None:
    source = path.read_text()
    assert source.count(old) == 1
    path.write_text(source.replace(old, new))


def test_an_edit_elsewhere_is_never_answered_by_an_older_kernel(copied):
    package, draw = copied
    cache = package.parent / "cache"
    first = draw()
    kept = {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb*")}
    assert kept
    assert draw() == first
    assert {path: path.stat().st_mtime_ns for path in cache.rglob("*.nb*")} == kept  # nothing compiled again
    # A constant of a function that the kernel calls: other draws.
    edit(package / "core" / "random_state.py", "np.uint64(37), np.uint64(27)", "np.uint64(36), np.uint64(28)")
    second = draw()
    assert second != first
    assert second == draw(NUMBA_DISABLE_JIT="1")


def test_the_cache_is_named_after_all_that_kernels_read(tmp_path):
    package = tmp_path / "lifelore"
    (package / "room").mkdir(parents=True)
    files = {
        "room/a.py": "from lifelore.room.b import ONE\nimport numpy\n@kernel\ndef f(): return ONE\n",
        "room/b.py": "import lifelore.room.c\nONE = 1\n",
        "room/c.py": "from lifelore.room import d\n",
        "room/d.py": "",
        "room/stranger.py": "from lifelore.room import a\n",
    }
    for name, source in files.items():
        (package / name).write_text(source)
    found = {path.relative_to(package).as_posix() for path in jit._sources(package)}
    assert found == {"room/a.py", "room/b.py", "room/c.py", "room/d.py"}
    # The bits of an event are constants that kernels of other files read.
    assert PACKAGE / "core" / "mdp.py" in jit._sources(PACKAGE)


def test_every_kernel_lies_in_the_cache_folder():
    from lifelore.core import model_learning, planning, q_learning

    for function in (q_learning.learn, model_learning.explore, planning._sweep):
        assert Path(function.stats.cache_path).is_relative_to(jit.kernel_cache_dir())  # type: ignore[attr-defined]
