"""Without Stable-Baselines3 the bridge says which extra brings it, and nothing else needs it."""

import importlib
import subprocess
import sys

import pytest

from lifelore.core.errors import MissingExtraError


def test_without_the_library_the_extra_is_named(monkeypatch):
    monkeypatch.delitem(sys.modules, "lifelore.bridges.sb3", raising=False)
    monkeypatch.setitem(sys.modules, "stable_baselines3", None)
    with pytest.raises(MissingExtraError, match=r"pip install 'lifelore\[deep\]'"):
        importlib.import_module("lifelore.bridges.sb3")


@pytest.mark.slow
def test_masks_do_not_import_torch():
    code = (
        "import sys, lifelore.bridges.prior_mask; print(sorted({'torch', 'stable_baselines3'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
