"""How much types differ, and how often something new happens: weights κ and α, for each kind of cause.

    P(e | cause c; type i) ∝ n_ic(e) + κ pooled_c(e)
    pooled_c(e)            ∝ Σ_i n_ic(e) + α group_c(e)
    group_c(e)             ∝ Σ n(e) over the other causes of the group of c, + α p₀(e)

With a large κ the types hardly differ in a kind of cause (can a free object be lifted?), with a small one each has
its own way (what does a user pay for?). With a large α causes often have effects that they never had before.
Neither is known in advance. Where κ and α are too small, rare effects look impossible and seem to tell of a new
type.

Both are learnt from the counts: each counted effect is predicted from all others (leave one out), and the κ and α
of a grid are taken whose predictions have the largest log probability, with a weak prior around `USUAL`.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.long_lived.task_family import TaskFamily

Array = NDArray[np.float64]

KAPPA = 2.0 ** np.arange(-8, 8)
ALPHA = 2.0 ** np.arange(-2, 5)
"""The grid, in observations."""
USUAL = (1.0, 0.5)
"""κ and α of kinds of causes of which nothing is known."""
SPREAD = 1.5
"""Deviation of log κ and log α in their prior; with less it takes more counts to depart from `USUAL`."""
LEAST = 1e-12
"""Least probability of a counted effect; a family may have called it impossible."""


class Concentrations(NamedTuple):
    """κ and α of each cause, (n_causes,) float64."""

    kappa: Array
    alpha: Array


def learnt_concentrations(family: TaskFamily, counts: Array, smoothed: Array) -> Concentrations:
    """The concentrations with which each effect is best predicted from all others.

    Parameters
    ----------
    counts, smoothed : (n_types, n_causes, n_effects) float
        As counted, and after `TaskFamily.smoothed`.
    """
    found = Concentrations(*(np.full(family.n_causes, value) for value in USUAL))
    types, causes, effects = np.nonzero(counts)
    if not len(types):
        return found
    weight, total = counts[types, causes, effects], smoothed.sum(axis=0)
    # One observation is left out, and all that smoothing has made of it.
    alone = family.smoothed(np.eye(family.n_effects)[:, None].repeat(family.n_causes, axis=1))[effects, causes]
    left_out = np.minimum(weight, 1.0)[:, None] * alone
    place = np.arange(len(types)), effects

    def of_effect(rows: Array) -> tuple[Array, Array]:
        """The rows' numbers of the effect, and of all effects, to be broadcast with the grid."""
        return rows[place][:, None, None], rows.sum(axis=1)[:, None, None]

    own, all_own = of_effect(np.maximum(smoothed[types, causes] - left_out, 0.0))
    pooled, all_pooled = of_effect(np.maximum(total[causes] - left_out, 0.0))
    others, all_others = of_effect(_of_others(family, total)[causes])
    first, _ = of_effect(family.possible[causes])
    kappa, alpha = KAPPA[:, None], ALPHA
    law = (others + alpha * first) / (all_others + alpha)
    law = (pooled + alpha * law) / (all_pooled + alpha)
    law = (own + kappa * law) / (all_own + kappa)
    score = weight[:, None, None] * np.log(np.maximum(law, LEAST))
    prior = sum(
        -0.5 * (np.log(value / usual) / SPREAD) ** 2 for value, usual in zip((kappa, alpha), USUAL, strict=True)
    )
    kinds = family.kinds
    for kind in np.unique(kinds[causes]).tolist():
        best = np.argmax(score[kinds[causes] == kind].sum(axis=0) + prior)
        row, column = divmod(int(best), len(ALPHA))
        found.kappa[kinds == kind], found.alpha[kinds == kind] = KAPPA[row], ALPHA[column]
    return found


def group_laws(family: TaskFamily, counts: Array, alpha: Array) -> Array:
    """The law of each cause as the others of its group tell it, (n_causes, n_effects).

    Parameters
    ----------
    counts : (n_causes, n_effects) float
        Of all types together.
    alpha : (n_causes,) float
    """
    found = _of_others(family, counts) + alpha[:, None] * family.possible
    return found / found.sum(axis=1, keepdims=True)


def _of_others(family: TaskFamily, counts: Array) -> Array:
    """Counts of the other causes of each cause's group, (n_causes, n_effects)."""
    groups = np.zeros((family.groups.max() + 1, family.n_effects))
    np.add.at(groups, family.groups, counts)
    return np.maximum(groups[family.groups] - counts, 0.0)
