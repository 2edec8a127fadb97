"""Columns of tables: the same lists, libraries and errors from pandas, polars, Arrow and plain Python."""

import sys

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.frame_columns import FrameColumns, is_frame

COLUMNS = {
    "type": ["x", "x", "y", "y", "x", "y"],
    "policy": ["a", "b", "a", "b", "a", "b"],
    "outcome": [1.0, 2.5, 3.0, -4.0, 0.1, 5.0],
    "weight": [1, 2, 1, 1, 3, 1],
}


def pandas_frame(columns):
    return pytest.importorskip("pandas").DataFrame(columns)


def pandas_arrow_frame(columns):
    pytest.importorskip("pyarrow")
    return pandas_frame(columns).convert_dtypes(dtype_backend="pyarrow")


def pandas_categories(columns):
    return pandas_frame(columns).astype({"type": "category", "policy": "category"})


def polars_frame(columns):
    return pytest.importorskip("polars").DataFrame(columns)


def arrow_table(columns):
    return pytest.importorskip("pyarrow").table(columns)


def arrow_dictionary(columns):
    table = arrow_table(columns)
    return table.set_column(0, "type", table["type"].dictionary_encode())


def arrow_batch(columns):
    return arrow_table(columns).to_batches()[0]


def arrow_stream(columns):
    return arrow_table(columns).to_reader()


def arrow_capsule(columns):
    """Nothing but the PyCapsule method, as a database's result may be."""

    class Result:
        def __arrow_c_stream__(self, requested_schema=None):
            return table.__arrow_c_stream__(requested_schema)

    table = arrow_table(columns)
    return Result()


def arrays(columns):
    return {name: np.array(column) for name, column in columns.items()}


MAKERS = [
    dict, arrays, pandas_frame, pandas_arrow_frame, pandas_categories, polars_frame, arrow_table,
    arrow_dictionary, arrow_batch, arrow_stream, arrow_capsule,
]  # fmt: skip
every_maker = pytest.mark.parametrize("make", MAKERS, ids=lambda make: make.__name__)


@every_maker
def test_libraries_are_the_same_bit_for_bit(make):
    expected = PolicyLibrary.from_frame(COLUMNS, weight="weight")
    assert PolicyLibrary.from_frame(make(COLUMNS), weight="weight").to_bytes() == expected.to_bytes()


@pytest.mark.parametrize("make", [dict, pandas_frame, pandas_arrow_frame, polars_frame, arrow_table, arrow_stream])
def test_missing_values_are_none_and_refused_by_their_row(make):
    columns = {"type": ["x", None, "y"], "policy": ["a", "a", "a"], "outcome": [1.0, 2.0, 3.0]}
    assert FrameColumns(make(columns)).column("type") == ["x", None, "y"]
    with pytest.raises(InputError, match="column 'type' must have a name in every row, row 1 has none"):
        PolicyLibrary.from_frame(make(columns))
    columns = {"type": ["x", "x", "y"], "policy": ["a", "a", "a"], "outcome": [1.0, 2.0, None]}
    with pytest.raises(InputError, match="column 'outcome' must be finite, row 2 is nan"):
        PolicyLibrary.from_frame(make(columns))


@pytest.mark.parametrize("source", [3, "log.csv", None, [COLUMNS], np.zeros((3, 3))])
def test_what_is_no_table_is_refused(source):
    assert not is_frame(source)
    with pytest.raises(InputError, match="frame must be a mapping of columns"):
        FrameColumns(source)


def test_a_column_that_comes_twice_is_refused():
    frame = pandas_frame({"policy": ["a"], "outcome": [1.0], "other": [2.0]})
    frame.columns = ["policy", "outcome", "outcome"]
    with pytest.raises(InputError, match="frame must have one column 'outcome', it has 2"):
        FrameColumns(frame).column("outcome")


def test_a_lazy_frame_is_to_be_collected():
    lazy = polars_frame(COLUMNS).lazy()
    assert is_frame(lazy)
    with pytest.raises(InputError, match=r"got LazyFrame; call its collect\(\) first"):
        FrameColumns(lazy)


def test_a_stream_without_a_reader_says_what_to_install(monkeypatch):
    class Stream:
        def __arrow_c_stream__(self, requested_schema=None):
            raise AssertionError("nobody can read it")

    for name in ("pyarrow", "polars"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(NotFoundError, match="install pyarrow or polars"):
        FrameColumns(Stream())
