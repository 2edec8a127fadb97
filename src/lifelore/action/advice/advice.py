"""Decides when to advise an agent and which action to advise, from the evidence of its last steps.

    P(M | H) ∝ P(M) Π P(a | s, M)  over the window H                                      (Eq. 3.15)
    P(a | s, H) = Σ_M P(a | s, M) P(M | H)                                                 (Eq. 3.14)
    advise θ_s  if  KL[θ_s, P(A | s, H)] = Σ_a θ_s(a) log(θ_s(a) / P(a | s, H)) ≥ κ        (Eq. 3.13, 3.16)

Logarithms are natural. Actions with θ_s(a) = 0 add nothing to the sum. Every model gives every action a least
probability (`Guide.log_models`), so the ratio is always finite. In states without counts there is no advice.

A guide may have several *goal models*, one for each goal of the experts. It then advises the path to one goal at a
time: the goal with the largest probability per step to go. It drops a goal if the agent reaches it and walks on.
One goal model without a goal is the thesis's advisor. Thesis: §3.7.1.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel

SLOT, FILLED, PREVIOUS, TARGET, SPENDING = range(5)
"""Indices of `WatchedAgent.cursor`: next slot of the window, slots in use, last action, goal model that the advice
leads to (-1: none), and whether saved steps are being spent."""


class Guide(NamedTuple):
    """Tables of an advisor, for G goal models and M behaviour models.

    theta : (G, n_states, n_actions) float64, advice; rows sum to 1, or are all 0 in states without advice
    steps : (G, n_states) float64, the experts' mean steps to the goal, inf in states without advice
    goal_of_state : (n_states,) int32, goal model whose goal the state is, -1: none
    log_models : (M, n_states, H, n_actions) float64, log P(a | s, M); H is 1, or n_actions + 1 (last action)
    log_prior : (M,) float64, log P(M)
    is_expert : (M,) bool, whether a model describes experts
    goal_of_model : (M,) int32, goal model whose goal the behaviour model walks to, -1: none
    goal_share : (G,) float64, how likely each goal is beforehand, relative to their mean: 1 where all are alike
    """

    theta: NDArray[np.float64]
    steps: NDArray[np.float64]
    goal_of_state: NDArray[np.int32]
    log_models: NDArray[np.float64]
    log_prior: NDArray[np.float64]
    is_expert: NDArray[np.bool_]
    goal_of_model: NDArray[np.int32]
    goal_share: NDArray[np.float64]


class AdviceRule(NamedTuple):
    """Conditions of advice; see `AdviceSettings`."""

    kappa: float
    share: float
    burst: float
    own_steps_only: bool


class WatchedAgent(NamedTuple):
    """Evidence about one agent; changed in place.

    ring : (window, M) float64, log P(a | s, M) of each step of the window
    total : (M,) float64, their sum
    posterior : (M,) float64, P(M | H)
    cursor : (5,) int64
    dropped : (G,) bool, goals that the agent has reached and left
    saved : (1,) float64, number of steps that may be advised now
    """

    ring: NDArray[np.float64]
    total: NDArray[np.float64]
    posterior: NDArray[np.float64]
    cursor: NDArray[np.int64]
    dropped: NDArray[np.bool_]
    saved: NDArray[np.float64]


def new_watched_agent(guide: Guide, window: int) -> WatchedAgent:
    """An agent without any steps."""
    n_models, n_goals = len(guide.log_prior), len(guide.theta)
    cursor = np.zeros(SPENDING + 1, np.int64)
    cursor[[PREVIOUS, TARGET]] = -1
    return WatchedAgent(
        np.zeros((window, n_models)),
        np.zeros(n_models),
        np.exp(guide.log_prior),
        cursor,
        np.zeros(n_goals, np.bool_),
        np.zeros(1),
    )


@kernel
def observe(guide, rule, agent, s, a, advised):
    """The agent tried action `a` in state `s`; `advised` if this was the advice. Action -1 is no evidence."""
    # Unpacked once, because reading an array of a tuple inside a loop would count references.
    ring, total, _, cursor, dropped, _ = agent
    log_models, goal = guide.log_models, guide.goal_of_state[s]
    if goal >= 0:
        # The agent was at this goal and walked on.
        dropped[goal] = True
    if a >= 0 and not (advised and rule.own_steps_only):
        h = cursor[PREVIOUS] + 1 if log_models.shape[2] > 1 else 0
        slot, window = cursor[SLOT], len(ring)
        for m in range(total.size):
            total[m] += log_models[m, s, h, a] - ring[slot, m]
            ring[slot, m] = log_models[m, s, h, a]
        cursor[SLOT] = slot + 1
        cursor[FILLED] = min(cursor[FILLED] + 1, window)
        if slot + 1 == window:
            cursor[SLOT] = 0
            # A new sum once a round keeps rounding errors from adding up.
            for m in range(total.size):
                total[m] = 0.0
                for i in range(window):
                    total[m] += ring[i, m]
    cursor[PREVIOUS] = a


@kernel
def consider(guide, rule, agent, s):
    """Whether to advise the agent in state `s`, and the gain in nats; sets the goal in the cursor."""
    _, _, _, cursor, _, saved = agent
    _update_posterior(guide, agent)
    limited = rule.share < 1.0
    if limited and cursor[SPENDING] == 0 and saved[0] >= rule.burst:
        cursor[SPENDING] = 1
    if cursor[SPENDING] == 1 and saved[0] < 1.0:
        cursor[SPENDING] = 0
        cursor[TARGET] = -1
    cursor[TARGET] = _target_goal(guide, agent, s)
    gain = 0.0
    if cursor[TARGET] >= 0:
        gain = _gain(guide, agent, cursor[TARGET], s)
    advised = cursor[TARGET] >= 0 and gain >= rule.kappa and (cursor[SPENDING] == 1 or not limited)
    if limited:
        saved[0] = min(saved[0] + rule.share, rule.burst)
        if advised:
            saved[0] -= 1.0
    return advised, gain


@kernel
def _update_posterior(guide, agent):
    """Set P(M | H) (Eq. 3.15); models of dropped goals get probability 0."""
    _, total, posterior, _, dropped, _ = agent
    goal_of_model, log_prior = guide.goal_of_model, guide.log_prior
    if dropped.all():
        # The agent has left every known goal, so it has an unknown goal or a new one: allow all again.
        dropped[:] = False
    best = -np.inf
    for m in range(total.size):
        goal = goal_of_model[m]
        if (goal < 0 or not dropped[goal]) and log_prior[m] + total[m] > best:
            best = log_prior[m] + total[m]
    mass = 0.0
    for m in range(total.size):
        goal = goal_of_model[m]
        posterior[m] = 0.0
        if goal < 0 or not dropped[goal]:
            posterior[m] = np.exp(log_prior[m] + total[m] - best)
        mass += posterior[m]
    for m in range(total.size):
        posterior[m] /= mass


@inlined
def _is_shown(guide, g, s):
    """Whether experts on their way to goal `g` passed state `s`."""
    return guide.steps[g, s] < np.inf


@inlined
def _target_goal(guide, agent, s):
    """The goal that advice in `s` leads to, -1: none; the present goal, or the most probable per step."""
    _, _, posterior, cursor, dropped, _ = agent
    goal_of_model, goal_share = guide.goal_of_model, guide.goal_share
    present = cursor[TARGET]
    if present >= 0 and cursor[SPENDING] == 1 and not dropped[present] and _is_shown(guide, present, s):
        return present
    left = 0.0
    for g in range(dropped.size):
        if not dropped[g]:
            left += goal_share[g]
    chosen, best = -1, -1.0
    for g in range(dropped.size):
        if dropped[g] or guide.goal_of_state[s] == g or not _is_shown(guide, g, s):
            continue
        weight = 0.0
        for m in range(posterior.size):
            if goal_of_model[m] == g:
                weight += posterior[m]
            elif goal_of_model[m] < 0:
                # An agent without a goal of a model's own has each of those left by how likely it is beforehand.
                weight += posterior[m] * goal_share[g] / left
        weight /= 1.0 + guide.steps[g, s]
        if weight > best:
            best, chosen = weight, g
    return chosen


@inlined
def _gain(guide, agent, g, s):
    """KL[θ_s, P(A | s, H)] in nats (Eq. 3.13, 3.14)."""
    _, _, posterior, cursor, _, _ = agent
    log_models, advice = guide.log_models, guide.theta
    h = cursor[PREVIOUS] + 1 if log_models.shape[2] > 1 else 0
    gain = 0.0
    for a in range(advice.shape[2]):
        theta = advice[g, s, a]
        if theta > 0.0:
            mixture = 0.0
            for m in range(posterior.size):
                mixture += posterior[m] * np.exp(log_models[m, s, h, a])
            gain += theta * np.log(theta / mixture)
    # Rounding may make the gain negative, which must not prevent advice at κ = 0.
    return max(gain, 0.0)
