"""What a rule for selecting a policy is, and how likely it is to select each.

A rule gives every policy a score under a belief; the largest is selected, equals at random. Under a flat
belief many policies are worth exactly the same up to rounding, so all rules share one tolerance. Thesis: §4.5.
"""

from collections.abc import Callable
from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.compiler_start import kernel_pays
from lifelore.interaction.library.policy_library import PolicyLibrary

Array = NDArray[np.float64]
Variant = Literal["standard", "thesis"]

TOLERANCE = 1e-9
"""Scores this close to the best, relative to it, are equal: rounding moves sums of products by less."""
ROUNDING = 1e-15
"""Differences below this share of a row's largest score are rounding, however small the best score is."""
NUMBERS_AT_ONCE = 1 << 22
"""Size of the largest temporary array when many beliefs are scored."""


class SelectionRule(Protocol):
    """A way to select policies; settings alone, nothing is remembered between calls."""

    name: ClassVar[str]

    def scores(
        self,
        library: PolicyLibrary,
        belief: Array,
        *,
        episodes_left: float | None = None,
        generator: np.random.Generator | None = None,
    ) -> Array:
        """What each policy is worth selecting, (..., n_policies); the largest is selected.

        Parameters
        ----------
        library : PolicyLibrary
        belief : (..., n_types) float64
            Rows sum to 1.
        episodes_left : float, optional
            Episodes that follow the one now selected for.
        generator : numpy generator, optional
            For rules that draw.
        """
        ...

    def probabilities(self, library: PolicyLibrary, belief: Array, *, episodes_left: float | None = None) -> Array:
        """How likely each policy is to be selected, (..., n_policies); rows sum to 1."""
        ...


class Deterministic:
    """A rule whose scores do not draw: the best are selected, each as likely."""

    def probabilities(self, library: PolicyLibrary, belief: Array, *, episodes_left: float | None = None) -> Array:
        """How likely each policy is to be selected, (..., n_policies); rows sum to 1."""
        return tied_shares(self.scores(library, belief, episodes_left=episodes_left))  # pyright: ignore


def tied_shares(scores: ArrayLike, tolerance: float = TOLERANCE) -> Array:
    """How likely `choose` is to take each policy, (..., n_policies)."""
    scores = np.asarray(scores, np.float64)
    if not scores.shape[-1]:
        return np.empty_like(scores)
    if not kernel_pays(scores.size):
        shares = shares_of_tied(scores, tolerance)
    else:
        from lifelore.interaction.selection.tie_kernels import tied_rows

        rows = np.ascontiguousarray(scores.reshape(-1, scores.shape[-1]))
        shares = np.empty_like(rows)
        tied_rows(rows, tolerance, shares)
    if np.isnan(shares).any():
        raise InputError("scores must be numbers, got NaN")
    return shares.reshape(scores.shape)


def shares_of_tied(scores: Array, tolerance: float) -> Array:
    """1 / n for each of the n best of a row, NaN where a score is: the NumPy twin of `tie_kernels.tied_rows`."""
    best = scores.max(axis=-1, keepdims=True)
    least = np.where(scores > -np.inf, scores, best).min(axis=-1, keepdims=True)
    with np.errstate(invalid="ignore"):
        bar = best - (tolerance * np.abs(best) + ROUNDING * np.maximum(np.abs(best), np.abs(least)))
    bar = np.where(np.isinf(best), best, bar)
    tied = scores >= bar
    return np.where(np.isnan(best), np.nan, tied / np.maximum(tied.sum(axis=-1, keepdims=True), 1))


def in_blocks(belief: Array, numbers: int, scored: Callable[[Array], Array]) -> Array:
    """`scored` of one belief (n_types,), or of many in blocks whose temporary arrays stay small.

    Parameters
    ----------
    belief : (..., n_types) float
    numbers : int
        Size of what `scored` makes for one belief on the way.
    scored : callable
        (n, n_types) to (n, n_policies), and (n_types,) to (n_policies,).
    """
    belief = np.asarray(belief, np.float64)
    if belief.ndim == 1:
        return scored(belief)
    rows = belief.reshape(-1, belief.shape[-1])
    block = max(1, NUMBERS_AT_ONCE // max(1, numbers))
    parts = [scored(rows[at : at + block]) for at in range(0, max(1, len(rows)), block)]
    return np.concatenate(parts).reshape(*belief.shape[:-1], -1)


def weighted(belief: Array, values: Array) -> Array:
    """Σ β(τ) v(τ, π): beliefs (..., n_types) and values (..., n_types, n_policies) to (..., n_policies)."""
    if belief.ndim == 1:
        return belief @ values
    return np.matmul(belief[..., None, :], values)[..., 0, :]


def check_variant(variant: str) -> None:
    """Refuse a variant that is neither ``standard`` nor ``thesis``."""
    if variant not in ("standard", "thesis"):
        raise InputError(f"variant must be 'standard' or 'thesis' (as printed), got {variant!r}")


def check_generator(rule: str, generator: np.random.Generator | None) -> np.random.Generator:
    """The generator; InputError where a rule that draws has none."""
    if generator is None:
        raise InputError(f"{rule} draws at random; give a generator, e.g. numpy.random.default_rng(0)")
    return generator
