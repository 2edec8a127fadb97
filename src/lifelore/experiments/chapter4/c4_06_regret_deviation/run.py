"""C4.6: how much regret varies over ten surveillance tasks, by rule and episode, beside the printed table.

Ten tasks say little about a standard deviation, so that the experiment is repeated: `groups` times ten tasks,
and a printed number agrees where it lies within the middle 95 % of the deviations of groups of ten. The thesis
does not say which regret it means; measured are four readings: expected regret, the best policy's mean less
what was paid, and the size of the difference of what two episodes paid, with and without its sign. The default
is the size: with the standard deviation 20 of the noise it is the one that can leave what is printed for rules
that have converged.

What is known: exact models, or models learnt from `samples` deployments a pair with unseen tasks among those met.

Thesis: §4.6.4, Table 4.3.
"""

from collections.abc import Mapping

from lifelore.core.errors import InputError
from lifelore.experiments.chapter4.reuse_rules import RULES_SHOWN
from lifelore.experiments.chapter4.surveillance_runs import DEFAULT_WORLD, NOISES, run_method
from lifelore.experiments.engine.learning_settings import check_counts

AFTER = (5, 10, 20, 50)
METHODS = (*RULES_SHOWN, "BE, κ 30")


def check(settings: Mapping) -> None:
    check_counts(settings, ("tasks", "groups", "episodes", "samples"))
    if tuple(settings["after"]) != AFTER or settings["episodes"] < AFTER[-1]:
        raise InputError(f"after must be {list(AFTER)}, as printed, and episodes at least {AFTER[-1]}")


def cells(settings: Mapping) -> list[dict]:
    """Every rule with exact and with learnt models, and with exact ones under the other reading of the noise."""
    noises = [("exact", noise) for noise in NOISES] + [("headline", DEFAULT_WORLD["noise"])]
    return [
        {"method": name, "case": case, **DEFAULT_WORLD, "noise": noise, "groups": settings["groups"]}
        for case, noise in noises
        for name in METHODS
    ]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Regret after the printed episodes, task by task."""
    found = run_method(settings, cell, seed)
    return {key: found[key] for key in (*cell, "at", "against_mean", "realised")}
