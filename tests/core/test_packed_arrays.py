"""Archives of arrays with a header: what goes in comes out, and what is none of ours is refused in one line."""

import io

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.core.packed_arrays import PackedFormat

OURS = PackedFormat("a list", 2, "list", "save_list", largest=10_000)


def test_what_goes_in_comes_out_and_equal_content_gives_equal_bytes():
    arrays = {"b": np.arange(3), "a": np.array([0.1, -np.inf])}
    content = OURS.pack({"name": "ä"}, arrays)
    header, read = OURS.unpack(content, "x")
    assert header == {"format": "a list", "version": 2, "name": "ä"}
    assert all(read[name].tobytes() == value.tobytes() for name, value in arrays.items())
    assert set(read) == set(arrays)
    assert content == OURS.pack({"name": "ä"}, dict(arrays))


def test_an_open_file_serves_as_well():
    file = io.BytesIO()
    OURS.write(file, {}, {"a": np.ones(2)}, compress=False)
    file.seek(0)
    assert OURS.unpack(file, "x")[1]["a"].tolist() == [1.0, 1.0]


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (b"", "x is no list that can be read"),
        (OURS.pack({}, {"a": np.ones(9)})[:-30], "is no list that can be read"),
        (
            PackedFormat("a tree", 2, "tree", "save_tree").pack({}, {}),
            r"another kind of file\); write it anew with",
        ),
        (
            PackedFormat("a list", 3, "list", "save_list").pack({}, {}),
            "has version 3, this Lifelore reads 2; update",
        ),
        (OURS.pack({}, {"a": np.zeros(5000)}), r"it unpacks to \d+ bytes, more than 10000"),
    ],
)
def test_what_is_none_of_ours_is_one_line(content, says):
    with pytest.raises(InputError, match=says) as told:
        OURS.unpack(content, "x")
    assert "\n" not in str(told.value)


def test_a_header_that_is_not_json_writes_nothing():
    file = io.BytesIO()
    with pytest.raises(InputError, match="must be JSON values"):
        OURS.write(file, {"name": {1, 2}}, {})
    assert file.getvalue() == b""
