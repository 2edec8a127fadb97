"""Choice of a policy by the scores of a rule: the largest score, equals at random, among the available policies.

A rule scores the available policies as if the library had no others: a policy that is not available is no target
of expected improvement, no next choice of the knowledge gradient, and no best response to a type that belief
sampling draws. The belief is about all types and stays as it is. Shapes: T types, P policies, k users.
"""

from collections.abc import Callable, Sequence
from functools import partial
from math import isfinite
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import largest as largest_of
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.library_names import index_of

if TYPE_CHECKING:
    from lifelore.interaction.outcomes.prediction import Prediction
    from lifelore.interaction.selection.rule import RuleLibrary, SelectionRule

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]
Available = Sequence[str | int] | NDArray[Any]
"""Names or numbers of the available policies, or a bool for each policy."""

TOLERANCE = 1e-9
"""Scores this close to the best, relative to it, are equal: rounding moves sums of products by less."""
TOLERANCE_OF = {"d": TOLERANCE, "f": 1e-6}
"""Tolerance of scores in float64, and in float32, whose sums of products are rounded by more."""
ROUNDING = 1e-15
"""Differences below this share of a row's largest score are rounding, however small the best score is."""


# ---- the largest score -------------------------------------------------------------------------------------


def choose(scores: ArrayLike, generator: np.random.Generator) -> Any:
    """The policy of the largest score, equals at random.

    Scores that differ from the largest by no more than the tolerance of their precision are equal to it.

    Parameters
    ----------
    scores : (..., P) float
        Minus infinity where a policy is not available; infinity is allowed.
    generator : numpy generator
        Draws a number for each row in which policies tie, and no other.

    Returns
    -------
    int or (...) int64

    Raises
    ------
    InputError
        A score is NaN, or a row has no available policy.

    Examples
    --------
    >>> choose([1.0, 3.0, 2.0], np.random.default_rng(0))
    1
    """
    best = _best(scores)
    if best.ndim == 1:
        (best,) = best.nonzero()
        return best.item() if best.size == 1 else best[int(generator.random() * best.size)].item()
    chosen = best.argmax(axis=-1)
    if np.count_nonzero(best) > chosen.size:
        number = best.sum(axis=-1)
        tie = number > 1
        place = (generator.random(int(tie.sum())) * number[tie]).astype(np.int64)
        chosen[tie] = (best[tie].cumsum(axis=-1) > place[:, None]).argmax(axis=-1)
    return chosen


def tied_shares(scores: ArrayLike) -> Array:
    """Probability that `choose` takes each policy, (..., P); errors as there."""
    best = _best(scores)
    return best / best.sum(axis=-1, keepdims=True)


def best_policies(scores: ArrayLike, k: int, generator: np.random.Generator) -> NDArray[np.int64]:
    """The `k` policies of the largest scores (..., P), best first, equals at random, (..., k).

    Raises
    ------
    InputError
        `k` is below 1 or above the number of available policies, or a score is NaN.
    """
    left = np.array(scores, np.float64)
    most = int((left != -np.inf).sum(axis=-1).min())
    if not 1 <= k <= most:
        raise InputError(f"k must be 1 to {most}, the number of available policies, got {k}")
    best = np.empty((*left.shape[:-1], k), np.int64)
    for rank in range(k):
        best[..., rank] = choose(left, generator)
        np.put_along_axis(left, best[..., rank, None], -np.inf, axis=-1)
    return best


def _best(scores: ArrayLike) -> Mask:
    """Which policies are best or as good as the best in the precision of the scores, (..., P)."""
    scores = np.asarray(scores)
    if scores.dtype.kind != "f":
        scores = scores.astype(np.float64)
    tolerance = TOLERANCE_OF[scores.dtype.char]
    if scores.ndim == 1 and scores.size:
        # A single row of finite scores, quickly; a NaN would make the sum NaN.
        listed = scores.tolist()
        largest, least = max(listed), min(listed)
        if isfinite(sum(listed)):
            return scores >= _bar(largest, max(abs(largest), abs(least)), tolerance)
    if not scores.shape[-1] or not ((largest := largest_of(scores)) > -np.inf).all():
        raise InputError("scores must be numbers, at least one of them above minus infinity, got NaN or nothing")
    least = np.take_along_axis(scores, scores.argmin(axis=-1)[..., None], axis=-1)
    if not (least > -np.inf).all():
        least = scores.min(axis=-1, keepdims=True, where=scores > -np.inf, initial=np.inf)
    with np.errstate(invalid="ignore"):
        bar = _bar(largest, np.maximum(np.abs(largest), np.abs(least)), tolerance)
    return scores >= np.where(largest < np.inf, bar, largest)


def _bar(largest: Any, size: Any, tolerance: float) -> Any:
    """The least score that counts as the largest, in rows whose scores are at most `size` in size."""
    return largest - (tolerance * abs(largest) + ROUNDING * size)


# ---- scores and propensities among the available policies --------------------------------------------------


