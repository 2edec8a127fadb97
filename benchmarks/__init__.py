"""Benchmarks of speed and of one value: ratios to others, measured side by side; the answer is plain data.

A script a subject; `peers` holds the programs beside ours, and `rounds` measures all in turns. ``python -m
benchmarks`` lists them, ``python -m benchmarks NAME`` runs one. Stored results lie in ``benchmarks/results``.
"""

from importlib import import_module

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress

MOST_REPEATS = 1000

BENCHES = {
    "kernels": "steps of Q-learning, beside C, Gymnasium with NumPy, and tuned Python",
    "start": "time to a first answer: of a learner, and of each verb from the shell",
    "perceive": "a scene stage by stage, and a cloud from the shell",
    "separator": "the support vector machine between two clouds, beside scikit-learn",
    "reuse": "an episode of policy reuse, beside MABWiser and Vowpal Wabbit; a million users",
    "serve": "decisions and outcomes over HTTP, beside a bare FastAPI route",
    "memory": "learners, contexts and memory files of growing size; many memories merged, beside one by one",
    "buildings": "the first and a later task in buildings of 5,000 to 300,000 places",
    "lives": "the time of a life's tasks, by agent",
    "priors": "an action prior of a million contexts, beside dictionaries and lists; a factory's tables",
    "personalise_value": "choices for strangers by the default of reuse fit, beside LinUCB; value, not speed",
}
"""Each benchmark and what it measures; the function is ``bench_NAME(repeats, progress)`` in the module NAME."""


def bench(name: str, *, repeats: int = 7, progress: Progress | None = None) -> dict:
    """Run a benchmark.

    Parameters
    ----------
    name : str
        One of `BENCHES`.
    repeats : int
        Interleaved rounds, 1 to `MOST_REPEATS`; medians over them are reported. Parts of minutes run fewer.
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
        raise NotFoundError(f"benchmark must be one of {', '.join(BENCHES)}, got '{name}'")
    if not 1 <= repeats <= MOST_REPEATS:
        raise InputError(f"repeats must lie in [1, {MOST_REPEATS}], got {repeats}")
    run = getattr(import_module(f"{__name__}.{name}"), f"bench_{name}")
    return {"bench": name, **run(repeats, progress or _silent)}


def _silent(done: int, total: int, label: str) -> None:
    pass
