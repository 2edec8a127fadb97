"""Reward models and rules of `reuse evaluate`, learnt from a log without the users whom they predict."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.evaluate.replayed_choices import ReplayedChoices, replayed_choices
from lifelore.agent.personalise.fitting.fit import FitSettings, study_of_log
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.agent.personalise.study import Study
from lifelore.interaction.evaluation.reward_models import RewardModel, policy_means

Numbers = NDArray[np.int64]


def expected_by_means(log: ReuseLog, folds: Numbers) -> RewardModel:
    """Each policy's mean outcome over the users of other parts."""
    return policy_means(log.outcomes, log.policy.codes, len(log.policy.names), folds)


def studies_of_others(log: ReuseLog, folds: Numbers, types: int | None, seed: int) -> list[Study]:
    """For each part of the users, a study fitted to all other parts.

    Parameters
    ----------
    folds : (n,) int64
        Part of the users of each row.
    types : int, optional
        Number of types; default: selected by the outcomes.
    """
    settings = FitSettings(types=types, seed=seed)
    parts = range(int(folds.max()) + 1)
    return [study_of_log(log.take(np.flatnonzero(folds != part)), settings)[0] for part in parts]


def expected_by_library(
    log: ReuseLog, folds: Numbers, studies: Sequence[Study], means: RewardModel
) -> RewardModel:
    """Each policy's expected outcome under the user's belief, by the library of the user's part.

    Policies that the library does not know have their expectation in `means`.
    """
    expected = _replayed(log, folds, studies, choose=False).expected
    table = np.where(np.isnan(expected), means.table[means.row], expected)
    return RewardModel(table, np.arange(len(log)))


def choices_of_rule(
    log: ReuseLog, folds: Numbers, studies: Sequence[Study], rule: str, explore: float
) -> ReplayedChoices:
    """The choices of a rule, each by the library of the user's part; `explore` of them from all policies."""
    return _replayed(
        log, folds, [replace(study, rule=rule, rule_settings={}, explore=explore) for study in studies]
    )


def _replayed(log: ReuseLog, folds: Numbers, studies: Sequence[Study], choose: bool = True) -> ReplayedChoices:
    rows = [np.flatnonzero(folds == part) for part in range(len(studies))]
    parts = [replayed_choices(study, log, own, choose=choose) for study, own in zip(studies, rows, strict=True)]
    order = np.argsort(np.concatenate(rows))
    return ReplayedChoices(*(np.concatenate(column)[order] for column in zip(*parts, strict=True)))
