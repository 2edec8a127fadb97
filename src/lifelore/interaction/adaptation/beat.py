"""BEAT: an interface that adapts its action set to the type of its user, step by step (Algorithm 9).

At every step BEAT learns from the user's move (s, a, s') and chooses an action set: with probability 1 - ε the
action set of the largest expected value under the belief (Eq. 4.9), else any. This is Bayesian policy reuse whose
policies are action sets, whose signals are single transitions and whose rule is ε-greedy; for many users, give
`ReuseAlgorithm` that rule. Thesis: §4.8.4.

The printed algorithm never normalises the belief, which underflows within an episode; here beliefs are logarithms.
The printed ε falls from 0.5 by 0.1 an episode. Every action set gives evidence about the type, so exploration
gains no information, and the default is 0.
"""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.core.matrices import checked_numbers, dense_transitions
from lifelore.core.mdp import Tables
from lifelore.core.planning.planning import mean_start_value, optimal_q
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy
from lifelore.interaction.signals.transition_signal import TransitionSignal

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

    Examples
    --------
    >>> T = np.eye(3)[[[0, 1], [0, 2], [1, 2]]]  # three places in a row; the second type swaps left and right
    >>> sets = {"left": [0], "right": [1]}
    >>> beat = Beat.from_tasks([T, T[:, ::-1]], np.eye(3)[2], sets, 0.9, starts=[0])
    >>> beat.update("right", [(1, 1, 2)])
    >>> beat.belief.round(2).tolist(), beat.select()
    ([1.0, 0.0], 1)
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
        self._generator = stream(seed, "beat")

    @classmethod
    def from_tasks(
        cls,
        transitions: Sequence[Any],
        rewards: Any,
        action_sets: Mapping[str, ArrayLike],
        discount: float,
        *,
        terminal: ArrayLike = (),
        starts: ArrayLike | None = None,
        epsilon: float | str = "1/n",
        prior: ArrayLike | None = None,
        seed: int | np.random.Generator = 0,
    ) -> Self:
        """Algorithm 9 from the types' MDPs (Eq. 4.7): V is computed by value iteration (line 2).

        V(τ, α) is the mean, over the starts, of the value of the best policy of type τ restricted to the actions
        of α (§4.8.3.1).

        Parameters
        ----------
        transitions : (n_types, n_states, n_actions, n_states) float, or sequence
            T(s' | s, a; τ) of each type, in any form of `Tables.from_matrices`.
        rewards, terminal, starts
            As for `Tables.from_matrices`; the same for all types.
        action_sets : mapping of str to (n,) int
            The actions of each set α; in the thesis no two sets share one.
        discount : float
            γ in [0, 1).
        epsilon, prior, seed
            As for `Beat`; ε is 1/n by default, as printed.

        Raises
        ------
        InputError
            A matrix breaks its rule, types differ in states or actions, or a set is empty or names no action.

        Examples
        --------
        >>> sure = [[[0, 1], [1, 0], [0, 1]], [[0, 1], [0, 1], [0, 1]]]
        >>> shaky = [[[0.8, 0.2], [1, 0], [0.1, 0.9]], [[0, 1], [0, 1], [0, 1]]]
        >>> sets = {"fast": [0, 1], "slow": [2]}
        >>> beat = Beat.from_tasks([sure, shaky], [0.0, 1.0], sets, 0.9, terminal=1, epsilon=0.0)
        >>> beat.library.performance.mean.round(2).tolist()
        [[1.0, 1.0], [0.71, 0.99]]
        >>> beat.update("fast", (0, 0, 0))
        >>> beat.belief.tolist(), beat.library.policies[beat.select()]
        ([0.0, 1.0], 'slow')
        """
        tables = [Tables.from_matrices(each, rewards, terminal, starts) for each in transitions]
        if len({each.next_state.shape[:2] for each in tables}) != 1:
            raise InputError("transitions must be of types with the same states and actions, at least one type")
        n_actions = tables[0].n_actions
        if not isinstance(action_sets, Mapping):
            raise InputError(f"action_sets must map names to actions, got {type(action_sets).__name__}")
        sets = {
            name: checked_numbers(given, n_actions, f"action set '{name}'") for name, given in action_sets.items()
        }
        if not sets or not all(len(chosen) for chosen in sets.values()):
            raise InputError(f"action_sets must be sets of at least one action each, got {dict(action_sets)}")
        values = [[_value(each, chosen, discount) for chosen in sets.values()] for each in tables]
        signal = TransitionSignal(np.stack([dense_transitions(each) for each in tables]))
        library = PolicyLibrary.from_means(values, 1.0, policies=tuple(sets), signal=signal)
        return cls(library, epsilon=epsilon, prior=prior, seed=seed)

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


def _value(tables: Tables, actions: NDArray[np.int64], discount: float) -> float:
    """V of the best policy that takes only these actions, mean over the starts."""
    by_pair = tables.by_pair
    parts = {name: getattr(by_pair, name)[:, actions] for name in ("next_state", "reward", "event", "outcome_cum")}
    return mean_start_value(tables, optimal_q(by_pair._replace(**parts), discount).max(axis=1))
