"""Measures and rows of claim C4.7."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter4.c4_01_golf_example.measure import known
from lifelore.experiments.chapter4.c4_05_selection_rules.run import worlds
from lifelore.experiments.chapter4.c4_07_bandit_baselines.run import CASES_SHOWN, REUSE
from lifelore.experiments.chapter4.reuse_runs import grouped_mean, plain
from lifelore.experiments.chapter4.surveillance_peers import GIVEN, GP_PEERS, PEERS
from lifelore.experiments.chapter4.surveillance_runs import DEFAULT_WORLD, by_group, find, name_of, summary
from lifelore.experiments.engine.estimates import is_above, share_of

REUSE_GIVEN = "models of every type and policy; the pay of each deployment"


def _less(results: Sequence[Mapping], worse: str, better: str, case: str, **world: str) -> Estimate:
    """How much more regret `worse` has in all, task by task."""
    sums = [by_group(find(results, name, case, **world), "sums") for name in (worse, better)]
    return grouped_mean(sums[0] - sums[1])


def _ratio(results: Sequence[Mapping], top: str, bottom: str, case: str) -> Estimate:
    """Ratio of summed regrets, groups as pairs."""
    means = [by_group(find(results, name, case), "sums").mean(axis=1) for name in (top, bottom)]
    return ratio_estimate(*means)


def best_gp(results: Sequence[Mapping], case: str) -> str:
    """The GP-UCB of least regret, tuned ones and the one that knows the true distances among them."""
    return min(GP_PEERS, key=lambda name: float(np.mean(find(results, name, case)["sums"])))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Summed regret of each method and what it is more than expected improvement's, by case and over the grid."""
    measured: dict[str, Estimate] = {}
    for case in CASES_SHOWN:
        for name in (*REUSE, *PEERS):
            numbers = summary(find(results, name, case))
            measured |= {f"{key}_{name_of(name, case)}": value for key, value in numbers.items()}
        measured |= _of_case(settings, results, case)
    for peer in ("UCB1", "GP-UCB", "UCB1, tuned"):
        answers = [is_above(_less(results, peer, "EI", "exact", **world), 0.0) for world in worlds(settings)]
        measured[f"grid_EI_below_{name_of(peer, '')[:-1]}"] = share_of(answers)
    between = [
        is_above(_less(results, "UCB1", "GP-UCB", "exact", **world), 0.0)
        and is_above(_less(results, "interval estimation", "GP-UCB", "exact", **world), 0.0)
        for world in worlds(settings)
    ]
    measured["grid_GP_UCB_between"] = share_of(between)
    return measured


def _of_case(settings: Mapping, results: Sequence[Mapping], case: str) -> dict[str, Estimate]:
    short = case
    best = best_gp(results, case)
    found = {
        f"UCB1_minus_EI_{short}": _less(results, "UCB1", "EI", case),
        f"GP_UCB_minus_EI_{short}": _less(results, "GP-UCB", "EI", case),
        f"best_GP_UCB_minus_EI_{short}": _less(results, best, "EI", case),
        f"UCB1_tuned_minus_EI_{short}": _less(results, "UCB1, tuned", "EI", case),
        f"UCB1_minus_GP_UCB_{short}": _less(results, "UCB1", "GP-UCB", case),
        f"interval_estimation_minus_GP_UCB_{short}": _less(results, "interval estimation", "GP-UCB", case),
        f"interval_estimation_minus_UCB1_{short}": _less(results, "interval estimation", "UCB1", case),
        f"EI_over_best_GP_UCB_{short}": _ratio(results, "EI", best, case),
        f"EI_over_eps_greedy_on_means_{short}": _ratio(results, "EI", "eps-greedy on means", case),
        f"EI_over_UCB1_tuned_{short}": _ratio(results, "EI", "UCB1, tuned", case),
    }
    curves = {name: np.array(find(results, name, case)["curve"]["mean"]) for name in ("EI", "UCB1", "GP-UCB")}
    below = (curves["EI"] < curves["UCB1"]) & (curves["EI"] < curves["GP-UCB"])
    found[f"first_episode_below_for_good_{short}"] = known(float(np.flatnonzero(~below).max(initial=-1) + 2))
    few = settings["thesis_groups"]
    for name in ("EI", "UCB1", "GP-UCB"):
        first = by_group(find(results, name, case), "sums")[:few]
        found[f"cumulative_first_{first.size}_tasks_{name_of(name, case)}"] = mean_estimate(first.ravel())
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a cell: its summary, what it was given, and in the default reserve its curve."""
    kept = []
    for result in results:
        world = {key: result[key] for key in DEFAULT_WORLD}
        row = {"method": result["method"], "case": result["case"], **world, **plain(summary(result))}
        row |= {"tuned": result["tuned"], "given": GIVEN.get(result["method"], REUSE_GIVEN)}
        if world == DEFAULT_WORLD:
            row["curve"] = result["curve"]
        kept.append(row)
    return kept
