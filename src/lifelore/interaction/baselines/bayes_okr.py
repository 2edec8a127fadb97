"""Bayes-OKR: belief over opponents between episodes and within them (Chen et al., 2020).

Returns tell of an opponent only at the end of an episode; its moves tell sooner. In each episode:

    ξ ← β                                             the belief within the episode starts at that between episodes
    at each step:  ξ(τ) ← Π F(σ | τ, π) ξ(τ) / Σ ΠFξ  over the last l signals σ, with a floor
                   π ← argmax Σ (ρ β(τ) + (1 − ρ) ξ(τ)) E[U | τ, π]
    at its end:    β(τ) ← P(r | τ, π) β(τ) / Σ P β    by the return r, with a floor

F are models of the opponent's moves, the library's signal model. With l > 1 each signal counts up to l times; by
default each counts once. Not certain of the paper are the values of ρ, l and the floor, whether the mixture of β
and ξ replaces ξ or serves selection alone (as here), and how a return is read where several policies ran (here as
the return of the last of them).
"""

from collections import deque
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.interaction.baselines.bpr_plus import checked_floor, floored
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import law_of
from lifelore.interaction.selection.choice import Available, available_mask, choose, scored
from lifelore.interaction.selection.greedy import Greedy

Array = NDArray[np.float64]


class BayesOKR:
    """Policy reuse for a single task, with methods as in `BayesianPolicyReuse`.

    Parameters
    ----------
    library : PolicyLibrary
        Its signal model is that of steps or moves within an episode, its performance model that of returns.
    prior : (n_types,) float, optional
        The library's by default.
    weight : float
        ρ in [0, 1], the share of the belief between episodes in each selection.
    window : int
        l ≥ 1, number of signals.
    floor : float
        Least belief in a type before the sum is 1 again, in [0, 1 / n_types]; more forgets sooner.
    seed : int or numpy generator
        Serves the choice among equal policies.

    Attributes
    ----------
    between, within : (n_types,) float64
        log β and log ξ.

    Examples
    --------
    >>> from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal
    >>> moves = LikelihoodSignal(lambda policy, move: np.log([[0.9, 0.1], [0.1, 0.9]])[move], n_types=2)
    >>> agent = BayesOKR(PolicyLibrary.from_means([[1.0, 0.0], [0.0, 1.0]], 0.1, signal=moves))
    >>> agent.observe(0, 1)
    >>> agent.belief.round(2).tolist(), agent.select()
    ([0.14, 0.86], 1)
    >>> agent.end_episode(0.9)
    """

    def __init__(
        self,
        library: PolicyLibrary,
        *,
        prior: ArrayLike | None = None,
        weight: float = 0.1,
        window: int = 1,
        floor: float = 0.01,
        seed: int | np.random.Generator = 0,
    ) -> None:
        if not 0 <= weight <= 1 or not window >= 1:
            raise InputError(f"weight must lie in [0, 1] and window be at least 1, got {weight} and {window}")
        self.library, self.weight, self.floor = library, weight, checked_floor(floor, library)
        self.between: Array = log_prior(library.prior if prior is None else prior)
        if self.between.shape != (library.n_types,):
            raise InputError(f"prior must be ({library.n_types},), got {self.between.shape}")
        self.generator = stream(seed, "bayes-okr")
        self._law = law_of(library.signal, library.n_types, "plug-in")
        self._last: deque[Array] = deque(maxlen=window)
        self._begin()

    def _begin(self) -> None:
        """Start an episode."""
        self.within = self.between.copy()
        self._last.clear()
        self._policy: int | None = None

    @property
    def belief(self) -> Array:
        """ρ β + (1 − ρ) ξ, (n_types,); sums to 1."""
        return self.weight * np.exp(self.between) + (1 - self.weight) * np.exp(self.within)

    def select(self, available: Available | None = None) -> int:
        """The policy of the largest expected return now, also within an episode; equals at random.

        `available` and errors are as in `BayesianPolicyReuse.select`.
        """
        mask = None if available is None else available_mask(available, self.library.policies)
        chosen = choose(scored(Greedy(), self.library, self.belief, mask), self.generator)
        if not self._last:
            self._policy = chosen
        return chosen

    def observe(self, policy: int | str, signal: Any) -> None:
        """Learn from a signal of a policy within the episode; errors are the signal model's."""
        index = self.library.index_of_policy(policy)
        log_likelihood = self._law.log_likelihoods(index, self._law.checked(signal))
        last = deque([*self._last, log_likelihood], self._last.maxlen)
        self.within = floored(update(self.within, np.sum(last, axis=0)).log_belief, self.floor)
        self._last, self._policy = last, index

    def end_episode(self, outcome: float | None = None) -> None:
        """End the episode; its return teaches the belief between episodes.

        Parameters
        ----------
        outcome : float, optional
            The return, read as that of the policy of the last signal, or without signals of the last selected.

        Raises
        ------
        InputError
            The return is no finite number, or no policy was selected or observed. All stays as it was.
        """
        if outcome is not None:
            if self._policy is None:
                raise InputError("the return is of no policy; call select() or observe() before end_episode()")
            log_likelihood = self.library.performance.log_density(self._policy, outcome)
            self.between = floored(update(self.between, log_likelihood).log_belief, self.floor)
        self._begin()

    def update(self, policy: int | str, signal: Any, outcome: float | None = None) -> None:
        """Learn from the only signal of an episode and its return: `observe` and `end_episode`."""
        self.observe(policy, signal)
        self.end_episode(outcome)
