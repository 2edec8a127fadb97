"""Choices among the available policies: scores, probabilities and ranks where some policies cannot be chosen now.

A rule scores the available policies as if the library had no others: a policy that is not available is no target
of expected improvement, no next choice of the knowledge gradient, and no best response to a type that belief
sampling draws. The belief is about all types and stays as it is.
"""

from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.finite_signals.signal_table import SignalTable
from lifelore.interaction.library.library_names import index_of
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.outcome_model import OutcomeModel
from lifelore.interaction.selection.choice import choose
from lifelore.interaction.selection.rule import SelectionRule

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]
Available = Sequence[str | int] | NDArray[Any]
"""Names or numbers of the available policies, or a bool for each policy."""

MOST_PARTS = 64
"""Number of sets of available policies whose signal tables are stored for each table; more cost memory."""


def available_policies(available: Available, names: Sequence[str]) -> Numbers:
    """Numbers of the available policies, rising.

    Parameters
    ----------
    available : sequence of str or int, or (n_policies,) bool
    names : sequence of str
        Of all policies.

    Raises
    ------
    InputError
        No policy is available, or a bool mask has another length.
    NotFoundError
        There is no such policy.

    Examples
    --------
    >>> available_policies(["right", "left"], ["left", "middle", "right"]).tolist()
    [0, 2]
    >>> available_policies([False, True, False], ["left", "middle", "right"]).tolist()
    [1]
    """
    given = np.asarray(available)
    if given.dtype == bool:
        if given.shape != (len(names),):
            raise InputError(f"available must be ({len(names)},) bool, one for each policy, got {given.shape}")
        found = np.flatnonzero(given)
    else:
        listed = [available] if isinstance(available, str | int) else list(available)
        found = np.unique(np.array([index_of(policy, names, "policy") for policy in listed], np.int64))
    if not found.size:
        raise InputError("available must hold at least one policy, got none; end the episode with skip() instead")
    return found


def available_part(library: PolicyLibrary, policies: Numbers) -> PolicyLibrary:
    """The library of some policies, as rules read it: outcomes and signal tables, but no likelihoods of signals.

    Its models are views: any library will do, also one whose models cannot be restricted, and the part sees what
    the models learn later.

    Parameters
    ----------
    policies : (k,) int64
        As `available_policies` gives them.
    """
    if len(policies) == library.n_policies:
        return library
    performance: Any = _PartOfOutcomes(library.performance, policies)
    signal: Any = _PartOfTable(library, policies)
    names = tuple(library.policies[policy] for policy in policies)
    return PolicyLibrary(performance, signal, library.types, names, library.prior)


def available_scores(
    rule: SelectionRule,
    library: PolicyLibrary,
    belief: Array,
    policies: Numbers,
    *,
    episodes_left: float | None = None,
    generator: np.random.Generator | None = None,
) -> Array:
    """The rule's score of each policy under a belief (n_types,), (n_policies,); NaN where it is not available."""
    part = available_part(library, policies)
    scores = np.full(library.n_policies, np.nan)
    scores[policies] = rule.scores(part, belief, episodes_left=episodes_left, generator=generator)
    return scores


def available_probabilities(
    rule: SelectionRule,
    library: PolicyLibrary,
    belief: Array,
    policies: Numbers,
    *,
    episodes_left: float | None = None,
) -> Array:
    """Probability of choosing each policy under beliefs (..., n_types), (..., n_policies); rows sum to 1."""
    probs = np.zeros((*np.shape(belief)[:-1], library.n_policies))
    part = available_part(library, policies)
    probs[..., policies] = rule.probabilities(part, belief, episodes_left=episodes_left)
    return probs


def best_policies(scores: Array, k: int, generator: np.random.Generator) -> list[int]:
    """The `k` policies of the largest scores (n_policies,), best first, equals at random; never one of score NaN.

    Raises
    ------
    InputError
        `k` is below 1 or above the number of scores that are numbers.
    """
    left = np.flatnonzero(~np.isnan(scores))
    if not 1 <= k <= len(left):
        raise InputError(f"k must be 1 to {len(left)}, the number of available policies, got {k}")
    best: list[int] = []
    for _ in range(k):
        place = choose(scores[left], generator)
        best.append(int(left[place]))
        left = np.delete(left, place)
    return best


class _PartOfOutcomes:
    """The outcomes of some policies: arrays over pairs and methods that give them, cut to these policies."""

    def __init__(self, outcomes: OutcomeModel, policies: Numbers) -> None:
        self._outcomes, self._policies = outcomes, policies

    @property
    def n_types(self) -> int:
        return self._outcomes.n_types

    @property
    def n_policies(self) -> int:
        return len(self._policies)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        found: Any = getattr(self._outcomes, name)
        if isinstance(found, np.ndarray):
            return self._cut(found)
        if not callable(found):
            return found

        def cut(values: Any) -> Array:
            # For thresholds or values (...,), a method gives (..., n_types, n_policies).
            return self._cut(getattr(self._outcomes, name)(values))

        return cut

    def _cut(self, of_pairs: Array) -> Array:
        return np.ascontiguousarray(of_pairs[..., self._policies])


class _PartOfTable:
    """Stands for the signal model of a part of a library: gives the part's table and nothing else."""

    def __init__(self, library: PolicyLibrary, policies: Numbers) -> None:
        self._library, self._policies = library, policies

    def table(self, n_bins: int) -> SignalTable:
        """The rows of the part's policies in the library's table."""
        whole = self._library.table(n_bins)
        rows, parts = whole.probs[self._policies], _PARTS.setdefault(whole, {})
        key = self._policies.tobytes()
        # A library may change its table in place; the part is then made anew.
        if key not in parts or not np.array_equal(parts[key].probs, rows):
            if len(parts) >= MOST_PARTS:
                parts.clear()
            parts[key] = SignalTable.restored(rows)
        return parts[key]


_PARTS: WeakKeyDictionary[SignalTable, dict[bytes, SignalTable]] = WeakKeyDictionary()
