"""Readers of labels of scenes: `relations.csv` and `planes.csv`.

`relations.csv` has the columns scene, a, b, relation, confidence: ids as merged from the cloud's labels, 1 the
table; confidence 3 certain, 2 probable, 1 doubtful. `planes.csv` has scene, nx, ny, nz, d: the table's plane in
the camera frame, ``n · p + d`` the height above it in metres.
"""

import csv
from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.relations import PairLabel

RELATION_COLUMNS = ("scene", "a", "b", "relation", "confidence")
PLANE_COLUMNS = ("scene", "nx", "ny", "nz", "d")
LONGEST_NAME = 80


def read_relations(path: str | Path) -> dict[str, tuple[PairLabel, ...]]:
    """The labels of each scene, scenes and labels in the file's order.

    Raises
    ------
    InputError
        The file cannot be read, a column is missing, or a row breaks a rule; the line is named.
    """
    truths: dict[str, list[PairLabel]] = {}
    for line, row in _rows(path, RELATION_COLUMNS):
        label = PairLabel(
            _whole(path, line, row, "a", 1),
            _whole(path, line, row, "b", 1),
            _name(path, line, row, "relation"),
            _whole(path, line, row, "confidence", 1, 3),
        )
        if label.a == label.b:
            raise _wrong(path, line, f"a and b must differ, got {label.a} twice")
        truths.setdefault(_name(path, line, row, "scene"), []).append(label)
    if not truths:
        raise InputError(f"{path} must label at least one scene, got no rows below the header; add rows")
    return {scene: tuple(labels) for scene, labels in truths.items()}


def read_planes(path: str | Path) -> dict[str, NDArray[np.float64]]:
    """The table's plane of each scene: unit normal and offset, ``(4,)``.

    Raises
    ------
    InputError
        As `read_relations`; or a normal of length 0.
    """
    planes: dict[str, NDArray[np.float64]] = {}
    for line, row in _rows(path, PLANE_COLUMNS):
        try:
            plane = np.array([float(row[name]) for name in PLANE_COLUMNS[1:]])
        except ValueError:
            raise _wrong(path, line, "nx, ny, nz and d must be numbers") from None
        length = float(np.linalg.norm(plane[:3]))
        if not np.isfinite(plane).all() or not length > 0:
            raise _wrong(path, line, "nx, ny, nz and d must be finite and the normal longer than 0")
        planes[_name(path, line, row, "scene")] = plane / length
    return planes


def _rows(path: str | Path, columns: tuple[str, ...]) -> Iterator[tuple[int, Mapping[str, str]]]:
    try:
        with Path(path).open(newline="", encoding="utf-8-sig") as file:
            reader = csv.DictReader(file)
            missing = [name for name in columns if name not in (reader.fieldnames or ())]
            if missing:
                raise InputError(
                    f"{path} must have the columns {', '.join(columns)}; {', '.join(missing)} missing"
                )
            for row in reader:
                if any(row[name] is None for name in columns):
                    raise _wrong(path, reader.line_num, f"{len(columns)} fields are needed, some are missing")
                yield reader.line_num, row
    except OSError as error:
        raise InputError(f"{path} cannot be read: {error.strerror}") from None
    except (csv.Error, UnicodeDecodeError) as error:
        raise InputError(f"{path} is no CSV in UTF-8: {error}") from None


def _whole(
    path: str | Path, line: int, row: Mapping[str, str], name: str, least: int, most: int | None = None
) -> int:
    text = row[name].strip()
    number = int(text) if text.isascii() and text.isdigit() and len(text) < 10 else -1
    if number < least or (most is not None and number > most):
        limits = f"from {least}" if most is None else f"from {least} to {most}"
        raise _wrong(path, line, f"{name} must be a whole number {limits}, got '{text[:LONGEST_NAME]}'")
    return number


def _name(path: str | Path, line: int, row: Mapping[str, str], column: str) -> str:
    text = row[column].strip()
    if (
        not text
        or len(text) > LONGEST_NAME
        or not text.isprintable()
        or text.startswith("~")
        or text.endswith("=")
    ):
        rule = f"1 to {LONGEST_NAME} printable characters that neither start with ~ nor end with ="
        raise _wrong(path, line, f"{column} must be {rule}, got '{text[:LONGEST_NAME]}'")
    return text


def _wrong(path: str | Path, line: int, message: str) -> InputError:
    return InputError(f"{path}, line {line}: {message}")
