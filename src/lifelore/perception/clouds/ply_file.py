"""PLY files: the vertices of an ascii or binary file, with colours and a label property where it has them.

trimesh reads the vertices behind a check of the header: its sizes are compared with the bytes that follow before
anything is decoded. Lines ``obj_info num_rows`` and ``num_cols`` make an organised cloud if the vertices are as
many as these pixels. Faces and other elements are skipped.
"""

from dataclasses import dataclass
from io import BytesIO

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_columns import (
    MAX_POINTS,
    cast_to_header_type,
    cloud_from_columns,
    readable_fields,
)
from lifelore.perception.clouds.point_cloud import PointCloud

_CODES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_FORMATS = ("ascii", "binary_little_endian", "binary_big_endian")
_MAX_HEADER_BYTES = 65_536


@dataclass
class _Element:
    """One `element` of the header; its properties are (name, type), type "list" for a list."""

    name: str
    n: int
    properties: list[tuple[str, str]]

    @property
    def n_bytes(self) -> int:
        """Bytes of all its rows in a binary file."""
        return self.n * sum(np.dtype(_CODES[kind]).itemsize for _, kind in self.properties)


def read_ply(content: bytes, labels: str = "auto") -> PointCloud:
    """The vertices in the bytes of a PLY file.

    Raises
    ------
    InputError
        The header breaks a rule of the format, or the data does not fit it.
    """
    encoding, elements, start, sides = _header(content)
    before, vertices = _up_to_vertices(elements)
    data = _data_of_vertices(encoding, before, vertices, content[start:])
    columns = _columns(encoding, vertices, data)
    grid = (sides.get("num_rows", 0), sides.get("num_cols", 0))
    return cloud_from_columns(columns, labels, grid if grid[0] * grid[1] == vertices.n else None)


def _header(content: bytes) -> tuple[str, list[_Element], int, dict[str, int]]:
    """Format, elements, bytes of the header, and the sides of a range image by name."""
    end = content.find(b"end_header", 0, _MAX_HEADER_BYTES)
    stop = content.find(b"\n", end, end + 20)
    if not content.startswith(b"ply") or end < 0 or stop < 0:
        raise InputError("PLY header has no end_header line; the file is cut off or no PLY file")
    encoding, elements, sides = None, [], {}
    for line in content[:end].decode("ascii", "replace").splitlines()[1:]:
        match line.split():
            case ["format", name, _] if name in _FORMATS:
                encoding = name
            case ["element", name, n]:
                elements.append(_Element(name, _whole(n), []))
            case ["property", "list", _, _, name] if elements:
                elements[-1].properties.append((name.lower(), "list"))
            case ["property", kind, name] if elements and kind in _CODES:
                elements[-1].properties.append((name.lower(), kind))
            case ["obj_info", ("num_rows" | "num_cols") as name, n]:
                sides[name] = _whole(n)
            case [] | ["comment", *_] | ["obj_info", *_]:
                pass
            case _:
                raise InputError(f"PLY header line is not understood: {line[:60]!r}")
    if encoding is None:
        raise InputError(f"PLY header names no format; it must be one of {', '.join(_FORMATS)}")
    return encoding, elements, stop + 1, sides


def _whole(word: str) -> int:
    if not (word.isascii() and word.isdigit() and len(word) < 13):
        raise InputError(f"PLY element count must be a whole number, got {word[:40]!r}")
    return int(word)


def _up_to_vertices(elements: list[_Element]) -> tuple[list[_Element], _Element]:
    place = next((i for i, element in enumerate(elements) if element.name == "vertex"), None)
    if place is None or elements[place].n == 0:
        raise InputError("holds no vertices")
    vertices = elements[place]
    if any(kind == "list" for element in elements[: place + 1] for _, kind in element.properties):
        raise InputError(
            "PLY lists inside or before the vertices are not read; write the vertices first and plain"
        )
    if vertices.n > MAX_POINTS:
        raise InputError(
            f"PLY header asks for {vertices.n} vertices where at most {MAX_POINTS} are read; thin the cloud"
        )
    names = [name for name, _ in vertices.properties]
    if len(set(names)) < len(names):
        raise InputError("PLY vertices name a property twice; write the file again")
    return elements[:place], vertices


def _data_of_vertices(encoding: str, before: list[_Element], vertices: _Element, data: bytes) -> bytes:
    """The rows of the vertices alone."""
    if encoding == "ascii":
        skipped = sum(element.n for element in before)
        lines = [line for line in data.split(b"\n") if line.strip()][skipped : skipped + vertices.n]
        rows, is_short = b"\n".join(lines), len(lines) < vertices.n
    else:
        skipped = sum(element.n_bytes for element in before)
        rows = data[skipped : skipped + vertices.n_bytes]
        is_short = len(rows) < vertices.n_bytes
    if is_short:
        raise InputError(f"PLY header promises {vertices.n} vertices, but {len(data)} bytes follow; it is cut off")
    return rows


def _columns(encoding: str, vertices: _Element, data: bytes) -> dict[str, NDArray]:
    """The readable properties, each (n,)."""
    from trimesh.exchange.ply import load_ply

    types = dict(vertices.properties)
    names, is_text = readable_fields(list(types)), encoding == "ascii"
    header = [f"ply\nformat {encoding} 1.0\nelement vertex {vertices.n}\n"]
    # Text is read as doubles: a whole number may be written as 2.0 or nan.
    header += [f"property {'double' if is_text else kind} {name}\n" for name, kind in types.items()]
    file = BytesIO("".join([*header, "end_header\n"]).encode() + data)
    rows = load_ply(file)["metadata"]["_ply_raw"]["vertex"]["data"]
    columns = {name: rows[name] for name in names}
    if not is_text:
        return columns
    return {
        name: cast_to_header_type(np.asarray(column, float).reshape(vertices.n), np.dtype(_CODES[types[name]]))
        for name, column in columns.items()
    }
