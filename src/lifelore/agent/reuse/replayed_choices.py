"""A study replayed on logged decisions: before each, the policies' expected outcomes and their probabilities."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.reuse.log import ReuseLog
from lifelore.agent.reuse.one_user import policy_odds
from lifelore.agent.reuse.study import Study
from lifelore.agent.reuse.user_state import learn
from lifelore.interaction.beliefs.belief import expected_utility

Array = NDArray[np.float64]


class ReplayedChoices(NamedTuple):
    """What a study believes and would do before each logged decision.

    expected : (n, n_policies) float64
        Expected outcome of each policy of the log; NaN where the study's library does not know it.
    probabilities : (n, n_policies) float64
        With which the study would choose each policy of the log.
    unknown : (n,) float64
        Probability of policies that the log does not name.
    """

    expected: Array
    probabilities: Array
    unknown: Array


def replayed_choices(study: Study, log: ReuseLog, rows: NDArray[np.int64]) -> ReplayedChoices:
    """Replay some rows of a log: each user starts as a stranger and learns from the logged outcomes.

    Parameters
    ----------
    study : Study
    log : ReuseLog
    rows : (n,) int64
        Places in the log; those of a user are in order of time. The belief learns from each outcome before the
        user's next decision.
    """
    place = {policy: number for number, policy in enumerate(log.policy.names)}
    known = [(number, place[policy]) for number, policy in enumerate(study.library.policies) if policy in place]
    from_library, to_log = np.array(known, np.int64).reshape(-1, 2).T
    shape = len(rows), len(log.policy.names)
    expected, probabilities, unknown = np.full(shape, np.nan), np.zeros(shape), np.zeros(len(rows))
    beliefs: dict[int, Array] = {}
    policies, outcomes = log.policy.codes[rows].tolist(), log.outcomes[rows].tolist()
    mean = study.library.performance.mean[:, from_library]
    for number, user in enumerate(log.user.codes[rows].tolist()):
        if user not in beliefs:
            beliefs[user] = study.algorithm.start(study.prior_of(_context(log, user)))
        belief = study.algorithm.belief(beliefs[user])
        expected[number, to_log] = expected_utility(belief, mean)
        odds = policy_odds(study, belief)
        for policy, probability in zip(odds.policies, odds.probs.tolist(), strict=True):
            if policy in place:
                probabilities[number, place[policy]] = probability
            else:
                unknown[number] += probability
        learn(study, beliefs[user], log.policy.names[policies[number]], outcomes[number])
    return ReplayedChoices(expected, probabilities, unknown)


def _context(log: ReuseLog, user: int) -> str | None:
    place = int(log.context_of_user[user])
    return log.context.names[place] if place >= 0 else None
