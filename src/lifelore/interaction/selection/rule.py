"""The interface of a selection rule, and the functions that several rules share.

A rule gives every policy a score under a belief. The policy of the largest score is selected, equals at random.
Under a flat belief many scores are equal up to rounding, so all rules share the tolerance of `ties`. Thesis: §4.5.
"""

from collections.abc import Callable
from typing import ClassVar, Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.selection.choice import tied_shares

Array = NDArray[np.float64]
Variant = Literal["standard", "thesis"]

NUMBERS_AT_ONCE = 1 << 22
"""Size of the largest temporary array when many beliefs are scored."""


class SelectionRule(Protocol):
    """A way to select policies. A rule holds its settings and no state."""

    name: ClassVar[str]

    def scores(
        self,
        library: PolicyLibrary,
        belief: Array,
        *,
        episodes_left: float | None = None,
        generator: np.random.Generator | None = None,
    ) -> Array:
        """The score of each policy, (..., n_policies); the largest is selected.

        Parameters
        ----------
        library : PolicyLibrary
        belief : (..., n_types) float64
            Rows sum to 1.
        episodes_left : float, optional
            Number of episodes after this selection.
        generator : numpy generator, optional
            Needed by rules that draw.
        """
        ...

    def probabilities(self, library: PolicyLibrary, belief: Array, *, episodes_left: float | None = None) -> Array:
        """Probability of selecting each policy, (..., n_policies); rows sum to 1."""
        ...


class Deterministic:
    """Base of rules whose scores draw no random numbers: the best policies are equally likely."""

    def probabilities(self, library: PolicyLibrary, belief: Array, *, episodes_left: float | None = None) -> Array:
        """Probability of selecting each policy, (..., n_policies); rows sum to 1."""
        return tied_shares(self.scores(library, belief, episodes_left=episodes_left))  # pyright: ignore


def in_blocks(belief: Array, numbers: int, scored: Callable[[Array], Array]) -> Array:
    """`scored` of one belief (n_types,), or of many in blocks whose temporary arrays stay small.

    Parameters
    ----------
    belief : (..., n_types) float
    numbers : int
        Size of the temporary arrays that `scored` makes for one belief.
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
    """Raise InputError where the variant is neither ``standard`` nor ``thesis``."""
    if variant not in ("standard", "thesis"):
        raise InputError(f"variant must be 'standard' or 'thesis' (as printed), got {variant!r}")


def check_generator(rule: str, generator: np.random.Generator | None) -> np.random.Generator:
    """The generator; InputError where it is None and the rule draws."""
    if generator is None:
        raise InputError(f"{rule} draws at random; give a generator, e.g. numpy.random.default_rng(0)")
    return generator
