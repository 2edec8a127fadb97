"""Gaussian outcomes of every type and policy: the default performance model.

Thesis: §4.3.4, Fig. 4.1; the expected excess is the textbook expected improvement of a Gaussian.
"""

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.interaction.outcomes.law import of_users
from lifelore.interaction.outcomes.moment_outcomes import MomentOutcomes
from lifelore.interaction.outcomes.outcome_moments import known_moments
from lifelore.interaction.outcomes.prediction import over_types

Array = NDArray[np.float64]

_LOG_ROOT_2_PI = 0.5 * np.log(2 * np.pi)


class GaussianOutcomes(MomentOutcomes):
    """P(U | type, policy) = Normal(mean, deviation²).

    Parameters
    ----------
    mean : (n_types, n_policies) float
        Finite.
    deviation : float or (n_types, n_policies) float
        Positive.
    count : float or (n_types, n_policies) float, optional
        Number of samples behind the numbers, so that `observe` can change them; without it they are exact.

    Raises
    ------
    InputError
        A mean is not finite, a deviation or count not positive, or shapes do not agree.

    Examples
    --------
    >>> model = GaussianOutcomes([[0.0, 1.0], [2.0, 1.0]], 1.0)
    >>> model.expected_excess(0.0).round(3).tolist()
    [[0.399, 1.083], [2.008, 1.083]]
    """

    kind: ClassVar[str] = "gaussian"

    def __init__(self, mean: ArrayLike, deviation: ArrayLike, count: ArrayLike | None = None) -> None:
        super().__init__(known_moments(mean, deviation, count))

    def log_densities(self, policies: Any, values: Any) -> Array:
        """Log densities of many outcomes, (...) and (...) to (..., n_types); without checks."""
        z = over_types(values) - of_users(self._centre, policies)
        z *= of_users(self._narrow, policies)
        z *= z
        return np.subtract(of_users(self._log_height, policies), z, out=z)

    def sample(self, generator: np.random.Generator, type_: int, policy: int, size: Any = None) -> Any:
        """Random outcomes of a pair: a number, or an array of shape `size`."""
        return generator.normal(self.mean[type_, policy], self.deviation[type_, policy], size)

    def _prepare(self) -> None:
        self.mean, self.deviation = self.moments.mean, np.sqrt(self.moments.variance)
        # Policy first: an update reads the row of a policy.
        self._centre = np.ascontiguousarray(self.mean.T)
        self._narrow = np.ascontiguousarray(np.sqrt(0.5) / self.deviation.T)
        self._log_height = -np.ascontiguousarray(np.log(self.deviation.T)) - _LOG_ROOT_2_PI
