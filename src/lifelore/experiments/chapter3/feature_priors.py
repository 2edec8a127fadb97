"""The cells of C3.7: learners in new factories, with priors over features and over states of many others.

Every prior counts the exact optimal policies of the same training factories, all states alike. Measuring and
drawing live elsewhere, so that they can change without a new run. Thesis: §3.4.4, §3.4.5, Figure 3.11.
"""

from collections.abc import Mapping, Sequence
from functools import cache
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.domains.factory.contexts import PHI
from lifelore.experiments.chapter3.lattice_learning import schedule_of
from lifelore.experiments.chapter3.modified_factory_tasks import (
    N_ACTIONS,
    Problem,
    contexts_of,
    learn_problem,
    problem_of,
)
from lifelore.experiments.engine.open_choices import default_of, how_key

PLAIN, STATE = "uniform", "state"
METHODS = (PLAIN, STATE, *PHI)
KEYS = ("encoding", "schedule", "ties", "alpha0", "max_steps", "policies")
"""The choices left open that make a cell of the grid; only the prior over states reads ``encoding``."""

Priors = dict[tuple[str, int], ActionPrior]


def method_how(method: str, how: Mapping) -> dict:
    """A cell of the grid as one method meets it: what it does not read is None."""
    read = {PLAIN: ("schedule", "max_steps"), STATE: KEYS}.get(method, KEYS[1:])
    return {key: how[key] if key in read else None for key in KEYS}


def hows(settings: Mapping) -> list[dict]:
    """The grid: schedules of ε × ties, and every other choice one at a time."""
    default = default_of(settings, KEYS)
    crossed = product(settings["schedules"], settings["ties"])
    grid = [{**default, "schedule": s, "ties": t} for s, t in crossed]
    lists = {"encoding": "encodings"}
    others = ("encoding", "alpha0", "max_steps", "policies")
    sizes = [(key, n) for key in others for n in settings[lists.get(key, key)] if n != default[key]]
    return grid + [{**default, key: n} for key, n in sizes]


def cells(settings: Mapping) -> list[dict]:
    """A run each."""
    return [{"run": number} for number in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method in every cell of the grid."""
    own = (seed, "C3.7", cell["run"])
    priors = _priors(settings, own)
    testing = [problem_of(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])]
    met = {}
    for how in hows(settings):
        for method in METHODS:
            read = method_how(method, how)
            met.setdefault((method, how_key(read, KEYS)), (method, read))
    found = [_found(settings, priors, testing, *one) for one in met.values()]
    return {**cell, "optimal": float(np.mean([p.optimal for p in testing])), "found": found}


def _priors(settings: Mapping, own: tuple) -> Priors:
    """Priors by what they are conditioned on and number of policies, with α⁰ of 1."""
    names = [*PHI, *(f"{STATE} {encoding}" for encoding in settings["encodings"])]
    counting = {name: ActionPrior(N_ACTIONS, 1.0) for name in names}
    kept = {}
    for i in range(max(settings["policies"])):
        problem = problem_of(settings, (*own, "training", i))
        for name, prior in counting.items():
            prior.update(contexts_of(problem, name), problem.best)
            if i + 1 in settings["policies"]:
                kept[name, i + 1] = ActionPrior.merged([prior])
    return kept


def _found(settings: Mapping, priors: Priors, testing: Sequence[Problem], method: str, how: dict) -> dict:
    """What one method earns in a cell of the grid."""
    schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
    name = f"{STATE} {how['encoding']}" if method == STATE else method

    @cache
    def prior() -> ActionPrior:
        counts = priors[name, how["policies"]].fixed_point_counts()
        return ActionPrior.from_fixed_point_counts(*counts, how["alpha0"])

    def rows_for(problem: Problem):
        if method == PLAIN:
            return None
        return prior_rows(problem.tables, contexts_of(problem, name), prior().probs, how["ties"])

    rewards = np.array([learn_problem(problem, rows_for(problem), schedule)[0].rewards for problem in testing])
    found = {"method": method, **how, **summary(rewards, settings["early"])}
    default = {**settings["default"], "schedule": how["schedule"]}
    is_shown = how_key(how, KEYS) == how_key(method_how(method, default), KEYS)
    return found | curve_of(rewards) if is_shown else found


def summary(rewards: NDArray[np.float64], early: int) -> dict:
    """Mean reward of an episode from (n_tasks, n_episodes): of the first, of early, all and late ones."""
    parts = {"first": rewards[:, :1], "early": rewards[:, :early], "all": rewards, "late": rewards[:, -early:]}
    return {name: float(part.mean()) for name, part in parts.items()}


def curve_of(rewards: NDArray[np.float64]) -> dict:
    """Mean over tasks of each episode."""
    return {"mean": np.round(rewards.mean(axis=0), 2).tolist()}
