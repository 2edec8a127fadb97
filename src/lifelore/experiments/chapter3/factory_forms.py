"""One prior in several forms, in modified factories: proportions, a Dirichlet draw, softmaxes of several scales.

Each run draws layouts and lists of components for training and, apart from them, for testing; exact policies of
the former, pooled by observation, make the prior. Every form meets the same factories, lists and random numbers
of its own. The thesis prints the softmax of the counts U; an observation pools the counts of all states that share
it, which makes hundreds of them, and the thesis names no normalisation. So U is also divided by the number of
policies, and the softmax is also taken of the proportions, times a scale. Thesis: §3.2.2.1, §3.4.7, Figure 3.15.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.core.learning.q_learning import Rows, Schedule, uniform_rows
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import best_actions
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import feature_codes, features
from lifelore.domains.factory.factory import ACTION_NAMES, FactoryTask
from lifelore.domains.factory.modified_factory import modified_factory
from lifelore.experiments.chapter3.lattice_learning import schedule_of
from lifelore.experiments.engine.learning_run import learnt
from lifelore.experiments.engine.open_choices import default_of, how_key, is_default_but_for_schedule, plain_how

PLAIN, PROPORTION, DIRICHLET, AS_PRINTED = "uniform", "proportion", "dirichlet", "softmax of counts"
FORMS = (
    PROPORTION,
    DIRICHLET,
    AS_PRINTED,
    "softmax of counts a policy",
    "softmax of proportions",
    "softmax of 10 × proportions",
)
SOFTMAXES = FORMS[2:]
SCALE = {"softmax of proportions": 1.0, "softmax of 10 × proportions": 10.0}
KEYS = ("features", "schedule", "ties", "alpha0", "max_steps", "policies")
"""The choices left open that make a cell of the grid."""


class Met(NamedTuple):
    """A task as learners meet it: tables, names of its streams, codes of its states by set of features."""

    tables: Tables
    stream: tuple
    codes: dict[str, NDArray[np.int64]]
    optimal: float


class Run(NamedTuple):
    """Priors by set of features and number of policies, with α⁰ of 1, and test tasks."""

    priors: dict[tuple[str, int], ActionPrior]
    testing: list[Met]


def run_of(settings: Mapping, seed: int, number: int) -> Run:
    """Run `number`; more training or test tasks leave the first ones as they are."""
    own = (seed, "C3.11", number)
    names = settings["features"]
    counting = {name: ActionPrior(len(ACTION_NAMES), 1.0, name) for name in names}
    priors = {}
    for i in range(max(settings["policies"])):
        task = _task(settings, (*own, "training", i))
        best, seen = best_of(task), features(task)
        for name, prior in counting.items():
            prior.update(feature_codes(seen, name), best)
            if i + 1 in settings["policies"]:
                priors[name, i + 1] = ActionPrior.merged([prior])
    return Run(priors, [_met(settings, (*own, "testing", i)) for i in range(settings["test_tasks"])])


def _task(settings: Mapping, names: tuple) -> FactoryTask:
    random = stream(*names, "factory")
    factory = modified_factory(random, settings["discount"])
    return factory.task(factory.draw_components(random, settings["components"]))


def best_of(task: FactoryTask) -> NDArray[np.bool_]:
    """Optimal actions of every state, tied ones too, none where all is done, (n_states, 6)."""
    best = best_actions(task.optimal_q())
    best[task.completed] = False  # nothing is chosen any more
    return best


def _met(settings: Mapping, names: tuple) -> Met:
    task = _task(settings, names)
    tables, seen = task.tables(), features(task)
    codes = {name: feature_codes(seen, name) for name in settings["features"]}
    return Met(tables, names, codes, optimal_reward(tables, task.optimal_q(tables)))


def optimal_reward(tables: Tables, q: NDArray[np.float64]) -> float:
    """Summed reward of an episode under an optimal policy, from the first start; the world is deterministic."""
    state, total, event = int(tables.starts[0]), 0.0, 0
    while not event & TERMINAL:
        action = int(q[state].argmax())
        total += float(tables.reward[state, action, 0])
        state, event = int(tables.next_state[state, action, 0]), int(tables.event[state, action, 0])
    return total


def probs_of(
    prior: ActionPrior, codes: NDArray[np.int64], form: str, policies: int, generator: np.random.Generator
) -> NDArray[np.float64]:
    """Action probabilities of codes in one of `FORMS`, (n, 6), rows sum to 1."""
    if form in SCALE:
        share = SCALE[form] * prior.probs(codes)
        mass = np.exp(share - share.max(axis=1, keepdims=True))
        return mass / mass.sum(axis=1, keepdims=True)
    if form in (PROPORTION, DIRICHLET):
        return prior.probs(codes, form, generator=generator)
    return prior.probs(codes, "softmax", beta=1.0 if form == AS_PRINTED else 1.0 / policies)


def hows(settings: Mapping) -> list[dict]:
    """The grid: features × ε × ties, and every other α⁰, cap and number of policies, one at a time."""
    default = default_of(settings, KEYS)
    crossed = product(settings["features"], settings["schedules"], settings["ties"])
    grid = [{**default, "features": f, "schedule": s, "ties": t} for f, s, t in crossed]
    sizes = [(key, n) for key in ("alpha0", "max_steps", "policies") for n in settings[key] if n != default[key]]
    return grid + [{**default, key: n} for key, n in sizes]


def cells(settings: Mapping) -> list[dict]:
    """A run each."""
    return [{"run": number} for number in range(settings["runs"])]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every form in every cell of the grid."""
    run = run_of(settings, seed, cell["run"])
    optimal = float(np.mean([met.optimal for met in run.testing]))
    return {**cell, "optimal": optimal, "found": list(_all_found(settings, run))}


