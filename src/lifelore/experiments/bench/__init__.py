"""Speed and worth as ratios, measured side by side: one function a benchmark, plain data out."""

from collections.abc import Callable

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress

MOST_REPEATS = 1000


def _kernels(repeats: int, progress: Progress, map: str | None) -> dict:
    from lifelore.experiments.bench.kernels import bench_kernels

    if map is not None:
        raise InputError(f"map applies to bench courier, got {map} for kernels; leave it out")
    return bench_kernels(repeats, progress)


def _courier(repeats: int, progress: Progress, map: str | None) -> dict:
    from lifelore.experiments.bench.courier import bench_courier

    return bench_courier(repeats, progress, map)


BENCHES: dict[str, Callable[[int, Progress, str | None], dict]] = {"kernels": _kernels, "courier": _courier}
"""Name → benchmark; each takes the number of rounds, a callback, and a map or None."""


def bench(name: str, *, repeats: int = 7, map: str | None = None, progress: Progress | None = None) -> dict:
    """Run a benchmark.

    Parameters
    ----------
    name : str
        One of `BENCHES`.
    repeats : int
        Interleaved rounds, 1 to `MOST_REPEATS`; medians over them are reported. For ``courier``: lives.
    map : str, optional
        For ``courier``: a ROS map to live in; default generated offices.
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each piece.

    Returns
    -------
    dict
        ``{"bench", "rows": [{"name", "value", "unit", "ratio_to", "ratio"}], "goals": [{"name", "goal",
        "measured", "met"}]}``; `value`, `ratio`, `measured` and `met` are None where nothing could be measured.

    Raises
    ------
    NotFoundError
        No benchmark has this name.
    InputError
        `repeats` breaks its rule, or a program that is compared with does not build.
    """
    if name not in BENCHES:
        raise NotFoundError(f"bench must be one of {', '.join(BENCHES)}, got '{name}'")
    if not 1 <= repeats <= MOST_REPEATS:
        raise InputError(f"repeats must lie in [1, {MOST_REPEATS}], got {repeats}")
    return {"bench": name, **BENCHES[name](repeats, progress or _silent, map)}


def _silent(done: int, total: int, label: str) -> None:
    pass
