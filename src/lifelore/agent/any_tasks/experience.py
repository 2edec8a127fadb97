"""What a long-lived agent has learnt in anyone's tasks, and its form as records of memory.

Counts add up and the newest value of a policy's cell wins, so that robots can merge memories in any order. Types
that nothing tells apart are joined when experience is read, never in memory.
"""

from collections import ChainMap, Counter
from collections.abc import Hashable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import KIND as PRIOR_KIND
from lifelore.action.priors.action_prior import VERSION as PRIOR_VERSION
from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.any_tasks.moves import ONE, Counts, counts_of, counts_record
from lifelore.agent.any_tasks.policies import StoredPolicy, stored, table_records, update_table
from lifelore.agent.external_world.context_labels import KIND as LABELS
from lifelore.agent.external_world.context_labels import VERSION as LABELS_VERSION
from lifelore.agent.external_world.context_labels import ContextLabels, labels_record
from lifelore.core.errors import InputError
from lifelore.core.protocols import Record
from lifelore.memory import Memory, open_memory

COUNTS, POLICIES, VERSION = "task_counts", "task_policies", 1
HOPELESS = 0.1
"""Share of the range of mean returns above the least one up to which a policy counts as worthless."""
STALE = 0.5
"""Share of a policy's earlier returns that no longer counts once a task has taught the policy more."""
DOUBT, MOST_LEVEL = 1.0, 0.5
"""False alarms after which the observed rate counts as much as the calibrated one, and the largest level."""
DATE_BITS = 32
"""Bits of a task's context beside its date in a slot."""
SIZE_SLOTS = 1 << 40
"""Slots of the sums of each size of returns, see `_sums_record`."""


@dataclass(eq=False)
class TypeExperience:
    """What a type has shown.

    Parameters
    ----------
    moves : Counts
        Of causes and outcomes.
    sightings : Counts
        Belief in the type at the end of tasks, by date and context.
    returns : dict of str to (3,) float64
        Number, sum and sum of squares of the returns of each policy, by name, in tasks of this type; those from
        before a policy was learnt further count less, see `STALE`.
    rounds : dict of str to int
        How often each policy was learnt further.
    policy : QTable, StoredPolicy or callable, optional
        Learnt in tasks of this type, under its name.
    """

    moves: Counts = field(default_factory=Counter)
    sightings: Counts = field(default_factory=Counter)
    returns: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    policy: Any = None
    rounds: dict[str, int] = field(default_factory=dict)

    def add_returns(self, policy: str, record: Record) -> None:
        """Add returns of a policy, by the round in which it earned them; exact in any order."""
        size, slot = np.divmod(record.slots, SIZE_SLOTS)
        of_record, column = np.divmod(slot, 3)
        known = self.rounds.get(policy, 0)
        self.rounds[policy] = newest = max(known, int(of_record.max(initial=0)))
        sums = self.returns.setdefault(policy, np.zeros(3))
        sums *= (1 - STALE) ** (newest - known)
        np.add.at(sums, column, record.values / ONE * 2.0 ** (20 * size) * (1 - STALE) ** (newest - of_record))


class TaskNews(NamedTuple):
    """What a task has taught.

    belief : how much each type, by name, learns from the task
    returns : of each policy, by name, that ran
    prior : counts of useful actions; its labels are the features behind their contexts
    label : the task's context as it was given
    learner, policy : the type whose policy was learnt, by name, and the policy; None where none was
    alarm : whether the alarm was raised although a known type fits; None where none fits
    """

    date: int
    context: int
    belief: Mapping[str, float]
    moves: Counts
    returns: Mapping[str, list[float]]
    prior: ActionPrior
    label: Hashable = None
    learner: str | None = None
    policy: Any = None
    alarm: bool | None = None


