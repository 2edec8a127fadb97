"""Regret: the utility lost against the best policy of the library.

Means give expected regret. Realised utilities give realised regret, which includes the noise of both episodes.
Thesis: §4.3.2, Defs 4.3.1–2.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError

Array = NDArray[np.float64]


def library_regret(utilities: ArrayLike, chosen: ArrayLike) -> Array:
    """Regret of each choice against the best policy in hindsight (Def. 4.3.1), at least 0.

    Its mean over K trials is the average library regret (Def. 4.3.2).

    Parameters
    ----------
    utilities : (..., n_policies) float
        Utility of each policy on the task; finite.
    chosen : int, (..., K) int
        Chosen policies, one or K for each task.

    Returns
    -------
    (...) or (..., K) float

    Raises
    ------
    InputError
        Utilities are not finite, or shapes do not agree.
    NotFoundError
        There is no such policy in the library.

    Examples
    --------
    >>> library_regret([3.0, 5.0, 4.0], [0, 2, 1]).tolist()
    [2.0, 1.0, 0.0]
    """
    utilities, chosen = np.asarray(utilities, np.float64), np.asarray(chosen)
    if utilities.ndim < 1 or not utilities.shape[-1] or not np.isfinite(utilities).all():
        raise InputError(f"utilities must be finite numbers (..., n_policies), got {utilities.shape}")
    if chosen.dtype.kind not in "iu" or chosen.ndim not in (utilities.ndim - 1, utilities.ndim):
        raise InputError(f"chosen must be policy numbers (...) or (..., K), got {chosen.dtype} {chosen.shape}")
    if chosen.size and not (chosen.min() >= 0 and chosen.max() < utilities.shape[-1]):
        raise NotFoundError(f"unknown policy among those chosen; the library has 0 to {utilities.shape[-1] - 1}")
    single = chosen.ndim < utilities.ndim
    index = chosen[..., None] if single else chosen
    if index.shape[:-1] != utilities.shape[:-1]:
        raise InputError(f"chosen must be of the tasks {utilities.shape[:-1]}, got {chosen.shape}")
    regret = utilities.max(axis=-1, keepdims=True) - np.take_along_axis(utilities, index, axis=-1)
    return regret[..., 0] if single else regret
