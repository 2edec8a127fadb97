"""C4.17: regret of each rule relative to the best rule of each world, shares of stuck tasks, and the decision."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, difference_estimate, mean_estimate, ratio_estimate
from reproduction.chapter4.c4_17_default_rule.run import CANDIDATES, RULES
from reproduction.chapter4.c4_17_default_rule.worlds import EQUAL
from reproduction.chapter4.reuse.many_tasks import EXACT, LEARNT, UNCERTAIN
from reproduction.engine.estimates import exact_value

MOST_STUCK = 0.05
"""A default may leave this share of tasks stuck above the share of the rule that leaves the fewest in a world."""


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
    found["stuck_above_least_IDS_over_groups"] = _largest_excess(results, "IDS")
    means = {name: values.mean(axis=0) for name, values in relative.items()}
    for name in ("EI, pay", "EI, outcome", "KG"):
        found[f"regret_IDS_minus_{key_of(name)}"] = difference_estimate(means["IDS"], means[name])
    best = min((name for name in RULES if name != "IDS"), key=lambda name: means[name].mean())
    found["regret_IDS_minus_best_other"] = difference_estimate(means["IDS"], means[best])
    worse = (relative[name][unequal].mean(axis=0) for name in ("EI, outcome", "greedy"))
    found["regret_EI_outcome_over_greedy_unequal"] = ratio_estimate(*worse)
    return found | _uncertain(results)


def _largest_excess(results: Sequence[Mapping], rule: str) -> Estimate:
    """Share of stuck tasks above that of the least stuck rule, in the world where it is the largest; over groups.

    The interval is of that world alone. As the world is the worst of all, the number is rather too high.
    """
    stuck = {name: _shares(results, name) for name in RULES}
    world = int((stuck[rule] - np.min(list(stuck.values()), axis=0)).argmax())
    least = min(RULES, key=lambda name: stuck[name][world])
    mine, others = (results[world]["rules"][name]["stuck"] for name in (rule, least))
    found = difference_estimate(mine, others)
    certain = found.ci95 is None and len(mine) >= 3  # the same in every group
    return replace(found, ci95=(found.value, found.value)) if certain else found


def _uncertain(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The candidates with learnt models known to be uncertain.

    Regret is in units of that of the best of the six rules with plug-in models; stuck tasks are counted above the
    less stuck of the two candidates, and above the same rule with plug-in models. None of these decides the
    verdict, which was filed for plug-in models.
    """
    learnt = [result for result in results if UNCERTAIN in result]
    if not learnt:
        return {}
    means = {name: _relative(learnt, name, UNCERTAIN).mean(axis=0) for name in CANDIDATES}
    stuck = {name: _shares(learnt, name, UNCERTAIN) for name in CANDIDATES}
    least = np.min(list(stuck.values()), axis=0)
    found: dict[str, Estimate] = {}
    for name, key in ((name, key_of(name)) for name in CANDIDATES):
        plug_in, n = _relative(learnt, name).mean(axis=0), len(learnt)
        found[f"regret_{key}_uncertain"] = mean_estimate(means[name])
        found[f"regret_{key}_uncertain_minus_plug_in"] = difference_estimate(means[name], plug_in)
        found[f"stuck_above_least_{key}_uncertain"] = exact_value((stuck[name] - least).max(), n)
        above = (stuck[name] - _shares(learnt, name)).max()
        found[f"stuck_{key}_uncertain_above_plug_in"] = exact_value(above, n)
    apart = difference_estimate(means["IDS"], means["EI, pay"])
    return found | {"regret_IDS_uncertain_minus_EI_pay_uncertain": apart}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row a world, noise and model: regret and share of stuck tasks by rule, means over groups.

    Rows of learnt models have both once more under ``uncertain``, of rules that know the models to be uncertain.
    """
    return [
        {key: result[key] for key in ("world", "noise", "model")}
        | _by_rule(result["rules"])
        | ({UNCERTAIN: _by_rule(result[UNCERTAIN])} if UNCERTAIN in result else {})
        for result in results
    ]


def _by_rule(rules: Mapping[str, Mapping]) -> dict[str, dict[str, float]]:
    return {
        key: {name: float(np.mean(found[key])) for name, found in rules.items()} for key in ("regret", "stuck")
    }


def _relative(results: Sequence[Mapping], rule: str, kind: str = "rules") -> NDArray[np.float64]:
    """Regret of a rule by world and group, in units of the mean regret of the best rule of the world."""
    best = [min(np.mean(found["regret"]) for found in result["rules"].values()) for result in results]
    return np.array([result[kind][rule]["regret"] for result in results]) / np.array(best)[:, None]


def _shares(results: Sequence[Mapping], rule: str, kind: str = "rules") -> NDArray[np.float64]:
    """Share of stuck tasks of a rule by world."""
    return np.array([np.mean(result[kind][rule]["stuck"]) for result in results])
