"""A contribution: what one robot learnt from one task, the unit that memory stores, merges and forgets."""

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


@dataclass(frozen=True)
class Contribution:
    """One robot's lore from one task, packed.

    Parameters
    ----------
    robot, process, seq : str, str, int
        The identity: it is stored at most once in any memory.
    stamp : int
        Hybrid logical clock, nanoseconds; set once and carried along by merges.
    task : str
        JSON text about the task, for people.
    blob : bytes
        The compressed records.
    digest : str
        SHA-256 over everything above (over the records before compression).
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
        """What decides which of two contributions is the newer one: a total order."""
        return self.stamp, self.robot, self.process, self.seq

    def stamped(self, stamp: int) -> "Contribution":
        """The same contribution, made at `stamp`."""
        moved = replace(self, stamp=stamp)
        return replace(moved, digest=_digest(moved, decompress(self.blob)))

    def records(self) -> list[Record]:
        """The records; StoreError when a byte of the contribution is not what was stored."""
        payload = decompress(self.blob)
        if _digest(self, payload) != self.digest:
            raise StoreError(f"contribution {self.identity} does not match its SHA-256; the memory is damaged")
        return unpack(payload)


def new_contribution(
    robot: str, records: Sequence[Record], *, process: str, seq: int, task: Mapping[str, Any]
) -> Contribution:
    """A contribution not yet stamped (stamp 0), its rules checked."""
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
