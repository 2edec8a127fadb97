"""C3.8: how much entropy of the action prior each feature saves, in each of the sets φ1 to φ4.

The thesis counts policies and does not say of which states. Counted here: every state of a task, or only those on
an optimal way from the start to the end (what a demonstration shows); all tied-best actions (Eq. 3.1), or the
first of them. Thesis: §3.3.2, Alg. 5, §3.4.5, Figure 3.12.
"""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.counted_features import CountedFeatures
from lifelore.action.features.feature_selection import independent_features
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.factory.contexts import PHI
from lifelore.figures.style import GREY, Axes, colour_of
from reproduction.chapter3.factory import comparison, modified_tasks
from reproduction.chapter3.factory.learning import N_ACTIONS, Problem, contexts_of
from reproduction.chapter3.factory.modified_tasks import CARDINALS, FEATURES, FULL_SET, features_in_words
from reproduction.engine.grid import Cell, Grid
from reproduction.engine.records import having, nested
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

KEYS = ("policies", "over", "actions")
GAPS = {"gap_phi4": ("phi4", "phi4"), "gap_phi3": ("phi3", "phi3"), "gap_phi2_to_phi1": ("phi2", "phi1")}
"""Measures: the set with N, S, E and W, and that of the features they are compared with."""


def grid_of(settings: Mapping) -> Grid:
    """The grid: number of policies × states that count × actions that count."""
    return comparison.grid_of(settings, KEYS)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: Δ of every feature in every set, in every cell of the grid."""
    return {**cell, "found": list(_found(settings, (seed, "C3.8", cell["run"])))}


def _found(settings: Mapping, own: tuple) -> Iterator[dict]:
    priors = {key: ActionPrior(N_ACTIONS) for key in product(settings["over"], settings["actions"])}
    for i in range(max(settings["policies"])):
        problem = modified_tasks.problem_of(settings, (*own, "training", i))
        codes = contexts_of(problem, "phi4")
        for (over, actions), prior in priors.items():
            states = counted_states(problem, over)
            prior.update(codes[states], counted_actions(problem.best[states], actions))
            if i + 1 in settings["policies"]:
                yield {"policies": i + 1, "over": over, "actions": actions, "increase": importance(prior)}


def counted_states(problem: Problem, over: str) -> NDArray[np.int64]:
    """The states that count; completed ones never do."""
    return problem.way if over == "way" else np.arange(len(problem.best))


def counted_actions(best: NDArray[np.bool_], actions: str) -> NDArray[np.bool_]:
    """All best actions, or the first of each row (n, 6)."""
    return best & (best.cumsum(axis=1) == 1) if actions == "first" else best


def importance(prior: ActionPrior) -> dict[str, dict[str, float]]:
    """Δ in bits of every feature of each set, from Alg. 5."""
    found = {}
    for name, names in PHI.items():
        codes = FULL_SET.coarser(prior.contexts, names)
        counted = CountedFeatures(FULL_SET.subset(names), codes, prior.counts(prior.contexts))
        increase = independent_features(counted).increase
        found[name] = {feature: round(delta, 6) for feature, delta in increase.items()}
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The least Δ of N, S, E and W and the largest other Δ in φ4 at the default, bits."""
    ours, others = _least_and_largest(results, grid_of(settings).default, "phi4", "phi4")
    return {"least_of_four": mean_estimate(ours), "largest_other": mean_estimate(others)}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
    """The gaps in every cell of the grid."""
    for cell in grid_of(settings).cells:
        yield cell, _gaps(results, cell)


def _gaps(results: Sequence[Mapping], cell: Mapping) -> dict[str, Estimate]:
    """By how much the least of N, S, E, W exceeds the largest other, bits."""
    compared = {name: _least_and_largest(results, cell, *sets) for name, sets in GAPS.items()}
    return {name: mean_estimate(ours - others) for name, (ours, others) in compared.items()}


def _least_and_largest(
    results: Sequence[Mapping], cell: Mapping, ours: str, theirs: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The least Δ of N, S, E, W in a set, and the largest Δ of the other features of another, (n_runs,) each."""
    increases = _increases(results, cell)
    least = [min(run[ours][feature] for feature in CARDINALS) for run in increases]
    others = [feature for feature in PHI[theirs] if feature not in CARDINALS]
    return np.array(least), np.array([max(run[theirs][feature] for feature in others) for run in increases])


def _increases(results: Sequence[Mapping], cell: Mapping) -> list[Mapping[str, Mapping[str, float]]]:
    return [record["increase"] for record in having(nested(results, "found"), **cell)]


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Δ of each feature in each set at the default."""
    increases = _increases(results, grid_of(settings).default)
    return [
        {"set": phi, "feature": name, **mean_estimate([run[phi][name] for run in increases]).to_dict()}
        for phi, names in PHI.items()
        for name in names
    ]


COLOURS = {phi.replace("phi", "φ"): colour_of(phi) for phi in PHI}
TICKS = features_in_words(FEATURES)


@panels(8.0, 3.8)
def draw(result: Mapping, axes: Axes) -> None:
    """Figure of claim C3.8: how much entropy each feature saves in each set of features.

    Bars of each feature, one for each set that contains it.
    """
    number = {(row["set"], row["feature"]): row for row in result["rows"]}
    groups = {phi.replace("phi", "φ"): [number.get((phi, feature)) for feature in FEATURES] for phi in PHI}
    draw_interval_bars(
        axes, TICKS, groups, colours=COLOURS, horizontal=False, words=None,
        label="Δ, bits lost without the feature",
    )  # fmt: skip
    axes.axhline(0, color=GREY, linewidth=0.8)
    axes.legend(loc="upper right", ncols=4)
    axes.figure.supxlabel(
        f"{result['settings']['runs']} runs; lines: 95 % interval. N to SE: cells around the robot's.",
        fontsize=8, color=GREY,
    )  # fmt: skip
