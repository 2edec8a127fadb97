"""What is measured of the factory's task sequences, for C3.5 and C3.6 alike: gains over learning from scratch."""

from collections.abc import Mapping, Sequence
from math import comb
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.factory.layout import factory
from lifelore.experiments.chapter3.factory_series import SOURCES, uses
from lifelore.experiments.chapter3.factory_settings import OPEN, check_components, check_open, check_sizes

FULL = {**OPEN, "runs": 30, "prior_tasks": 40, "episodes": 100, "late": 10, "grid_tasks": [5, 40]}
QUICK = {
    **FULL,
    "runs": 4,
    "prior_tasks": 6,
    "episodes": 30,
    "max_steps": 500,
    "schedules": [[1.0, 0.98, 0.01]],
    "alpha0": [0.1],
    "late": 2,
    "grid_tasks": [1, 6],
}
SHOWN = (0, 1, 2, 5, 10, 20, 40)
"""Numbers of prior tasks whose gain is a measured number of its own."""


class Series(NamedTuple):
    """The sequences of one number of components, arrays (n_runs, n_tasks); see `factory_series`."""

    rewards: dict[str, NDArray[np.float64]]
    optimal: NDArray[np.float64]
    seen: NDArray[np.bool_]
    met: NDArray[np.int64]

    def gain(self, method: str) -> NDArray[np.float64]:
        """Reward of an episode beyond that from scratch."""
        return self.rewards[method] - self.rewards["uniform"]

    def closed(self, method: str, late: int) -> NDArray[np.float64]:
        """What is gained in the last `late` tasks, as a share of what could be: (n_runs,)."""
        room = self.optimal - self.rewards["uniform"]
        return self.gain(method)[:, -late:].sum(axis=1) / room[:, -late:].sum(axis=1)


def series_of(results: Sequence[Mapping], components: int) -> Series:
    """The sequences of all runs with so many components."""
    of_kind = [r for r in results if r["kind"] == "series" and r["components"] == components]
    names = of_kind[0]["rewards"]
    return Series(
        {name: np.array([r["rewards"][name] for r in of_kind]) for name in names},
        np.array([r["optimal"] for r in of_kind]),
        np.array([r["seen"] for r in of_kind], bool),
        np.array([r["met"] for r in of_kind]),
    )


def check(settings: Mapping) -> None:
    """Raise `InputError` for settings that cannot be run."""
    check_sizes(settings, "runs", "prior_tasks", "episodes", "max_steps", "late")
    check_components(settings["components"])
    check_open(settings)
    if 2 * settings["late"] > settings["prior_tasks"]:
        raise InputError(
            f"late must be at most half of prior_tasks ({settings['prior_tasks']}), got {settings['late']}"
        )
    few, *_, many = settings["grid_tasks"] if len(settings["grid_tasks"]) > 1 else (0, 0)
    if not 1 <= few < many <= settings["prior_tasks"] or len(settings["grid_tasks"]) != 2:
        raise InputError(
            f"grid_tasks must be two numbers, few and many, rising in [1, prior_tasks], "
            f"got {settings['grid_tasks']}"
        )


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Gains of the first number of components at the default, each source and encoding beside it, and the grid."""
    k = settings["components"][0]
    series = series_of(results, k)
    return {
        **_headline(settings, series, k),
        **_each_make(settings, series),
        **_grid_shares(settings, results),
    }


def _headline(settings: Mapping, series: Series, k: int) -> dict[str, Estimate]:
    late, gain = settings["late"], series.gain(f"exact {settings['default']['encoding']}")
    n_possible = comb(factory().n_components, k)
    found = {f"gain_after_{n}": mean_estimate(gain[:, n]) for n in SHOWN if n < gain.shape[1]}
    found |= {
        "gain_late": mean_estimate(gain[:, -late:].mean(axis=1)),
        "growth": mean_estimate(gain[:, -late:].mean(axis=1) - gain[:, 1 : late + 1].mean(axis=1)),
        "trend": mean_estimate([_rank_correlation(of_run) for of_run in gain]),
        "uniform_reward": mean_estimate(series.rewards["uniform"].mean(axis=1)),
        "optimal_reward": mean_estimate(series.optimal.mean(axis=1)),
        "late_tasks_seen": mean_estimate(series.seen[:, -late:].mean(axis=1)),
        "share_of_tasks_met": mean_estimate(series.met / n_possible),
    }
    return found | _by_seen(gain[:, -late:], series.seen[:, -late:])


def _rank_correlation(gain: NDArray[np.float64]) -> float:
    """Spearman's, of the gain with the number of prior tasks; 0 where the gain never changes."""
    from scipy.stats import rankdata

    if (gain == gain[0]).all():
        return 0.0
    return float(np.corrcoef(np.arange(len(gain)), rankdata(gain))[0, 1])


