"""Worlds of claim O1: mean pays, the noise of the pays, and libraries with exact or learnt models.

Means come from the surveillance reserve in four layouts, from golf (minus the yards missed), from the telephone
(expected pay of a call), and from random tables with three types. Pays are normal around the means. In the world
"calls" the pay of a telephone call is 3 or 10, as in the thesis, and no other noise is possible.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.streams import stream
from lifelore.domains.golf.golf import Golf
from lifelore.domains.surveillance.surveillance import LAYOUTS, Surveillance
from lifelore.domains.telephone.telephone import UTILITIES, Telephone
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from reproduction.chapter4.reuse.many_tasks import EXACT

Array = NDArray[np.float64]
GOLF, TELEPHONE, TABLES, CALLS = "golf", "telephone", "tables", "calls"
WORLDS = (*LAYOUTS, GOLF, TELEPHONE, TABLES, CALLS)
EQUAL, BY_POLICY, BY_PAIR = "equal", "by policy", "by pair"
NOISES = (EQUAL, BY_POLICY, BY_PAIR)
"""Deviations: the same for all pairs, drawn for each policy, or drawn for each pair of type and policy."""
DEVIATIONS = {**dict.fromkeys(LAYOUTS, 20.0), GOLF: 8.0, TELEPHONE: 3.0, TABLES: 20.0}
"""Deviation of equal noise, and median of unequal noise, in the units of the world's pays."""
FACTOR = 30.0
"""Ratio of the ends of the middle 95 % of drawn deviations, which are log-normal."""
TABLE_SHAPE, TABLE_SPREAD = (3, 10), 20.0
"""Types and policies of random tables, and the deviation of their means around 0."""
PSEUDO_COUNT = 0.5
"""Count added to each pay of a call in learnt models."""


class World(NamedTuple):
    """Pays of one group of tasks.

    mean : (n_types, n_policies) float64
    deviation : (n_types, n_policies) float64
    probs : (n_types, n_policies, n_values) float64 or None, distribution of the pays of calls
    """

    mean: Array
    deviation: Array
    probs: Array | None = None

    def pays(self, types: NDArray[np.int64], luck: NDArray) -> Callable[[int, NDArray[np.int64]], Array]:
        """The pays of an episode by policy; `luck` (n_tasks, n_episodes) is uniform in (0, 1)."""
        from scipy.special import ndtri

        standard = ndtri(luck)

        def paid(episode: int, policies: NDArray[np.int64]) -> Array:
            if self.probs is None:
                return self.mean[types, policies] + self.deviation[types, policies] * standard[:, episode]
            cumulative = self.probs[types, policies].cumsum(axis=-1)[:, :-1]
            return np.array(UTILITIES)[(luck[:, episode, None] >= cumulative).sum(axis=-1)]

        return paid

    def library(self, model: str, samples: int, generator: np.random.Generator) -> PolicyLibrary:
        """Exact models, or models learnt from `samples` runs a pair."""
        if self.probs is not None:
            if model == EXACT:
                return PolicyLibrary(CategoricalOutcomes(UTILITIES, self.probs))
            uniform = generator.random((*self.mean.shape, samples, 1))
            place = (uniform >= self.probs.cumsum(axis=-1)[:, :, None, :-1]).sum(axis=-1)
            return PolicyLibrary(
                CategoricalOutcomes.from_samples(np.array(UTILITIES)[place], UTILITIES, PSEUDO_COUNT)
            )
        if model == EXACT:
            return PolicyLibrary.from_means(self.mean, self.deviation)
        noise = generator.standard_normal((*self.mean.shape, samples))
        return PolicyLibrary.from_samples(self.mean[..., None] + self.deviation[..., None] * noise)


def world_of(name: str, noise: str, seed: int, group: int) -> World:
    """The world of a group of tasks: its deviations and random tables are its own."""
    if name == CALLS:
        phone = Telephone()
        probs = phone.utility_probs
        return World(phone.mean, np.sqrt(probs @ np.square(UTILITIES) - phone.mean**2), probs)
    mean = _mean_of(name, seed, group)
    generator, deviation = stream(seed, "O1", "deviations", name, noise, group), DEVIATIONS[name]
    if noise == EQUAL:
        return World(mean, np.full(mean.shape, deviation))
    shape = (1, mean.shape[1]) if noise == BY_POLICY else mean.shape
    factors = np.exp(np.log(FACTOR) / (2 * 1.96) * generator.standard_normal(shape))
    return World(mean, deviation * np.broadcast_to(factors, mean.shape))


def _mean_of(name: str, seed: int, group: int) -> Array:
    if name in LAYOUTS:
        return Surveillance(name).mean
    if name == TABLES:
        return TABLE_SPREAD * stream(seed, "O1", "tables", group).standard_normal(TABLE_SHAPE)
    return Golf().mean if name == GOLF else Telephone().mean
