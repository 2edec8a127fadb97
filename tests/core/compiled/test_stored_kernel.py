"""Stored kernels give the bits of plain Python, load without Numba, and never answer for older source."""

import os
import time
from pathlib import Path

import numpy as np
import pytest

from lifelore.core.compiled.kernel_cache import STALE_DAYS
from lifelore.core.compiled.machine_code import linked_address
from lifelore.core.compiled.stored_kernel import ArrayType, Signature, StoredKernel, kernel_part, stored_kernel

from .fresh_python import run

STEP = 0.1
compiles = pytest.mark.skipif(
    os.environ.get("NUMBA_DISABLE_JIT") == "1", reason="plain Python has no machine code"
)


@kernel_part
def damped(x):
    return x / (1.0 + x * x) + STEP


@stored_kernel("f8(f8[:, ::1], i8[::1], f8, i8)")
def total(rows, counts, factor, repeats):
    """Sum of damped numbers, and the number of rows in `counts`."""
    counts[0] = len(rows)
    found = 0.0
    for _ in range(repeats):
        for i in range(rows.shape[0]):
            for j in range(rows.shape[1]):
                found += damped(rows[i, j] * factor)
    return found


@stored_kernel("f8(f8)")
def inverse(x):
    return 1.0 / x


def test_a_signature_is_read():
    read = Signature.from_text("f8(f8[:, ::1], i4[::1], i8)")
    assert read.result == "f8"
    assert read.arguments == (ArrayType(np.dtype("f8"), 2), ArrayType(np.dtype("i4"), 1), "i8")
    assert len(read.c_types) == 2 + (5 + 4) + (5 + 2) + 1
    with pytest.raises(ValueError, match="signature must look like"):
        Signature.from_text("f8[::1]")


@compiles
def test_machine_code_gives_the_bits_of_plain_python(monkeypatch):
    monkeypatch.setattr(
        StoredKernel, "dispatcher", property(lambda kernel: pytest.fail("Numba's version was asked"))
    )
    rows, counts = np.random.default_rng(0).normal(size=(7, 3)), np.zeros(1, np.int64)
    assert total(rows, counts, np.float64(0.3), np.int64(2)) == total.py_func(rows, counts.copy(), 0.3, 2)
    assert counts[0] == 7


@compiles
@pytest.mark.parametrize(
    "turned", [np.asfortranarray, lambda rows: rows.astype(np.float32), lambda rows: rows[::2], None]
)
def test_other_arrays_are_answered_too(turned):
    rows = np.random.default_rng(0).normal(size=(8, 3))
    if turned is None:
        rows.flags.writeable = False
    else:
        rows = turned(rows)
    counts = np.zeros(1, np.int64)
    assert total(rows, counts, 0.5, 1) == pytest.approx(total.py_func(rows, counts, 0.5, 1), rel=1e-6)


@compiles
def test_a_failure_is_an_error():
    assert inverse(4.0) == 0.25
    with pytest.raises(ArithmeticError, match="kernel inverse failed"):
        inverse(0.0)


def test_what_is_no_machine_code_is_not_linked():
    assert linked_address(b"no object file") is None


SOURCE = """
import sys
import numpy as np
from lifelore.core.compiled.stored_kernel import kernel_part, stored_kernel

@kernel_part
def step(x):
    return x + 1.5

@stored_kernel("f8(f8[::1])")
def total(row):
    found = 0.0
    for x in row:
        found += step(x)
    return found

print(total(np.arange(4.0)), "numba" in sys.modules)
"""


@pytest.fixture
def answer(tmp_path):
    """What a fresh process with the kernel of `SOURCE` prints: the sum, and whether it imported Numba."""
    script = tmp_path / "script.py"
    script.write_text(SOURCE)

    def fresh(**environment) -> list[str]:
        cache = {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "NUMBA_DISABLE_JIT": "0"}
        return run(str(script), **(cache | environment)).split()

    return script, fresh


def stored(script: Path) -> list[Path]:
    return sorted((script.parent / "cache" / "machine-code").iterdir())


def test_a_later_process_needs_no_numba_and_an_edit_compiles_again(answer):
    script, fresh = answer
    assert fresh() == ["12.0", "True"]
    assert fresh() == ["12.0", "False"]
    (file,) = stored(script)
    month_ago = time.time() - (STALE_DAYS + 1) * 24 * 3600
    os.utime(file, (month_ago, month_ago))
    script.write_text(SOURCE.replace("1.5", "2.5"))
    assert fresh() == ["16.0", "True"]
    assert fresh() == ["16.0", "False"]
    # The file of the older source had not been used for a month.
    assert file not in stored(script)
    assert fresh(NUMBA_DISABLE_JIT="1") == ["16.0", "False"]


def test_another_processor_and_a_damaged_file_compile_again(answer):
    script, fresh = answer
    fresh()
    (file,) = stored(script)
    file.write_bytes(file.read_bytes()[:-100])
    assert fresh() == ["12.0", "True"]
    assert fresh() == ["12.0", "False"]
    assert fresh(NUMBA_CPU_NAME="generic", NUMBA_CPU_FEATURES="") == ["12.0", "True"]
    assert len(stored(script)) == 2


def test_where_nothing_can_be_stored_kernels_run(answer):
    script, fresh = answer
    blocked = script.parent / "blocked"
    blocked.write_text("a file where the folder should be")
    assert fresh(NUMBA_CACHE_DIR=str(blocked)) == ["12.0", "True"]


def test_without_the_insides_of_numba_everything_works_the_same(answer):
    script, fresh = answer
    removed = "import numba.core.caching\ndel numba.core.caching.CompileResultCacheImpl\n"
    script.write_text(removed + SOURCE)
    assert fresh() == ["12.0", "True"]
    assert not (script.parent / "cache" / "machine-code").exists()
