"""`read_cloud`: which reader, and one line for whatever is no cloud."""

import os

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_file import read_cloud

PCD = b"VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\nDATA ascii\n0 0 0\n1 1 1\n"


def test_an_array_is_a_cloud():
    cloud = read_cloud(np.array([[0, 0, 0, 1], [1, 1, 1, 2]]))
    assert cloud.points.tolist() == [[0, 0, 0], [1, 1, 1]]
    assert cloud.labels.tolist() == [1, 2]


def test_content_goes_before_suffix(tmp_path):
    path = tmp_path / "cloud.ply"
    path.write_bytes(PCD)
    assert read_cloud(path).points.tolist() == [[0, 0, 0], [1, 1, 1]]


def test_suffix_helps_where_content_does_not(tmp_path):
    path = tmp_path / "cloud.pcd"
    path.write_bytes(b"\n# by hand\n" + PCD)
    assert len(read_cloud(str(path)).points) == 2


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is empty; give a PCD, PLY, npz or npy file"),
        (b"hello", "is no cloud we know"),
        (b"\x89MCAP0\r\n", "is a rosbag, not a cloud; pass the .bag or .mcap file"),
        (PCD.replace(b"1 1 1", b"1 1"), "is damaged or not a cloud"),
        (PCD.replace(b"1 1 1", b"1 1 one"), "is damaged or not a cloud"),
        (PCD.replace(b"0 0 0\n1 1 1", b"nan 0 0\n1 nan 1"), "no finite point among 2"),
        (b"PK\x03\x04 and then nothing", "is damaged or not a cloud"),
        (PCD.replace(b"x y z", b"x y \x1b[31mz"), "has no field z"),
    ],
)
def test_what_is_no_cloud_is_one_line_with_its_name(tmp_path, content, said):
    path = tmp_path / "cloud.dat"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_cloud(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert said in str(caught.value)
    assert str(caught.value).isprintable()


def test_places_without_a_file(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_cloud(tmp_path / "none.pcd")
    with pytest.raises(InputError, match="is no file"):
        read_cloud(tmp_path)
    os.mkfifo(tmp_path / "pipe.pcd")
    with pytest.raises(InputError, match="is no file"):
        read_cloud(tmp_path / "pipe.pcd")
    with pytest.raises(InputError, match=r"cannot be read|no such file"):
        read_cloud("a\0b.pcd")


@pytest.mark.parametrize(
    ("labels", "rule", "ids", "from_parts"),
    [
        ([1, 2, 20, 21], "auto", [1, 1, 2, 2], True),
        ([1, 2, 30, 31], "parts", [1, 1, 3, 3], True),
        ([1, 2, 20, 21], "plain", [1, 2, 20, 21], False),
        ([0, 1, 2, 3], "auto", [0, 1, 2, 3], False),
        ([-1, 1, 2, 3], "auto", [0, 1, 2, 3], False),
    ],
)
def test_a_cloud_knows_whether_its_labels_were_parts(tmp_path, labels, rule, ids, from_parts):
    np.savez(tmp_path / "cloud.npz", points=np.eye(4, 3), labels=np.array(labels))
    for source in (tmp_path / "cloud.npz", np.column_stack([np.eye(4, 3), labels])):
        cloud = read_cloud(source, labels=rule)
        assert cloud.labels.tolist() == ids
        assert cloud.from_parts is from_parts


def test_a_bad_option_is_refused(tmp_path):
    path = tmp_path / "cloud.pcd"
    path.write_bytes(PCD)
    with pytest.raises(InputError, match="units must be m, cm, mm or inch"):
        read_cloud(path, units="feet")
    with pytest.raises(InputError, match="labels must be one of"):
        read_cloud(np.zeros((2, 3)), labels="none")
