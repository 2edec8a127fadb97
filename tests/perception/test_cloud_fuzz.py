"""Damaged and hostile files: each is read or refused in one line, quickly and in bounded memory."""

import contextlib
import io
import resource
import struct
from collections.abc import Callable
from pathlib import Path

import lzf
import numpy as np
import pytest

from lifelore.core import InputError, stream
from lifelore.perception import PointCloud, read_cloud, to_scene

_NUMBERS = (b"0", b"1", b"-1", b"7", b"65537", b"2147483648", b"4294967295", b"999999999999", b"1e9", b"nan", b"")
_WORDS = (
    b"F",
    b"U",
    b"ascii",
    b"binary",
    b"binary_compressed",
    b"list",
    b"property",
    b"vertex",
    b"x",
    b"\xff\x00",
)


def records() -> np.ndarray:
    """Forty points with a label and a colour: a table and one object."""
    rng = np.random.default_rng(1)
    table = np.zeros(40, [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgba", "<u4"), ("label", "<u4")])
    for axis in "xyz":
        table[axis] = rng.uniform(0, 0.5, 40)
    table["z"][:30] = 0.0
    table["label"][:30], table["label"][30:] = 1, 2
    return table


def pcd(data: str) -> bytes:
    table = records()
    header = (
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgba label\nSIZE 4 4 4 4 4\nTYPE F F F U U\nCOUNT 1 1 1 1 1\n"
        f"WIDTH 8\nHEIGHT 5\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 40\nDATA {data}\n"
    ).encode()
    if data == "ascii":
        return header + "\n".join(" ".join(str(value) for value in row) for row in table.tolist()).encode()
    if data == "binary":
        return header + table.tobytes()
    columns = b"".join(table[name].tobytes() for name in table.dtype.names or ())
    packed = lzf.compress(columns)
    return header + struct.pack("<II", len(packed), len(columns)) + packed


def ply(order: str) -> bytes:
    table = records()
    header = (
        f"ply\nformat {order} 1.0\nelement vertex 40\nproperty float x\nproperty float y\nproperty float z\n"
        "property uint rgba\nproperty uint label\nelement face 0\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()
    if order == "ascii":
        return header + "\n".join(" ".join(str(value) for value in row) for row in table.tolist()).encode()
    return header + table.tobytes()


def npz(packed: bool) -> bytes:
    table, file = records(), io.BytesIO()
    points = np.stack([table[axis] for axis in "xyz"], axis=1)
    (np.savez_compressed if packed else np.savez)(file, points=points, labels=table["label"])
    return file.getvalue()


def npy() -> bytes:
    file = io.BytesIO()
    np.save(file, np.stack([records()[axis] for axis in "xyz"], axis=1))
    return file.getvalue()


SEEDS = {
    **{f"{data}.pcd": pcd(data) for data in ("ascii", "binary", "binary_compressed")},
    **{f"{order}.ply": ply(order) for order in ("ascii", "binary_little_endian")},
    "stored.npz": npz(False),
    "packed.npz": npz(True),
    "points.npy": npy(),
}


def flipped(content: bytearray, rng: np.random.Generator) -> None:
    for place in rng.integers(0, len(content), rng.integers(1, 9)):
        content[place] ^= 1 << int(rng.integers(8))


def cut(content: bytearray, rng: np.random.Generator) -> None:
    del content[int(rng.integers(len(content))) :]


def renumbered(content: bytearray, rng: np.random.Generator) -> None:
    """Swap one word of the header for another number or keyword."""
    words = bytes(content[:400]).split(b" ")
    place = int(rng.integers(len(words)))
    choice = _NUMBERS if rng.random() < 0.7 else _WORDS
    tail = words[place].partition(b"\n")[1:]
    words[place] = choice[int(rng.integers(len(choice)))] + b"".join(tail)
    content[:400] = b" ".join(words)


def spliced(content: bytearray, rng: np.random.Generator) -> None:
    """Copy a piece of the file over or into another place."""
    start, length, target = (int(x) for x in rng.integers(0, len(content), 3))
    piece = content[start : start + length % 64]
    content[target : target + (len(piece) if rng.random() < 0.5 else 0)] = piece


MUTATIONS: tuple[Callable[[bytearray, np.random.Generator], None], ...] = (flipped, cut, renumbered, spliced)


def mutated(content: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(content)
    for _ in range(int(rng.integers(1, 4))):
        if changed:
            MUTATIONS[int(rng.integers(len(MUTATIONS)))](changed, rng)
    return bytes(changed)


def outcomes(folder: Path, n: int, seed: int) -> tuple[int, int]:
    """Read `n` damaged files; how many were read, and how many refused in one line after their name."""
    rng, read, lines = stream(seed, "cloud fuzz"), 0, []
    for i in range(n):
        name = list(SEEDS)[i % len(SEEDS)]
        path = folder / name
        path.write_bytes(mutated(SEEDS[name], rng))
        try:
            cloud = read_cloud(path)
        except InputError as error:
            lines.append(str(error).removeprefix(f"{path}: "))
            continue
        assert cloud.measured.any()
        read += 1
        upright_or_refused(cloud)
    assert all(line.isprintable() and str(folder) not in line and len(line) < 400 for line in lines)
    return read, len(lines)


def upright_or_refused(cloud: PointCloud) -> None:
    with contextlib.suppress(InputError):
        assert 0 < len(to_scene(cloud).points) <= len(cloud.points)


def test_the_seeds_themselves_are_read(tmp_path: Path) -> None:
    for name, content in SEEDS.items():
        (tmp_path / name).write_bytes(content)
        cloud = read_cloud(tmp_path / name)
        assert len(cloud.points) == 40
        assert cloud.points[7, 0] == records()["x"][7]
        assert (cloud.labels is None) == (name == "points.npy")


def check(tmp_path: Path, n: int, seed: int) -> None:
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    read, refused = outcomes(tmp_path, n, seed)
    grown = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    # Both ways out must be exercised, and a kilobyte must not become hundreds of megabytes (ru_maxrss is in KiB).
    assert min(read, refused) > n // 20
    assert grown < 200_000


@pytest.mark.slow
def test_a_thousand_damaged_files(tmp_path: Path) -> None:
    check(tmp_path, 1000, seed=1)


@pytest.mark.soak
def test_a_hundred_thousand_damaged_files(tmp_path: Path) -> None:
    check(tmp_path, 100_000, seed=2)
