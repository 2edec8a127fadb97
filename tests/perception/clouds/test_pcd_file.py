"""PCD in its three encodings, as pypcd4 and hands write it, and headers that lie."""

import io
import os
from pathlib import Path

import numpy as np
import pypcd4
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.pcd_file import read_pcd

HEADER = (
    "VERSION 0.7\nFIELDS x y z label\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
    "VIEWPOINT 0.5 0 1 1 0 0 0\nPOINTS 2\nDATA ascii\n"
)
ROWS = "0 0.25 0.5 1\n1 nan 2 2\n"


def written(encoding: str, label: type) -> tuple[bytes, list[np.ndarray]]:
    """A file by pypcd4, and the columns in it."""
    rng = np.random.default_rng(3)
    xyz = [(rng.integers(0, 9, 50) / 3).astype(np.float32) for _ in range(3)]
    xyz[2][7] = np.nan
    columns = [
        *xyz,
        np.resize(rng.integers(0, 2**24, 5), 50).astype(np.uint32),
        rng.integers(0, 9, 50).astype(label),
    ]
    types = [np.float32, np.float32, np.float32, np.uint32, label]
    cloud = pypcd4.PointCloud.from_points(columns, ("x", "y", "z", "rgb", "label"), types)
    file = io.BytesIO()
    cloud.save(file, pypcd4.Encoding(encoding))
    return file.getvalue(), columns


@pytest.mark.parametrize("label", [np.uint8, np.int16, np.uint32, np.int64, np.float32])
@pytest.mark.parametrize("encoding", ["ascii", "binary", "binary_compressed"])
def test_what_pypcd4_writes_is_read_back(encoding: str, label: type) -> None:
    content, (x, y, z, rgb, labels) = written(encoding, label)
    cloud = read_pcd(content)
    np.testing.assert_array_equal(cloud.points, np.stack([x, y, z], axis=1))
    assert cloud.labels.tolist() == labels.astype(int).tolist()
    assert cloud.colours.tolist() == [[c >> 16, c >> 8 & 255, c & 255] for c in rgb.tolist()]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("\n", "\n"),
        ("\n", "\r\n"),
        (" ", "\t"),
        (" ", "  "),
        ("\n", " \n "),
        ("\n", "\n\n"),
        (" 2\n", " 2.0\n3 3 3 3\n"),
    ],
)
def test_text_may_be_spaced_in_any_way_and_go_on(old: str, new: str) -> None:
    cloud = read_pcd((HEADER + ROWS.replace(old, new)).encode())
    np.testing.assert_array_equal(cloud.points, [[0, 0.25, 0.5], [1, np.nan, 2]])
    assert cloud.labels.tolist() == [1, 2]
    assert (cloud.camera.tolist(), cloud.grid) == ([0.5, 0, 1], None)


def test_text_of_one_point() -> None:
    header = HEADER.replace("WIDTH 2", "WIDTH 1").replace("POINTS 2", "POINTS 1")
    assert read_pcd((header + "1 2 3 4").encode()).points.tolist() == [[1, 2, 3]]


def test_padding_and_fields_of_several_numbers_are_passed_over() -> None:
    layout = np.dtype([("n", "<f4", 3), ("x", "<f4"), ("_", "u1", 5), ("y", "<f4"), ("z", "<f8")])
    rows = np.zeros(4, layout)
    rows["x"], rows["y"], rows["z"], rows["n"] = [1, 2, 3, 4], 5, [6, 7, 8, 9], 99
    header = b"FIELDS n x _ y z\nSIZE 4 4 1 4 8\nTYPE F F U F F\nCOUNT 3 1 5 1 1\nWIDTH 2\nHEIGHT 2\nDATA binary\n"
    cloud = read_pcd(header + rows.tobytes())
    assert cloud.points.tolist() == [[1, 5, 6], [2, 5, 7], [3, 5, 8], [4, 5, 9]]
    assert cloud.grid == (2, 2)


