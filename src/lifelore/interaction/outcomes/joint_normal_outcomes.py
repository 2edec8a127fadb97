"""Outcomes of users whose mean outcomes are jointly normal over policies, around the means of their type.

With a single type this is the classic Gaussian prior over items: ratings of some tell of others. With several
types and a small covariance it is the hard types of the thesis (§4.3.3).
"""

from collections.abc import Sequence
from typing import Any, ClassVar, NoReturn, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.joint_normal_law import JointNormalLaw
from lifelore.interaction.outcomes.outcome_rows import chosen_of, numbers, of_shape, rows_of_more
from lifelore.interaction.outcomes.spread import Spread

Array = NDArray[np.float64]

ROUNDING = 1e-9
"""Share of the largest variance by which a covariance may be off: rounding, not another matrix."""


class JointNormalOutcomes(GaussianOutcomes):
    """U = u_π + noise, u ~ Normal(mean of the type, covariance), noise ~ Normal(0, deviation²).

    As `GaussianOutcomes`, it is taken for the truth: users like their type's mean, outcomes with both variances.
    With uncertain models each user's u is learnt from what the user shows (`JointNormalLaw`).

    Parameters
    ----------
    mean : (n_types, n_policies) float
    covariance : (n_policies, n_policies) float
        Symmetric, without negative eigenvalues.
    deviation : float or (n_policies,) float
        Positive.

    Raises
    ------
    InputError
        A parameter breaks its rule.

    Examples
    --------
    Who likes the first item likes the second:

    >>> model = JointNormalOutcomes([[0.0, 0.0]], [[1.0, 0.9], [0.9, 1.0]], 1.0)
    >>> law = model.law()
    >>> shown = law.shown(1)
    >>> law.learn(shown, 0, 0, 2.0)
    >>> law.prediction(shown, 0, np.zeros(1)).mean.round(3).tolist()
    [[1.0, 0.9]]
    """

    kind: ClassVar[str] = "joint-normal"

    def __init__(self, mean: ArrayLike, covariance: ArrayLike, deviation: ArrayLike) -> None:
        mean = np.array(mean, np.float64)
        covariance = numbers(covariance, "covariance must be numbers of shape (n_policies, n_policies)")
        n_policies = mean.shape[-1] if mean.ndim else 0
        if covariance.shape != (n_policies, n_policies) or not np.isfinite(covariance).all():
            raise InputError(
                f"covariance must be ({n_policies}, {n_policies}) finite numbers, got {covariance.shape}"
            )
        slack = ROUNDING * np.abs(covariance).max(initial=0.0)
        if (
            np.abs(covariance - covariance.T).max(initial=0.0) > slack
            or np.linalg.eigvalsh(covariance)[0] < -slack
        ):
            raise InputError("covariance must be symmetric, without negative eigenvalues")
        self.covariance, self.noise = covariance.copy(), of_shape(deviation, (n_policies,), "deviation")
        if not (self.noise > 0).all():
            raise InputError("deviation must be positive")
        marginal = np.sqrt(self.noise**2 + np.diag(covariance))
        super().__init__(mean, np.broadcast_to(marginal, mean.shape))

    def _uncertain_law(self, spread: Spread, dtype: str) -> Any:
        """The law of outcomes given what users have shown; the covariance takes the place of a spread."""
        return JointNormalLaw(self.mean, self.covariance, self.noise, dtype)

    def with_type(self, samples: ArrayLike, gaps: bool = False) -> Self:
        """With a type of the mean outcomes of `samples` (n_policies, n); with `gaps`, else that of the others."""
        rows = rows_of_more(samples, self.n_policies, 0, gaps)
        count = rows.sums()
        mean = np.where(count > 0, rows.sums(rows.values) / np.maximum(count, 1), self.mean.mean(axis=0))
        return type(self)(np.vstack([self.mean, mean]), self.covariance, self.noise)

    def take(self, types: Sequence[int] | None = None, policies: Sequence[int] | None = None) -> Self:
        """A new model of some types and policies, in the order given; None means all."""
        rows, columns = chosen_of(types, self.n_types), chosen_of(policies, self.n_policies)
        covariance = self.covariance[np.ix_(columns, columns)]
        return type(self)(self.mean[np.ix_(rows, columns)], covariance, self.noise[columns])

    def to_arrays(self) -> dict[str, NDArray[Any]]:
        """The parameters by name."""
        return {"mean": self.mean, "covariance": self.covariance, "deviation": self.noise}

    @classmethod
    def from_arrays(cls, arrays: dict[str, NDArray[Any]]) -> Self:
        """The model of `to_arrays`, bit for bit."""
        return cls(arrays["mean"], arrays["covariance"], arrays["deviation"])

    @classmethod
    def from_rows(cls, *_: Any, **__: Any) -> NoReturn:
        """Refuse: outcomes of a type do not say how policies go together."""
        raise InputError("a joint-normal model learns from users' outcomes side by side; see joint_normal_fit")

    observe = absorb = with_policy = from_rows  # pyright: ignore[reportAssignmentType]
