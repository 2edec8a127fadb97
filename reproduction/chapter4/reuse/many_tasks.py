"""Policy reuse and its peers on many tasks side by side, and statistics of their regret.

All methods of a comparison meet the same tasks and the same noise: the signals of an episode are fixed
before any method chooses. Regret is expected library regret (Definition 4.3.1): how much less the chosen policy
pays on average than the best of the library.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.intervals import LEAST_VALUES, RESAMPLES, percentile_interval
from lifelore.core.metrics import Estimate, entropy, mean_estimate
from lifelore.core.streams import stream
from lifelore.interaction.baselines import Baseline
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Models
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.selection import SelectionRule

Array = NDArray[np.float64]
Signals = Callable[[int, NDArray[np.int64]], NDArray]
"""``signals(episode, policies)``: the signals of the policies (n_tasks,) in that episode, (n_tasks,)."""

EXACT, LEARNT, UNCERTAIN = "exact", "learnt", "uncertain"
"""Kinds of models that rules know: true, learnt and taken for the truth, learnt and known to be uncertain."""
SETTLED = 1e-9
"""Regret below this is none."""
LAST = 10
"""Number of episodes that count as the last."""


class Played(NamedTuple):
    """Policies chosen in each episode.

    policies : (n_tasks, n_episodes) int64
    entropy : (n_tasks, n_episodes + 1) float64, of the belief before each episode and after the last, nats
    """

    policies: NDArray[np.int64]
    entropy: Array


def play_rule(
    rule: SelectionRule,
    library: PolicyLibrary,
    signals: Signals,
    n_tasks: int,
    n_episodes: int,
    generator: np.random.Generator,
    first: int | None = None,
    models: Models = "plug-in",
) -> Played:
    """Bayesian policy reuse (Alg. 7, 8) on `n_tasks` tasks at once; types are static, as in the thesis.

    Parameters
    ----------
    generator : numpy generator
        Serves the rule and the choice among equals.
    first : int, optional
        The policy of the first episode, in place of the rule's choice.
    models : {"plug-in", "uncertain"}
        Whether models are taken for the truth, as in the thesis, or learnt models are known to be uncertain.
    """
    reuse = ReuseAlgorithm(library, n_tasks, dynamics=TypeDynamics.static(), models=models)
    every = np.arange(n_tasks)
    policies = np.empty((n_tasks, n_episodes), np.int64)
    entropies = np.empty((n_tasks, n_episodes + 1))
    for t in range(n_episodes):
        entropies[:, t] = entropy(reuse.belief(every))
        if t == 0 and first is not None:
            policies[:, t] = first
        else:
            policies[:, t], _ = reuse.select(every, rule, generator, episodes_left=n_episodes - 1 - t)
        reuse.update(every, policies[:, t], signals(t, policies[:, t]))
    entropies[:, -1] = entropy(reuse.belief(every))
    return Played(policies, entropies)


def play_baseline(player: Baseline, pays: Signals, n_episodes: int) -> NDArray[np.int64]:
    """The policies, (n_tasks, n_episodes), of a peer that learns from payoffs."""
    policies = np.empty((player.rows, n_episodes), np.int64)
    for t in range(n_episodes):
        policies[:, t] = player.select()
        player.update(policies[:, t], pays(t, policies[:, t]))
    return policies


def converged_after(regret: Array) -> NDArray[np.int64]:
    """First episode, from 1, from which on regret is none, (n_tasks,); the last plus 1 where it never is."""
    n_episodes = regret.shape[1]
    some = regret > SETTLED
    last = n_episodes - some[:, ::-1].argmax(axis=1)
    return np.where(some.any(axis=1), last, 0) + 1


def late_regret(regret: Array) -> Array:
    """Mean regret over the last ten episodes, (n_tasks,)."""
    return regret[:, -LAST:].mean(axis=1)


def grouped_mean(values: ArrayLike) -> Estimate:
    """Mean and median of `values` (n_groups, n_each), with an interval from groups, whose members share much."""
    values = np.asarray(values, float)
    of_groups = mean_estimate(values.mean(axis=1))
    return Estimate(of_groups.value, float(np.median(values)), of_groups.ci95, values.size)


def grouped_quantile(values: ArrayLike, q: float) -> Estimate:
    """Quantile of all `values` (n_groups, n_each), with a bootstrap interval over groups; none below three."""
    values, interval = np.asarray(values, float), None
    n = len(values)
    if n >= LEAST_VALUES:
        draws = stream(n, "bootstrap of a quantile").integers(0, n, size=(RESAMPLES, n))
        interval = percentile_interval(np.quantile(values[draws].reshape(RESAMPLES, -1), q, axis=1))
    return Estimate(float(np.quantile(values, q)), float(np.median(values)), interval, values.size)
