"""Measures and rows of C3.5, and of C3.6: what a prior gains over learning each factory task from scratch."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from math import comb
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.factory.layout import factory
from reproduction.chapter3.c3_05_one_component.run import SOURCES
from reproduction.chapter3.factory.learning import KEYS, LEARNT, PLAIN, grid_of
from reproduction.engine.estimates import interval_or_value, share_of
from reproduction.engine.results_table import BAND, ResultsTable, curve_of


class Series(NamedTuple):
    """The sequences of one number of components, arrays (n_runs, n_tasks); see `run`."""

    rewards: dict[str, NDArray[np.float64]]
    optimal: NDArray[np.float64]
    seen: NDArray[np.bool_]
    met: NDArray[np.int64]

    @classmethod
    def of(cls, results: Sequence[Mapping], components: int) -> "Series":
        """The sequences of all runs with a number of components."""
        runs = [r for r in results if r["kind"] == "series" and r["components"] == components]
        rewards = {name: np.array([r["rewards"][name] for r in runs]) for name in runs[0]["rewards"]}
        optimal, seen, met = (np.array([r[key] for r in runs]) for key in ("optimal", "seen", "met"))
        return cls(rewards, optimal, seen, met)

    def gain(self, method: str) -> NDArray[np.float64]:
        """Reward of an episode beyond that from scratch."""
        return self.rewards[method] - self.rewards[PLAIN]

    def closed(self, method: str, late: int) -> NDArray[np.float64]:
        """Gain of the last `late` tasks, as a share of the possible gain: (n_runs,)."""
        room = self.optimal - self.rewards[PLAIN]
        return self.gain(method)[:, -late:].sum(axis=1) / room[:, -late:].sum(axis=1)


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Gains at the default, shares of the possible gain by source and encoding, and the share of the grid."""
    k, late = settings["components"][0], settings["late"]
    series = Series.of(results, k)
    gain = series.gain(f"exact {settings['default']['encoding']}")
    ways = list(product(SOURCES, settings["encodings"]))
    both = [(after[:, 1], after[:, 1] - after[:, 0]) for _, after, _ in _grid(settings, results)]
    grows = [all(interval_or_value(mean_estimate(gains))[0] > 0 for gains in pair) for pair in both]
    return {
        "gain_after_0": mean_estimate(gain[:, 0]),
        "gain_late": mean_estimate(gain[:, -late:].mean(axis=1)),
        "growth": mean_estimate(gain[:, -late:].mean(axis=1) - gain[:, 1 : late + 1].mean(axis=1)),
        "trend": mean_estimate([_rank_correlation(of_run) for of_run in gain]),
        "late_tasks_seen": mean_estimate(series.seen[:, -late:].mean(axis=1)),
        "share_of_tasks_met": mean_estimate(series.met / comb(factory().n_components, k)),
        **_by_seen(gain[:, -late:], series.seen[:, -late:]),
        **{f"closed_late_{s}_{e}": mean_estimate(series.closed(f"{s} {e}", late)) for s, e in ways},
        "grid_gains_and_grows": share_of(grows),
    }


def _rank_correlation(gain: NDArray[np.float64]) -> float:
    """Spearman's, of the gain with the number of prior tasks; 0 where the gain never changes."""
    from scipy.stats import rankdata

    if (gain == gain[0]).all():
        return 0.0
    return float(np.corrcoef(np.arange(len(gain)), rankdata(gain))[0, 1])


def _by_seen(gain: NDArray[np.float64], seen: NDArray[np.bool_]) -> dict[str, Estimate]:
    """Late gains in tasks that were met before and in new ones, over the runs that have such tasks."""
    found = {}
    for name, chosen in (("met", seen), ("new", ~seen)):
        means = [g[c].mean() for g, c in zip(gain, chosen, strict=True) if c.any()]
        if means:
            found[f"gain_late_{name}"] = mean_estimate(means)
    return found


def _grid(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[dict, NDArray, NDArray]]:
    """Each cell of the grid, its gains (n_runs, 2) after few and after many tasks, and the possible gain."""
    grid, of_kind = grid_of(settings), [r for r in results if r["kind"] == "grid"]
    table = ResultsTable.nested(of_kind, "found", keys=("prior", *KEYS), outer=("run",))
    optimal = np.array([r["optimal"] for r in of_kind])
    for cell in grid.cells:
        learnt, plain = (table.values("rewards", **grid.where(m, cell, "prior")) for m in (LEARNT, PLAIN))
        yield cell, learnt - plain, optimal - plain[:, 0]


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean reward by number of prior tasks of every sequence; shares of the possible gain in every cell."""
    found = []
    for k in settings["components"]:
        series = Series.of(results, k)
        for name, rewards in {**series.rewards, "optimal": series.optimal}.items():
            found.append({"series": name, "components": k, **curve_of(rewards, parts=BAND)})
    for cell, gain, room in _grid(settings, results):
        closed = gain / room[:, None]
        numbers = {"few": closed[:, 0], "many": closed[:, 1], "growth": closed[:, 1] - closed[:, 0]}
        found.append({**cell, **{name: mean_estimate(n).to_dict() for name, n in numbers.items()}})
    return found
