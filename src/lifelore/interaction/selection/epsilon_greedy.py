"""ε-greedy selection: with probability ε any policy, else the greedy policy. Thesis: §4.5."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from lifelore.core.errors import InputError
from lifelore.interaction.selection.choice import tied_shares
from lifelore.interaction.selection.rule import Array, RuleLibrary, check_generator


@dataclass(frozen=True)
class EpsilonGreedy:
    """ε-greedy on the expected utility.

    Parameters
    ----------
    epsilon : float
        In [0, 1]; the thesis's surveillance experiments take 0.3.

    Raises
    ------
    InputError
        `epsilon` lies outside [0, 1].

    Examples
    --------
    >>> from lifelore import PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> EpsilonGreedy(0.2).probabilities(library, np.array([1.0, 0.0])).tolist()
    [0.9, 0.1]
    """

    epsilon: float = 0.3
    name: ClassVar[str] = "epsilon-greedy"
    by_means: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not 0 <= self.epsilon <= 1:
            raise InputError(f"epsilon must lie in [0, 1], got {self.epsilon}")

    def scores(
        self, library: RuleLibrary, belief: Array, *, generator: np.random.Generator | None = None, **_: Any
    ) -> Array:
        """Expected utilities, or with probability ε random numbers, (P,) or (k, P)."""
        generator = check_generator(self.name, generator)
        utility = library.performance.expected(belief)
        explores = np.asarray(generator.random(utility.shape[:-1]) < self.epsilon)
        if not explores.any():
            return utility
        return np.where(explores[..., None], generator.random(utility.shape), utility)

    def probabilities(self, library: RuleLibrary, belief: Array, **_: Any) -> Array:
        """Probability of selecting each policy, (P,) or (k, P); rows sum to 1."""
        best = tied_shares(library.performance.expected(belief))
        return self.epsilon / best.shape[-1] + (1 - self.epsilon) * best