@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA names no data")
@pytest.mark.parametrize("name", ["learn20", "learn25", "test53"])
def test_real_scenes_are_what_pypcd4_reads_without_the_check(name: str) -> None:
    path = Path(os.environ["LIFELORE_DATA"]) / "osd" / f"{name}.pcd"
    raw = pypcd4.PointCloud.from_path(path).pc_data
    cloud = read_cloud(path)
    points = np.stack([raw[axis] for axis in "xyz"], axis=1)
    finite = np.isfinite(points).all(axis=1)
    np.testing.assert_array_equal(cloud.points[finite], points[finite])
    assert (cloud.measured == finite).all()
    label = raw["label"].astype(int)
    assert cloud.labels is not None
    assert (cloud.labels == np.where((label > 0) & (label < 10), 1, label // 10)).all()
    assert (cloud.colours[:, 1] == (raw["rgba"] >> 8 & 255)).all()
    assert cloud.grid == (480, 640)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("WIDTH 2", "WIDTH 3", "2 POINTS, but WIDTH 3"),
        ("WIDTH 2", "WIDTH -2", "WIDTH must be 1 whole numbers"),
        ("WIDTH 2\n", "", "WIDTH must be"),
        ("SIZE 4 4 4 4", "SIZE 4 4 4", "SIZE must be 4"),
        ("TYPE F F F U", "TYPE F F F", "4 FIELDS and 3 TYPE"),
        ("SIZE 4 4 4 4", "SIZE 4 4 4 3", "field label has type U 3 × 1, which is not read"),
        ("COUNT 1 1 1 1", "COUNT 1 1 0 1", "field z has type F 4 × 0, which is not read"),
        ("COUNT 1 1 1 1", "COUNT 1 1 3 1", "field z has type F 4 × 3, which is not read"),
        ("DATA ascii", "DATA asci", "DATA must be"),
        ("DATA ascii\n", "", "no DATA line"),
        ("VIEWPOINT 0.5", "VIEWPOINT inf", "VIEWPOINT must begin with three finite numbers"),
        ("VIEWPOINT 0.5", "VIEWPOINT here", "VIEWPOINT must begin with three finite numbers"),
        ("FIELDS x y z", "FIELDS x y w", "has no field z"),
        ("WIDTH 2\nHEIGHT 1\nVIEWPOINT 0.5 0 1 1 0 0 0\nPOINTS 2", "WIDTH 0\nHEIGHT 0", "holds no points"),
        ("2\nHEIGHT 1\nVIEWPOINT 0.5 0 1 1 0 0 0\nPOINTS 2", "100000\nHEIGHT 100000", "10000000000 points"),
        ("WIDTH 2\nHEIGHT 1\nVIEWPOINT 0.5 0 1 1 0 0 0\nPOINTS 2", "WIDTH 900\nHEIGHT 1", "2 lines follow"),
        ("WIDTH 2\nHEIGHT 1\nVIEWPOINT 0.5 0 1 1 0 0 0\nPOINTS 2", "WIDTH 3\nHEIGHT 1", "2 lines follow"),
        ("DATA ascii", "DATA binary", "promises 32 bytes of points, but 23 follow"),
        ("DATA ascii", "DATA binary_compressed", "cut off or damaged"),
    ],
)
def test_a_header_that_lies_is_refused(old: str, new: str, said: str) -> None:
    assert old in HEADER
    with pytest.raises(InputError, match=said):
        read_pcd((HEADER.replace(old, new) + ROWS).encode())


def test_compressed_data_that_does_not_decode_is_refused_in_one_line(tmp_path: Path) -> None:
    content, _ = written("binary_compressed", np.uint8)
    start = content.index(b"DATA binary_compressed\n") + len(b"DATA binary_compressed\n") + 8
    path = tmp_path / "damaged.pcd"
    path.write_bytes(content[:start] + b"\xff" * (len(content) - start))
    with pytest.raises(InputError, match=r"damaged\.pcd: is damaged or not a cloud .*; write it again"):
        read_cloud(path)
