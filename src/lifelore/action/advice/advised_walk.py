"""A walk under an advisor's eyes: an agent follows its own policy, and the advice where it is given.

Thesis: §3.7.2, the one-shot tasks of the fixed-policy agents (Table 3.1, Figures 3.21 and 3.23).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.advice.advice import consider, observe
from lifelore.action.advice.advisor import Advisor
from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import cumulative
from lifelore.core.mdp import TERMINAL, Tables


class Walk(NamedTuple):
    """What happened, step by step, all (n_steps,); and whether the goal was reached.

    states, actions : where it was and what it tried
    advised : whether the step followed advice
    p_normal : P(M | H) of experts before the step
    gain : nats
    reached : bool
    reward : float, summed
    """

    states: NDArray[np.int32]
    actions: NDArray[np.int8]
    advised: NDArray[np.bool_]
    p_normal: NDArray[np.float64]
    gain: NDArray[np.float64]
    reached: bool
    reward: float


def advised_walk(
    tables: Tables,
    policy: ArrayLike,
    advisor: Advisor,
    generator: np.random.Generator,
    max_steps: int = 5000,
    *,
    start: int | None = None,
    heeds: bool = True,
) -> Walk:
    """One task of an agent with a fixed policy.

    Parameters
    ----------
    tables : Tables
        Of a task whose outcomes are certain.
    policy : (n_states, n_actions) or (n_states, n_actions + 1, n_actions) float
        The agent's own action probabilities; with three axes by the action tried last, plus 1.
    advisor : Advisor
    generator : numpy generator
        Draws the start, then one number a step: with and without advice the same ones.
    max_steps : int
        The thesis's 5,000.
    start : int, optional
        Default: one of the task's starts.
    heeds : bool
        Whether the agent acts by the advice when it is given (§3.7.1.1); if not, it is watched and never told.

    Raises
    ------
    InputError
        The task is uncertain, or the shapes of task, policy and advisor differ.
    """
    if max_steps < 1:
        raise InputError(f"max_steps must be at least 1, got {max_steps}")
    if start is not None and not 0 <= start < tables.n_states:
        raise InputError(f"start must be a state in [0, {tables.n_states}), got {start}")
    policy_cum = _cumulative_policy(policy, tables, advisor)
    random = random_state(generator)
    drawn = int(tables.starts[int(next_uniform(random) * len(tables.starts))])
    trace = (
        np.zeros(max_steps, np.int32),
        np.zeros(max_steps, np.int8),
        np.zeros(max_steps, np.bool_),
        np.zeros(max_steps),
        np.zeros(max_steps),
    )
    n, reached, reward = _walk(
        (tables.next_state, tables.reward, tables.event),
        policy_cum,
        advisor.guide,
        advisor.rule,
        advisor.watch(),
        random,
        drawn if start is None else start,
        heeds,
        trace,
    )
    return Walk(*[array[:n] for array in trace], reached=bool(reached), reward=float(reward))  # type: ignore[arg-type]


def _cumulative_policy(policy: ArrayLike, tables: Tables, advisor: Advisor) -> NDArray[np.float64]:
    """The policy as the kernel takes it, (n_states, 1 or n_actions + 1, n_actions), once all shapes agree."""
    policy = np.asarray(policy, np.float64)
    shape = (tables.n_states, tables.n_actions)
    if tables.outcome_cum.size != 1:
        raise InputError("tables must be those of a task whose outcomes are certain")
    if (advisor.n_states, advisor.n_actions) != shape or (policy.shape[0], policy.shape[-1]) != shape:
        raise InputError(
            f"task, policy and advisor must agree in states and actions, got {shape}, "
            f"{(policy.shape[0], policy.shape[-1])} and {(advisor.n_states, advisor.n_actions)}"
        )
    flat = policy.reshape(-1, shape[1])
    if (flat < 0).any() or not np.allclose(flat.sum(axis=1), 1, atol=1e-9):
        raise InputError("policy must hold probabilities: non-negative rows that sum to 1")
    return cumulative(flat).reshape(shape[0], -1, shape[1])


@kernel
def _walk(world, policy_cum, guide, rule, watch, random, state, heeds, trace):
    next_state, reward_of, event_of = world
    states, actions, advised, p_normal, gain = trace
    total, previous = 0.0, -1
    for t in range(states.size):
        told, gain[t] = consider(guide, rule, watch, state)
        told = told and heeds
        for m in range(watch.posterior.size):
            if guide.normal[m]:
                p_normal[t] += watch.posterior[m]
        u = next_uniform(random)
        if told:
            a = _drawn(guide.theta, watch.cursor[3], state, u)
        else:
            a = 0
            h = previous + 1 if policy_cum.shape[1] > 1 else 0
            while u >= policy_cum[state, h, a]:
                a += 1
        states[t], actions[t], advised[t] = state, a, told
        observe(guide, rule, watch, state, a, told)
        total += reward_of[state, a, 0]
        previous = a
        if event_of[state, a, 0] & TERMINAL:
            return t + 1, True, total
        state = next_state[state, a, 0]
    return states.size, False, total


@inlined
def _drawn(theta, g, s, u):
    """The action that the uniform number `u` draws from advice; never one of no mass, whatever the rounding."""
    chosen = -1
    for a in range(theta.shape[2]):
        if theta[g, s, a] > 0.0 and (chosen < 0 or u >= 0.0):
            chosen = a
            u -= theta[g, s, a]
    return chosen
