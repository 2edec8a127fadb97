"""The belief about a user as stored state, with checkpoints that let a late outcome be taken in without a replay.

A checkpoint is the belief before a decision. The last checkpoint, the head, is the belief before the next
decision. An outcome that comes late changes only the checkpoints after its decision: they are computed again
from the checkpoint before it. Checkpoints are the denser the newer they are, so the cost of an outcome grows
with its delay, and not with the number of decisions. Decisions before the first open one need no checkpoints,
because their outcomes are final.

All operations are those of a replay from the first decision on, in the same order, so the belief has the same
bits.
"""

import json
import struct
import zlib
from collections import deque
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.reuse.explanation import MAX_EVIDENCE, Evidence
from lifelore.interaction.reuse.user_library import UserLibrary

if TYPE_CHECKING:
    from lifelore.agent.reuse.history import Decision
    from lifelore.agent.reuse.study import Study
    from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector

FORMAT = 2
KEPT = 4096
"""States that stay in main memory, some 2 kB each."""
_HEAD = struct.Struct("<II")


class Checkpoint(NamedTuple):
    """The belief before a decision.

    number : of the decision
    log_belief : (n_types,) float64, never changed in place
    surprise : of the outcomes before it, in nats
    task : what the user has shown (`ReuseAlgorithm.state`); empty where models are exact
    """

    number: int
    log_belief: NDArray[np.float64]
    surprise: float
    task: Mapping[str, NDArray[Any]] = MappingProxyType({})

    @property
    def belief(self) -> NDArray[np.float64]:
        """β, (n_types,)."""
        return np.exp(self.log_belief)


@dataclass(frozen=True, eq=False)
class UserState:
    """Checkpoints of a user's belief, and the evidence and settings that they hold for.

    Parameters
    ----------
    basis : str
        Hash of the library, the dynamics, the prior and the user's past, see `user_belief`.
    origin : dict
        Plain data that tell without a look at the past whether `basis` still holds.
    context : str, optional
        Whose prior counts.
    features : dict of str to float, optional
        Numbers known of the user beforehand.
    first_open : int
        Number of the first decision without an outcome; that of the head where there is none.
    checkpoints : tuple of Checkpoint
        Ascending; the last is the head.
    """

    basis: str
    origin: dict[str, Any]
    context: str | None
    first_open: int
    checkpoints: tuple[Checkpoint, ...]
    features: dict[str, float] | None = None

    @property
    def head(self) -> Checkpoint:
        """The belief before the next decision."""
        return self.checkpoints[-1]

    def before(self, number: int) -> Checkpoint | None:
        """The last checkpoint at or before a decision; None before the first open decision."""
        return next((point for point in reversed(self.checkpoints) if point.number <= number), None)

    def after(self, study: "Study", decisions: "Iterable[Decision]", start: Checkpoint) -> "UserState":
        """The state after all decisions from `start` on.

        Parameters
        ----------
        decisions : iterable of Decision
            Every decision from `start` on, ascending.
        start : Checkpoint
            One of the checkpoints; later ones are computed again.
        """
        decisions = list(decisions)
        end = decisions[-1].number + 1 if decisions else start.number
        points = [point for point in self.checkpoints if point.number < start.number]
        belief = WorkingBelief(study, start)
        for decision in decisions:
            if decision.number == start.number or _lasts(decision.number, end):
                points.append(belief.checkpoint(decision.number))
            belief.learn(decision.policy, decision.outcome)
        points.append(belief.checkpoint(end))
        still_open = [decision.number for decision in decisions if decision.outcome is None]
        first_open = self.first_open if self.first_open < start.number else (still_open or [end])[0]
        return replace(self, first_open=first_open, checkpoints=_thinned(points, first_open))

    def _task_arrays(self) -> list[tuple[tuple[int, str], NDArray[Any]]]:
        points = enumerate(self.checkpoints)
        return [((place, name), array) for place, point in points for name, array in point.task.items()]

    def to_bytes(self) -> bytes:
        """The state as bytes; `from_bytes` restores every bit."""
        header = {
            "format": FORMAT,
            "basis": self.basis,
            "origin": self.origin,
            "context": self.context,
            "open": self.first_open,
        }
        if self.features:
            header["features"] = self.features
        tasks = [[number, name, array.dtype.str, array.shape] for (number, name), array in self._task_arrays()]
        sizes = {"n": len(self.checkpoints), "types": len(self.head.log_belief), "tasks": tasks}
        text = json.dumps(header | sizes).encode()
        numbers = np.array([point.number for point in self.checkpoints], "<i8")
        surprise = np.array([point.surprise for point in self.checkpoints], "<f8")
        beliefs = np.array([point.log_belief for point in self.checkpoints], "<f8")
        body = text + numbers.tobytes() + surprise.tobytes() + beliefs.tobytes()
        body += b"".join(array.astype(array.dtype.newbyteorder("<")).tobytes() for _, array in self._task_arrays())
        return _HEAD.pack(len(text), zlib.crc32(body)) + body


