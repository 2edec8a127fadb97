"""Mixtures of signal distributions in NumPy: twins of `information_kernels` with the same order of sums."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Ints = NDArray[np.int64]


def mixtures(share: NDArray[Any], support: Ints, policies: Ints, probs: NDArray[Any]) -> NDArray[Any]:
    """Σ share F(signal | type, policy) over the types of a support, for some policies, (n, n_signals).

    Parameters
    ----------
    share : (k,) float
    support : (k,) int64
    policies : (n,) int64
    probs : (n_policies, n_types, n_signals) float
    """
    probs = probs[policies]
    mixed = np.zeros((probs.shape[0], probs.shape[2]), probs.dtype)
    fours = len(support) - len(support) % 4
    for i in range(0, fours, 4):
        a, b, c, d = (share[j] * probs[:, support[j]] for j in range(i, i + 4))
        mixed += (a + b) + (c + d)
    for i in range(fours, len(support)):
        mixed += share[i] * probs[:, support[i]]
    return mixed


def class_mixtures(
    share: NDArray[Any], support: Ints, classes: NDArray[np.int32], policies: Ints, probs: NDArray[Any]
) -> NDArray[Any]:
    """`mixtures` with the shares of types of one class (n_policies, n_types) summed first."""
    classes, probs = classes[policies], probs[policies]
    mixed = np.zeros((probs.shape[0], probs.shape[2]), probs.dtype)
    for row, own, laws in zip(mixed, classes, probs, strict=True):
        weights: dict[int, Any] = {}
        shown: dict[int, int] = {}
        # Classes are in the order of their first types.
        for weight, type_ in zip(share, support.tolist(), strict=True):
            of_type = int(own[type_])
            weights[of_type] = weights[of_type] + weight if of_type in weights else weight
            shown.setdefault(of_type, type_)
        for of_type, weight in weights.items():
            row += weight * laws[shown[of_type]]
    return mixed
