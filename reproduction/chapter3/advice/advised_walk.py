"""Simulates the walk of an agent that follows its own policy, and the advice where it is given.

Thesis: §3.7.2, the one-shot tasks of the fixed-policy agents (Table 3.1, Figures 3.21 and 3.23).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.advice.advice import TARGET, consider, observe
from lifelore.action.advice.advisor import Advisor
from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learning import cumulative
from lifelore.core.mdp import TERMINAL, Tables


class Walk(NamedTuple):
    """The steps of a walk, all (n_steps,), and whether it reached the goal.

    states, actions : state of the agent and action tried
    advised : whether the step followed advice
    p_normal : P(M | H) of experts before the step
    gain : nats
    reached : bool
    reward : float, sum over the steps
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
    follows_advice: bool = True,
) -> Walk:
    """Simulate one task of an agent with a fixed policy.

    Parameters
    ----------
    tables : Tables
        A deterministic task.
    policy : (n_states, n_actions) or (n_states, n_actions + 1, n_actions) float
        The agent's own action probabilities; with three axes the middle one is the last action plus 1.
    advisor : Advisor
    generator : numpy generator
        Draws the start, then one number a step, the same numbers with and without advice.
    max_steps : int
        Maximum number of steps; the thesis uses 5,000.
    start : int, optional
        Default: one of the task's starts.
    follows_advice : bool
        Whether the agent follows the advice (§3.7.1.1); if not, the advisor only watches it.

    Raises
    ------
    InputError
        The task is not deterministic, or the shapes of task, policy and advisor differ.
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
        follows_advice,
        trace,
    )
    return Walk(*[array[:n] for array in trace], reached=bool(reached), reward=float(reward))  # type: ignore[arg-type]


def _cumulative_policy(policy: ArrayLike, tables: Tables, advisor: Advisor) -> NDArray[np.float64]:
    """Cumulative probabilities of the policy, (n_states, 1 or n_actions + 1, n_actions); checks all shapes."""
    policy = np.asarray(policy, np.float64)
    shape = (tables.n_states, tables.n_actions)
    if tables.n_outcomes != 1:
        raise InputError("tables must be deterministic, with one outcome for each action")
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
def _walk(world, policy_cum, guide, rule, agent, random, state, follows_advice, trace):
    next_state, reward_of, event_of = world
    states, actions, advised, p_normal, gain = trace
    total, previous = 0.0, -1
    for t in range(states.size):
        advise, gain[t] = consider(guide, rule, agent, state)
        advise = advise and follows_advice
        for m in range(agent.posterior.size):
            if guide.is_expert[m]:
                p_normal[t] += agent.posterior[m]
        u = next_uniform(random)
        if advise:
            a = _drawn(guide.theta, agent.cursor[TARGET], state, u)
        else:
            a = 0
            h = previous + 1 if policy_cum.shape[1] > 1 else 0
            while u >= policy_cum[state, h, a]:
                a += 1
        states[t], actions[t], advised[t] = state, a, advise
        observe(guide, rule, agent, state, a, advise)
        total += reward_of[state, a, 0]
        previous = a
        if event_of[state, a, 0] & TERMINAL:
            return t + 1, True, total
        state = next_state[state, a, 0]
    return states.size, False, total


@inlined
def _drawn(theta, g, s, u):
    """The action that the uniform number `u` draws from the advice; never an action with probability 0."""
    chosen = -1
    for a in range(theta.shape[2]):
        if theta[g, s, a] > 0.0 and (chosen < 0 or u >= 0.0):
            chosen = a
            u -= theta[g, s, a]
    return chosen