def _tasks_from(body: bytes, offset: int, listed: list[Any], n: int) -> list[dict[str, NDArray[Any]]]:
    """The task's arrays of each of n checkpoints."""
    found: list[dict[str, NDArray[Any]]] = [{} for _ in range(n)]
    for place, name, kind, shape in listed:
        dtype, size = np.dtype(kind), int(np.prod(shape, dtype=np.int64))
        found[place][name] = (
            np.frombuffer(body, dtype, size, offset).reshape(shape).astype(dtype.newbyteorder("="), copy=False)
        )
        offset += size * dtype.itemsize
    return found


@lru_cache(maxsize=KEPT)
def from_bytes(content: bytes | None) -> UserState | None:
    """The state of `UserState.to_bytes`; None for anything else, also for another format.

    An outcome mostly follows its decision soon, so the last states stay; their arrays are read only.
    """
    if content is None or len(content) < _HEAD.size:
        return None
    length, checksum = _HEAD.unpack_from(content)
    body = content[_HEAD.size :]
    if zlib.crc32(body) != checksum:
        return None
    header = json.loads(body[:length].decode())
    if header["format"] != FORMAT:
        return None
    n = header["n"]
    numbers = np.frombuffer(body, "<i8", n, length).tolist()
    surprise = np.frombuffer(body, "<f8", n, length + 8 * n).tolist()
    n_types, offset = header["types"], length + 16 * n
    beliefs = np.frombuffer(body, "<f8", n * n_types, offset).reshape(n, n_types).astype(np.float64, copy=False)
    tasks = _tasks_from(body, offset + 8 * n * n_types, header["tasks"], n)
    points = tuple(Checkpoint(*point) for point in zip(numbers, beliefs, surprise, tasks, strict=True))
    return UserState(
        header["basis"], header["origin"], header["context"], header["open"], points, header.get("features")
    )


class WorkingBelief:
    """A belief that takes in decisions one after the other: a row of Algorithm 7.

    Parameters
    ----------
    study : Study
    start : Checkpoint
        The belief before the first of them.

    Attributes
    ----------
    evidence : deque of Evidence
        Of the last outcomes that were learnt.
    novelty : NoveltyDetector or None
        Takes in the same outcomes.
    """

    def __init__(self, study: "Study", start: Checkpoint) -> None:
        self._study, self._surprise = study, start.surprise
        self.evidence: deque[Evidence] = deque(maxlen=MAX_EVIDENCE)
        self.novelty: NoveltyDetector | None = None
        self._row = study.algorithm.new_rows()
        self._row.log_belief[0] = start.log_belief
        if start.task:
            self._row.restore(0, start.log_belief, start.task)

    @classmethod
    def of_stranger(cls, study: "Study", prior: NDArray[np.float64], novelty: bool = False) -> "WorkingBelief":
        """The belief before the first outcome, from a prior (n_types,).

        Parameters
        ----------
        novelty : bool
            Whether to follow the probability that no type fits; InputError where no broad law is known.
        """
        belief = cls(study, Checkpoint(0, study.algorithm.start(prior), 0.0))
        if novelty:
            from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector

            models: Any = study.models
            belief.novelty = NoveltyDetector(study.library, prior=prior, dynamics=study.dynamics, models=models)
        return belief

    def learn(self, policy: str | None, outcome: float | None) -> None:
        """Learn from an outcome of a policy.

        Without an outcome, or with a policy that the library does not know, there is no evidence. The user's type
        may change all the same.
        """
        if outcome is not None and policy in self._study.library.policies:
            index = self._study.library.index_of_policy(policy)
            found = self._row.observe(0, index, outcome)
            self.evidence.append(Evidence(index, found.log_likelihood, float(found.log_evidence)))
            self._surprise += self.evidence[-1].surprise
            if self.novelty is not None:
                self.novelty.observe(index, outcome)
        self._row.end_episode(0)
        if self.novelty is not None:
            self.novelty.end_episode()

    @property
    def belief(self) -> NDArray[np.float64]:
        """The belief over types as it is now, (n_types,)."""
        return self._row.belief(0)

    @property
    def known(self) -> UserLibrary:
        """The library as rules read it now, given the user's outcomes."""
        return self._row.known(0)

    @property
    def expected(self) -> NDArray[np.float64]:
        """Expected outcome of each policy of the library, (n_policies,)."""
        return self.known.performance.expected(self.belief)

    def propensities(self, available: NDArray[np.bool_]) -> NDArray[np.float64]:
        """Probability that the study's rule selects each policy among the available ones, (n_policies,)."""
        return self._row.propensities(0, self._study.selection, available)

    def checkpoint(self, number: int) -> Checkpoint:
        """The belief as it is now, before the decision of that number."""
        return Checkpoint(number, self._row.log_belief[0].copy(), self._surprise, self._row.state(0))


def _lasts(number: int, end: int) -> bool:
    """Whether a checkpoint stays: at a distance d before the end, multiples of the power of 2 below d / 2 do."""
    spacing = 1 << max(0, ((end - number) // 2).bit_length() - 1)
    return number % spacing == 0


def _thinned(points: list[Checkpoint], first_open: int) -> tuple[Checkpoint, ...]:
    end = points[-1].number
    first = max(point.number for point in points if point.number <= first_open)
    return tuple(
        point
        for point in points
        if point.number >= first and (point.number in (first, end) or _lasts(point.number, end))
    )