def _by_seen(gain: NDArray[np.float64], seen: NDArray[np.bool_]) -> dict[str, Estimate]:
    """Late gains in tasks that were met before and in those never met, run by run; runs without any stay out."""
    found = {}
    for name, chosen in (("met", seen), ("new", ~seen)):
        means = [g[c].mean() for g, c in zip(gain, chosen, strict=True) if c.any()]
        if means:
            found[f"gain_late_{name}"] = mean_estimate(means)
    return found


def _each_make(settings: Mapping, series: Series) -> dict[str, Estimate]:
    found = {}
    for source in SOURCES:
        for encoding in settings["encodings"]:
            closed = series.closed(f"{source} {encoding}", settings["late"])
            found[f"closed_late_{source}_{encoding}"] = mean_estimate(closed)
    return found


def against_one_component(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Whether as much of what could be gained is gained as with the second number of components."""
    many, one = (series_of(results, k) for k in settings["components"])
    found = {}
    for encoding in settings["encodings"]:
        closed = [series.closed(f"exact {encoding}", settings["late"]) for series in (many, one)]
        found[f"closed_minus_one_component_{encoding}"] = mean_estimate(closed[0] - closed[1])
        found[f"closed_late_one_component_{encoding}"] = mean_estimate(closed[1])
    default = settings["default"]["encoding"]
    return {"closed_minus_one_component": found[f"closed_minus_one_component_{default}"], **found}


# ---- the grid ----------------------------------------------------------------------------------------


def _grid(settings: Mapping, results: Sequence[Mapping]) -> list[tuple[dict, NDArray, NDArray]]:
    """Each use of a prior, its gains (n_runs, 2) after few and after many tasks, and what could be gained."""
    of_kind = [r for r in results if r["kind"] == "grid"]
    optimal = np.array([r["optimal"] for r in of_kind])
    found = []
    for i, how in enumerate(uses(settings)):
        place = settings["schedules"].index(how["schedule"])
        uniform = np.array([r["uniform"][place]["reward"] for r in of_kind])
        rewards = np.array([r["methods"][i]["rewards"] for r in of_kind])
        found.append((how, rewards - uniform[:, None], optimal - uniform))
    return found


def _grid_shares(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of the grid's cells in which the prior gains, and gains more after many tasks, by the intervals."""
    gains, grows = [], []
    for _, gain, _ in _grid(settings, results):
        gains.append(_above_zero(mean_estimate(gain[:, 1])))
        grows.append(_above_zero(mean_estimate(gain[:, 1] - gain[:, 0])))
    truths = {"gains": np.array(gains), "grows": np.array(grows)}
    truths["gains_and_grows"] = truths["gains"] & truths["grows"]
    return {
        f"grid_{name}": Estimate(float(truth.mean()), float(np.median(truth)), None, len(truth))
        for name, truth in truths.items()
    }


def _above_zero(number: Estimate) -> bool:
    return (number.ci95[0] if number.ci95 else number.value) > 0


# ---- rows --------------------------------------------------------------------------------------------


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Every sequence's mean reward by number of prior tasks, and the grid."""
    found = []
    for k in settings["components"]:
        series = series_of(results, k)
        for name, rewards in {**series.rewards, "optimal": series.optimal}.items():
            found.append({"series": name, "components": k, **band(rewards)})
    return found + _grid_rows(settings, results)


def band(rewards: NDArray[np.float64]) -> dict[str, list[float]]:
    """Mean over runs (n_runs, n) with its 95 % interval (t)."""
    from scipy.stats import t

    mean, n = rewards.mean(axis=0), len(rewards)
    half = t.ppf(0.975, n - 1) * rewards.std(axis=0, ddof=1) / np.sqrt(n) if n > 1 else 0 * mean
    return {"mean": mean.tolist(), "low": (mean - half).tolist(), "high": (mean + half).tolist()}


def _grid_rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """What is gained of what could be gained, after few and after many tasks, and what more it is."""
    found = []
    for how, gain, room in _grid(settings, results):
        closed = gain / room[:, None]
        numbers = {"few": closed[:, 0], "many": closed[:, 1], "growth": closed[:, 1] - closed[:, 0]}
        found.append({**how, **{name: mean_estimate(n).to_dict() for name, n in numbers.items()}})
    return found


def draw(result: Mapping):
    """The figure of either claim."""
    from lifelore.experiments.chapter3.figure_factory_gains import draw_factory_gains

    return draw_factory_gains(result)
