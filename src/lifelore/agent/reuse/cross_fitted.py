"""Outcome models and rules of `reuse evaluate`, learnt from a log without the users whom they predict."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.fit import FitSettings, study_of_log
from lifelore.agent.reuse.log import ReuseLog
from lifelore.agent.reuse.replayed_choices import ReplayedChoices, replayed_choices
from lifelore.interaction.evaluation.outcome_models import OutcomeModel, policy_means

Numbers = NDArray[np.int64]


def expected_by_means(log: ReuseLog, folds: Numbers) -> OutcomeModel:
    """Each policy's mean outcome over the users of other parts."""
    return policy_means(log.outcomes, log.policy.codes, len(log.policy.names), folds)


def expected_by_library(
    log: ReuseLog, folds: Numbers, means: OutcomeModel, types: int | None, seed: int
) -> OutcomeModel:
    """Each policy's expected outcome under the user's belief, by a library of the users of other parts.

    Parameters
    ----------
    folds : (n,) int64
        Part of the users of each row.
    means : OutcomeModel
        Counts for policies that a part's library does not know.
    types : int, optional
        Number of types; default: selected by the outcomes.
    """
    table = means.table[means.row]
    for rows, choices in _choices(log, folds, FitSettings(types=types, seed=seed)):
        table[rows] = np.where(np.isnan(choices.expected), table[rows], choices.expected)
    return OutcomeModel(table, np.arange(len(log)))


def cross_fitted_choices(
    log: ReuseLog, folds: Numbers, rule: str, explore: float, types: int | None, seed: int
) -> ReplayedChoices:
    """The choices of a rule, each by a library of the users of other parts."""
    settings = FitSettings(types=types, rule=rule, explore=explore, seed=seed)
    parts = list(_choices(log, folds, settings))
    order = np.argsort(np.concatenate([rows for rows, _ in parts]))
    joined = zip(*(choices for _, choices in parts), strict=True)
    return ReplayedChoices(*(np.concatenate(column)[order] for column in joined))


def _choices(log: ReuseLog, folds: Numbers, settings: FitSettings) -> Iterator[tuple[Numbers, ReplayedChoices]]:
    """For each part its rows, and what a study fitted to the other parts believes and would do there."""
    for fold in range(int(folds.max()) + 1):
        study, *_ = study_of_log(log.take(np.flatnonzero(folds != fold)), settings)
        rows = np.flatnonzero(folds == fold)
        yield rows, replayed_choices(study, log, rows)
