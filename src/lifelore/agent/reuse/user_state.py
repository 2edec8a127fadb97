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
from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.interaction.reuse.explanation import surprise_of

if TYPE_CHECKING:
    from lifelore.agent.reuse.history import Decision
    from lifelore.agent.reuse.study import Study

FORMAT = 1
_HEAD = struct.Struct("<II")


class Checkpoint(NamedTuple):
    """The belief before a decision.

    number : of the decision
    log_belief : (n_types,) float64, never changed in place
    surprise : of the outcomes before it, in nats
    """

    number: int
    log_belief: NDArray[np.float64]
    surprise: float


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
        log_belief, surprise = start.log_belief.copy(), start.surprise
        for decision in decisions:
            if decision.number == start.number or _lasts(decision.number, end):
                points.append(Checkpoint(decision.number, log_belief.copy(), surprise))
            surprise += learn(study, log_belief, decision.policy, decision.outcome)
        points.append(Checkpoint(end, log_belief, surprise))
        still_open = [decision.number for decision in decisions if decision.outcome is None]
        first_open = self.first_open if self.first_open < start.number else (still_open or [end])[0]
        return replace(self, first_open=first_open, checkpoints=_thinned(points, first_open))

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
        text = json.dumps(header | {"n": len(self.checkpoints)}).encode()
        numbers = np.array([point.number for point in self.checkpoints], "<i8")
        surprise = np.array([point.surprise for point in self.checkpoints], "<f8")
        beliefs = np.array([point.log_belief for point in self.checkpoints], "<f8")
        body = text + numbers.tobytes() + surprise.tobytes() + beliefs.tobytes()
        return _HEAD.pack(len(text), zlib.crc32(body)) + body


def from_bytes(content: bytes | None) -> UserState | None:
    """The state of `UserState.to_bytes`; None for anything else, also for another format."""
    if content is None or len(content) < _HEAD.size:
        return None
    length, checksum = _HEAD.unpack_from(content)
    body = content[_HEAD.size :]
    if zlib.crc32(body) != checksum:
        return None
    header = json.loads(body[:length])
    if header["format"] != FORMAT:
        return None
    n = header["n"]
    numbers = np.frombuffer(body, "<i8", n, length).tolist()
    surprise = np.frombuffer(body, "<f8", n, length + 8 * n).tolist()
    beliefs = np.frombuffer(body, "<f8", -1, length + 16 * n).reshape(n, -1).astype(np.float64)
    points = tuple(Checkpoint(*point) for point in zip(numbers, beliefs, surprise, strict=True))
    return UserState(
        header["basis"], header["origin"], header["context"], header["open"], points, header.get("features")
    )


def learn(study: "Study", log_belief: NDArray[np.float64], policy: str | None, outcome: float | None) -> float:
    """Update a log belief (n_types,) in place by an outcome of a policy; the surprise in nats.

    Without an outcome, or with a policy that the library does not know, there is no evidence. The user's type may
    change all the same.
    """
    if outcome is None or policy not in study.library.policies:
        study.algorithm.step_row(log_belief)
        return 0.0
    index = study.library.index_of_policy(policy)
    return surprise_of(study.algorithm.update_row(log_belief, index, outcome)[1])


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
