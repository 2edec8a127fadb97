"""`Contribution`: the records of one robot about one task; memory stores, merges and forgets contributions."""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory.record_blob import compress, decompress, pack, unpack
from lifelore.memory.record_rules import canonical_json, check_name, check_whole, checked_records

Identity = tuple[str, str, int]
Order = tuple[int, str, str, int]
LoreKey = tuple[str, str, int]
"""(kind, key, version) of a record."""


@dataclass(frozen=True)
class Contribution:
    """The packed records of one robot about one task.

    Parameters
    ----------
    robot, process, seq : str, str, int
        The identity: each memory stores it at most once.
    stamp : int
        Hybrid logical clock in nanoseconds; set once, and copied by merges.
    task : str
        JSON text that describes the task for readers.
    blob : bytes
        The compressed records.
    digest : str
        SHA-256 of all fields above, with the records before compression.
    """

    robot: str
    process: str
    seq: int
    stamp: int
    task: str
    blob: bytes
    digest: str

    @property
    def identity(self) -> Identity:
        """(robot, process, seq)."""
        return self.robot, self.process, self.seq

    @property
    def order(self) -> Order:
        """The key of a total order; the larger of two contributions is the newer."""
        return self.stamp, self.robot, self.process, self.seq

    def stamped(self, stamp: int) -> "Contribution":
        """The same contribution with another stamp."""
        moved = replace(self, stamp=stamp)
        return replace(moved, digest=_digest(moved, decompress(self.blob)))

    def without(self, forgotten: Mapping[LoreKey, int]) -> "Contribution":
        """The contribution without the records whose key was forgotten at its stamp or later."""
        records = self.records()
        left = [one for one in records if forgotten.get((one.kind, one.key, one.version), -1) < self.stamp]
        if len(left) == len(records):
            return self
        stripped = replace(self, blob=compress(payload := pack(left)))
        return replace(stripped, digest=_digest(stripped, payload))

    def records(self) -> list[Record]:
        """The records; StoreError if the contribution has changed since it was stored."""
        payload = decompress(self.blob)
        if _digest(self, payload) != self.digest:
            raise StoreError(f"contribution {self.identity} does not match its SHA-256; the memory is damaged")
        return unpack(payload)


def new_contribution(
    robot: str, records: Sequence[Record], *, process: str, seq: int, task: Mapping[str, Any]
) -> Contribution:
    """A checked contribution without a stamp (stamp 0)."""
    unsigned = Contribution(
        robot=check_name("robot", robot),
        process=check_name("process", process),
        seq=check_whole("seq", seq),
        stamp=0,
        task=canonical_json("task", task),
        blob=compress(payload := pack(checked_records(records))),
        digest="",
    )
    return replace(unsigned, digest=_digest(unsigned, payload))


def _digest(contribution: Contribution, payload: bytes) -> str:
    head = [*contribution.identity, contribution.stamp, contribution.task]
    return hashlib.sha256(json.dumps(head).encode() + b"\n" + payload).hexdigest()
