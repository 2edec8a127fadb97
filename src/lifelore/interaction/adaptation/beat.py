"""BEAT: an interface that adapts its action set to the type of its user, step by step (Algorithm 9).

At every step BEAT learns from the user's move (s, a, s') and chooses an action set: with probability 1 - ε the
action set of the largest expected value under the belief (Eq. 4.9), else any. This is Bayesian policy reuse whose
policies are action sets, whose signals are single transitions and whose rule is ε-greedy. Thesis: §4.8.4.

The printed algorithm never normalises the belief, which underflows within an episode; here beliefs are logarithms.
The printed ε falls from 0.5 by 0.1 an episode. Every action set gives evidence about the type, so exploration
gains no information, and the default is 0.
"""

from collections.abc import Callable
from copy import copy
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.protocols import SignalModel
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.library.library_names import checked_prior
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.choice import choose
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy

Array = NDArray[np.float64]

Exploration = float | str | Callable[[int, int], float]
"""Type of ε: a number, a name of `EPSILONS`, or a function of the step and the episode, both counted from 0."""


# Named functions, because a learner with a lambda could not be pickled.


def _by_step(step: int, episode: int) -> float:
    return 1.0 / (step + 1)


def _by_episode(step: int, episode: int) -> float:
    return max(0.5 - 0.1 * episode, 0.0)


def _constant(epsilon: float, step: int, episode: int) -> float:
    return epsilon


EPSILONS: dict[str, Callable[[int, int], float]] = {"1/n": _by_step, "by episode": _by_episode}
"""The thesis's schedules: 1/n as in §4.8.4.2; 0.5 less 0.1 an episode as in its experiments (§4.8.5.1)."""


def epsilon_of(exploration: Exploration) -> Callable[[int, int], float]:
    """ε as a function of the step and the episode.

    Raises
    ------
    InputError
        A number outside [0, 1], or an unknown name.
    """
    if callable(exploration):
        return exploration
    if isinstance(exploration, str):
        if exploration not in EPSILONS:
            raise InputError(f"epsilon must be a number or one of {', '.join(EPSILONS)}, got {exploration!r}")
        return EPSILONS[exploration]
    return partial(_constant, EpsilonGreedy(float(exploration)).epsilon)


class Beat:
    """The learner that adapts the interface to a single user.

    Parameters
    ----------
    library : PolicyLibrary
        Types × action sets; its performance is V (§4.8.3.1), its signal model that of single transitions.
    epsilon : float, str or callable
        See `Exploration`.
    prior : (n_types,) float, optional
        β⁰; the library's by default.
    actions : SignalModel, optional
        How each type acts under each action set: a second factor of the likelihood, which the thesis leaves out.
        Its signals are the ``action=`` of `update`.
    lag : int
        Steps that a user needs to adapt to a new action set. Until then her actions are judged by the old action
        set. The thesis's users adapt at once.
    seed : int or numpy generator

    Attributes
    ----------
    log_belief : (n_types,) float64
    step, episode : int
        Number of moves so far, and of finished episodes.
    surprises : int
        Number of moves that no type explains; they leave the belief as it is.

    Raises
    ------
    InputError
        ε or the prior breaks its rule, the lag is negative, or `actions` is for other types or action sets.
    """

    def __init__(
        self,
        library: PolicyLibrary,
        *,
        epsilon: Exploration = 0.0,
        prior: ArrayLike | None = None,
        actions: SignalModel | None = None,
        lag: int = 0,
        seed: int | np.random.Generator = 0,
    ) -> None:
        if lag < 0:
            raise InputError(f"lag must be at least 0, got {lag}")
        for axis in ("n_types", "n_policies"):
            if (size := getattr(actions, axis, None)) not in (None, getattr(library, axis)):
                raise InputError(f"actions has {axis} {size}, the library has {getattr(library, axis)}")
        self.library, self.actions = library, actions
        start = library.prior if prior is None else checked_prior(prior, library.n_types)
        self.log_belief: Array = log_prior(start)
        self.step = self.episode = self.surprises = 0
        self.adaptation = Adaptation(lag)
        self._epsilon = epsilon_of(epsilon)
        self._generator = seed if isinstance(seed, np.random.Generator) else stream(seed, "beat")

    @property
    def belief(self) -> Array:
        """β(τ), (n_types,); sums to 1."""
        return np.exp(self.log_belief)

    def select(self) -> int:
        """The action set for the next step; before the first step that of Eq. 4.8."""
        rule = EpsilonGreedy(self._epsilon(self.step, self.episode))
        return int(choose(rule.scores(self.library, self.belief, generator=self._generator), self._generator))

    def update(self, policy: str | int, signal: Any, action: Any = None) -> None:
        """Learn from a move.

        Parameters
        ----------
        policy : str or int
            The action set in force.
        signal
            The transition, as the library's signal model takes it.
        action : optional
            What the user did, as `actions` takes it.

        Raises
        ------
        NotFoundError
            There is no such action set.
        InputError
            An action without a model of actions, or a signal that its model cannot have made. The state stays.
        """
        policy = self.library.index_of_policy(policy)
        adaptation = copy(self.adaptation)
        adapted = adaptation.after_step(policy)
        likelihood = self._log_likelihood(self.library.signal, policy, signal)
        if action is not None:
            if self.actions is None:
                raise InputError("action was given, but no model of actions; give Beat(..., actions=...)")
            likelihood = likelihood + self._log_likelihood(self.actions, adapted, action)
        self.log_belief, evidence = update(self.log_belief, likelihood)
        self.adaptation = adaptation
        self.surprises += bool(np.isneginf(evidence))
        self.step += 1

    def _log_likelihood(self, model: SignalModel, policy: int, signal: Any) -> Array:
        found = np.asarray(model.log_likelihood(policy, signal), np.float64)
        if found.shape != self.log_belief.shape:
            raise InputError(
                f"signal model {type(model).__name__} must give {self.log_belief.shape} log likelihoods, gave "
                f"{found.shape}"
            )
        return found

    def end_episode(self) -> None:
        """Count a finished episode; the belief about the user stays."""
        self.episode += 1


class Adaptation:
    """The action set that a user has adapted to: a new action set only after `lag` steps under it."""

    def __init__(self, lag: int) -> None:
        self.lag, self.held, self.held_for, self.adapted = lag, -1, 0, -1

    def after_step(self, policy: int) -> int:
        """The action set that the user has adapted to in a step under `policy`."""
        if policy != self.held:
            first = self.held < 0
            self.held, self.held_for = policy, self.lag if first else 0
        if self.held_for >= self.lag:
            self.adapted = policy
        self.held_for += 1
        return self.adapted
