"""How well a study's predictions fit its decisions: quantiles of outcomes, and probabilities of types.

Users are a random sample of so many that a report takes seconds, with all that happened to them. Outcomes are
predicted by the belief before each, in the order in which they came. Types are known of users whom a log names;
the name itself and the outcomes of the log are left out, so that only decisions speak for a type.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.beliefs import learn, learn_turn, start_at_priors, turns
from lifelore.agent.personalise.study import Study
from lifelore.core.intervals import welch_interval
from lifelore.interaction.reuse.calibration import outcome_calibration, type_calibration
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.memory import Memory
from lifelore.memory.study_rows import DecisionRow, UserRow

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

SAMPLE = 2000
"""Largest number of users in a sample; more cost time and make curves and calibration less noisy."""


class History(NamedTuple):
    """A user.

    past : (policy, outcome) of the outcomes elsewhere
    decisions : those that count, in order of time
    """

    user: UserRow
    past: list[tuple[str, float]]
    decisions: list[DecisionRow]

    @property
    def ended(self) -> list[DecisionRow]:
        """The decisions with an outcome in the order in which outcomes came."""
        ended = (one for one in self.decisions if one.outcome is not None)
        return sorted(ended, key=lambda one: (one.ended, one.id))


def sampled_histories(
    memory: Memory, study: Study, people: NDArray[np.float64], *, since: int = 0
) -> list[History]:
    """At most `SAMPLE` of users, sorted by name; the same sample of the same users.

    Parameters
    ----------
    people : (n,) float64
        Numbers of users.
    since : int
        Decisions before this time are left out, in milliseconds.
    """
    people = np.sort(people)
    if len(people) > SAMPLE:
        people = np.sort(np.random.default_rng(0).choice(people, SAMPLE, replace=False))
    numbers = people.astype(np.int64).tolist()
    with memory.studies.reading(study.number) as rows:
        users, past, decisions = rows.numbered(numbers), rows.past_of(numbers), rows.decisions_of(numbers)
    found = [
        History(user, past.get(number, []), [one for one in decisions.get(number, []) if one.time >= since])
        for number, user in users.items()
    ]
    return sorted((one for one in found if one.decisions), key=lambda one: one.user.name)


def difference(first: NDArray[np.float64], second: NDArray[np.float64]) -> dict[str, Any] | None:
    """Difference of means of users with Welch's interval, if there are users and spread enough for one."""
    if not len(first) or not len(second):
        return None
    ci95 = welch_interval(first, second)  # pyright: ignore[reportArgumentType]
    value = float(np.mean(first) - np.mean(second))
    return {"value": value, "ci95": list(ci95) if ci95 else None, "n": [len(first), len(second)]}


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
