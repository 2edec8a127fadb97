"""BPR+: policy reuse against opponents that switch between known types (Hernandez-Leal et al., 2016).

Identifying and tracking switching, non-stationary opponents: a Bayesian approach. In each episode:

    π ← argmax of expected improvement under β;  run π, obtain the return r
    β(τ) ← P(r | τ, π) β(τ) / Σ P β,  no entry below a floor, so that each type can return
    p(τ) ← mean over the last n returns of how well type τ explains them
    if p(τ) < ρ for all types:  no type fits

From there the paper learns a policy against the new opponent and adds both to the library. That is left out: here
the belief begins again at the prior, which also ends a window that mixes two types. The paper's p is a density;
here it is that of a normal return, as a share of its density at the mean, so that ρ has no unit. The values of the
floor, n and ρ are ours.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.baselines.baseline import LEAST, Baseline
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import law_of
from lifelore.interaction.selection import SelectionRule, rule_of
from lifelore.interaction.selection.choice import scored


class BPRPlus(Baseline):
    """A belief over a library's types by returns alone; the models are taken for the truth, as in the paper.

    Parameters
    ----------
    library : PolicyLibrary
        Of `n_policies` policies; not copied.
    rule : SelectionRule or str
        The paper's is expected improvement.
    floor : float
        Least belief in a type before the sum is 1 again, in [0, 1 / n_types]; more forgets sooner.
    window : int
        n ≥ 1, number of returns; 0 never begins again.
    threshold : float
        ρ in [0, 1]. A return of the right type explains itself to 0.71 on average, if it is normal.
    n_policies, n_tasks, seed
        As in `Baseline`.

    Examples
    --------
    >>> library = PolicyLibrary.from_means([[1.0, 0.0], [0.0, 1.0]], 0.1)
    >>> player = BPRPlus.from_library(library)
    >>> player.update(0, 0.05)
    >>> player.belief.round(3).tolist(), player.select()
    ([0.001, 0.999], 1)
    """

    name: ClassVar[str] = "bpr-plus"

    def __init__(
        self,
        n_policies: int,
        *,
        library: PolicyLibrary,
        rule: SelectionRule | str = "expected-improvement",
        floor: float = 0.001,
        window: int = 10,
        threshold: float = 0.4,
        **common: Any,
    ) -> None:
        super().__init__(n_policies, **common)
        if n_policies != library.n_policies:
            raise InputError(f"n_policies must be the library's {library.n_policies}, got {n_policies}")
        if not window >= 0 or not 0 <= threshold <= 1:
            raise InputError(f"window must be at least 0 and threshold in [0, 1], got {window} and {threshold}")
        self.library, self.rule, self.floor = library, rule_of(rule, library), checked_floor(floor, library)
        self.window, self.threshold = window, threshold
        self._law = law_of(library.performance, library.n_types, "plug-in")
        self._log_prior = log_prior(library.prior)
        self.log_belief = np.tile(self._log_prior, (self.rows, 1))
        self._fits = np.zeros((self.rows, max(window, 1), library.n_types))
        self._seen = np.zeros(self.rows, np.int64)

    @classmethod
    def settings_from(cls, library: PolicyLibrary) -> dict[str, Any]:
        """The library itself."""
        return {"library": library}

    @property
    def belief(self) -> NDArray[np.float64]:
        """β, (n_types,) or (n_tasks, n_types); sums to 1."""
        found = np.exp(self.log_belief)
        return found[0] if self.n_tasks is None else found

    def _scores(self) -> NDArray[np.float64]:
        return scored(self.rule, self.library, np.exp(self.log_belief), generator=self._generator)

    def _learn(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        log_likelihood = self._law.log_likelihoods(policies, self._law.checked(rewards))
        self.log_belief = floored(update(self.log_belief, log_likelihood).log_belief, self.floor)
        if self.window:
            self._begin_again(policies, rewards)

    def _begin_again(self, policies: NDArray[np.int64], rewards: NDArray[np.float64]) -> None:
        """Set the tasks whose last returns fit no type back to the prior."""
        model = self.library.performance
        z = (rewards[:, None] - model.mean.T[policies]) / np.maximum(model.deviation.T[policies], LEAST)
        self._fits[np.arange(self.rows), self._seen % self.window] = np.exp(-0.5 * z**2)
        self._seen += 1
        lost = (self._seen >= self.window) & (self._fits.mean(axis=1).max(axis=1) < self.threshold)
        self.log_belief[lost], self._seen[lost] = self._log_prior, 0


def floored(log_belief: NDArray[np.float64], floor: float) -> NDArray[np.float64]:
    """Log beliefs (..., n_types) after entries below `floor` are raised to it, normalised again."""
    belief = np.maximum(np.exp(log_belief), floor)
    with np.errstate(divide="ignore"):
        return np.log(belief / belief.sum(axis=-1, keepdims=True))


def checked_floor(floor: float, library: PolicyLibrary) -> float:
    """`floor`; InputError where it is outside [0, 1 / n_types]."""
    if not 0 <= floor <= 1 / library.n_types:
        raise InputError(f"floor must lie in [0, 1/{library.n_types}], got {floor}")
    return float(floor)
