"""Studies replayed on logged decisions: before each, the policies' expected outcomes and their probabilities.

A study of memory is replayed on all; those that are fitted to the log itself each on users whom it has not seen.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.beliefs import learn_turn, probabilities, start_at_priors
from lifelore.agent.personalise.fitting.fit import FitSettings, study_of_log
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.agent.personalise.study import Study
from lifelore.interaction.evaluation.propensity_weights import decision_numbers
from lifelore.interaction.evaluation.reward_models import RewardModel
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.selection.choice import available_mask
from lifelore.memory.study_rows import UserRow

Array = NDArray[np.float64]

USERS_AT_ONCE = 256
"""Number of users who are replayed side by side; more need more memory and are hardly faster."""


class ReplayedChoices(NamedTuple):
    """What a study believes and would do before each logged decision.

    expected : (n, n_policies) float64
        Expected outcome of each policy of the log; NaN where the study does not choose from it.
    probabilities : (n, n_policies) float64
        With which the study would choose each policy of the log.
    unknown : (n,) float64
        Probability of policies that the log does not name.
    """

    expected: Array
    probabilities: Array
    unknown: Array


def replayed_choices(
    study: Study, log: ReuseLog, rows: NDArray[np.int64], *, choose: bool = True
) -> ReplayedChoices:
    """Replay some rows of a log: each user starts as a stranger and learns from the logged outcomes.

    Parameters
    ----------
    study : Study
    log : ReuseLog
    rows : (n,) int64
        Places in the log; those of a user are in order of time. The belief learns from each outcome before the
        user's next decision.
    choose : bool
        Whether to compute the probabilities of the choices; they stay 0 otherwise.
    """
    numbers = {policy: number for number, policy in enumerate(study.library.policies)}
    to_library = np.array([numbers.get(policy, -1) for policy in log.policy.names], np.int64)
    usable = available_mask(study.active, study.library.policies)
    users, user_of = np.unique(log.user.codes[rows], return_inverse=True)
    policies, outcomes, turn = to_library[log.policy.codes[rows]], log.outcomes[rows], decision_numbers(user_of)
    # By policy of the library; users take their turns side by side.
    expected, probs = np.zeros((2, len(rows), study.library.n_policies))
    for first in range(0, len(users), USERS_AT_ONCE):
        algorithm = _strangers(study, log, users[first : first + USERS_AT_ONCE].tolist())
        inside = np.flatnonzero(user_of // USERS_AT_ONCE == first // USERS_AT_ONCE)
        for number in range(turn[inside].max() + 1):
            at = inside[turn[inside] == number]
            own = user_of[at] - first
            expected[at] = algorithm.known(own).performance.expected(algorithm.belief(own))
            if choose:
                probs[np.ix_(at, np.array(study.active_numbers))] = probabilities(study, algorithm, own)
            learn_turn(algorithm, own, policies[at], outcomes[at])
    return _by_policy_of_log(expected, probs, np.where(np.append(usable, False)[to_library], to_library, -1))


def _by_policy_of_log(expected: Array, probs: Array, to_library: NDArray[np.int64]) -> ReplayedChoices:
    """The choices by policy of the log; `to_library` is -1 where the study does not choose from it."""
    shared = to_library >= 0
    by_log = ReplayedChoices(
        np.full((len(probs), len(to_library)), np.nan),
        np.zeros((len(probs), len(to_library))),
        np.delete(probs, to_library[shared], axis=1).sum(axis=1),
    )
    by_log.expected[:, shared] = expected[:, to_library[shared]]
    by_log.probabilities[:, shared] = probs[:, to_library[shared]]
    return by_log


def _strangers(study: Study, log: ReuseLog, users: list[int]) -> ReuseAlgorithm:
    """Rows of users of whom only context and features are known."""
    algorithm = study.algorithm.new_rows(len(users))
    strangers = [UserRow(0, "", _context(log, user), _features(log, user), None, False, 0, None) for user in users]
    start_at_priors(algorithm, study, strangers)
    return algorithm


def _context(log: ReuseLog, user: int) -> str | None:
    place = int(log.context_of_user[user])
    return log.context.names[place] if place >= 0 else None


def _features(log: ReuseLog, user: int) -> dict[str, float] | None:
    """The numbers known of a user; None unless all are."""
    row = log.features_of_user[user]
    if not row.size or np.isnan(row).any():
        return None
    return dict(zip(log.feature_names, row.tolist(), strict=True))


def studies_of_others(log: ReuseLog, folds: NDArray[np.int64], types: int | None, seed: int) -> list[Study]:
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
    log: ReuseLog, folds: NDArray[np.int64], studies: Sequence[Study], means: RewardModel
) -> RewardModel:
    """Each policy's expected outcome under the user's belief, by the library of the user's part.

    Policies that the library does not know have their expectation in `means`.
    """
    expected = _replayed(log, folds, studies, choose=False).expected
    table = np.where(np.isnan(expected), means.table[means.row], expected)
    return RewardModel(table, np.arange(len(log)))


def choices_of_rule(
    log: ReuseLog, folds: NDArray[np.int64], studies: Sequence[Study], rule: str, explore: float
) -> ReplayedChoices:
    """The choices of a rule, each by the library of the user's part; `explore` of them from all policies."""
    return _replayed(
        log, folds, [replace(study, rule=rule, rule_settings={}, explore=explore) for study in studies]
    )


def _replayed(
    log: ReuseLog, folds: NDArray[np.int64], studies: Sequence[Study], choose: bool = True
) -> ReplayedChoices:
    rows = [np.flatnonzero(folds == part) for part in range(len(studies))]
    parts = [replayed_choices(study, log, own, choose=choose) for study, own in zip(studies, rows, strict=True)]
    order = np.argsort(np.concatenate(rows))
    return ReplayedChoices(*(np.concatenate(column)[order] for column in zip(*parts, strict=True)))
