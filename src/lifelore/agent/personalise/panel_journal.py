"""The journal of a panel: batches of decisions and of outcomes as records of memory.

    reuse_panel/STUDY/RUN.SEQ    about: kind (decisions or outcomes), order, length, request, policies

A record holds the columns of its batch one after the other, eight bytes in a value. Each run of a program has a
name of its own, so that journals of several memories merge. Names of users are not stored, only hashes of them.
"""

import secrets
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.protocols import Record
from lifelore.memory import Memory

KIND, VERSION = "reuse_panel", 1
COLUMNS: dict[str, tuple[tuple[str, str], ...]] = {
    "decisions": (("user", "<u8"), ("probability", "<f4"), ("policy", "<u2"), ("control", "u1")),
    "outcomes": (("outcome", "<f8"), ("place", "<u4")),
}
"""Name and type of the columns of a batch."""
Columns = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Entry:
    """A stored batch.

    name : of the entry, ``RUN.SEQ``
    kind : "decisions" or "outcomes"
    about : its description
    columns : (n,) each
    """

    name: str
    kind: str
    about: dict[str, Any]
    columns: Columns


class PanelJournal:
    """Writes the batches of a panel and reads all of them.

    Parameters
    ----------
    memory : Memory
    study : str
        Name of the study whose users the panel holds.
    """

    def __init__(self, memory: Memory, study: str) -> None:
        self._memory, self._study = memory, study
        self._run, self._seq = secrets.token_hex(8), 0

    def append(self, kind: str, columns: Columns, **about: Any) -> str:
        """Store a batch; the name of its entry."""
        name = f"{self._run}.{self._seq}"
        n = len(next(iter(columns.values())))
        packed = b"".join(columns[column].astype(dtype).tobytes() for column, dtype in COLUMNS[kind])
        values = np.frombuffer(packed + bytes(-len(packed) % 8), "<i8").astype(np.int64)
        described = {"study": self._study, "kind": kind, "order": time.time_ns(), "length": n, **about}
        record = Record(
            KIND, f"{self._study}/{name}", VERSION, "newest", np.arange(len(values)), values, described
        )
        task = {"study": self._study, "panel": kind, "length": n}
        self._memory.contribute(
            f"reuse {self._study}: panel", [record], process=self._run, seq=self._seq, task=task
        )
        self._seq += 1
        return name

    def entries(self) -> list[Entry]:
        """All stored batches in the order in which they were stored."""
        start = f"{self._study}/"
        named = [
            (about["order"], key, about) for key, _, about in self._memory.keys(KIND) if key.startswith(start)
        ]
        return [self._entry(key, about) for _, key, about in sorted(named, key=lambda one: one[:2])]

    def _entry(self, key: str, about: dict[str, Any]) -> Entry:
        record = self._memory.recall(KIND, key, VERSION)
        assert record is not None
        content, n, at = record.values.astype("<i8").tobytes(), about["length"], 0
        columns = {}
        for column, dtype in COLUMNS[about["kind"]]:
            columns[column] = np.frombuffer(content, dtype, n, at)
            at += n * np.dtype(dtype).itemsize
        return Entry(key.removeprefix(f"{self._study}/"), about["kind"], about, columns)
