"""Users of a study with all that happened to them, or a random sample of so many that a report takes seconds."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.study import Study
from lifelore.core.intervals import welch_interval
from lifelore.memory import Memory
from lifelore.memory.study_rows import DecisionRow, UserRow

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
