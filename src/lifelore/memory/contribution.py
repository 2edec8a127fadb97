"""`Contribution`: the records of one robot about one task; memory stores, merges and forgets contributions."""

import hashlib
import json
from collections.abc import Mapping
from typing import NamedTuple, Self

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory.record_blob import compress, decompress, pack, unpack

Identity = tuple[str, str, int]
Order = tuple[int, str, str, int]
LoreKey = tuple[str, str, int]
"""(kind, key, version) of a record."""


class Contribution(NamedTuple):
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

    @classmethod
    def packed(cls, identity: Identity, stamp: int, task: str, payload: bytes) -> Self:
        """The contribution of packed records; its digest follows from all of them."""
        return cls(*identity, stamp, task, compress(payload), _digest(identity, stamp, task, payload))

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
        return self.packed(self.identity, self.stamp, self.task, pack(left))

    def records(self) -> list[Record]:
        """The records; StoreError if the contribution has changed since it was stored."""
        payload = decompress(self.blob)
        if _digest(self.identity, self.stamp, self.task, payload) != self.digest:
            raise StoreError(f"contribution {self.identity} does not match its SHA-256; the memory is damaged")
        return unpack(payload)


def _digest(identity: Identity, stamp: int, task: str, payload: bytes) -> str:
    return hashlib.sha256(json.dumps([*identity, stamp, task]).encode() + b"\n" + payload).hexdigest()
