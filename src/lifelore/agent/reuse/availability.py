"""The policies that were available at a decision: words to names, and the record in memory.

    reuse_available/STUDY/USER    slots NUMBER · 2^16 + i: the policies that were available at decision NUMBER

A decision among all policies has no slots here. The record is a part of the user's contribution, so it is merged
and forgotten with the decision.
"""

from collections.abc import Sequence

import numpy as np

from lifelore.agent.reuse.study import ACTIVE, PILOT, Study, policy_number
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Record
from lifelore.memory import Memory

KIND, VERSION = "reuse_available", 1
WIDTH = 1 << 16
"""Slots of a decision."""


def listed_policies(study: Study, words: Sequence[str]) -> list[str]:
    """Names of policies from words such as ``a,b``; a word that is itself the name of a policy is not cut.

    Raises
    ------
    NotFoundError
        There is no such policy.
    InputError
        There is no word.
    """
    names = [name for word in words for name in ([word] if word in study.states else word.split(","))]
    return checked_available(study, [name.strip() if name not in study.states else name for name in names])


def checked_available(study: Study, available: Sequence[str]) -> list[str]:
    """The available policies that somebody can get, sorted; retired ones are left out.

    Raises
    ------
    NotFoundError
        There is no such policy.
    InputError
        No policy is left.
    """
    for policy in available:
        if policy not in study.states:
            raise NotFoundError(
                f"available must name policies of the study, got '{policy}'; there are "
                f"{', '.join(sorted(study.states))}"
            )
    usable = sorted({policy for policy in available if study.states[policy] in (ACTIVE, PILOT)})
    if not usable:
        raise InputError(
            f"available must name a policy in use, got {', '.join(available) or 'none'}; in use are "
            f"{', '.join([*study.active, *study.pilots])}"
        )
    return usable


def available_record(study: str, key: str, number: int, available: Sequence[str]) -> Record:
    """What a decision among `available` policies adds to memory beside the decision."""
    values = np.array([policy_number(policy) for policy in available], np.int64)
    slots = WIDTH * number + np.arange(len(values))
    return Record(KIND, f"{study}/{key}", VERSION, "newest", slots, values, {"study": study})


def read_available(memory: Memory, study: Study, key: str) -> dict[int, tuple[str, ...]]:
    """The policies that were available at each decision for a user, by the number of the decision."""
    record = memory.recall(KIND, f"{study.name}/{key}", VERSION)
    if record is None:
        return {}
    found: dict[int, list[str]] = {}
    names = study.policy_names
    for slot, value in zip(record.slots.tolist(), record.values.tolist(), strict=True):
        if value in names:
            found.setdefault(slot // WIDTH, []).append(names[value])
    return {number: tuple(policies) for number, policies in found.items()}