class Experience:
    """Types by name, the action prior, and how many tasks showed each cause.

    Parameters
    ----------
    key : str
        Meaning of states, actions and contexts.
    n_actions : int
    alpha0 : float
        As of `ActionPrior`.
    """

    def __init__(self, key: str, n_actions: int, alpha0: float = 0.1) -> None:
        self.key, self.n_actions = key, n_actions
        self.types: dict[str, TypeExperience] = {}
        self.prior = ActionPrior(n_actions, alpha0, f"{key}/prior")
        self.prior.labels = self._features = ChainMap[int, Any]({})
        self.causes: Counts = Counter()  # tasks that showed each cause, with outcome 0
        self.labels: dict[int, Any] = {}  # contexts of tasks as they were given, by code
        self.n_tasks = 0
        self.alarms = np.zeros(2)  # number of tasks of known types, and of those with an alarm

    # ---- reading -----------------------------------------------------------------------------------

    @property
    def policies(self) -> tuple[str, ...]:
        """Names of the types that have a policy, sorted."""
        return tuple(name for name in sorted(self.types) if self.types[name].policy is not None)

    def is_hopeless(self, name: str) -> bool:
        """Whether the policy of a type earns about the least that this life has seen: nothing can be lost."""
        means = {
            (type_, policy): sums[1] / sums[0]
            for type_, one in self.types.items()
            for policy, sums in one.returns.items()
            if sums[0] > 0
        }
        low, high = min(means.values(), default=0.0), max(means.values(), default=0.0)
        return means.get((name, name), low) <= low + HOPELESS * (high - low)

    def alarm_level(self, stated: float) -> float:
        """The level at which alarms in tasks of known types are as frequent as stated, by how often they were.

        The ratio of the true rate to the calibrated one has a Gamma law, at first of mean 1 and weight `DOUBT`.
        """
        known, raised = self.alarms
        return min(stated * (DOUBT + stated * known) / (DOUBT + raised), MOST_LEVEL)

    # ---- learning ----------------------------------------------------------------------------------

    def learn(self, news: TaskNews) -> list[Record]:
        """Learn from a task; return the records by which memory adds it."""
        records = [record for record in self._records(news) if len(record.slots)]
        self.add(records)
        if news.learner is not None:
            # Policies that cannot be stored are kept as long as the agent lives.
            self.types[news.learner].policy = news.policy
        return records

    def _records(self, news: TaskNews) -> Iterable[Record]:
        for name, belief in news.belief.items():
            yield counts_record(COUNTS, f"{self.key}/moves/{name}", news.moves, belief)
            seen = Counter({(news.date, news.context): belief})
            yield counts_record(COUNTS, f"{self.key}/sightings/{name}", seen, bits=DATE_BITS)
            for policy, values in news.returns.items():
                sums = belief * np.array([len(values), np.sum(values), np.square(values).sum()])
                known = self.types.get(name)
                round_ = 0 if known is None else known.rounds.get(policy, 0) + (policy == news.learner)
                yield _sums_record(f"{self.key}/returns/{name}/{policy}", round_, sums)
        if news.learner is not None:
            yield from self._policy_records(news.learner, news.policy)
        if news.alarm is not None:
            seen = np.array([1, news.alarm], np.int64)
            yield Record(COUNTS, f"{self.key}/alarms", VERSION, "add", np.arange(2), seen)
        yield counts_record(COUNTS, f"{self.key}/causes", Counter({(cause, 0) for cause, _ in news.moves}))
        # Tasks of agents that keep no types do not count: they have shown no causes.
        one, about = np.array([bool(news.belief)], np.int64), {"n_actions": self.n_actions}
        yield Record(COUNTS, f"{self.key}/tasks", VERSION, "add", np.zeros(1, np.int64), one, about)
        yield news.prior.to_record({"prior": "tasks", "means": self.key})
        codes = news.prior.contexts
        new = set(codes[self.prior.counts(codes).sum(axis=1) == 0].tolist())
        features = {code: one for code, one in news.prior.labels.items() if code in new}
        contexts = {} if news.context in self.labels else {news.context: news.label}
        yield labels_record(f"{self.key}/features", features)
        yield labels_record(f"{self.key}/contexts", contexts)

    def _policy_records(self, name: str, policy: Any) -> Iterable[Record]:
        if isinstance(policy, dict):
            before = self.types[name].policy if name in self.types else None
            known = before if isinstance(before, dict) else {}
            yield from table_records(policy, POLICIES, f"{self.key}/table/{name}", known)
        elif hasattr(policy, "to_bytes"):
            yield stored(policy.to_bytes(), POLICIES, f"{self.key}/bytes/{name}")

    def add(self, records: Iterable[Record]) -> None:
        """Add records of this key; others are left out."""
        for record in records:
            part, _, rest = record.key.removeprefix(f"{self.key}/").partition("/")
            if record.kind == PRIOR_KIND and record.key == self.prior.key:
                self.prior.merge(ActionPrior.from_record(record, self.n_actions, self.prior.alpha0))
            elif record.kind == LABELS and record.key == f"{self.key}/features":
                self._features.maps[0].update(ContextLabels(lambda record=record: record))
            elif record.kind == LABELS and record.key == f"{self.key}/contexts":
                self.labels |= ContextLabels(lambda record=record: record)
            elif record.kind in (COUNTS, POLICIES) and record.key.startswith(f"{self.key}/"):
                self._add(part, rest, record)

    def _add(self, part: str, rest: str, record: Record) -> None:
        name, _, policy = rest.partition("/")
        values = record.values.tolist()
        match part:
            case "tasks":
                self.n_tasks += values[0]
            case "alarms":
                self.alarms += record.values
            case "causes":
                self.causes.update(counts_of(record))
            case "moves":
                self._type(name).moves.update(counts_of(record))
            case "sightings":
                self._type(name).sightings.update(counts_of(record, DATE_BITS))
            case "returns":
                self._type(name).add_returns(policy, record)
            case "table":
                if not isinstance(self._type(name).policy, dict):
                    self._type(name).policy = {}
                update_table(self._type(name).policy, record, self.n_actions)
            case "bytes":
                self._type(name).policy = StoredPolicy.from_record(record)

    def _type(self, name: str) -> TypeExperience:
        return self.types.setdefault(name, TypeExperience())

    @staticmethod
    def keys(memory: Memory) -> list[str]:
        """The keys of the lives in a memory."""
        return sorted(name.removesuffix("/tasks") for name, _, _ in memory.keys(COUNTS) if name.endswith("/tasks"))

    def check_actions(self, n_actions: int) -> None:
        """InputError if an environment has another number of actions."""
        if self.n_actions != n_actions:
            raise InputError(f"env must have the {self.n_actions} actions of the tasks before, got {n_actions}")

    @classmethod
    def recalled(
        cls, key: str, memory: Memory, alpha0: float = 0.1, *, labels: str | Path | None = None
    ) -> "Experience | None":
        """What a memory holds under this key; None where it holds nothing.

        `labels` is where the memory is: the features behind contexts, which take most of the time, are read there
        when somebody asks for them. Without, contexts have their codes alone.
        """
        about = {
            (kind, name, version): about
            for kind in (COUNTS, POLICIES)
            for name, version, about in memory.keys(kind)
            if name.startswith(f"{key}/") and version == VERSION
        }
        tasks = about.get((COUNTS, f"{key}/tasks", VERSION))
        if tasks is None:
            return None
        made = cls(key, int(tasks["n_actions"]), alpha0)
        keys = [*about, (LABELS, f"{key}/contexts", LABELS_VERSION), (PRIOR_KIND, made.prior.key, PRIOR_VERSION)]
        found = (memory.recall(*name) for name in keys)
        made.add([record for record in found if record is not None])

        def features() -> Record | None:
            with open_memory(labels, read_only=True) as again:
                return again.recall(LABELS, f"{key}/features", LABELS_VERSION)

        if labels is not None:
            later: Any = ContextLabels(features)
            made._features.maps.append(later)
        return made


def _sums_record(key: str, round_: int, sums: NDArray[np.float64]) -> Record:
    """Sums (3,) of returns in fixed point, in units by their size, so that squares keep their digits.

    A sum of size k counts units of 2^(20 k) millionths. Sums from 0.001 to a million have size 0.
    """
    millionths = np.abs(sums) * ONE
    above = np.ceil((np.log2(np.maximum(millionths, 1)) - 40) / 20)
    size = np.where(millionths < 1000, -1, np.maximum(above, 0)).astype(np.int64)
    values = np.rint(sums * ONE / 2.0 ** (20 * size)).astype(np.int64)
    return Record(COUNTS, key, VERSION, "add", SIZE_SLOTS * size + 3 * round_ + np.arange(3), values)
