"""Simulates the walk of an agent that follows its own policy, and the advice where it is given.

Thesis: §3.7.2, the one-shot tasks of the fixed-policy agents (Table 3.1, Figures 3.21 and 3.23).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.advice.advice import TARGET, consider, observe
from lifelore.action.advice.advisor import Advisor
from lifelore.core.compiled.jit import inlined, kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
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
    policy: NDArray[np.float64],
    advisor: Advisor,
    generator: np.random.Generator,
    max_steps: int,
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
    follows_advice : bool
        Whether the agent follows the advice (§3.7.1.1); if not, the advisor only watches it.
    """
    n_states, n_actions = tables.n_states, tables.n_actions
    policy_cum = cumulative(policy.reshape(-1, n_actions)).reshape(n_states, -1, n_actions)
    random = random_state(generator)
    start = int(tables.starts[int(next_uniform(random) * len(tables.starts))])
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
        start,
        follows_advice,
        trace,
    )
    return Walk(*[array[:n] for array in trace], reached=bool(reached), reward=float(reward))  # type: ignore[arg-type]


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
