"""C4.7: how much more regret bandits and Gaussian processes have than policy reuse."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from reproduction.chapter4.c4_07_bandit_baselines.run import CASES_SHOWN, DOUBTING, REUSE
from reproduction.chapter4.reuse.many_tasks import grouped_mean
from reproduction.chapter4.surveillance.peers import GIVEN, GP_PEERS, PEERS
from reproduction.chapter4.surveillance.runs import (
    by_group,
    by_seen,
    find,
    is_default,
    name_of,
    row_of,
    worlds,
)
from reproduction.engine.estimates import exact_value, is_above, share_of

PAIRS = (
    ("UCB1", "EI"), ("GP-UCB", "EI"), ("UCB1, tuned", "EI"), ("UCB1", "GP-UCB"),
    ("interval estimation", "GP-UCB"), ("interval estimation", "UCB1"), ("interval estimation", "EI"),
)  # fmt: skip
"""Pairs of methods whose regret is compared. The thesis calls the first the worse, except that it does not compare
interval estimation with UCB1 and GP-UCB, only with policy reuse."""
SENTENCE = (("UCB1", "EI"), ("GP-UCB", "EI"), ("interval estimation", "EI"), ("UCB1", "GP-UCB"))
"""Pairs of which the thesis calls the first slower, or less suited to the problem."""
REUSE_GIVEN = "models of every type and policy; the pay of each deployment"


def more_regret(results: Sequence[Mapping], worse: str, better: str, case: str, **world: str) -> Estimate:
    """How much more summed regret `worse` has, task by task."""
    sums = [by_group(find(results, name, case, **world), "sums") for name in (worse, better)]
    return grouped_mean(sums[0] - sums[1])


def best_gp(results: Sequence[Mapping], case: str) -> str:
    """The GP-UCB of least regret, among them the tuned forms and the form that knows the true distances."""
    return min(GP_PEERS, key=lambda name: float(np.mean(find(results, name, case)["sums"])))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """How much more regret a method has than another, by case, and in which share of the grid for certain."""
    measured: dict[str, Estimate] = {}
    for case in CASES_SHOWN:
        measured |= _comparisons(settings, results, case)
    measured |= _unseen(results)

    def above(worse: str, better: str) -> list[bool]:
        every = worlds(settings)
        return [is_above(more_regret(results, worse, better, "exact", **world), 0.0) for world in every]

    for peer in ("UCB1", "GP-UCB", "UCB1, tuned"):
        measured[f"grid_EI_below_{name_of(peer, '')[:-1]}"] = share_of(above(peer, "EI"))
    sentence = [above(*pair) for pair in SENTENCE]
    found_by_case = [
        all(is_above(more_regret(results, *pair, case), 0.0) for pair in SENTENCE)
        for case in CASES_SHOWN
        if case != "exact"  # which is the default of the reserves
    ]
    measured["grid_sentence"] = share_of([*np.all(sentence, axis=0), *found_by_case])
    between = np.logical_and(above("UCB1", "GP-UCB"), above("interval estimation", "GP-UCB"))
    return measured | {"grid_GP_UCB_between": share_of(between)}


def _unseen(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Learnt models, tasks never in training: rules that doubt their models beside the best GP-UCB."""
    best = best_gp(results, "headline")
    shown = [("best GP-UCB", best, "headline"), *((name, name, "uncertain, with unseen") for name in DOUBTING)]
    found, sums = {}, {}
    for label, name, case in shown:
        result = find(results, name, case)
        unseen = by_group(result, "seen") == 0
        sums[label] = by_group(result, "sums")[unseen].reshape(len(unseen), -1).mean(axis=1)
        place = name_of(label, "unseen" if label == "best GP-UCB" else "doubting_unseen")
        numbers = by_seen(result)
        found |= {f"{key}_{place}": numbers[f"{key}_unseen"] for key in ("cumulative", "stuck")}
        if label != "best GP-UCB":
            found[f"{name_of(label, 'doubting')}_over_best_GP_UCB_unseen"] = ratio_estimate(
                sums[label], sums["best GP-UCB"]
            )
    return found


def _comparisons(settings: Mapping, results: Sequence[Mapping], case: str) -> dict[str, Estimate]:
    """Of one case: differences and ratios of summed regret, and the episode from which EI is below for good."""
    best = best_gp(results, case)
    sums = {name: by_group(find(results, name, case), "sums") for name in (*REUSE, *PEERS)}
    found = {f"best_GP_UCB_minus_EI_{case}": more_regret(results, best, "EI", case)}
    for worse, better in PAIRS:
        name = f"{name_of(worse, 'minus')}_{name_of(better, case)}"
        found[name] = more_regret(results, worse, better, case)
    for name, other in (("best_GP_UCB", best), ("eps_greedy_on_means", "eps-greedy on means")):
        means = (sums[method].mean(axis=1) for method in ("EI", other))
        found[f"EI_over_{name}_{case}"] = ratio_estimate(*means)
    shown = ("EI", "UCB1", "GP-UCB")
    ei, ucb, gp = (np.array(find(results, name, case)["curve"]["mean"]) for name in shown)
    not_below = np.flatnonzero((ei >= ucb) | (ei >= gp))
    found[f"first_episode_below_for_good_{case}"] = exact_value(not_below.max(initial=-1) + 2)
    for name in shown:
        first = sums[name][: settings["thesis_groups"]]
        found[f"cumulative_first_{first.size}_tasks_{name_of(name, case)}"] = mean_estimate(first.ravel())
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: its summary, its prior knowledge, and in the default reserve its curve."""
    found = []
    for result in results:
        row = row_of(result) | {"tuned": result["tuned"], "given": GIVEN.get(result["method"], REUSE_GIVEN)}
        found.append(row | {"curve": result["curve"]} if is_default(row) else row)
    return found
