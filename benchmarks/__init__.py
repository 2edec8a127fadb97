"""Benchmarks: speed and benefit as ratios, measured side by side; plain data out.

A folder a subject: a benchmark's module has its name, and its peers stand beside it. `rounds` measures them in
turns.
"""

from importlib import import_module

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress

MOST_REPEATS = 1000


BENCHES = {
    "kernels": "learners",
    "courier": "lives",
    "priors": "action",
    "separator": "perception",
    "perceive": "perception",
    "relations": "perception",
    "plans": "perception",
    "puzzles": "perception",
    "pictures": "perception",
    "lived_relations": "perception",
    "views": "perception",
    "registration": "perception",
    "segmentation": "perception",
    "raw_frames": "perception",
    "factory": "action",
    "deep": "action",
    "reuse": "interaction",
    "start": "startup",
    "buildings": "lives",
    "merge": "fleet",
    "capacity": "fleet",
    "large_memory": "fleet",
    "fleet": "fleet",
    "customer_fleet": "fleet",
    "recognition": "lives",
    "lidar": "lives",
    "destinations": "lives",
    "worlds": "lives",
    "tabletop_lives": "lives",
    "contexts": "action",
    "advice_classes": "action",
    "deep_layouts": "action",
    "long_user": "interaction",
    "changing_types": "interaction",
    "bands": "interaction",
    "perfect_information": "interaction",
    "evaluation": "interaction",
    "novelty": "interaction",
    "log": "interaction",
    "long_lived_worlds": "agent",
    "changing_customers": "agent",
    "serve": "service",
    "soak": "service",
}
"""Each benchmark and its folder; the function is ``bench_NAME(repeats, progress)`` in the module of that name."""
WITH_MAP = ("courier", "recognition", "lidar", "long_lived_worlds")
"""Benchmarks that also take a ROS map."""


def bench(name: str, *, repeats: int = 7, map: str | None = None, progress: Progress | None = None) -> dict:
    """Run a benchmark.

    Parameters
    ----------
    name : str
        One of `BENCHES`.
    repeats : int
        Interleaved rounds, 1 to `MOST_REPEATS`; medians over them are reported. For ``courier`` and ``lidar``:
        lives; for ``recognition`` and ``destinations``: offices; for ``relations``, ``segmentation``, ``plans``,
        ``views`` and ``registration``: lots of scenes, judged together; for ``raw_frames``: rooms of each kind;
        for ``puzzles``: lots of 20 puzzles; for ``perfect_information``: groups of ten tasks in each world;
        for ``deep``: runs of learning; for ``serve``: at most 5; for ``soak``: minutes; for ``tabletop_lives``:
        five lives each; for ``long_lived_worlds``: lives, half as many outside the factory; for
        ``changing_customers`` and ``lived_relations``: lives; for ``customer_fleet``: worlds; for ``evaluation``:
        60 simulated studies each; for ``novelty``: libraries of each case.
    map : str, optional
        For those of `WITH_MAP`: a ROS map to live in; default generated offices.
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each piece.

    Returns
    -------
    dict
        ``{"bench", "rows": [{"name", "value", "unit", "ratio_to", "ratio"}], "goals": [{"name", "goal",
        "measured", "met"}]}``; `value`, `ratio`, `measured` and `met` are None where nothing could be measured.
        Sometimes also ``"notes"``, sentences that say why.

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
    if map is not None and name not in WITH_MAP:
        raise InputError(f"map applies to bench {' and '.join(WITH_MAP)}, got {map} for {name}; leave it out")
    run = getattr(import_module(f"{__name__}.{BENCHES[name]}.{name}"), f"bench_{name}")
    options = {"map": map} if name in WITH_MAP else {}
    return {"bench": name, **run(repeats, progress or _silent, **options)}


def _silent(done: int, total: int, label: str) -> None:
    pass
