"""`lifelore doctor --warm`: what it promises about the kernels of the verbs, and what it refuses."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lifelore.app.command_line import run
from lifelore.core.compiled.kernel_cache import cache_folder

JIT_OFF = os.environ.get("NUMBA_DISABLE_JIT", "0") != "0"


VERBS = """
import json, sys
from lifelore.app.command_line import run
for arguments in json.loads(sys.argv[1]):
    assert run(arguments) == 0, arguments
"""
"""Runs verbs in a process of its own, so that only kernels on disk are at hand."""


def compiled(folder: Path) -> set[Path]:
    return set(folder.rglob("*.nbc"))


@pytest.mark.skipif(JIT_OFF, reason="nothing is compiled")
def test_after_the_warm_up_verbs_compile_nothing(ask, tmp_path):
    said = ask("doctor", "--warm", "--json")
    assert said.status == 0
    # A copy, since tests on another core compile kernels into the same folder meanwhile.
    folder = tmp_path / "cache" / cache_folder().name
    shutil.copytree(cache_folder(), folder, ignore=lambda _, names: [name for name in names if "tmp" in name])
    before = compiled(folder)
    assert len(before) > 20
    random = np.random.default_rng(5)
    points = np.vstack(
        [random.uniform((-0.3, -0.3, 0), (0.3, 0.3, 0), (4000, 3)), random.uniform(0, 0.1, (900, 3))]
    )
    np.savez(tmp_path / "cloud.npz", points=points, labels=np.repeat([1, 2], [4000, 900]))
    log = "user,policy,outcome\n" + "".join(f"u{i % 5},p{i % 3},{random.random()}\n" for i in range(60))
    (tmp_path / "log.csv").write_text(log)
    verbs = (
        ("live", "--seed", "9", "--tasks", "2", "--agent", "all", "--memory", "m.db"),
        ("live", "--domain", "noise", "--tasks", "1", "--memory", "n.db"),
        ("perceive", "cloud.npz", "--json"),
        ("reuse", "fit", "log.csv", "--memory", "r.db"),
        ("reuse", "choose", "--user", "ann", "--memory", "r.db"),
    )
    command = [sys.executable, "-c", VERBS, json.dumps(verbs)]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache")}
    subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, check=True)
    assert compiled(folder) == before


WARMED_BY_NO_KERNEL = """
import sys
from lifelore.agent import compile_kernels
from lifelore.app.command_line import run
compile_kernels.VERBS = {"a verb": lambda folder: None}
sys.exit(run(["doctor", "--warm"]))
"""


def test_a_warm_up_that_stores_nothing_says_so(tmp_path):
    blocked = tmp_path / "blocked"
    blocked.write_text("a file where the folder should be")
    command = [sys.executable, "-c", WARMED_BY_NO_KERNEL]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(blocked), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("lifelore: no kernel could be stored in ")
    assert done.stderr.count("\n") == 1


def test_memory_is_not_looked_at_while_kernels_are_compiled(capsys):
    assert run(["doctor", "--warm", "--memory", "some.db"]) == 2
    assert "leave --memory or --warm out" in capsys.readouterr().err
