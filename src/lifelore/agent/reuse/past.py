"""The past of users in logs: which policies they got and how it went, before memory's own decisions for them.

A fit stores the past of its users, `warm` adds that of users who came later. The past is evidence as decisions
are: it comes before them. It is stored in records of some users each (buckets), found by the hash of the user's
name, so that a choice reads one small record however long the logs are. Names are not stored.

    reuse_past/STUDY          about: generation, token, number of buckets, files, users, rows
    reuse_past/STUDY/BUCKET   the compressed JSON of its users, eight bytes in a value
"""

import hashlib
import json
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from lifelore.core.errors import StoreError
from lifelore.core.protocols import Record
from lifelore.memory import Memory
from lifelore.memory.byte_words import bytes_of, words_of

KIND, VERSION = "reuse_past", 1
USERS_A_BUCKET, MOST_BUCKETS = 32, 1024
"""Users that share a record: more make a choice slower, fewer make a fit slower."""
ATTEMPTS = 100

Outcomes = list[tuple[str, float]]


class FedFile(NamedTuple):
    """A log whose lines are in the past, recognised by its content.

    path : where it was
    size, digest : bytes, and their SHA-256
    last_line : number of its last line with a choice
    by : "fit" or "warm"
    """

    path: str
    size: int
    digest: str
    last_line: int
    by: str


@dataclass
class PastUser:
    """The past of one user.

    type : as a log names it, or None
    context : the last one in a log, or None
    features : numbers known of the user beforehand, the last ones in a log, or None
    rows : by file number, policies and outcomes in their order
    """

    type: str | None = None
    context: str | None = None
    rows: dict[int, Outcomes] = field(default_factory=dict)
    features: dict[str, float] | None = None

    @property
    def outcomes(self) -> Outcomes:
        """All policies and outcomes, file by file."""
        return [row for number in sorted(self.rows) for row in self.rows[number]]


@dataclass
class Past:
    """The past of all users of a study.

    users : by the user's key
    files : by number
    generation : of the record in memory that it was read from; 0: there is none
    """

    users: dict[str, PastUser] = field(default_factory=dict)
    files: dict[int, FedFile] = field(default_factory=dict)
    generation: int = 0

    def without_files(self, numbers: set[int]) -> "Past":
        """The past without the rows of some files, and without users who have no others."""
        users = {}
        for key, user in self.users.items():
            rows = {number: own for number, own in user.rows.items() if number not in numbers}
            if rows:
                users[key] = PastUser(user.type, user.context, rows, user.features)
        files = {number: file for number, file in self.files.items() if number not in numbers}
        return Past(users, files, self.generation)

    def users_of(self, by: str) -> set[str]:
        """Keys of the users with lines of a fit, or of `warm`."""
        files = {number for number, file in self.files.items() if file.by == by}
        return {key for key, user in self.users.items() if files & set(user.rows)}

    @property
    def n_rows(self) -> int:
        """Number of outcomes."""
        return sum(len(own) for user in self.users.values() for own in user.rows.values())

    def keep(self, memory: Memory, study: str) -> bool:
        """Make it the newest in memory; False where another process was faster.

        Earlier generations are forgotten afterwards, so that nothing of a removed user stays.
        """
        generation = self.generation + 1
        records = self._records(study, generation)
        task = {"study": study, "users": len(self.users)}
        robot = _robot(study, generation)
        if not memory.contribute(robot, records, process="past", seq=0, task=task):
            return False
        for earlier in range(1, generation):
            if memory.tasks(_robot(study, earlier)):
                memory.forget(_robot(study, earlier))
        return True

    def _records(self, study: str, generation: int) -> list[Record]:
        n_buckets = 1
        while n_buckets < min(MOST_BUCKETS, len(self.users) / USERS_A_BUCKET):
            n_buckets *= 2
        buckets: list[dict[str, PastUser]] = [{} for _ in range(n_buckets)]
        for key in sorted(self.users):
            buckets[_bucket(key, n_buckets)][key] = self.users[key]
        packed = [_pack(bucket) for bucket in buckets]
        records = []
        for number, content in enumerate(packed):
            values = words_of(content)
            about = {"study": study, "bytes": len(content)}
            slots = np.arange(len(values))
            records.append(Record(KIND, f"{study}/{number:04d}", VERSION, "newest", slots, values, about))
        token = hashlib.sha256(b"".join(hashlib.sha256(content).digest() for content in packed)).hexdigest()[:32]
        about = {
            "study": study, "generation": generation, "buckets": n_buckets, "token": token,
            "files": {str(number): list(file) for number, file in self.files.items()},
            "users": len(self.users), "rows": self.n_rows,
        }  # fmt: skip
        empty = np.array([], np.int64)
        return [Record(KIND, study, VERSION, "newest", empty, empty, about), *records]


