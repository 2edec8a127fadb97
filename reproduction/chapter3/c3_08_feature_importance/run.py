"""Cells of C3.8: how much entropy of the action prior each feature saves, in each of the sets φ1 to φ4.

The thesis counts policies and does not say of which states. Counted here: every state of a task, or only those on
an optimal way from the start to the end (what a demonstration shows); all tied-best actions (Eq. 3.1), or the
first of them. Thesis: §3.3.2, Alg. 5, §3.4.5, Figure 3.12.
"""

from collections.abc import Iterator, Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.action.features.counted_features import CountedFeatures
from lifelore.action.features.feature_selection import independent_features
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.domains.factory.contexts import PHI
from reproduction.chapter3.factory import modified_tasks
from reproduction.chapter3.factory.modified_tasks import FULL_SET, Problem
from reproduction.engine.grid import Grid

KEYS = ("policies", "over", "actions")
"""The choices left open that make a cell of the grid."""


def grid_of(settings: Mapping) -> Grid:
    """The grid: number of policies × states that count × actions that count."""
    return Grid.crossed(settings, KEYS, {key: key for key in KEYS})


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: Δ of every feature in every set, in every cell of the grid."""
    return {**cell, "found": list(_found(settings, (seed, "C3.8", cell["run"])))}


def _found(settings: Mapping, own: tuple) -> Iterator[dict]:
    priors = {key: ActionPrior(modified_tasks.N_ACTIONS) for key in product(settings["over"], settings["actions"])}
    for i in range(max(settings["policies"])):
        problem = modified_tasks.problem_of(settings, (*own, "training", i))
        codes = modified_tasks.contexts_of(problem, "phi4")
        for (over, actions), prior in priors.items():
            states = counted_states(problem, over)
            prior.update(codes[states], counted_actions(problem.best[states], actions))
            if i + 1 in settings["policies"]:
                yield {"policies": i + 1, "over": over, "actions": actions, **importance(prior)}


def counted_states(problem: Problem, over: str) -> NDArray[np.int64]:
    """The states that count; completed ones never do."""
    return problem.way if over == "way" else np.arange(len(problem.best))


def counted_actions(best: NDArray[np.bool_], actions: str) -> NDArray[np.bool_]:
    """All best actions, or the first of each row (n, 6)."""
    return best & (best.cumsum(axis=1) == 1) if actions == "first" else best


def importance(prior: ActionPrior) -> dict:
    """Δ in bits of every feature of each set, H of the set, and what Alg. 5 chooses from it."""
    found: dict[str, dict] = {"increase": {}, "entropy": {}, "chosen": {}}
    for name, names in PHI.items():
        codes = FULL_SET.coarser(prior.contexts, names)
        counted = CountedFeatures(FULL_SET.subset(names), codes, prior.counts(prior.contexts))
        choice = independent_features(counted)
        found["increase"][name] = {feature: round(delta, 6) for feature, delta in choice.increase.items()}
        found["entropy"][name] = round(choice.full_entropy, 6)
        found["chosen"][name] = list(choice.names)
    return found
