"""The journal of a panel: batches of decisions and of outcomes as records of memory.

    reuse_panel/STUDY/RUN.SEQ    about: kind (decisions or outcomes), order, length, bytes, …

A record holds the compressed columns of its batch, eight bytes in a value: memory takes a microsecond for a value.
Each run of a program has a name of its own, so that journals of several memories merge. A run numbers its users in
the order of their first decision. Names of users are not stored, only 64 bits of a hash of each.
"""

import secrets
import time
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory import Memory
from lifelore.memory.byte_words import bytes_of, words_of

KIND, VERSION = "reuse_panel", 1
COLUMNS: dict[str, tuple[tuple[str, str], ...]] = {
    "decisions": (("number", "<i4"), ("probability", "<f4"), ("policy", "<u2"), ("control", "u1")),
    "outcomes": (("outcome", "<f8"), ("place", "<u4")),
}
"""Name and type of the columns of a batch. A user's number is stored as the difference to the one before."""
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
        self._run, self._seq, self._order = secrets.token_hex(8), 0, 0
        self._keys: dict[str, NDArray[np.uint64]] = {}
        self._numbers = np.empty(0, np.int64)
        self._n_numbered = 0

    def append_decisions(
        self, keys: NDArray[np.uint64], rows: NDArray[np.int64], columns: Columns, **about: Any
    ) -> str:
        """Store a batch of decisions for the users of these keys, which the caller has in `rows`; its name."""
        if (more := int(rows.max(initial=-1)) + 1 - len(self._numbers)) > 0:
            self._numbers = np.concatenate([self._numbers, np.full(more + len(self._numbers), -1)])
        unknown = np.flatnonzero(self._numbers[rows] < 0)
        _, first = np.unique(rows[unknown], return_index=True)
        new = unknown[np.sort(first)]
        self._numbers[rows[new]] = self._n_numbered + np.arange(len(new))
        self._n_numbered += len(new)
        numbers = np.diff(self._numbers[rows], prepend=0)
        head = keys[new].astype("<u8").tobytes()
        return self._append("decisions", head, columns | {"number": numbers}, new=len(new), **about)

    def append_outcomes(self, columns: Columns, **about: Any) -> str:
        """Store outcomes; the name of the entry."""
        return self._append("outcomes", b"", columns, **about)

    def _append(self, kind: str, head: bytes, columns: Columns, **about: Any) -> str:
        name = f"{self._run}.{self._seq}"
        n = len(next(iter(columns.values())))
        parts = [columns[column].astype(dtype).tobytes() for column, dtype in COLUMNS[kind]]
        packed = zlib.compress(head + b"".join(parts), 1)
        values = words_of(packed)
        self._order = max(time.time_ns(), self._order + 1)
        described = {
            "study": self._study, "kind": kind, "order": self._order, "length": n, "bytes": len(packed), **about
        }  # fmt: skip
        record = Record(
            KIND, f"{self._study}/{name}", VERSION, "newest", np.arange(len(values)), values, described
        )
        task = {"study": self._study, "panel": kind, "length": n}
        robot = f"reuse {self._study}: panel"
        self._memory.contribute(robot, [record], process=self._run, seq=self._seq, task=task)
        self._seq += 1
        return name

    def entries(self) -> list[Entry]:
        """All stored batches in the order in which they were stored.

        Raises
        ------
        StoreError
            An entry is damaged.
        """
        start = f"{self._study}/"
        named = [
            (about["order"], key, about) for key, _, about in self._memory.keys(KIND) if key.startswith(start)
        ]
        return [self._entry(key, about) for _, key, about in sorted(named, key=lambda one: one[:2])]

    def _entry(self, key: str, about: dict[str, Any]) -> Entry:
        record = self._memory.recall(KIND, key, VERSION)
        name = key.removeprefix(f"{self._study}/")
        try:
            content = zlib.decompress(bytes_of(record.values, about["bytes"]))  # pyright: ignore
            n, at, columns = about["length"], 8 * about.get("new", 0), {}
            for column, dtype in COLUMNS[about["kind"]]:
                columns[column] = np.frombuffer(content, dtype, n, at)
                at += n * np.dtype(dtype).itemsize
            if about["kind"] == "decisions":
                run = name.partition(".")[0]
                new = np.frombuffer(content, "<u8", about["new"]).astype(np.uint64)
                self._keys[run] = np.concatenate([self._keys.get(run, np.empty(0, np.uint64)), new])
                columns["user"] = self._keys[run][np.cumsum(columns["number"])]
        except (zlib.error, ValueError, LookupError, AttributeError) as error:
            raise StoreError(
                f"the panel of study '{self._study}' is damaged ({error}); restore an export"
            ) from None
        return Entry(name, about["kind"], about, columns)