def read_index(memory: Memory, study: str) -> Mapping[str, Any]:
    """What the past of a study is described by; empty where there is none."""
    found = memory.recall_state(*index_name(study))
    return found.about if found else {}


def index_name(study: str) -> tuple[str, str, int]:
    """Kind, key and version of the record whose description `read_index` gives."""
    return KIND, study, VERSION


def read_past_user(memory: Memory, study: str, index: Mapping[str, Any], key: str) -> PastUser:
    """The past of one user; one without rows where there is none."""
    if not index:
        return PastUser()
    return _read_bucket(memory, study, _bucket(key, index["buckets"])).get(key, PastUser())


def read_past(memory: Memory, study: str) -> Past:
    """The past of all users of a study."""
    index = read_index(memory, study)
    if not index:
        return Past()
    files = {int(number): FedFile(*file) for number, file in index["files"].items()}
    users: dict[str, PastUser] = {}
    for number in range(index["buckets"]):
        users |= _read_bucket(memory, study, number)
    return Past(users, files, index["generation"])


def forget_past(memory: Memory, study: str, key: str) -> bool:
    """Remove the past of a user for good; whether there was any."""
    if not read_past_user(memory, study, read_index(memory, study), key).rows:
        return False
    for _ in range(ATTEMPTS):
        past = read_past(memory, study)
        past.users.pop(key, None)
        if past.keep(memory, study):
            return True
    raise too_busy(memory)


def too_busy(memory: Memory) -> StoreError:
    """The error where other processes always change the past first."""
    return StoreError(f"memory {memory.location}: too many processes change the past of one study; try again")


def _read_bucket(memory: Memory, study: str, number: int) -> dict[str, PastUser]:
    record = memory.recall(KIND, f"{study}/{number:04d}", VERSION)
    if record is None:
        raise StoreError(f"the past of study '{study}' is damaged; fit the study anew")
    # Cells beyond the content are an earlier, longer one's.
    return _unpack(bytes_of(record.values, record.about["bytes"]), study)


def _robot(study: str, generation: int) -> str:
    return f"reuse {study}: past {generation}"


def _bucket(key: str, n_buckets: int) -> int:
    return int(key[:8], 16) % n_buckets


def _pack(users: Mapping[str, PastUser]) -> bytes:
    policies: dict[str, int] = {}
    rows = {
        key: [
            user.type,
            user.context,
            [
                [
                    number,
                    [policies.setdefault(policy, len(policies)) for policy, _ in own],
                    [value for _, value in own],
                ]
                for number, own in sorted(user.rows.items())
            ],
            # Last, and only where there are any: pasts of an earlier Lifelore have none.
            *([user.features] if user.features else []),
        ]
        for key, user in users.items()
    }
    text = json.dumps({"users": rows, "policies": list(policies)}, separators=(",", ":"), allow_nan=False)
    return zlib.compress(text.encode(), 1)


def _unpack(content: bytes, study: str) -> dict[str, PastUser]:
    try:
        document = json.loads(zlib.decompress(content))
        names = document["policies"]
        return {
            key: PastUser(
                type_,
                context,
                {
                    number: [(names[place], value) for place, value in zip(places, values, strict=True)]
                    for number, places, values in parts
                },
                *features,
            )
            for key, (type_, context, parts, *features) in document["users"].items()
        }
    except (zlib.error, ValueError, KeyError, IndexError) as error:
        raise StoreError(f"the past of study '{study}' is damaged ({error}); fit the study anew") from None
