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

    def without(self, forgotten: Mapping[LoreKey, int]) -> "Contribution":
        """The contribution without the records whose key was forgotten at its stamp or later."""
        records = self.records()
        left = [one for one in records if forgotten.get((one.kind, one.key, one.version), -1) < self.stamp]
        if len(left) == len(records):
            return self
        stripped = replace(self, blob=compress(payload := pack(left)))
        return replace(stripped, digest=_digest(self.identity, self.stamp, self.task, payload))

    def records(self) -> list[Record]:
        """The records; StoreError if the contribution has changed since it was stored."""
        payload = decompress(self.blob)
        if _digest(self.identity, self.stamp, self.task, payload) != self.digest:
            raise StoreError(f"contribution {self.identity} does not match its SHA-256; the memory is damaged")
        return unpack(payload)


@dataclass(frozen=True)
class Offer:
    """Checked records of one robot about one task, before they get a stamp.

    Parameters
    ----------
    identity : (robot, process, seq)
    task : str
        JSON text.
    records : list of Record
    payload : bytes
        The packed records, not compressed.
    """

    identity: Identity
    task: str
    records: list[Record]
    payload: bytes

    def stamped(self, stamp: int) -> Contribution:
        """The contribution with this stamp."""
        digest = _digest(self.identity, stamp, self.task, self.payload)
        return Contribution(*self.identity, stamp, self.task, compress(self.payload), digest)


def new_offer(robot: str, records: Sequence[Record], *, process: str, seq: int, task: Mapping[str, Any]) -> Offer:
    """Check names and records; InputError where they break a rule."""
    identity = check_name("robot", robot), check_name("process", process), check_whole("seq", seq)
    described, checked = canonical_json("task", task), checked_records(records)
    return Offer(identity, described, checked, pack(checked))


def _digest(identity: Identity, stamp: int, task: str, payload: bytes) -> str:
    return hashlib.sha256(json.dumps([*identity, stamp, task]).encode() + b"\n" + payload).hexdigest()
