"""`FeatureAcquisition`: acquires new features while the entropy of its action prior stays high.

A high entropy has two possible reasons: tasks use a context differently, or the features are too poor (§3.3.2). An
agent cannot tell which from the features that it has. It finds out by trial: it records a further feature in the
next tasks, and compares the entropy with it and without it in the counts of these tasks (Eq. 3.11). It keeps the
feature where it saves enough bits, and else drops it and tries the next.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.features.counted_features import CountedFeatures
from lifelore.action.features.feature_set import FeatureSet
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError


@dataclass(frozen=True)
class AcquisitionSettings:
    """When a feature is tried, and when it is kept.

    Parameters
    ----------
    high : float
        Bits above which the entropy of the prior counts as high; ≥ 0. Higher leaves the features as they are.
    patience : int
        Tasks in a row after which the entropy stays high, ≥ 1.
    trial : int
        Tasks of a trial, ≥ 1. With few counts every feature seems to save bits.
    least : float
        Bits that a kept feature saves in its trial, > 0.
    """

    high: float = 0.5
    patience: int = 2
    trial: int = 2
    least: float = 0.05

    def __post_init__(self) -> None:
        for name, holds, rule in (
            ("high", self.high >= 0, "at least 0 bits"),
            ("patience", self.patience >= 1, "at least 1 task"),
            ("trial", self.trial >= 1, "at least 1 task"),
            ("least", self.least > 0, "above 0 bits"),
        ):
            if not holds:
                raise InputError(f"{name} must be {rule}, got {getattr(self, name)}")


@dataclass(frozen=True)
class Trial:
    """A trial that ended: the feature, the bits that it saved, and whether it was kept."""

    feature: str
    saved: float
    kept: bool


class FeatureAcquisition:
    """A prior over few features, and the trials that add more.

    Parameters
    ----------
    features : FeatureSet
        All features: those of the start and the candidates.
    start : sequence of str
        Names of the features that the agent has at first.
    actions : sequence of str
        Names of the actions.
    candidates : sequence of str, optional
        Features to try, in this order; default all others in the order of `features`.
    settings : AcquisitionSettings
    alpha0 : float
        As in `ActionPrior`.

    Attributes
    ----------
    prior : ActionPrior
        θ over codes of the features that the agent has. After a feature is kept, it holds the counts since the
        trial began, because earlier tasks did not record it.
    chosen : FeatureSet
        The features that the agent has.
    on_trial : str or None
    trials : list of Trial
        Those that ended, in order.

    Raises
    ------
    InputError
        A candidate is among the features of the start.
    NotFoundError
        A name is none of `features`.

    Examples
    --------
    >>> acquisition = FeatureAcquisition(FeatureSet(("wall", "odd"), (2, 2)), ["wall"], ["left", "right"])
    >>> acquisition.update(np.arange(4), np.eye(2, dtype=bool)[[0, 1, 0, 1]])
    >>> acquisition.probs(np.arange(2)).round(2).tolist()
    [[0.5, 0.5], [0.5, 0.5]]
    """

    def __init__(
        self,
        features: FeatureSet,
        start: Sequence[str],
        actions: Sequence[str],
        candidates: Sequence[str] | None = None,
        settings: AcquisitionSettings | None = None,
        alpha0: float = 0.1,
    ) -> None:
        others = [name for name in features.names if name not in start] if candidates is None else list(candidates)
        if known := [name for name in others if name in start]:
            raise InputError(f"candidates must be none of the features at the start, got '{known[0]}'")
        features.subset(others)
        self.features, self.actions, self.alpha0 = features, tuple(actions), alpha0
        self.settings = settings or AcquisitionSettings()
        self.chosen = features.subset(start)
        self.prior = self._empty(self.chosen)
        self.on_trial: str | None = None
        self.trials: list[Trial] = []
        self._waiting, self._tasks = others, 0
        self._finer: tuple[FeatureSet, ActionPrior] | None = None

    @property
    def entropy(self) -> float:
        """H of the prior in bits (Eq. 3.11)."""
        return CountedFeatures.from_prior(self.prior, self.chosen).entropy()

    def update(self, contexts: ArrayLike, best: ArrayLike, weight: float = 1.0) -> None:
        """Count the policy of one task, and begin or end a trial.

        As `ActionPrior.update`, with codes of all `features` as contexts. The agent reads only the features that
        it has and the one on trial.
        """
        self.prior.update(self.features.coarser(contexts, self.chosen.names), best, weight)
        self._tasks += 1
        if self._finer is not None:
            finer, counts = self._finer
            counts.update(self.features.coarser(contexts, finer.names), best, weight)
            if self._tasks >= self.settings.trial:
                self._end_trial(finer, counts)
        elif self.entropy <= self.settings.high:
            self._tasks = 0
        elif self._tasks >= self.settings.patience and self._waiting:
            self.on_trial, self._tasks = self._waiting.pop(0), 0
            finer = self.features.subset((*self.chosen.names, self.on_trial))
            self._finer = finer, self._empty(finer)

    def probs(self, contexts: ArrayLike, form: str = "proportion", **form_settings) -> NDArray[np.float64]:
        """θ for codes of all features, (n, n_actions), as `prior_rows` takes it."""
        return self.prior.probs(self.features.coarser(contexts, self.chosen.names), form, **form_settings)

    def _end_trial(self, finer: FeatureSet, counts: ActionPrior) -> None:
        counted = CountedFeatures.from_prior(counts, finer)
        saved = counted.entropy(self.chosen.names) - counted.entropy()
        kept = saved >= self.settings.least
        assert self.on_trial is not None
        self.trials.append(Trial(self.on_trial, saved, kept))
        if kept:
            self.chosen, self.prior = finer, counts
        self.on_trial, self._finer, self._tasks = None, None, 0

    def _empty(self, features: FeatureSet) -> ActionPrior:
        return ActionPrior(len(self.actions), self.alpha0, features.key(self.actions))
