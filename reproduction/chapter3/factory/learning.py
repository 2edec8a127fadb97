"""Learners in the factory with learnt and hand-made priors, on shared random streams.

A run is a sequence of random tasks with the same number of components. All methods meet a task with the same
random numbers, so differences between methods are paired. Thesis: §3.4.2, §3.4.3.
"""

from collections.abc import Iterable, Mapping
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
from lifelore.domains.factory.contexts import state_contexts
from lifelore.domains.factory.factory import ACTION_NAMES, Factory, FactoryTask
from lifelore.domains.factory.layout import factory

N_ACTIONS = len(ACTION_NAMES)
LEARNT = "learnt"
"""ε-QSAP with a prior from policies."""


class Solved(NamedTuple):
    """A task and its exact solution.

    best : (n_states, n_actions) bool, best and tied-best actions; completed rows empty, nothing is chosen there
    way : (n_steps,) int, states in which an optimal policy acts, from the start to the end
    optimal_return, optimal_reward : float, of that policy: discounted (the value of the start), and summed
    """

    task: FactoryTask
    best: NDArray[np.bool_]
    way: NDArray[np.int64]
    optimal_return: float
    optimal_reward: float


class Problem(NamedTuple):
    """A solved task as learners meet it: its tables and the names of its streams."""

    solved: Solved
    tables: Tables
    stream: tuple


def tasks_of(settings: Mapping, seed: int, k: int, run: int, n_tasks: int) -> list[tuple[int, ...]]:
    """The first tasks of a run's sequence: lists of `k` components, drawn with replacement."""
    random = stream(seed, "factory", k, run, "tasks")
    return [floor(settings["discount"]).draw_components(random, k) for _ in range(n_tasks)]


def problem_of(settings: Mapping, components: tuple[int, ...], stream_of: tuple) -> Problem:
    """The problem of a list of components; `stream_of` names its streams."""
    known = solved(components, settings["discount"])
    return Problem(known, known.task.tables(), stream_of)


@cache
def floor(discount: float) -> Factory:
    """The thesis's factory under a discount."""
    return factory(discount=discount)


@cache
def solved(components: tuple[int, ...], discount: float) -> Solved:
    """A task solved exactly; cached, since runs draw the same lists again."""
    task = floor(discount).task(components)
    tables = task.tables()
    q = task.optimal_q(tables)
    best = best_actions(q)
    best[task.completed] = False
    way, reward = optimal_way(tables, q)
    return Solved(task, best, way, float(q[tables.starts[0]].max()), reward)


def optimal_way(tables: Tables, preference: NDArray) -> tuple[NDArray[np.int64], float]:
    """States and summed reward on the way from the start to the end, by the first action of largest `preference`.

    `preference` is (n_states, n_actions), such as Q or marks of best actions; the world is deterministic.
    """
    state, way, total, event = int(tables.starts[0]), [], 0.0, 0
    while not event & TERMINAL:
        action = int(preference[state].argmax())
        way.append(state)
        total += float(tables.reward[state, action, 0])
        state, event = int(tables.next_state[state, action, 0]), int(tables.event[state, action, 0])
    return np.array(way), total


def exact_prior(known: Iterable[Solved], encoding: str, alpha0: float) -> ActionPrior:
    """The prior over states from exact optimal policies, tied actions counted (Eq. 3.1, 3.5)."""
    prior = ActionPrior(N_ACTIONS, alpha0)
    for task in known:
        prior.update(state_contexts(task.task, encoding), task.best)
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


def contexts_of(problem: Problem, encoding: str | None) -> NDArray[np.int64]:
    """Codes of all states, (n_states,): by an encoding, or the task's own states for a hand-made prior (None)."""
    known = problem.solved
    return np.arange(len(known.best)) if encoding is None else state_contexts(known.task, encoding)


def rows_of(problem: Problem, prior: ActionPrior, encoding: str | None, ties: str) -> Rows:
    """ε-QSAP's rows (Alg. 2) with a prior whose contexts are `contexts_of`."""
    return prior_rows(problem.tables, contexts_of(problem, encoding), prior.probs, ties)


def greedy_return(problem: Problem, q: NDArray[np.float64]) -> float:
    """The discounted return of the greedy policy from the start; 0 where it has no policy there."""
    values = policy_values(problem.tables, greedy_policy(q), problem.solved.task.domain.discount)
    return float(values[problem.tables.starts[0]])
