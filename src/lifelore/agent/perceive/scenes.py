"""Writes simulated scenes of objects on a table as a folder of clouds (`lifelore scenes`)."""

import time
from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE
from lifelore.core.protocols import Progress
from lifelore.core.relations import CORE_RELATIONS
from lifelore.domains.tabletop.scene_folder import SceneFolder
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.tabletop import tabletop_scenes


def make_scenes(
    n: int,
    out: str | Path,
    seed: int = 0,
    *,
    mix: Mapping[str, float] | None = None,
    camera: str = "kinect",
    shapes: str = "training",
    arrangement: str = "mixed",
    jobs: int = 1,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Draw `n` scenes and write them to the folder `out`.

    Parameters
    ----------
    n : int
        At least 1.
    out : str or Path
        A folder without scenes.
    seed : int
        The same seed gives the same files, for any number of jobs.
    mix, camera, shapes, arrangement
        As in `TabletopSettings`.
    jobs : int
        Processes.
    progress : Progress, optional
        Called after each scene.

    Returns
    -------
    dict
        ``scenes``, ``out``, ``seconds``, ``attempts`` (number of draws), ``pairs`` (number of pairs of objects, by
        relation), ``mix`` (their shares) and ``with_table`` (number of pairs with the table, by relation).

    Raises
    ------
    InputError, MissingExtraError, StoreError
        An argument breaks its rule; MuJoCo is missing; the folder cannot be written.
    """
    if n < 1 or jobs < 1:
        raise InputError(f"n and jobs must be at least 1, got {n} and {jobs}")
    settings = TabletopSettings(arrangement=arrangement, mix=mix, camera=camera, shapes=shapes)
    start, folder = time.perf_counter(), SceneFolder(out)
    pairs: Counter[str] = Counter()
    with_table: Counter[str] = Counter()
    attempts = 0
    for done, scene in enumerate(tabletop_scenes(n, seed, settings, jobs), start=1):
        folder.write(scene)
        attempts += scene.attempts
        for label in scene.truth:
            (with_table if label.b == TABLE else pairs)[label.relation] += 1
        if progress is not None:
            progress(done, n, scene.name)
    return {
        "scenes": n,
        "out": str(out),
        "seconds": round(time.perf_counter() - start, 3),
        "attempts": attempts,
        "pairs": {relation: pairs[relation] for relation in CORE_RELATIONS},
        "mix": {relation: round(pairs[relation] / max(pairs.total(), 1), 4) for relation in CORE_RELATIONS},
        "with_table": {relation: with_table[relation] for relation in CORE_RELATIONS},
    }
