"""Compiled kernels equal plain Python to the bit."""

from pathlib import Path

import numpy as np
import pytest

from .fresh_python import run

KERNELS_RUN = Path(__file__).parents[1] / "kernels_run.py"


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
