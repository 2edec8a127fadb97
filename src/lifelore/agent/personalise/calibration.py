"""How well a study's predictions fit its decisions: quantiles of outcomes, and probabilities of types.

Outcomes are predicted by the belief before each, in the order in which they came. Types are known of users whom
a log names; the name itself and the outcomes of the log are left out, so that only decisions speak for a type.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.beliefs import learn, learn_turn, start_at_priors, turns
from lifelore.agent.personalise.histories import History
from lifelore.agent.personalise.study import Study
from lifelore.interaction.reuse.calibration import outcome_calibration, type_calibration
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


def lived_again(study: Study, histories: Sequence[History]) -> tuple[ReuseAlgorithm, dict[str, Any] | None]:
    """The beliefs about users after their last outcomes, a row each, and the calibration of the outcomes.

    Returns
    -------
    algorithm : ReuseAlgorithm
    calibration : dict
        `Calibration.to_dict` with users as groups; None without an outcome of a policy that the library knows.
    """
    algorithm, levels, users = study.algorithm.new_rows(len(histories)), [], []
    start_at_priors(algorithm, study, [one.user for one in histories])
    learn(algorithm, study, [(row, *pair) for row, one in enumerate(histories) for pair in one.past])
    for rows, policies, outcomes in turns(study, _outcomes_of(histories)):
        known = policies >= 0
        if known.any():
            levels.append(_levels(algorithm, rows[known], policies[known], outcomes[known]))
            users.append(rows[known])
        learn_turn(algorithm, rows, policies, outcomes)
    if not users:
        return algorithm, None
    return algorithm, outcome_calibration(np.concatenate(levels), np.concatenate(users)).to_dict()


def _outcomes_of(histories: Sequence[History]) -> list[tuple[int, str, float]]:
    """(row, policy, outcome) of the decisions of users in the order in which outcomes came."""
    return [(row, one.policy, one.outcome or 0.0) for row, own in enumerate(histories) for one in own.ended]


def _levels(algorithm: ReuseAlgorithm, rows: Numbers, policies: Numbers, values: Array) -> Array:
    """P(U < u) and P(U ≤ u) of an outcome of each user under the belief before it, (n, 2)."""
    belief, levels = algorithm.belief(rows), np.empty((len(rows), 2))
    for policy in np.unique(policies).tolist():
        at = policies == policy
        performance = algorithm.known(rows[at]).performance
        for end, own in enumerate((np.nextafter(values[at], -np.inf), values[at])):
            levels[at, end] = (belief[at].T * performance.cumulative(policy, own)).sum(axis=0)
    return np.clip(levels, 0.0, 1.0)


def type_probabilities(study: Study, histories: Sequence[History]) -> dict[str, Any] | None:
    """The calibration of beliefs over types, as for `lived_again`; None where no user's type is known."""
    known = [one for one in histories if one.user.type in study.library.types and one.ended]
    if not known:
        return None
    algorithm = study.algorithm.new_rows(len(known))
    start_at_priors(algorithm, study, [one.user._replace(type=None) for one in known])
    of_user = np.array([study.library.index_of_type(one.user.type or "") for one in known])
    beliefs, users = [], []
    for rows, policies, outcomes in turns(study, _outcomes_of(known)):
        learn_turn(algorithm, rows, policies, outcomes)
        beliefs.append(algorithm.belief(rows))
        users.append(rows)
    rows = np.concatenate(users)
    return type_calibration(np.concatenate(beliefs), of_user[rows], rows).to_dict()
