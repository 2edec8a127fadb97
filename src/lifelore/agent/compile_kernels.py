"""Compiles the kernels of `live` and `perceive` before their first use (`lifelore doctor --warm`)."""

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.core.compiled.kernel_cache import cache_folder
from lifelore.core.errors import StoreError
from lifelore.core.protocols import Progress


def compile_kernels(progress: Progress | None = None) -> dict[str, Any]:
    """Run each of `VERBS` once on small inputs, so that the kernel cache holds its compiled kernels.

    Parameters
    ----------
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each verb.

    Returns
    -------
    dict
        ``folder`` of the cache; ``compiled``: number of new kernels; ``seconds``.

    Raises
    ------
    StoreError
        No kernel was stored: the folder cannot be written, or compiling is switched off.
    """
    began, before = time.perf_counter(), _compiled()
    with tempfile.TemporaryDirectory() as folder:
        for done, (label, run) in enumerate(VERBS.items(), start=1):
            run(Path(folder))
            if progress:
                progress(done, len(VERBS), label)
    after = _compiled()
    if not after:
        raise StoreError(
            f"no kernel could be stored in {cache_folder()}: make the folder writable or set NUMBA_CACHE_DIR, "
            "and leave NUMBA_DISABLE_JIT unset"
        )
    return {
        "folder": str(cache_folder()),
        "compiled": len(after - before),
        "seconds": round(time.perf_counter() - began, 3),
    }


def _compiled() -> set[Path]:
    return set(cache_folder().rglob("*.nbc"))


def _live(folder: Path) -> None:
    from lifelore.agent.live.life import live
    from lifelore.agent.live.life_settings import LifeSettings, MemorySettings
    from lifelore.core.learning.q_learner import QLearning
    from lifelore.domains.buildings.clear_path import clear_path
    from lifelore.domains.worlds import make_world

    memory = MemorySettings(str(folder / "life.db"))
    life = live(LifeSettings(memory=memory, agent="all", tasks=2, episodes=3, max_steps=50))
    random = np.random.default_rng(0)
    QLearning(episodes=3).learn(make_world("lattice").task(0).tables(), 0.95, world=random, own=random)
    assert life.floor is not None, "the default domain is a building"
    clear_path(life.floor, *life.floor.metres(life.floor.anchors[:2]))


def _perceive(folder: Path) -> None:
    from lifelore.agent.perceive.perceive import perceive

    points, labels = _two_boxes_on_a_table()
    cloud = folder / "cloud.npz"
    np.savez(cloud, points=points, labels=labels)
    perceive(str(cloud))
    np.savez(cloud, points=points)
    perceive(str(cloud))


def _two_boxes_on_a_table() -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) in metres and labels (n,), 1 the table: a box on a box, seen from the front and above."""
    random = np.random.default_rng(0)

    def face(n: int, low: tuple, high: tuple) -> np.ndarray:
        return random.uniform(low, high, (n, 3))

    def box(bottom: float, side: float) -> np.ndarray:
        top = bottom + side
        above = face(900, (-side / 2, -side / 2, top), (side / 2, side / 2, top))
        front = face(900, (-side / 2, -side / 2, bottom), (side / 2, -side / 2, top))
        return np.vstack([above, front])

    parts = [face(6000, (-0.4, -0.4, 0), (0.4, 0.4, 0)), box(0.0, 0.12), box(0.12, 0.1)]
    # The camera does not see the table behind and below the boxes.
    parts[0] = parts[0][~((abs(parts[0][:, 0]) < 0.06) & (parts[0][:, 1] > -0.06) & (parts[0][:, 1] < 0.2))]
    return np.vstack(parts), np.repeat([1, 2, 3], [len(part) for part in parts])


VERBS: dict[str, Callable[[Path], None]] = {"live": _live, "perceive": _perceive}
"""Verbs with kernels, each with a function that runs it in an empty folder."""
