"""What a rule for selecting a policy is, and how the best of its scores is chosen.

A rule gives every policy a score under a belief; the largest is selected, equals at random. Under a flat
belief many policies are worth exactly the same up to rounding, so all rules share one tolerance. Thesis: §4.5.
"""

from collections.abc import Callable
from typing import Any, ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.policy_library import PolicyLibrary
from lifelore.interaction.selection.tie_kernels import choose_row, choose_rows, tied_rows

Array = NDArray[np.float64]
Variant = Literal["standard", "thesis"]

TOLERANCE = 1e-9
"""Scores this close to the best, relative to it, are equal: rounding moves sums of products by less."""
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


def choose(scores: ArrayLike, generator: np.random.Generator, tolerance: float = TOLERANCE) -> Any:
    """The policy of the largest score, equals at random.

    Parameters
    ----------
    scores : (..., n_policies) float
        Infinities allowed.
    generator : numpy generator
        Asked for one number where policies tie; for many rows, for one each.
    tolerance : float
        Scores this close to the best, relative to it, are equal; ≥ 0.

    Returns
    -------
    int or (...) int64

    Raises
    ------
    InputError
        A score is NaN, or there is none.

    Examples
    --------
    >>> choose([1.0, 3.0, 2.0], np.random.default_rng(0))
    1
    """
    scores = np.asarray(scores, np.float64)
    if scores.ndim == 1:
        chosen = choose_row(scores, -1.0, tolerance)
        if chosen < -1:
            chosen = choose_row(scores, generator.random(), tolerance)
        if chosen == -1:
            raise InputError("scores must be numbers, at least one, got NaN or nothing")
        return int(chosen)
    rows = np.ascontiguousarray(scores.reshape(-1, scores.shape[-1]))
    policies = np.empty(len(rows), np.int64)
    choose_rows(rows, generator.random(len(rows)), tolerance, policies)
    if (policies < 0).any():
        raise InputError("scores must be numbers, at least one a row, got NaN or nothing")
    return policies.reshape(scores.shape[:-1])


def tied_shares(scores: ArrayLike, tolerance: float = TOLERANCE) -> Array:
    """How likely `choose` is to take each policy, (..., n_policies)."""
    scores = np.asarray(scores, np.float64)
    rows = np.ascontiguousarray(scores.reshape(-1, scores.shape[-1]))
    shares = np.empty_like(rows)
    tied_rows(rows, tolerance, shares)
    if np.isnan(shares).any():
        raise InputError("scores must be numbers, got NaN")
    return shares.reshape(scores.shape)


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
