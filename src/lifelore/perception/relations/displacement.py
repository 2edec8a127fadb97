"""The thesis's classifier of displacements between contact points: votes of the k nearest neighbours (§2.3.5)."""

from typing import Any, Self

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data


class DisplacementNeighbours(ClassifierMixin, BaseEstimator):
    """k nearest neighbours among labelled displacements d = χ_a - χ_b.

    Parameters
    ----------
    k : int
        The thesis's 4.
    omega : float, optional
        Largest displacement in training (the thesis's threshold ω), metres; None uses all. If all are longer, the
        shortest of each class is used.
    weights : {"uniform", "distance"}
        Equal votes, or votes by the inverse of the distance (the thesis's alternative to ω).
    """

    def __init__(self, k: int = 4, omega: float | None = None, weights: str = "uniform") -> None:
        self.k = k
        self.omega = omega
        self.weights = weights

    def fit(self, X: Any, y: Any) -> Self:
        """Store displacements ``(n, d)`` and their labels ``(n,)``."""
        if self.weights not in ("uniform", "distance") or not self.k >= 1:
            raise ValueError(
                f"weights must be uniform or distance and k at least 1, got {self.weights!r}, {self.k!r}"
            )
        X, y = validate_data(self, X, y, dtype=np.float64)
        check_classification_targets(y)
        self.classes_, codes = np.unique(y, return_inverse=True)
        chosen = self._short_enough(np.linalg.norm(X, axis=1), codes)
        self.displacements_, self.codes_ = X[chosen], codes[chosen]
        return self

    def _short_enough(self, length: NDArray[np.float64], codes: NDArray[np.int64]) -> NDArray[np.bool_]:
        chosen = np.full(len(length), True) if self.omega is None else length <= self.omega
        for code in range(len(self.classes_)):
            own = np.flatnonzero(codes == code)
            if not chosen[own].any():
                chosen[own[length[own].argmin()]] = True
        return chosen

    def predict_proba(self, X: Any) -> NDArray[np.float64]:
        """Share of the neighbours' votes for each of ``classes_``, ``(n, n_classes)``, rows sum to 1."""
        check_is_fitted(self)
        X = validate_data(self, X, reset=False, dtype=np.float64)
        return votes(self.displacements_, self.codes_, len(self.classes_), X, self.k, self.weights)

    def predict(self, X: Any) -> NDArray[Any]:
        """The label with most votes for each row, ``(n,)``; of equal ones the first in order."""
        shares = self.predict_proba(X)
        return self.classes_[shares.argmax(axis=1)]


def votes(
    known: NDArray[np.float64],
    codes: NDArray[np.int64],
    n_classes: int,
    queries: NDArray[np.float64],
    k: int,
    weights: str,
) -> NDArray[np.float64]:
    """Shares of the votes of the k nearest among `known` (n, d), each of the class in `codes` (n,).

    Returns ``(len(asked), n_classes)``, rows sum to 1.
    """
    distance, at = KDTree(known).query(queries, k=[*range(1, min(k, len(known)) + 1)])  # type: ignore[arg-type]
    vote = np.ones_like(distance) if weights == "uniform" else _inverse(distance)
    shares = np.zeros((len(queries), n_classes))
    np.add.at(shares, (np.arange(len(queries))[:, None], codes[at]), vote)
    return shares / shares.sum(axis=1, keepdims=True)


def _inverse(distance: NDArray[np.float64]) -> NDArray[np.float64]:
    """1 / distance; a neighbour at distance 0 alone votes."""
    at_place = distance == 0
    found = at_place.any(axis=1, keepdims=True)
    return np.where(found, at_place, 1.0 / np.where(at_place, 1.0, distance))
