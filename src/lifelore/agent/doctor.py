"""Examines the installation for `lifelore doctor`: packages, speed of the kernels, kernel cache and memory."""

import platform
import tempfile
import time
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np

from lifelore.core.compiled.kernel_cache import cache_folder
from lifelore.core.errors import LifeloreError
from lifelore.core.learning.curve import TOTAL
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.streams import stream
from lifelore.core.usable_cores import usable_cores
from lifelore.domains.worlds import make_world
from lifelore.memory import open_memory
from lifelore.memory.location import locate

PACKAGES = {
    "numpy": "arrays",
    "scipy": "maps and graphs",
    "numba": "kernels",
    "gymnasium": "environments",
    "matplotlib": "figures",
    "scikit-learn": "learning relations",
    "networkx": "route graphs, holes in objects",
    "pypcd4": "PCD clouds",
    "trimesh": "PLY clouds",
    "clingo": "logic over scenes",
}
"""Packages that every installation has, and what they are for."""
EXTRAS = {
    "fastapi": ("web", "serve"),
    "psycopg": ("postgres", "--memory postgresql://… of every verb"),
    "rosbags": ("ros", "perceive and learn-from of rosbags, perceive --log *.mcap"),
    "rerun-sdk": ("view", "perceive --log *.rrd"),
    "mujoco": ("sim", "scenes, live --domain tabletop"),
    "unified-planning": ("planning", "perceive --plan"),
    "minigrid": ("envs", "MiniGrid worlds, in examples"),
    "stable-baselines3": ("deep", "bridges.sb3: action priors in deep Q-learning"),
    "openfeature-sdk": ("openfeature", "bridges.openfeature_provider: studies as flags"),
    "distributed": ("cluster", "reproduce --scheduler"),
}
"""Packages of extras: the extra, and the verbs and options that need it."""
SLOW = 5.0
"""Million Q-learning steps a second; slower kernels are probably not compiled."""
RESTORE = "restore an export into a new memory: lifelore memory import EXPORT --memory NEW"


def examine(memory: str | None = None) -> dict:
    """Examine this machine.

    Returns
    -------
    dict
        ``lifelore``, ``python``, ``system``, ``cores``;
        ``packages``: [{"name", "version" or None, "for", "extra" or None}];
        ``checks``: [{"what", "ok", "finding", "advice"}]; the advice is None where the check is ok.
    """
    return {
        "lifelore": version("lifelore"),
        "python": platform.python_version(),
        "system": platform.platform(terse=True),
        "cores": usable_cores(),
        "packages": [
            {"name": name, "version": _version(name), "for": use, "extra": extra}
            for name, (extra, use) in ({name: (None, use) for name, use in PACKAGES.items()} | EXTRAS).items()
        ],
        "checks": [_kernels(), _kernel_cache(), _memory(memory)],
    }


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _kernels() -> dict:
    tables = make_world("lattice").task(0).tables()
    method = QLearning(episodes=300, epsilon=0.1, epsilon_floor=0.1)
    speeds = []
    for attempt in range(3):
        began = time.thread_time()
        learner, _ = method.learn(tables, 0.95, world=stream(0, "world"), own=stream(0, "own", attempt))
        speeds.append(learner.cursor[TOTAL] / (time.thread_time() - began) / 1e6)
    speed = float(np.max(speeds))
    return _check(
        "kernels",
        speed > SLOW,
        f"{speed:.0f} million Q-learning steps a second on one core",
        "end other heavy programs and examine again; check that NUMBA_DISABLE_JIT is not set",
    )


def _kernel_cache() -> dict:
    folder = cache_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return _check("kernel cache", True, str(folder))
    except OSError as error:
        finding = f"{folder} cannot be written ({error.strerror}), so every start compiles the kernels again"
        return _check("kernel cache", False, finding, "set NUMBA_CACHE_DIR to a folder that you may write")


def _memory(where: str | None) -> dict:
    place = locate(where)
    if where is None and isinstance(place, Path) and not place.exists():
        return _check("memory", True, f"none yet; the first life creates {place}")
    try:
        with open_memory(where, create=False) as opened:
            problems, robots = opened.check(), len(opened.robots())
    except LifeloreError as error:
        finding, _, advice = str(error).partition("; ")
        return _check("memory", False, finding, advice.removeprefix("nothing was changed: ") or RESTORE)
    if problems:
        return _check(
            "memory", False, f"{opened.location}: {len(problems)} problems, first: {problems[0]}", RESTORE
        )
    return _check("memory", True, f"{opened.location}, {robots} robots")


def _check(what: str, ok: bool, finding: str, advice: str | None = None) -> dict:
    return {"what": what, "ok": ok, "finding": finding, "advice": None if ok else advice}
