"""A study replayed on logged decisions: before each, the policies' expected outcomes and their probabilities."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.log import ReuseLog
from lifelore.agent.reuse.one_user import policy_odds
from lifelore.agent.reuse.study import Study
from lifelore.agent.reuse.user_state import Checkpoint, WorkingBelief
from lifelore.interaction.beliefs.belief import expected_utility

Array = NDArray[np.float64]


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
    place = {policy: number for number, policy in enumerate(log.policy.names)}
    in_log = np.array([policy in place for policy in study.active])
    from_study, elsewhere = np.flatnonzero(in_log), np.flatnonzero(~in_log)
    to_log = np.array([place[study.active[number]] for number in from_study], np.int64)
    shape = len(rows), len(log.policy.names)
    expected, probabilities, unknown = np.full(shape, np.nan), np.zeros(shape), np.zeros(len(rows))
    beliefs: dict[int, WorkingBelief] = {}
    policies, outcomes = log.policy.codes[rows].tolist(), log.outcomes[rows].tolist()
    for number, user in enumerate(log.user.codes[rows].tolist()):
        if user not in beliefs:
            prior = study.algorithm.start(study.prior_of(_context(log, user), _features(log, user)))
            beliefs[user] = WorkingBelief(study, Checkpoint(0, prior, 0.0))
        now = beliefs[user].checkpoint(number)
        belief, library = study.algorithm.belief(now.log_belief), study.choice_for(now.task)
        probs = policy_odds(study, library, belief).probs if choose else np.zeros(library.n_policies)
        probabilities[number, to_log] = probs[from_study]
        expected[number, to_log] = expected_utility(belief, library.performance.mean)[from_study]
        unknown[number] = probs[elsewhere].sum()
        beliefs[user].learn(log.policy.names[policies[number]], outcomes[number])
    return ReplayedChoices(expected, probabilities, unknown)


def _context(log: ReuseLog, user: int) -> str | None:
    place = int(log.context_of_user[user])
    return log.context.names[place] if place >= 0 else None


def _features(log: ReuseLog, user: int) -> dict[str, float] | None:
    """The numbers known of a user; None unless all are."""
    row = log.features_of_user[user]
    if not row.size or np.isnan(row).any():
        return None
    return dict(zip(log.feature_names, row.tolist(), strict=True))