def _all_found(settings: Mapping, run: Run) -> Iterator[dict]:
    """Numbers of uniform exploration once for each schedule and cap, then of each form for each cell."""

    @cache
    def prior_of(name: str, policies: int, alpha0: float) -> ActionPrior:
        codes, counts = run.priors[name, policies].fixed_point_counts()
        return ActionPrior.from_fixed_point_counts(codes, counts, alpha0)

    def numbers(how: Mapping, rows_for) -> dict:
        schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
        rewards = np.array([learn_task(met, rows_for(met), schedule) for met in run.testing])
        found = summary(rewards, settings["early"])
        return {**found, **_curve(rewards)} if is_default_but_for_schedule(how, settings, KEYS) else found

    plain = {how_key(how, KEYS): how for how in (plain_how(h, KEYS) for h in hows(settings))}
    for how in plain.values():
        yield {"form": PLAIN, **how, **numbers(how, lambda met: uniform_rows(met.tables))}
    for how in hows(settings):
        prior = prior_of(how["features"], how["policies"], how["alpha0"])
        for form in FORMS:
            yield {"form": form, **how, **numbers(how, lambda met, p=prior, f=form, h=how: rows_of(met, p, f, h))}


def rows_of(met: Met, prior: ActionPrior, form: str, how: Mapping) -> Rows:
    """Rows of ε-QPAP; a Dirichlet is drawn from once for the task."""
    random = stream(*met.stream, "dirichlet")

    def probs(codes):
        return probs_of(prior, codes, form, how["policies"], random)

    return prior_rows(met.tables, met.codes[how["features"]], probs, how["ties"])


def learn_task(met: Met, rows: Rows, schedule: Schedule) -> NDArray[np.float64]:
    """Summed reward of each episode, (n_episodes,)."""
    return learnt(met.tables, met.stream, rows, schedule)[0].rewards


def summary(rewards: NDArray[np.float64], early: int) -> dict:
    """A run's numbers from (n_tasks, n_episodes) rewards: means, and standard deviations across tasks.

    `spread_early` is the deviation of an episode's reward, a mean over the first `early` episodes (what a shaded
    band shows); `spread_of_means` that of the tasks' own means over those episodes.
    """
    parts = {"first": rewards[:, :1], "early": rewards[:, :early], "all": rewards, "late": rewards[:, -early:]}
    found = {name: float(part.mean()) for name, part in parts.items()}
    for name in ("first", "early"):
        found[f"spread_{name}"] = float(parts[name].std(axis=0, ddof=1).mean())
    return found | {"spread_of_means": float(parts["early"].mean(axis=1).std(ddof=1))}


def _curve(rewards: NDArray[np.float64]) -> dict:
    """Mean and standard deviation across tasks of each episode."""
    return {"mean": rewards.mean(axis=0).tolist(), "deviation": rewards.std(axis=0, ddof=1).tolist()}
