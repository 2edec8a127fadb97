import struct
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from lifelore.core import Record, StoreError
from lifelore.memory import record_blob
from lifelore.memory.record_blob import compress, decompress, pack, unpack

names = st.text(st.characters(categories=("L", "N", "S")), min_size=1, max_size=8)
columns = st.integers(0, 20).flatmap(
    lambda n: st.tuples(arrays(np.int64, n, unique=True).map(np.sort), arrays(np.int64, n))
)


@st.composite
def records(draw):
    slots, values = draw(columns)
    return Record(draw(names), draw(names), draw(st.integers(0, 2**40)),
                  draw(st.sampled_from(["add", "newest", "union"])), slots, values,
                  draw(st.dictionaries(names, st.integers() | names | st.none(), max_size=3)))  # fmt: skip


@pytest.mark.slow
@given(st.lists(records(), max_size=4, unique_by=lambda r: (r.kind, r.key, r.version)))
def test_what_is_packed_comes_back(given_records):
    found = unpack(decompress(compress(pack(given_records))))
    assert len(found) == len(given_records)
    for one, other in zip(found, given_records, strict=True):
        assert (one.kind, one.key, one.version, one.merge) == (other.kind, other.key, other.version, other.merge)
        assert one.about == other.about
        assert np.array_equal(one.slots, other.slots)
        assert np.array_equal(one.values, other.values)


def test_the_bytes_by_hand():
    payload = pack([Record("k", "y", 1, "add", np.array([3]), np.array([-1]), {})])
    text = b'[{"about":{},"key":"y","kind":"k","merge":"add","n":1,"version":1}]'
    assert payload == struct.pack("<I", len(text)) + text + struct.pack("<qq", 3, -1)


def header(text: bytes, rest: bytes = b"") -> bytes:
    return struct.pack("<I", len(text)) + text + rest


@pytest.mark.parametrize(
    "payload",
    [
        b"", b"\0", header(b"{"), header(b"{}"), header(b"[1]"), header(b'[{"n":1}]', bytes(16)),
        header(b'[{"about":{},"key":"y","kind":"k","merge":"add","n":1,"version":1}]', bytes(8)),
        header(b'[{"about":{},"key":"y","kind":"k","merge":"add","n":-1,"version":1}]'),
        header(b'[{"about":{},"key":"y","kind":"k","merge":"pickle","n":0,"version":1}]'),
        header(b"[]", bytes(7)), struct.pack("<I", 2**31) + b"[]", header(b"\xff\xfe"),
    ],
)  # fmt: skip
def test_what_was_not_packed_is_refused(payload):
    with pytest.raises(StoreError, match="damaged"):
        unpack(payload)


@pytest.mark.parametrize("blob", [b"", b"no zlib", zlib.compress(bytes(100))[:-5]])
def test_a_damaged_blob_is_refused(blob):
    with pytest.raises(StoreError, match="damaged"):
        decompress(blob)


def test_a_blob_that_unpacks_to_too_much_is_refused(monkeypatch):
    monkeypatch.setattr(record_blob, "LARGEST_PAYLOAD", 1000)
    assert len(decompress(zlib.compress(bytes(1000)))) == 1000
    with pytest.raises(StoreError, match="more than 1 GiB"):
        decompress(zlib.compress(bytes(1001)))
