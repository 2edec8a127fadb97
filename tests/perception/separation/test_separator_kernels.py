"""The separator's kernels: compiled equals plain Python to the bit."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

RUN = Path(__file__).with_name("separator_kernels_run.py")


def arrays(path: Path, disable_jit: str):
    environment = os.environ | {"NUMBA_DISABLE_JIT": disable_jit}
    command = [sys.executable, "-W", "error", str(RUN), str(path)]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    with np.load(path) as loaded:
        return dict(loaded)


@pytest.mark.slow
def test_compiled_and_plain_python_agree_to_the_bit(tmp_path):
    compiled, plain = arrays(tmp_path / "compiled.npz", "0"), arrays(tmp_path / "plain.npz", "1")
    assert set(compiled) == set(plain)
    for name in compiled:
        assert compiled[name].size > 0, name
        assert compiled[name].dtype == plain[name].dtype, name
        assert np.array_equal(compiled[name], plain[name]), name
