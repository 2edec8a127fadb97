"""Probabilistic policy reuse (PRQ): Q-learning whose exploration follows policies of a library.

Before each episode a policy k is drawn with probability ∝ exp(τ W_k), where W_k is its mean return so far (0
before its first episode) and τ rises by Δτ an episode. The last policy is the new policy, followed greedily. A
past policy is followed with probability ψ at a step, else the new policy ε-greedily. ψ has its initial value at
the start of each episode and decays by ν a step. The new policy is learnt from every step of every episode.

PRQ runs on tables and reads the rows of Q that it is given (`Rows.q_row`), so it can learn where the state is
hidden. Fernandez and Veloso (2006); thesis: §4.6.3, Figure 4.8.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.compiled.random_state import next_uniform, random_state
from lifelore.core.errors import InputError
from lifelore.core.learning.curve import Curve, new_curve
from lifelore.core.learning.q_learning import Rows, Schedule, epsilon_greedy
from lifelore.core.mdp import COLLISION, TERMINAL, Tables


class Reuser(NamedTuple):
    """The state between episodes; changed in place.

    q : (n_q_rows, n_actions) float64
    gain, uses : (n_policies + 1,) float64, mean return W by policy, the new policy last, and number of episodes
    temperature : (1,) float64, τ
    world_random, own_random : (2,) uint64
    """

    q: NDArray[np.float64]
    gain: NDArray[np.float64]
    uses: NDArray[np.float64]
    temperature: NDArray[np.float64]
    world_random: NDArray[np.uint64]
    own_random: NDArray[np.uint64]


class ReuseRule(NamedTuple):
    """Δτ, ψ at the start of an episode, ν, and the divisor of W before τ multiplies it."""

    temperature_step: float
    reuse: float
    reuse_decay: float
    gain_unit: float


@dataclass(frozen=True)
class ProbabilisticPolicyReuse:
    """The settings of PRQ, and runs of it on tables.

    Parameters
    ----------
    temperature, temperature_step : float
        τ of the first episode and Δτ; at least 0. Thesis and paper: 0 and 0.05.
    reuse, reuse_decay : float
        ψ of an episode's first step, and ν, both in [0, 1]. The thesis gives no values; paper: 1 and 0.95.
    gain_unit : float
        Divisor of returns in the softmax; positive. τ is in units of 1/return: the paper's returns lie in
        [0, 1], and returns of 100 make its temperatures a hundred times as greedy.

    Examples
    --------
    >>> import numpy as np
    >>> from lifelore.core.mdp import Tables
    >>> from lifelore.core.learning.q_learning import Schedule, uniform_rows
    >>> corridor = Tables(np.array([[[0], [1]], [[0], [1]]], np.int32), np.array([[[0.0], [0.0]], [[0.0], [1.0]]]),
    ...                   np.array([[[0], [0]], [[0], [1]]], np.uint8), np.ones(1), np.zeros(1, np.int32))
    >>> always_on = np.array([[[0.0, 1.0], [0.0, 1.0]]])
    >>> prq, streams = ProbabilisticPolicyReuse(), [np.random.default_rng(i) for i in (0, 1)]
    >>> reuser = prq.begin(2, always_on, *streams)
    >>> plan = Schedule(np.full(50, 0.1), np.full(50, 0.5), 20, 1.0)
    >>> curve, chosen = prq.learn(corridor, uniform_rows(corridor), always_on, plan, reuser)
    >>> float(curve.returns[-10:].mean()), reuser.q.argmax(axis=1).tolist()
    (1.0, [1, 1])
    """

    temperature: float = 0.0
    temperature_step: float = 0.05
    reuse: float = 1.0
    reuse_decay: float = 0.95
    gain_unit: float = 1.0

    def __post_init__(self) -> None:
        for name in ("temperature", "temperature_step"):
            if not 0 <= getattr(self, name) < np.inf:
                raise InputError(f"{name} must be at least 0, got {getattr(self, name)}")
        for name in ("reuse", "reuse_decay"):
            if not 0 <= getattr(self, name) <= 1:
                raise InputError(f"{name} must lie in [0, 1], got {getattr(self, name)}")
        if not 0 < self.gain_unit < np.inf:
            raise InputError(f"gain_unit must be positive, got {self.gain_unit}")

    def begin(
        self, n_q_rows: int, library: NDArray[np.float64], world: np.random.Generator, own: np.random.Generator
    ) -> Reuser:
        """A learner before its first episode: Q = 0, W = 0."""
        n_policies, n_rows, n_actions = np.shape(library)
        if n_rows != n_q_rows:
            raise InputError(f"library must have {n_q_rows} rows a policy, one for each row of Q, got {n_rows}")
        if np.min(library, initial=0.0) < 0 or not np.allclose(np.sum(library, axis=2), 1, atol=1e-9):
            raise InputError("library must hold probabilities: non-negative rows that sum to 1")
        return Reuser(
            np.zeros((n_q_rows, n_actions)),
            np.zeros(n_policies + 1),
            np.zeros(n_policies + 1),
            np.array([self.temperature]),
            random_state(world),
            random_state(own),
        )

    def learn(
        self, tables: Tables, rows: Rows, library: NDArray[np.float64], schedule: Schedule, reuser: Reuser
    ) -> tuple[Curve, NDArray[np.int64]]:
        """Run the episodes of `schedule`; a later call with the same `reuser` continues.

        Parameters
        ----------
        tables : Tables
        rows : Rows
            Which row of Q, and of the policies, is read in a state; exploration and ties (context of class 0).
        library : (n_policies, n_q_rows, n_actions) float
            Probabilities of actions; rows sum to 1.
        schedule : Schedule
            ε and α of each episode, the cap on steps, γ.
        reuser : Reuser
            From `begin`; changed in place.

        Returns
        -------
        curve : Curve
            Its ``returns``, discounted by γ, are what W averages.
        chosen : (n_episodes,) int64
            The followed policy; n_policies for the new policy.
        """
        library_cum = np.cumsum(library, axis=2, dtype=np.float64)
        library_cum[..., -1] = 1.0
        rule = ReuseRule(self.temperature_step, self.reuse, self.reuse_decay, self.gain_unit)
        curve = new_curve(len(schedule.epsilon))
        return curve, _learn(tables, rows, library_cum, schedule, rule, reuser, curve)


@kernel
def _learn(tables, rows, library_cum, schedule, rule, reuser, curve):
    next_state, reward_of, event_of, outcome_cum, starts = tables
    q_row, context_row, _, explore_cum, tie_weight = rows
    epsilons, alphas, max_steps, gamma = schedule
    q, gain, uses, temperature, world, own = reuser
    returns, rewards, steps, collisions, reached = curve
    cum = np.broadcast_to(outcome_cum, next_state.shape)
    new, n_outcomes = gain.size - 1, next_state.shape[2]
    chosen = np.zeros(epsilons.size, np.int64)
    for episode in range(epsilons.size):
        k = _draw_policy(gain, temperature[0] / rule.gain_unit, own)
        psi, discount = rule.reuse, 1.0
        state = starts[int(next_uniform(world) * starts.size)]
        for _ in range(max_steps):
            row = q_row[state]
            if k < new and next_uniform(own) < psi:
                u = next_uniform(own)
                a = 0
                while u >= library_cum[k, row, a]:
                    a += 1
            else:
                epsilon = epsilons[episode] if k < new else 0.0
                a = epsilon_greedy(q, row, explore_cum, tie_weight, context_row[state, 0], epsilon, own)
            o = 0
            if n_outcomes > 1:
                u = next_uniform(world)
                while u >= cum[state, a, o]:
                    o += 1
            following, event, reward = next_state[state, a, o], event_of[state, a, o], reward_of[state, a, o]
            target = reward
            if not event & TERMINAL:
                target += gamma * q[q_row[following]].max()
            q[row, a] += alphas[episode] * (target - q[row, a])
            returns[episode] += discount * reward
            rewards[episode] += reward
            steps[episode] += 1
            if event & COLLISION:
                collisions[episode] += 1
            state = following
            psi *= rule.reuse_decay
            discount *= gamma
            if event & TERMINAL:
                reached[episode] = True
                break
        uses[k] += 1.0
        gain[k] += (returns[episode] - gain[k]) / uses[k]
        temperature[0] += rule.temperature_step
        chosen[episode] = k
    return chosen


@kernel
def _draw_policy(gain, temperature, random):
    """A policy with probability ∝ exp(τ W)."""
    # The greatest exponent is 0, so no weight overflows.
    weight = np.exp(temperature * (gain - gain.max()))
    left = next_uniform(random) * weight.sum()
    for k in range(gain.size - 1):
        left -= weight[k]
        if left < 0.0:
            return k
    return gain.size - 1
