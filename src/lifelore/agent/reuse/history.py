"""Decisions for one user and their outcomes, as memory stores them.

Each decision and each outcome is a contribution of its own: a history only grows. `user_belief` has the belief
that follows from it.
"""

import hashlib
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from lifelore.agent.reuse.availability import available_record, read_available
from lifelore.agent.reuse.study import Study, policy_number
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.memory import Memory

KIND, VERSION = "reuse_user", 1
LAST_SLOT = 2**62
FIELDS = 8
"""Slots a decision: those of `_POLICY` and after."""
_POLICY, _PROBABILITY, _CONTROL, _CHOSEN, _ATTEMPT, _OUTCOME, _ENDED, _AVAILABLE = range(8)


@dataclass(frozen=True)
class Decision:
    """One choice for one user.

    number : from 0
    policy : str, or None where no fit or log has named it
    probability : of the policy, at that moment
    control : whether the user was held out then
    chosen, ended : seconds since 1970; `ended` is None while the outcome is not known
    attempt : tells it from a forgotten decision of the same number
    outcome : float, or None while not known
    available : names of the policies that were available; None where all were
    """

    number: int
    policy: str | None
    probability: float
    control: bool
    chosen: int
    attempt: int
    outcome: float | None = None
    ended: int | None = None
    available: tuple[str, ...] | None = None


@dataclass(frozen=True)
class History:
    """All decisions for one user, the first one first."""

    study: str
    key: str
    user: str
    context: str | None
    decisions: tuple[Decision, ...]
    features: dict[str, float] | None = None

    @property
    def robot(self) -> str:
        """Under which name memory keeps it; not the user's, for that name outlives forgetting."""
        return robot_of(self.study, self.key)

    def identifier(self, decision: Decision) -> str:
        """What the outcome is given by later: ``KEY-NUMBER``, or ``KEY-NUMBER.ATTEMPT``."""
        return f"{self.key}-{decision.number}" + (f".{decision.attempt}" if decision.attempt else "")

    def records_of(self, decision: Decision) -> list[Record]:
        """What a choice adds."""
        fields = {
            _POLICY: policy_number(decision.policy or ""), _PROBABILITY: _bits(decision.probability),
            _CONTROL: int(decision.control), _CHOSEN: decision.chosen, _ATTEMPT: decision.attempt,
        }  # fmt: skip
        if decision.available is None:
            return [self._record(decision.number, fields)]
        fields[_AVAILABLE] = len(decision.available)
        among = available_record(self.study, self.key, decision.number, decision.available)
        return [self._record(decision.number, fields), among]

    def outcome_record(self, decision: Decision, outcome: float, ended: int) -> Record:
        """What an outcome adds."""
        return self._record(decision.number, {_OUTCOME: _bits(outcome), _ENDED: ended})

    def _record(self, number: int, fields: dict[int, int]) -> Record:
        slots = np.array([FIELDS * number + field for field in fields], np.int64)
        values = np.array(list(fields.values()), np.int64)
        about: dict[str, Any] = {"study": self.study, "user": self.user, "context": self.context}
        if self.features:
            about["features"] = self.features
        return Record(KIND, f"{self.study}/{self.key}", VERSION, "newest", slots, values, about)


def robot_of(study: str, key: str) -> str:
    """The contributor's name of a user."""
    return f"reuse {study}: {key}"


def user_key(study: str, user: str) -> str:
    """16 hexadecimal digits that stand for a user of a study."""
    return hashlib.sha256(f"{study}\x1f{user}".encode()).hexdigest()[:16]


def parse_identifier(identifier: str) -> tuple[str, int, int]:
    """Key, number and attempt of a decision's identifier; InputError where it is none."""
    found = re.fullmatch(r"([0-9a-f]{16})-(\d{1,9})(?:\.(\d{1,9}))?", identifier)
    if not found:
        raise InputError(f"decision must be what `reuse choose` printed (KEY-NUMBER), got {identifier[:60]!r}")
    return found[1], int(found[2]), int(found[3] or 0)


def open_history(memory: Memory, study: Study, key: str, user: str = "") -> History:
    """What memory holds of a user, empty where it knows nothing; `user` is believed only then."""
    record = memory.recall(KIND, f"{study.name}/{key}", VERSION)
    if record is None or not record.slots.size:
        return History(study.name, key, user, None, ())
    about = record.about
    decisions = _decisions(memory, study, key, record)
    return History(study.name, key, about["user"], about.get("context"), decisions, about.get("features"))


def read_decisions(memory: Memory, study: Study, key: str, first: int = 0) -> tuple[Decision, ...]:
    """The decisions for a user from number `first` on; the time depends on their number alone."""
    record = memory.recall(KIND, f"{study.name}/{key}", VERSION, slots=slots_from(first))
    return decisions_in(memory, study, key, record)


def slots_from(number: int) -> tuple[int, int]:
    """First and last slot of the decisions from a number on."""
    return FIELDS * number, LAST_SLOT


def decisions_in(memory: Memory, study: Study, key: str, record: Record | None) -> tuple[Decision, ...]:
    """The decisions in a user's record, or in a part of it."""
    return () if record is None else _decisions(memory, study, key, record)


def _decisions(memory: Memory, study: Study, key: str, record: Record) -> tuple[Decision, ...]:
    cells = dict(zip(record.slots.tolist(), record.values.tolist(), strict=True))
    numbers = sorted({slot // FIELDS for slot in cells})
    restricted = any(slot % FIELDS == _AVAILABLE for slot in cells)
    available = read_available(memory, study, key) if restricted else {}
    names = study.policy_names
    return tuple(
        _decision(number, cells, names, available.get(number))
        for number in numbers
        if FIELDS * number + _POLICY in cells
    )


def histories(memory: Memory, study: Study) -> list[History]:
    """All users of a study that had a decision, sorted by name."""
    start = f"{study.name}/"
    keys = [key.removeprefix(start) for key, version, _ in memory.keys(KIND) if key.startswith(start)]
    return sorted((open_history(memory, study, key) for key in keys), key=lambda one: one.user)


def _decision(
    number: int, cells: dict[int, int], names: dict[int, str], available: tuple[str, ...] | None
) -> Decision:
    stored = {field: cells.get(FIELDS * number + field) for field in range(7)}
    outcome = stored[_OUTCOME]
    return Decision(
        number,
        names.get(stored[_POLICY] or 0),
        _number(stored[_PROBABILITY] or 0),
        bool(stored[_CONTROL]),
        stored[_CHOSEN] or 0,
        stored[_ATTEMPT] or 0,
        None if outcome is None else _number(outcome),
        stored[_ENDED],
        available,
    )


def _bits(number: float) -> int:
    return int(np.float64(number).view(np.int64))


def _number(bits: int) -> float:
    return float(np.int64(bits).view(np.float64))