def scored(
    rule: "SelectionRule",
    library: "RuleLibrary",
    belief: Array,
    available: Mask | None = None,
    *,
    episodes_left: float | None = None,
    generator: np.random.Generator | None = None,
) -> Array:
    """The rule's score of each policy, (P,) or (k, P); minus infinity where it is not available.

    Parameters
    ----------
    rule : SelectionRule
    library : RuleLibrary
        `PolicyLibrary`, or a library of users with a method ``part(rows, policies)``.
    belief : (T,) or (k, T) float64
    available : (P,) or (k, P) bool, optional
        At least one policy of each row; see `available_mask`. All policies by default.
    episodes_left : float, optional
        Number of episodes after this selection.
    generator : numpy generator, optional
        Needed by rules that draw.
    """
    if available is None or getattr(rule, "by_means", False):
        scores = rule.scores(library, belief, episodes_left=episodes_left, generator=generator)
        return scores if available is None or available.all() else np.where(available, scores, -np.inf)
    values = partial(rule.scores, episodes_left=episodes_left, generator=generator)
    return _by_part(values, library, belief, available, -np.inf)


def propensities(
    rule: "SelectionRule",
    library: "RuleLibrary",
    belief: Array,
    available: Mask | None = None,
    *,
    episodes_left: float | None = None,
) -> Array:
    """Probability that the rule selects each policy, (P,) or (k, P); rows sum to 1. Parameters as for `scored`."""
    values = partial(rule.probabilities, episodes_left=episodes_left)
    return _by_part(values, library, belief, available, 0.0)


def available_mask(available: Available, names: Sequence[str], n_rows: int | None = None) -> Mask:
    """Which policies are available, (P,) bool, or (n_rows, P) where a mask has a row for each user.

    Parameters
    ----------
    available : sequence of str or int, or (P,) or (n_rows, P) bool
    names : sequence of str
        Of all policies.
    n_rows : int, optional
        Number of users; without it a mask must be (P,).

    Raises
    ------
    InputError
        No policy is available, or a bool mask has another shape.
    NotFoundError
        There is no such policy.

    Examples
    --------
    >>> available_mask(["right", "left"], ["left", "middle", "right"]).tolist()
    [True, False, True]
    """
    given = np.asarray(available)
    if given.dtype == bool:
        if given.shape not in ((len(names),), (n_rows, len(names))):
            of_rows = "" if n_rows is None else f" or ({n_rows}, {len(names)})"
            raise InputError(
                f"available must be ({len(names)},){of_rows} bool, one for each policy, got {given.shape}"
            )
        mask = given
    else:
        listed = [available] if isinstance(available, str | int) else list(available)
        mask = np.zeros(len(names), np.bool_)
        mask[[index_of(policy, names, "policy") for policy in listed]] = True
    if not mask.any(axis=-1).all():
        raise InputError(
            "available must hold at least one policy, got none; end the episode with end_episode() instead"
        )
    return mask


def _by_part(
    values: Callable[[Any, Array], Array], library: Any, belief: Array, available: Mask | None, missing: float
) -> Array:
    """`values` of the rows with each set of available policies, `missing` elsewhere, (P,) or (k, P)."""
    if available is None or available.all():
        return values(library, belief)
    found = np.full((*belief.shape[:-1], library.n_policies), missing)
    sets = np.atleast_2d(available)
    if (sets == sets[:1]).all():
        found[..., sets[0]] = values(_part(library, slice(None), sets[0]), belief)
        return found
    sets, group = np.unique(sets, axis=0, return_inverse=True)
    for number, policies in enumerate(sets):
        rows = np.flatnonzero(group.ravel() == number)
        found[np.ix_(rows, policies)] = values(_part(library, rows, policies), belief[rows])
    return found


def _part(library: Any, rows: Any, policies: Mask) -> Any:
    """The library of some users and policies; only libraries that users do not share have a method `part`."""
    return library.part(rows, policies) if hasattr(library, "part") else PartOfLibrary(library, policies)


class PartOfLibrary:
    """Some policies of a library, as rules read it.

    Parameters
    ----------
    library : RuleLibrary
        Any library will do, also one whose models cannot be restricted.
    policies : (P,) bool
        The policies that are left.
    """

    def __init__(self, library: "RuleLibrary", policies: Mask) -> None:
        self._library, self._policies = library, policies
        self.n_types, self.n_policies = library.n_types, int(policies.sum())
        self.performance = PartOfOutcomes(library.performance, policies)

    def table(self, n_bins: int) -> SignalTable:
        """The table of these policies' signals."""
        return self._library.table(n_bins).part(slice(None), self._policies)


class PartOfOutcomes:
    """The outcomes of some policies: the moments, and the methods of `Prediction`."""

    def __init__(self, outcomes: "Prediction", policies: Mask) -> None:
        self._outcomes, self._policies = outcomes, policies

    @property
    def mean(self) -> Array:
        return self._outcomes.mean[..., self._policies]

    @property
    def deviation(self) -> Array:
        return self._outcomes.deviation[..., self._policies]

    @property
    def mean_variance(self) -> Array | None:
        variance = self._outcomes.mean_variance
        return None if variance is None else variance[..., self._policies]

    def __getattr__(self, method: str) -> Callable[[Any], Array]:
        of_all = getattr(self._outcomes, method)
        return lambda given: of_all(given)[..., self._policies]
