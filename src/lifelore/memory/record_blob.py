"""Packs records into bytes: a length, a JSON header, then raw little-endian int64 arrays, without pickle."""

import json
import struct
import zlib
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, StoreError
from lifelore.core.protocols import Record
from lifelore.memory.record_rules import checked_records

_LENGTH = struct.Struct("<I")
_WORD = np.dtype("<i8")
_header = json.JSONEncoder(sort_keys=True, separators=(",", ":")).encode
# Level 1 compresses counts 8-fold; level 6 needs 5 times the time and saves another tenth.
_LEVEL = 1
_SMALL = 2**10
"""Bytes up to which a window of this size is used: to clear a large one takes longer than to compress."""
# Largest size of an unpacked blob, because a file may come from anyone; a task has about 100 kB.
LARGEST_PAYLOAD = 2**30


def pack(records: Sequence[Record]) -> bytes:
    """The uncompressed bytes of checked records; equal records give equal bytes."""
    header = [
        {
            "kind": record.kind,
            "key": record.key,
            "version": record.version,
            "merge": record.merge,
            "n": int(record.slots.size),
            "about": dict(record.about),
        }
        for record in records
    ]
    text = _header(header).encode()
    arrays = [column.astype(_WORD).tobytes() for record in records for column in (record.slots, record.values)]
    payload = b"".join([_LENGTH.pack(len(text)), text, *arrays])
    if len(payload) > LARGEST_PAYLOAD:
        raise InputError(
            f"records must take at most {LARGEST_PAYLOAD} bytes together, got {len(payload)};"
            " contribute them in parts"
        )
    return payload


def unpack(payload: bytes) -> list[Record]:
    """The records of `pack`; StoreError if the bytes have another format."""
    try:
        (length,) = _LENGTH.unpack_from(payload)
        header = json.loads(payload[_LENGTH.size : _LENGTH.size + length])
        words = np.frombuffer(payload, dtype=_WORD, offset=_LENGTH.size + length)
        return checked_records(_records(header, words))
    except (struct.error, ValueError, KeyError, TypeError, AttributeError) as error:
        raise StoreError(f"a contribution's records cannot be read ({error}); the memory is damaged") from error


def _records(header: list[dict[str, Any]], words: NDArray[np.int64]) -> list[Record]:
    if not isinstance(header, list):
        raise ValueError("the header is not a list")
    lengths = [entry["n"] for entry in header]
    if any(n < 0 for n in lengths) or 2 * sum(lengths) != words.size:
        raise ValueError(f"the header gives {2 * sum(lengths)} numbers, the block holds {words.size}")
    starts = 2 * np.cumsum([0, *lengths])[:-1]
    return [
        Record(
            entry["kind"], entry["key"], entry["version"], entry["merge"],
            slots=words[start : start + n], values=words[start + n : start + 2 * n], about=entry["about"],
        )
        for entry, start, n in zip(header, starts.tolist(), lengths, strict=True)
    ]  # fmt: skip


def compress(payload: bytes) -> bytes:
    """Compress the bytes."""
    if len(payload) > _SMALL:
        return zlib.compress(payload, _LEVEL)
    packer = zlib.compressobj(_LEVEL, zlib.DEFLATED, 10, 1)
    return packer.compress(payload) + packer.flush()


def decompress(blob: bytes) -> bytes:
    """The payload of `compress`; StoreError if the blob is damaged or unpacks to more than 1 GiB."""
    unpacker = zlib.decompressobj()
    try:
        payload = unpacker.decompress(blob, LARGEST_PAYLOAD)
    except zlib.error as error:
        raise StoreError(f"a contribution's blob cannot be unpacked ({error}); the memory is damaged") from error
    if not unpacker.eof:
        raise StoreError("a contribution's blob ends early or unpacks to more than 1 GiB; the memory is damaged")
    return payload
