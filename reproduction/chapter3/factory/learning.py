"""Tasks of the factory, solved and as learners meet them, and learnt and hand-made priors.

A run is a sequence of random tasks with the same number of components. All methods meet a task with the same
random numbers, so differences between methods are paired. Thesis: §3.4.2, §3.4.3.
"""

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.action.priors.exploration import prior_rows
from lifelore.action.priors.policy_counts import actions_to_count
from lifelore.core.learning.q_learning import QLearner, Rows
from lifelore.core.mdp import TERMINAL, Tables
from lifelore.core.planning.planning import best_actions, greedy_policy, policy_values
from lifelore.core.streams import stream
from lifelore.domains.factory.contexts import PHI, feature_codes, features, state_contexts
from lifelore.domains.factory.factory import ACTION_NAMES, Factory, FactoryTask
from lifelore.domains.factory.layout import factory

N_ACTIONS = len(ACTION_NAMES)
LEARNT = "learnt"
"""ε-QSAP with a prior from policies."""


class Problem(NamedTuple):
    """A solved task as learners meet it, and the names of its streams.

    best : (n_states, 6) bool, best and tied-best actions; completed rows empty, nothing is chosen there
    seen : (n_states, 10) int8, values of the features of φ4
    way : (n_steps,) int, states in which an optimal policy acts, from the start to the end
    optimal, optimal_return : float, of that policy: summed rewards, and discounted (the value of the start)
    """

    task: FactoryTask
    tables: Tables
    best: NDArray[np.bool_]
    seen: NDArray[np.int8]
    way: NDArray[np.int64]
    optimal: float
    optimal_return: float
    stream: tuple = ()


def tasks_of(settings: Mapping, seed: int, k: int, run: int, n_tasks: int) -> list[tuple[int, ...]]:
    """The first tasks of a run's sequence: lists of `k` components, drawn with replacement."""
    random = stream(seed, "factory", k, run, "tasks")
    return [floor(settings["discount"]).draw_components(random, k) for _ in range(n_tasks)]


def problem_of(settings: Mapping, components: tuple[int, ...], stream_of: tuple) -> Problem:
    """The problem of a list of components; `stream_of` names its streams."""
    return solved(components, settings["discount"])._replace(stream=stream_of)


@cache
def floor(discount: float) -> Factory:
    """The thesis's factory under a discount."""
    return factory(discount=discount)


@cache
def solved(components: tuple[int, ...], discount: float) -> Problem:
    """The problem of a list of components; cached, since runs draw the same lists again."""
    return solved_task(floor(discount).task(components))


def solved_task(task: FactoryTask) -> Problem:
    """The exact solution of a task."""
    tables = task.tables()
    q = task.optimal_q(tables)
    best = best_actions(q)
    best[task.completed] = False
    optimal_return = float(q[tables.starts[0]].max())
    return Problem(task, tables, best, features(task), *optimal_way(tables, best), optimal_return)


def optimal_way(tables: Tables, best: NDArray[np.bool_]) -> tuple[NDArray[np.int64], float]:
    """States and summed reward on the way from the start to the end, by the first best action."""
    state, way, total, event = int(tables.starts[0]), [], 0.0, 0
    while not event & TERMINAL:
        action = int(best[state].argmax())
        way.append(state)
        total += float(tables.reward[state, action, 0])
        state, event = int(tables.next_state[state, action, 0]), int(tables.event[state, action, 0])
    return np.array(way), total


def exact_prior(known: Iterable[Problem], conditioned_on: str, alpha0: float) -> ActionPrior:
    """The prior from exact optimal policies, tied actions counted (Eq. 3.1, 3.5, 3.7); see `contexts_of`."""
    prior = ActionPrior(N_ACTIONS, alpha0)
    for problem in known:
        prior.update(contexts_of(problem, conditioned_on), problem.best)
    return prior


def hand_made_prior(advice: NDArray[np.bool_], weight: float, alpha0: float) -> ActionPrior:
    """A person's advice (n_states, n_actions) as a prior over the states of one task.

    It counts as much as `weight` policies that follow it.
    """
    prior = ActionPrior(N_ACTIONS, alpha0)
    prior.update(np.arange(len(advice)), advice, weight)
    return prior


def with_pseudo_count(prior: ActionPrior, alpha0: float) -> ActionPrior:
    """The same counts read with another α⁰."""
    return ActionPrior.from_fixed_point_counts(*prior.fixed_point_counts(), alpha0, prior.key)


def tried_actions(learner: QLearner, ended: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Actions of a learnt policy that count: the best of those tried, in every state where any was.

    The rule of mazes asks for a value above zero (erratum E4). Moves cost here, and few states have one; a shift
    grants it to every action tried. `ended`: completed states, which never count.
    """
    return actions_to_count(learner.q - learner.q.min() + 1.0, "visited", ended=ended, visits=learner.visits)


def contexts_of(problem: Problem, conditioned_on: str | None) -> NDArray[np.int64]:
    """Codes of all states, (n_states,).

    By a set φ of `PHI`; by an encoding, also as ``state global``; or the task's own states for a hand-made prior
    (None).
    """
    if conditioned_on is None:
        return np.arange(len(problem.best))
    if conditioned_on in PHI:
        return feature_codes(problem.seen, conditioned_on)
    return state_contexts(problem.task, conditioned_on.removeprefix("state "))


def rows_of(problem: Problem, conditioned_on: str | None, probs_of: Callable, ties: str) -> Rows:
    """Rows of ε-QPAP (Alg. 4) with the prior whose ``probs`` are `probs_of`; over states ε-QSAP's (Alg. 2)."""
    return prior_rows(problem.tables, contexts_of(problem, conditioned_on), probs_of, ties)


def greedy_return(problem: Problem, q: NDArray[np.float64]) -> float:
    """The discounted return of the greedy policy from the start; 0 where it has no policy there."""
    values = policy_values(problem.tables, greedy_policy(q), problem.task.domain.discount)
    return float(values[problem.tables.starts[0]])
