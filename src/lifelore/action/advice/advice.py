"""When to give advice, and which: the evidence of the last steps, step by step, in log space.

    P(M | H) ∝ P(M) Π P(a | s, M)  over the window H                                      (Eq. 3.15)
    P(a | s, H) = Σ_M P(a | s, M) P(M | H)                                                 (Eq. 3.14)
    advise θ_s  if  KL[θ_s, P(A | s, H)] = Σ_a θ_s(a) log(θ_s(a) / P(a | s, H)) ≥ κ        (Eq. 3.13, 3.16)

Logarithms are natural. An action that θ excludes adds nothing to the sum; every model keeps a trace of mass for
every action (`Guide.log_models`), so the ratio is always finite. Where nothing was counted, nothing is advised.

A guide may know several *purposes* (the goals that experts went to): then it advises the way to one of them at a
time, the one likeliest to be the agent's for the steps it costs, and drops a goal that the agent left again. One
purpose without a goal is the thesis's advisor.
Thesis: §3.7.1.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import inlined, kernel

SLOT, FILLED, PREVIOUS, TARGET, SPENDING = range(5)
"""Places in `Watch.cursor`: next slot of the window, slots in use, action tried last, purpose advised for or -1,
whether what was saved up is being spent."""


class Guide(NamedTuple):
    """What an advisor knows; G purposes, M models.

    theta : (G, n_states, n_actions) float64, advice; rows sum to 1, or are all 0 where it is silent
    steps : (G, n_states) float64, steps to go as far as experts showed, inf where it is silent
    goal_of : (n_states,) int32, purpose whose goal a state is, -1: none
    log_models : (M, n_states, H, n_actions) float64, log P(a | s, M); H is 1, or n_actions + 1 (action tried last)
    log_prior : (M,) float64, log P(M)
    normal : (M,) bool, whether a model is one of experts
    purpose_of : (M,) int32, the purpose a model is bound for, -1: none
    """

    theta: NDArray[np.float64]
    steps: NDArray[np.float64]
    goal_of: NDArray[np.int32]
    log_models: NDArray[np.float64]
    log_prior: NDArray[np.float64]
    normal: NDArray[np.bool_]
    purpose_of: NDArray[np.int32]


class Rule(NamedTuple):
    """When advice is given; see `AdviceSettings`."""

    kappa: float
    share: float
    burst: float
    own_steps_only: bool


class Watch(NamedTuple):
    """What is known of one agent; changed in place.

    ring : (window, M) float64, log P(a | s, M) of each step of the window
    total : (M,) float64, their sum
    posterior : (M,) float64, P(M | H)
    cursor : (5,) int64
    dropped : (G,) bool, goals that were not this agent's
    saved : (1,) float64, steps that may be advised by now
    """

    ring: NDArray[np.float64]
    total: NDArray[np.float64]
    posterior: NDArray[np.float64]
    cursor: NDArray[np.int64]
    dropped: NDArray[np.bool_]
    saved: NDArray[np.float64]


def new_watch(guide: Guide, window: int) -> Watch:
    """Nothing seen of the agent yet."""
    n_models, n_purposes = len(guide.log_prior), len(guide.theta)
    cursor = np.zeros(5, np.int64)
    cursor[[PREVIOUS, TARGET]] = -1
    return Watch(
        np.zeros((window, n_models)),
        np.zeros(n_models),
        np.exp(guide.log_prior),
        cursor,
        np.zeros(n_purposes, np.bool_),
        np.zeros(1),
    )


@kernel
def observe(guide, rule, watch, s, a, advised):
    """The agent, in state `s`, tried action `a`; `advised` if it had been told to. Action -1 is no evidence."""
    ring, total, _, cursor, dropped, _ = watch
    if guide.goal_of[s] >= 0:
        # It stood on this goal and went on.
        dropped[guide.goal_of[s]] = True
    if a >= 0 and not (advised and rule.own_steps_only):
        h = cursor[2] + 1 if guide.log_models.shape[2] > 1 else 0
        slot, window = cursor[0], len(ring)
        for m in range(total.size):
            total[m] += guide.log_models[m, s, h, a] - ring[slot, m]
            ring[slot, m] = guide.log_models[m, s, h, a]
        cursor[0] = slot + 1
        cursor[1] = min(cursor[1] + 1, window)
        if slot + 1 == window:
            cursor[0] = 0
            # Summed afresh once a round, so that rounding never piles up.
            for m in range(total.size):
                total[m] = 0.0
                for i in range(window):
                    total[m] += ring[i, m]
    cursor[2] = a


@kernel
def consider(guide, rule, watch, s):
    """What to tell the agent in state `s`: (whether to advise, gain in nats); the purpose stands in the cursor."""
    _, _, _, cursor, _, saved = watch
    _update_posterior(guide, watch)
    limited = rule.share < 1.0
    if limited and cursor[4] == 0 and saved[0] >= rule.burst:
        cursor[4] = 1
    if cursor[4] == 1 and saved[0] < 1.0:
        cursor[4] = 0
        cursor[3] = -1
    cursor[3] = _purpose(guide, watch, s)
    gain = 0.0
    if cursor[3] >= 0:
        gain = _gain(guide, watch, cursor[3], s)
    advised = cursor[3] >= 0 and gain >= rule.kappa and (cursor[4] == 1 or not limited)
    if limited:
        saved[0] = min(saved[0] + rule.share, rule.burst)
        if advised:
            saved[0] -= 1.0
    return advised, gain


@kernel
def _update_posterior(guide, watch):
    """P(M | H) (Eq. 3.15), models bound for dropped goals left out."""
    _, total, posterior, _, dropped, _ = watch
    if dropped.all():
        # None of the goals known was its goal, or it has a new errand: begin again.
        dropped[:] = False
    best = -np.inf
    for m in range(total.size):
        purpose = guide.purpose_of[m]
        if (purpose < 0 or not dropped[purpose]) and guide.log_prior[m] + total[m] > best:
            best = guide.log_prior[m] + total[m]
    mass = 0.0
    for m in range(total.size):
        purpose = guide.purpose_of[m]
        posterior[m] = 0.0
        if purpose < 0 or not dropped[purpose]:
            posterior[m] = np.exp(guide.log_prior[m] + total[m] - best)
        mass += posterior[m]
    for m in range(total.size):
        posterior[m] /= mass


@inlined
def _is_shown(guide, g, s):
    """Whether experts bound for `g` passed state `s`."""
    return guide.steps[g, s] < np.inf


@inlined
def _purpose(guide, watch, s):
    """The purpose to advise for in `s`, -1 where nothing is known: the present one, or the likeliest per step."""
    _, _, posterior, cursor, dropped, _ = watch
    present = cursor[3]
    if present >= 0 and cursor[4] == 1 and not dropped[present] and _is_shown(guide, present, s):
        return present
    left = dropped.size - dropped.sum()
    chosen, best = -1, -1.0
    for g in range(dropped.size):
        if dropped[g] or guide.goal_of[s] == g or not _is_shown(guide, g, s):
            continue
        weight = 0.0
        for m in range(posterior.size):
            if guide.purpose_of[m] == g:
                weight += posterior[m]
            elif guide.purpose_of[m] < 0:
                weight += posterior[m] / left
        weight /= 1.0 + guide.steps[g, s]
        if weight > best:
            best, chosen = weight, g
    return chosen


@inlined
def _gain(guide, watch, g, s):
    """KL[θ_s, P(A | s, H)] in nats (Eq. 3.13, 3.14)."""
    _, _, posterior, cursor, _, _ = watch
    h = cursor[2] + 1 if guide.log_models.shape[2] > 1 else 0
    gain = 0.0
    for a in range(guide.theta.shape[2]):
        theta = guide.theta[g, s, a]
        if theta > 0.0:
            mixture = 0.0
            for m in range(posterior.size):
                mixture += posterior[m] * np.exp(guide.log_models[m, s, h, a])
            gain += theta * np.log(theta / mixture)
    # Never negative but by rounding, which must not silence κ = 0.
    return max(gain, 0.0)
