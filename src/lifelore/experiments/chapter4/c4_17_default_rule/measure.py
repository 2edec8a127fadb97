"""C4.17: regret of each rule relative to the best rule of each world, shares of stuck tasks, and the decision."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from lifelore.experiments.chapter4.c4_17_default_rule.run import RULES
from lifelore.experiments.chapter4.c4_17_default_rule.worlds import EQUAL
from lifelore.experiments.chapter4.reuse.many_tasks import EXACT, LEARNT
from lifelore.experiments.engine.estimates import exact_value

MOST_STUCK = 0.05
"""A default may leave this share of tasks stuck above the share of the rule that leaves the fewest in a world."""


CANDIDATES = ("EI, pay", "IDS")
"""Rules among which the library's default is decided: they need no horizon and cost little for many users."""


def decided_rule(measured: Mapping[str, Mapping[str, Any]], among: Sequence[str] = tuple(RULES)) -> str:
    """The rule that the filed decision names, by the measures of a result.

    It has the least mean of relative regret among the rules that are stuck on at most 5 % of tasks more than the
    least stuck rule in every world. Where there is no such rule, the rule for which the largest of these excesses
    is least.
    """
    excess = {name: measured[f"stuck_above_least_{key_of(name)}"]["value"] for name in among}
    regret = {name: measured[f"regret_{key_of(name)}"]["value"] for name in among}
    allowed = [name for name in among if excess[name] <= MOST_STUCK]
    return min(allowed, key=regret.__getitem__) if allowed else min(among, key=excess.__getitem__)


def key_of(rule: str) -> str:
    """A rule in the name of a measure."""
    return rule.replace(", ", "_")


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Relative regret by rule, over all worlds, by model and by noise; paired differences; shares stuck."""
    relative = {name: _relative(results, name) for name in RULES}
    stuck = {name: _shares(results, name) for name in RULES}
    above = {name: shares - np.min(list(stuck.values()), axis=0) for name, shares in stuck.items()}
    exact = np.array([result["model"] == EXACT for result in results])
    unequal = np.array([result["noise"] != EQUAL for result in results])
    parts = {EXACT: exact, LEARNT: ~exact, "equal": ~unequal, "unequal": unequal}
    found: dict[str, Estimate] = {}
    for name in RULES:
        key = key_of(name)
        found[f"regret_{key}"] = mean_estimate(relative[name].mean(axis=0))
        for part, which in parts.items():
            found[f"regret_{key}_{part}"] = mean_estimate(relative[name][which].mean(axis=0))
        found[f"stuck_{key}_exact"] = exact_value(stuck[name][exact].max(), int(exact.sum()))
        found[f"stuck_above_least_{key}"] = exact_value(above[name].max(), len(results))
    means = {name: values.mean(axis=0) for name, values in relative.items()}
    for name in ("EI, pay", "EI, outcome", "KG"):
        found[f"regret_IDS_minus_{key_of(name)}"] = difference_estimate(means["IDS"], means[name])
    best = min((name for name in RULES if name != "IDS"), key=lambda name: means[name].mean())
    found["regret_IDS_minus_best_other"] = difference_estimate(means["IDS"], means[best])
    worse = (relative[name][unequal].mean(axis=0) for name in ("EI, outcome", "greedy"))
    found["regret_EI_outcome_over_greedy_unequal"] = ratio_estimate(*worse)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a world, noise and model: regret and share of stuck tasks by rule, means over groups."""
    return [
        {key: result[key] for key in ("world", "noise", "model")}
        | {
            "regret": {name: float(np.mean(found["regret"])) for name, found in result["rules"].items()},
            "stuck": {name: float(np.mean(found["stuck"])) for name, found in result["rules"].items()},
        }
        for result in results
    ]


def _relative(results: Sequence[Mapping], rule: str) -> NDArray[np.float64]:
    """Regret of a rule by world and group, in units of the mean regret of the best rule of the world."""
    best = [min(np.mean(found["regret"]) for found in result["rules"].values()) for result in results]
    return np.array([result["rules"][rule]["regret"] for result in results]) / np.array(best)[:, None]


def _shares(results: Sequence[Mapping], rule: str) -> NDArray[np.float64]:
    """Share of stuck tasks of a rule by world."""
    return np.array([np.mean(result["rules"][rule]["stuck"]) for result in results])
