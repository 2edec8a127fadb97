"""BEAT: an interface that adapts its action set to the type of its user, step by step (Algorithm 9).

At every step BEAT learns from the user's move (s, a, s') and chooses an action set: with probability 1 - ε the
action set of the largest expected value under the belief (Eq. 4.9), else any. This is Bayesian policy reuse whose
policies are action sets, whose signals are single transitions and whose rule is ε-greedy; for many users, give
`ReuseAlgorithm` that rule. Thesis: §4.8.4.

The printed algorithm never normalises the belief, which underflows within an episode; here beliefs are logarithms.
The printed ε falls from 0.5 by 0.1 an episode. Every action set gives evidence about the type, so exploration
gains no information, and the default is 0.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy

Array = NDArray[np.float64]

EPSILONS: dict[str, Callable[[int, int], float]] = {
    "1/n": lambda step, episode: 1.0 / (step + 1),
    "by episode": lambda step, episode: max(0.5 - 0.1 * episode, 0.0),
}
"""The thesis's schedules, functions of the step and the episode, both counted from 0.

1/n as in §4.8.4.2; 0.5 less 0.1 an episode as in its experiments (§4.8.5.1).
"""


def rule_at(epsilon: float | str, step: int = 0, episode: int = 0) -> EpsilonGreedy:
    """The selection rule at a step of an episode, for ε as a number or a name of `EPSILONS`.

    Raises
    ------
    InputError
        A number outside [0, 1], or an unknown name.
    """
    if not isinstance(epsilon, str):
        return EpsilonGreedy(float(epsilon))
    if epsilon not in EPSILONS:
        raise InputError(f"epsilon must be a number or one of {', '.join(EPSILONS)}, got {epsilon!r}")
    return EpsilonGreedy(EPSILONS[epsilon](step, episode))


class Beat:
    """The learner that adapts the interface to a single user.

    Parameters
    ----------
    library : PolicyLibrary
        Types × action sets; its performance is V (§4.8.3.1), its signal model that of single transitions.
    epsilon : float or str
        A number in [0, 1], or a name of `EPSILONS`.
    prior : (n_types,) float, optional
        β⁰; the library's by default.
    seed : int or numpy generator

    Attributes
    ----------
    algorithm : ReuseAlgorithm
        Its only row is the belief about the user.
    step, episode : int
        Number of moves so far, and of finished episodes.
    surprises : int
        Number of moves that no type explains; they leave the belief as it is.

    Raises
    ------
    InputError
        ε or the prior breaks its rule.
    """

    def __init__(
        self,
        library: PolicyLibrary,
        *,
        epsilon: float | str = 0.0,
        prior: ArrayLike | None = None,
        seed: int | np.random.Generator = 0,
    ) -> None:
        rule_at(epsilon)
        self.library = library
        self.algorithm = ReuseAlgorithm(library, prior=prior, dynamics=TypeDynamics.static(), models="plug-in")
        self.step = self.episode = self.surprises = 0
        self._epsilon = epsilon
        self._generator = seed if isinstance(seed, np.random.Generator) else stream(seed, "beat")

    @property
    def log_belief(self) -> Array:
        """log β(τ), (n_types,); a copy."""
        return self.algorithm.log_belief[0].copy()

    @property
    def belief(self) -> Array:
        """β(τ), (n_types,); sums to 1."""
        return self.algorithm.belief(0)

    @property
    def rule(self) -> EpsilonGreedy:
        """The selection rule of the next step."""
        return rule_at(self._epsilon, self.step, self.episode)

    def select(self) -> int:
        """The action set for the next step; before the first step that of Eq. 4.8."""
        return self.algorithm.select(0, self.rule, self._generator)[0]

    def update(self, policy: str | int, signal: Any) -> None:
        """Learn from a move.

        Parameters
        ----------
        policy : str or int
            The action set in force.
        signal
            The transition, as the library's signal model takes it.

        Raises
        ------
        NotFoundError
            There is no such action set.
        InputError
            The signal model cannot have made the signal. The state stays.
        """
        observed = self.algorithm.observe(0, self.library.index_of_policy(policy), signal)
        self.surprises += bool(observed.log_evidence == -np.inf)
        self.step += 1

    def end_episode(self) -> None:
        """Count a finished episode; the belief about the user stays."""
        self.episode += 1
