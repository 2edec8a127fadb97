"""Selects features by the entropy that they save: over all sets (Eq. 3.12), singly (Alg. 5), after each task (Alg.
6).

Thesis: §3.3.2, §3.3.3, §3.4.5.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import prod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.features.counted_features import CountedFeatures, action_set_entropy, pooled_counts
from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError

MOST_FEATURES = 15
"""Maximum number of features of an exhaustive search, which then compares 32,768 sets."""
SLACK = 1e-12
"""Bits by which an increase may be below the threshold, because the mean of equal numbers may round up."""


# ---- Eq. 3.12, exhaustively -------------------------------------------------------------------------------


@dataclass(frozen=True)
class FeatureSearch:
    """φ*, and the entropy of every set.

    names : the chosen features, in the full set's order
    entropy : H_φ* in bits
    objective : H_φ* + c ‖φ*‖
    entropies : every subset as a tuple of names, with its H_φ
    """

    names: tuple[str, ...]
    entropy: float
    objective: float
    entropies: dict[tuple[str, ...], float]


def best_feature_set(counted: CountedFeatures, penalty: float = 0.0) -> FeatureSearch:
    """φ* = arg min H_φ + c ‖φ‖ over all subsets (Eq. 3.12); of equally good sets the smallest, then the first.

    Parameters
    ----------
    counted : CountedFeatures
        At most `MOST_FEATURES` features.
    penalty : float
        c ≥ 0, bits per feature.

    Examples
    --------
    >>> columns = [[0, 0], [0, 1], [1, 0], [1, 1]]
    >>> counted = CountedFeatures.from_columns(columns, [[1, 0], [1, 0], [0, 1], [0, 1]])
    >>> best_feature_set(counted, penalty=0.1).names
    ('f0',)
    """
    n = len(counted.features)
    if n > MOST_FEATURES:
        raise InputError(f"exhaustive search takes at most {MOST_FEATURES} features, got {n}; use Alg. 5")
    if not (penalty >= 0 and np.isfinite(penalty)):
        raise InputError(f"penalty must be finite and at least 0, got {penalty}")
    entropies = dict(_all_subsets(counted))
    ranked = sorted(entropies, key=lambda names: (len(names), [counted.features.names.index(x) for x in names]))
    best = ranked[0]
    for names in ranked[1:]:
        gain = entropies[best] + penalty * len(best) - entropies[names] - penalty * len(names)
        best = names if gain > SLACK else best
    return FeatureSearch(best, entropies[best], entropies[best] + penalty * len(best), entropies)


def _all_subsets(counted: CountedFeatures) -> Iterator[tuple[tuple[str, ...], float]]:
    """Every subset with its entropy, computed from the counts of a set with one more feature."""
    names, sizes = counted.features.names, counted.features.sizes
    waiting = [(tuple(range(len(names))), *pooled_counts(counted.codes, counted.counts), len(names))]
    while waiting:
        own, codes, counts, below = waiting.pop()
        yield tuple(names[i] for i in own), action_set_entropy(counts)
        # The next features left out stand before the last one left out, so that each set occurs once.
        place = prod(sizes[i] for i in own[below:])
        for at in reversed(range(below)):
            coarser = codes // (place * sizes[own[at]]) * place + codes % place
            waiting.append((own[:at] + own[at + 1 :], *pooled_counts(coarser, counts), at))
            place *= sizes[own[at]]


# ---- Alg. 5 -----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class FeatureChoice:
    """Features chosen by Alg. 5, and their entropy increases.

    names : the chosen features, in the full set's order
    full_entropy : H of the full set, bits
    increase : Δ_f of every feature, bits: growth of the entropy without it; at least 0 up to rounding
    threshold : ω
    """

    names: tuple[str, ...]
    full_entropy: float
    increase: dict[str, float]
    threshold: float


def independent_features(counted: CountedFeatures, threshold: float | None = None) -> FeatureChoice:
    """Features without which the entropy grows by ω or more (Alg. 5).

    Each feature is left out alone, so two copies of one feature both have an increase of 0; see
    `features_by_removal`.

    Parameters
    ----------
    counted : CountedFeatures
    threshold : float, optional
        ω in bits; default the mean of all Δ (§3.3.3).

    Examples
    --------
    >>> counted = CountedFeatures.from_columns([[0, 0], [0, 1], [1, 0], [1, 1]], [[1, 0], [1, 0], [0, 1], [0, 1]])
    >>> independent_features(counted).names
    ('f0',)
    """
    features = counted.features
    codes, counts = pooled_counts(counted.codes, counted.counts)
    full = action_set_entropy(counts)
    increase = {}
    for name in features.names:
        others = [other for other in features.names if other != name]
        increase[name] = action_set_entropy(pooled_counts(features.coarser(codes, others), counts)[1]) - full
    mean = float(np.mean(list(increase.values()))) if increase else 0.0
    omega = mean if threshold is None else float(threshold)
    if np.isnan(omega):
        raise InputError(f"threshold must be a number, got {threshold}")
    chosen = tuple(name for name, delta in increase.items() if delta >= omega - SLACK)
    return FeatureChoice(chosen, full, increase, omega)


def features_by_removal(counted: CountedFeatures, penalty: float) -> tuple[str, ...]:
    """Features left when the least useful is removed while H_φ + c ‖φ‖ does not grow (§3.4.5).

    Unlike Alg. 5, it retains one of two copies of a feature. `penalty`: c ≥ 0, bits per feature.
    """
    if not (penalty >= 0 and np.isfinite(penalty)):
        raise InputError(f"penalty must be finite and at least 0, got {penalty}")
    own, (codes, counts) = counted.features, pooled_counts(counted.codes, counted.counts)
    entropy = action_set_entropy(counts)
    while len(own):
        tried = []
        for i in range(len(own)):
            names = own.names[:i] + own.names[i + 1 :]
            pooled = pooled_counts(own.coarser(codes, names), counts)
            tried.append((action_set_entropy(pooled[1]), names, pooled))
        least, names, pooled = min(tried, key=lambda candidate: candidate[0])
        if least - entropy > penalty + SLACK:
            break
        own, (codes, counts), entropy = own.subset(names), pooled, least
    return own.names


# ---- Alg. 6 -----------------------------------------------------------------------------------------------


class OnlineFeatureSelection:
    """Selects features after each task, and holds the prior over the selected features (Alg. 6).

    Parameters
    ----------
    features : FeatureSet
        φ_full.
    actions : sequence of str
        Names of the actions.
    alpha0 : float
        As in `ActionPrior`.
    threshold : float, optional
        ω of Alg. 5; default the mean of all Δ.

    Attributes
    ----------
    full : ActionPrior
        θ_full, over codes of all features.
    prior : ActionPrior
        θ, over codes of the chosen features; before the first task all features are chosen.
    chosen : FeatureSet
    choices : list of FeatureChoice
        The choice after each task.

    Examples
    --------
    >>> online = OnlineFeatureSelection(FeatureSet(("wall", "odd"), (2, 2)), ["left", "right"])
    >>> online.update(np.arange(4), [[True, False], [True, False], [False, True], [False, True]]).names
    ('wall',)
    """

    def __init__(
        self, features: FeatureSet, actions: Sequence[str], alpha0: float = 0.1, threshold: float | None = None
    ) -> None:
        self.features, self.actions, self.threshold = features, tuple(actions), threshold
        self.full = ActionPrior(len(self.actions), alpha0, features.key(self.actions))
        self.chosen, self.prior = features, self.full
        self.choices: list[FeatureChoice] = []

    def update(self, contexts: ArrayLike, best: ArrayLike, weight: float = 1.0) -> FeatureChoice:
        """Count the policy of one task and select features (Alg. 6, lines 6-8).

        As `ActionPrior.update`, with codes of `features` as contexts.
        """
        self.features.coarser(contexts, ())  # refuses codes of another set
        self.full.update(contexts, best, weight)
        choice = independent_features(CountedFeatures.from_prior(self.full, self.features), self.threshold)
        self.chosen = self.features.subset(choice.names)
        coarser = self.features.coarser(self.full.contexts, choice.names)
        self.prior = self.full.marginalise(coarser, self.chosen.key(self.actions))
        self.choices.append(choice)
        return choice

    def probs(self, contexts: ArrayLike, form: str = "proportion", **form_settings) -> NDArray[np.float64]:
        """θ for codes of the full set, (n, n_actions), as `prior_rows` takes it."""
        return self.prior.probs(self.features.coarser(contexts, self.chosen.names), form, **form_settings)
