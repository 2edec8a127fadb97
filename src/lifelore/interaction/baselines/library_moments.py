"""What a policy library says to a method that knows no types: how each policy does over all of them."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from lifelore.interaction.library.policy_library import PolicyLibrary


class Moments(NamedTuple):
    """First two moments of each policy's payoff when the type is drawn from the library's prior.

    mean : (n_policies,) float
        E[U].
    spread : (n_policies,) float
        Deviation of the mean payoff from type to type.
    noise : (n_policies,) float
        Deviation of a payoff about its type's mean, root mean square over types.
    """

    mean: NDArray[np.float64]
    spread: NDArray[np.float64]
    noise: NDArray[np.float64]


def library_moments(library: "PolicyLibrary") -> Moments:
    """Moments under the library's prior G₀ over types."""
    prior, means = np.asarray(library.prior), np.asarray(library.performance.mean)
    mean = prior @ means
    spread = np.sqrt(prior @ (means - mean) ** 2)
    noise = np.sqrt(prior @ np.asarray(library.performance.deviation) ** 2)
    return Moments(mean, spread, noise)
