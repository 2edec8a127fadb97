"""Requests of clients by their identifier: a request that comes again gets the decision that it got before.

    reuse_request/STUDY/USER    slots: a hash of the request's identifier; values: NUMBER · 2^30 + ATTEMPT

The record is a part of the decision's contribution, so that it is stored, merged and forgotten with the decision.
"""

import hashlib

import numpy as np

from lifelore.agent.reuse.log_columns import check_word
from lifelore.core.protocols import Record
from lifelore.memory import Memory

KIND, VERSION = "reuse_request", 1
WIDTH = 1 << 30


def request_record(study: str, key: str, request: str, number: int, attempt: int) -> Record:
    """What a decision for a request adds to memory beside the decision."""
    slots, values = np.array([_slot(request)], np.int64), np.array([number * WIDTH + attempt], np.int64)
    return Record(KIND, f"{study}/{key}", VERSION, "newest", slots, values, {"study": study})


def requested(memory: Memory, study: str, key: str, request: str) -> tuple[int, int] | None:
    """Number and attempt of the decision that a request got; None for a new request.

    Raises
    ------
    InputError
        The identifier is no printable text.
    """
    check_word("request", request)
    slot = _slot(request)
    record = memory.recall(KIND, f"{study}/{key}", VERSION, slots=(slot, slot))
    if record is None or not record.slots.size:
        return None
    number, attempt = divmod(int(record.values[0]), WIDTH)
    return number, attempt


def _slot(request: str) -> int:
    return int.from_bytes(hashlib.sha256(request.encode()).digest()[:8], "big") >> 2
