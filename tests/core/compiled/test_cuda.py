"""CUDA form of `step`: the processor's results on a simulated GPU, and code for a real one."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import lifelore

from .fresh_python import run

RUN = Path(__file__).with_name("cuda_run.py")
PACKAGE = Path(lifelore.__file__).parent
SIMULATED = {"NUMBA_ENABLE_CUDASIM": "1"}
REAL = {"NUMBA_ENABLE_CUDASIM": "0", "NUMBA_CUDA_LOW_OCCUPANCY_WARNINGS": "0"}


def check_all_moves(path: Path) -> None:
    """Moves in a file of `cuda_run` equal the scalar `step` of each task to the bit."""
    spec = importlib.util.spec_from_file_location("cuda_run", RUN)
    assert spec is not None
    assert spec.loader is not None
    cuda_run = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(cuda_run)
    with np.load(path) as moves:
        for name, task in cuda_run.tasks().items():
            step = getattr(task.domain.step, "py_func", task.domain.step)
            expected = [step(task.params, *pair) for pair in zip(*cuda_run.pairs(task), strict=True)]
            for what, values in zip(("states", "rewards", "events"), zip(*expected, strict=True), strict=True):
                assert moves[f"{name} {what}"].tolist() == [
                    value.item() if hasattr(value, "item") else value for value in values
                ], name
            assert {0, 1, 2} <= set(moves[f"{name} events"].tolist())


@pytest.mark.slow
def test_a_simulated_gpu_moves_as_the_processor_does(tmp_path):
    run(RUN, tmp_path / "moves.npz", **SIMULATED)
    check_all_moves(tmp_path / "moves.npz")


MISTAKES = """
import numpy as np
from lifelore.core.compiled.cuda import CudaTask, step_ptx
from lifelore.core.errors import InputError
from lifelore.domains.grids.lattice import lattice
task = lattice(7).task(goal=0)
gpu = CudaTask(task)
for pairs in (
    ([21], [0], [0.0]), ([2**32], [0], [0.0]), ([-1], [0], [0.0]), ([0], [4], [0.0]), ([0], [0], [1.0]),
    ([0], [0], [np.nan]), ([0, 1], [0], [0.0]), ([0.5], [0], [0.0]), ([[0]], [0], [0.0]),
):
    try:
        print("taken:", gpu.step_many(*pairs))
    except InputError as error:
        print(error)
print([array.dtype.name + str(array.shape) for array in gpu.step_many([], [], [])])
try:
    step_ptx(task)
except InputError as error:
    print(error)
"""


@pytest.mark.slow
def test_mistakes_are_refused_before_the_launch():
    states = "states must lie in [0, 21), got "
    uniforms = "uniforms must lie in [0, 1), got "
    assert run("-c", MISTAKES, **SIMULATED).splitlines() == [
        f"{states}21..21",
        f"{states}{2**32}..{2**32}",
        f"{states}-1..-1",
        "actions must lie in [0, 4), got 4..4",
        f"{uniforms}1.0..1.0",
        f"{uniforms}nan..nan",
        "states, actions and uniforms must be of one length, got 2, 1, 1",
        "states must be a list of int32, got float64 of shape (1,)",
        "states must be a list of int32, got int64 of shape (1, 1)",
        "['int32(0,)', 'float64(0,)', 'uint8(0,)']",
        "step_ptx compiles, and NUMBA_ENABLE_CUDASIM=1 interprets instead: leave the variable out",
    ]


WITHOUT = """
import sys
sys.modules["numba_cuda"] = None
from lifelore.core.errors import MissingExtraError
try:
    import lifelore.core.compiled.cuda
except MissingExtraError as error:
    print(error)
"""


@pytest.mark.slow
def test_without_the_library_the_extra_is_named():
    (line,) = run("-c", WITHOUT, **REAL).splitlines()
    assert "pip install 'lifelore[cuda]'" in line


def test_one_file_knows_cuda():
    """Import-linter sees `numba_cuda`, but not that `numba.cuda` is a module of its own."""
    files = [
        path
        for path in PACKAGE.rglob("*.py")
        if "numba.cuda" in (text := path.read_text("utf-8")) or "import cuda" in text
    ]
    assert [path.relative_to(PACKAGE).as_posix() for path in files] == ["core/compiled/cuda.py"]


COMPILED = f"""
import sys
sys.path.insert(0, {str(RUN.parent)!r})
from cuda_run import tasks
from lifelore.core.compiled.cuda import step_ptx
for name, task in tasks().items():
    for version in ((7, 5), (9, 0)):
        lines = step_ptx(task, version).splitlines()
        print(name, *(line for line in lines if line.startswith(".target") or "fma" in line))
"""


@pytest.mark.cuda
def test_every_step_compiles_for_a_gpu_and_adds_no_products():
    """A sum of a product in one rounding (fma) would not be the processor's result to the bit."""
    pytest.importorskip("numba_cuda")
    assert run("-c", COMPILED, **REAL).splitlines() == [
        f"{name} .target sm_{version}"
        for name in ("lattice", "noise", "factory", "pacman", "strip")
        for version in (75, 90)
    ]


@pytest.mark.cuda
def test_a_gpu_moves_as_the_processor_does(tmp_path):
    pytest.importorskip("numba_cuda")
    if run("-c", "from numba import cuda; print(cuda.is_available())", **REAL) != "True\n":
        pytest.skip("this machine has no GPU")
    run(RUN, tmp_path / "moves.npz", **REAL)
    check_all_moves(tmp_path / "moves.npz")
