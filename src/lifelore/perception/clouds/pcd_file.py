"""PCD files: ascii, binary and binary_compressed, read by pypcd4 behind a check of the header.

pypcd4 trusts the header. Here its sizes are compared with the bytes that follow before anything is decoded, so a
file of a kilobyte cannot claim a gigabyte.
"""

import re
import struct
from collections.abc import Sequence
from io import BytesIO
from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
    from pypcd4.pypcd4 import MetaData

_TYPES = {("F", 4), ("F", 8), *((kind, size) for kind in "IU" for size in (1, 2, 4, 8))}
_MAX_HEADER_BYTES = 16_384
_MAX_RECORD_BYTES = 65_536
_MAX_LZF_RATIO = 100  # the format's best is 264 bytes from 3


def read_pcd(content: bytes, labels: str = "auto") -> PointCloud:
    """The cloud in the bytes of a PCD file.

    Raises
    ------
    InputError
        The header breaks a rule of the format, or the data does not fit it.
    """
    lines, start = _header_lines(content)
    header, camera = _checked_header(lines), _camera(lines)
    _check_length(header, memoryview(content)[start:])
    columns = _columns(header, content[start:])
    return cloud_from_columns(columns, labels, (header.height, header.width), camera)


def _header_lines(content: bytes) -> tuple[dict[str, list[str]], int]:
    """The words of each line of the header by the line's first word, and the bytes of the header."""
    lines: dict[str, list[str]] = {}
    start = 0
    while "DATA" not in lines:
        end = content.find(b"\n", start, _MAX_HEADER_BYTES)
        if end < 0:
            raise InputError("PCD header has no DATA line; the file is cut off or no PCD file")
        words = content[start:end].decode("ascii", "replace").split()
        if words and not words[0].startswith("#"):
            lines[words[0].upper()] = words[1:]
        start = end + 1
    return lines, start


def _checked_header(lines: dict[str, list[str]]) -> "MetaData":
    """The header, whose fields that no cloud needs are named ``_``, as padding is."""
    names, types = lines.get("FIELDS", lines.get("COLUMNS", [])), lines.get("TYPE", [])
    if not names or len(types) != len(names):
        raise InputError(f"PCD header has {len(names)} FIELDS and {len(types)} TYPE; they must be as many")
    sizes, counts = _whole(lines, "SIZE", len(names)), _whole(lines, "COUNT", len(names), "1" * len(names))
    readable = set(readable_fields(names))
    fields = [name if name in readable else "_" for name in names]
    for name, kind, size, count in zip(fields, types, sizes, counts, strict=True):
        if (kind, size) not in _TYPES or not 1 <= count <= (_MAX_RECORD_BYTES if name == "_" else 1):
            raise InputError(f"PCD field {name} has type {kind[:8]} {size} × {count}, which is not read")
    (width,), (height,) = _whole(lines, "WIDTH", 1), _whole(lines, "HEIGHT", 1, "1")
    (points,) = _whole(lines, "POINTS", 1, [str(width * height)])
    record_bytes = sum(size * count for size, count in zip(sizes, counts, strict=True))
    if points != width * height:
        raise InputError(f"PCD header says {points} POINTS, but WIDTH {width} × HEIGHT {height}")
    if points == 0:
        raise InputError("holds no points")
    if points > MAX_POINTS or record_bytes > _MAX_RECORD_BYTES:
        raise InputError(
            f"PCD header asks for {points} points of {record_bytes} bytes where at most "
            f"{MAX_POINTS} points of {_MAX_RECORD_BYTES} bytes are read; crop or thin the cloud"
        )
    encoding = " ".join(lines["DATA"])
    if encoding not in ("ascii", "binary", "binary_compressed"):
        raise InputError(f"PCD DATA must be ascii, binary or binary_compressed, got {encoding[:40]!r}")
    from pypcd4.pypcd4 import MetaData

    sides = {"points": points, "width": width, "height": height}
    return MetaData.model_validate(
        {"fields": fields, "type": types, "size": sizes, "count": counts, "data": encoding, **sides}
    )


def _whole(lines: dict[str, list[str]], key: str, n: int, default: Sequence[str] = ()) -> list[int]:
    words = lines.get(key, default)
    if len(words) != n or not all(word.isascii() and word.isdigit() and len(word) < 13 for word in words):
        raise InputError(f"PCD {key} must be {n} whole numbers, got {' '.join(words)[:60]!r}")
    return [int(word) for word in words]


def _camera(lines: dict[str, list[str]]) -> NDArray[np.float64]:
    words = lines.get("VIEWPOINT", ["0", "0", "0"])[:3]
    try:
        camera = np.array(words, float)
    except ValueError:
        camera = np.full(3, np.nan)
    if len(camera) != 3 or not np.isfinite(camera).all():
        raise InputError(f"PCD VIEWPOINT must begin with three finite numbers, got {' '.join(words)[:60]!r}")
    return camera


def _check_length(header: "MetaData", data: memoryview) -> None:
    """Refuse binary data that is shorter than the header promises, and packed data that would outgrow it."""
    need = header.points * sum(size * count for size, count in zip(header.size, header.count, strict=True))
    if header.data.value == "binary" and len(data) < need:
        raise InputError(f"PCD header promises {need} bytes of points, but {len(data)} follow; it is cut off")
    if header.data.value == "binary_compressed":
        packed, size = struct.unpack("<II", data[:8]) if len(data) >= 8 else (0, 0)
        if size != need or packed > len(data) - 8 or size > _MAX_LZF_RATIO * packed:
            raise InputError(
                f"compressed PCD data says {packed} bytes hold {size}; {len(data)} bytes follow, and the header "
                f"promises {need} bytes of points; it is cut off or damaged"
            )


def _columns(header: "MetaData", data: bytes) -> dict[str, NDArray]:
    """The readable fields, each (n,)."""
    from pypcd4.pypcd4 import PointCloud as PcdCloud

    is_text, plain = header.data.value == "ascii", header
    if is_text:
        # pypcd4 takes single spaces only, and no 2.0 or nan for a whole number: all columns are read as doubles.
        data = re.sub(rb" \n ?|\n ", b"\n", re.sub(rb"[ \t\r]{2,}|[\t\r]", b" ", data)).strip()
        n = len(header.fields)
        plain = header.derive(type=("F",) * n, size=(8,) * n)
    file = BytesIO(plain.compose_header().encode() + data)
    records = np.atleast_1d(PcdCloud.from_fileobj(file).pc_data)[: header.points]  # type: ignore[arg-type]
    if len(records) != header.points:
        raise InputError(
            f"PCD header promises {header.points} points, but {len(records)} lines follow; it is cut off"
        )
    columns = {}
    for name, kind, size in zip(header.fields, header.type, header.size, strict=True):
        if name != "_":
            dtype = np.dtype(f"<{kind.lower()}{size}")
            columns[name] = cast_to_header_type(records[name], dtype) if is_text else records[name]
    return columns
