"""Columns of tables from pandas, polars, Arrow or plain Python as lists, without a dependency on any of them.

A table is a mapping of columns, or has column names and gives a column by its name (pandas, polars, pyarrow). Any
other object with the Arrow PyCapsule method ``__arrow_c_stream__`` (a database's result, a reader of batches) is
read by pyarrow or polars, whichever is installed.
"""

from collections.abc import Mapping
from typing import Any

from lifelore.core.errors import InputError, NotFoundError


class FrameColumns:
    """The columns of a table by name, as lists.

    Parameters
    ----------
    frame : mapping of str to sequences, DataFrame, or Arrow table

    Raises
    ------
    InputError
        `frame` is no table.
    NotFoundError
        `frame` is an Arrow stream, and no library that reads it is installed.
    """

    def __init__(self, frame: Any) -> None:
        names = _names(frame)
        if names is None and hasattr(frame, "__arrow_c_stream__"):
            frame = _from_arrow(frame)
            names = _names(frame)
        if names is None:
            hint = "; call its collect() first" if hasattr(frame, "collect") else ""
            raise InputError(
                "frame must be a mapping of columns, a DataFrame of pandas or polars, or an Arrow table, got "
                f"{type(frame).__name__}{hint}"
            )
        self.names: list[str] = names
        self._frame = frame

    def column(self, name: str) -> list[Any]:
        """The values of a column, None where one is missing; InputError where there is none or several."""
        if name not in self.names:
            raise InputError(f"frame has no column {name!r}; its columns are {self.names[:20]}")
        if (count := self.names.count(name)) > 1:
            raise InputError(f"frame must have one column {name!r}, it has {count}")
        column = self._frame[name]
        method = next((name for name in ("to_pylist", "to_list", "tolist") if hasattr(column, name)), None)
        values = column if method is None else getattr(column, method)()
        return [None if _is_missing(value) else value for value in values]


def is_frame(source: Any) -> bool:
    """Whether `source` is a table that `FrameColumns` reads, or a table not collected yet."""
    return _names(source) is not None or hasattr(source, "__arrow_c_stream__") or hasattr(source, "collect")


def _is_missing(value: Any) -> bool:
    """Whether a value is None, NaN, or one of the missing values of pandas."""
    if isinstance(value, float):
        return value != value
    return value is None or type(value).__name__ in ("NAType", "NaTType")


def _names(frame: Any) -> list[str] | None:
    """Names of the columns; None where a column is not to be had by its name."""
    if isinstance(frame, Mapping):
        return [str(name) for name in frame]
    if hasattr(frame, "collect") or not hasattr(frame, "__getitem__"):
        return None
    for attribute in ("column_names", "columns"):
        names = getattr(frame, attribute, None)
        # pyarrow's `columns` are the columns themselves.
        if names is not None and not callable(names) and all(isinstance(name, str) for name in names):
            return list(names)
    return None


def _from_arrow(stream: Any) -> Any:
    """The table of an Arrow stream, read by pyarrow or polars."""
    try:
        import pyarrow  # pyright: ignore[reportMissingImports]

        return pyarrow.RecordBatchReader.from_stream(stream).read_all()
    except ImportError:
        pass
    try:
        import polars  # pyright: ignore[reportMissingImports]

        return polars.DataFrame(stream)
    except ImportError:
        raise NotFoundError(
            f"frame is an Arrow stream ({type(stream).__name__}); install pyarrow or polars to read it"
        ) from None
