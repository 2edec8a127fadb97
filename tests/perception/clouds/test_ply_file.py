"""PLY as trimesh and hands write it, and headers that lie."""

import numpy as np
import pytest
import trimesh

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_file import read_cloud
from lifelore.perception.clouds.ply_file import read_ply

HEADER = (
    "ply\nformat ascii 1.0\ncomment by hand\nelement camera 1\nproperty float far\nelement vertex 2\n"
    "property float x\nproperty float y\nproperty float z\nproperty uchar red\nproperty uchar green\n"
    "property uchar blue\nproperty int label\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
)
ROWS = "9.5\n0 0.25 0.5 1 2 3 2\n1 nan 2 4 5 6 20\n3 0 1 1\n"


def test_a_range_image_with_a_vertex_for_every_pixel_is_organised():
    header = HEADER.replace("vertex 2", "vertex 4").replace(
        "comment by hand", "obj_info num_cols 2\nobj_info num_rows 2"
    )
    rows = ROWS.replace("3 0 1 1\n", "0 0 0 1 2 3 2\n0 0 0 1 2 3 2\n3 0 1 1\n")
    assert read_ply((header + rows).encode()).grid == (2, 2)
    assert read_ply((header.replace("num_rows 2", "num_rows 3") + rows).encode()).grid is None
    assert read_ply((HEADER + ROWS).encode()).grid is None


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_in_both_byte_orders(order):
    code = {"<": "binary_little_endian", ">": "binary_big_endian"}[order]
    layout = [(axis, order + "f8") for axis in "xyz"] + [(name, "u1") for name in ("red", "green", "blue")]
    rows = np.array([(1, 2, 3, 4, 5, 6, -1), (7, 8, 9, 10, 11, 12, 3)], [*layout, ("label", order + "i2")])
    header = HEADER.replace("ascii", code).replace("float", "double").replace("int label", "short label")
    content = header.encode() + np.array([9.5], order + "f8").tobytes() + rows.tobytes() + b"\x01\0\0\0\0"
    cloud = read_ply(content)
    assert cloud.points.tolist() == [[1, 2, 3], [7, 8, 9]]
    assert cloud.labels.tolist() == [0, 3]
    assert cloud.colours.tolist() == [[4, 5, 6], [10, 11, 12]]
    with pytest.raises(InputError, match="cut off"):
        read_ply(content[:-6])


@pytest.mark.parametrize("encoding", ["ascii", "binary_little_endian"])
def test_what_trimesh_writes_is_read_back(encoding):
    mesh = trimesh.creation.box((0.1, 0.2, 0.3))
    mesh.visual.vertex_colors = np.arange(32, dtype=np.uint8).reshape(8, 4)
    mesh.vertex_attributes["label"] = np.arange(2, 10, dtype=np.int32)
    content = trimesh.exchange.ply.export_ply(mesh, encoding=encoding, include_attributes=True)
    cloud = read_ply(content)
    np.testing.assert_allclose(cloud.points, mesh.vertices, atol=1e-7)
    assert cloud.colours.tolist() == np.asarray(mesh.visual.vertex_colors)[:, :3].tolist()
    assert cloud.labels.tolist() == list(range(2, 10))


@pytest.mark.parametrize(
    ("old", "new"),
    [("\n", "\r\n"), (" ", "\t"), (" ", "  "), ("\n", " \n "), ("\n", "\n\n"), (" 20\n", " 20.0\n")],
)
def test_text_may_be_spaced_in_any_way(old, new):
    cloud = read_ply((HEADER + ROWS.replace(old, new)).encode(), "plain")
    np.testing.assert_array_equal(cloud.points, [[0, 0.25, 0.5], [1, np.nan, 2]])
    assert (cloud.labels.tolist(), cloud.camera) == ([2, 20], None)
    assert cloud.colours.tolist() == [[1, 2, 3], [4, 5, 6]]


@pytest.mark.parametrize(("old", "new"), [("nan", "hm"), (" 20\n", "\n")])
def test_text_that_breaks_off_within_a_line_is_refused_in_one_line(tmp_path, old, new):
    path = tmp_path / "damaged.ply"
    path.write_text(HEADER + ROWS.replace(old, new))
    with pytest.raises(InputError, match=r"damaged\.ply: is damaged or not a cloud .*; write it again"):
        read_cloud(path)


def test_polygons_of_different_sizes_after_the_vertices_are_passed_over():
    header = HEADER.replace("ascii", "binary_little_endian").replace("face 1", "face 2")
    rows = np.array([(1, 2, 3, 4, 5, 6, 2)] * 2, "<f4,<f4,<f4,u1,u1,u1,<i4").tobytes()
    faces = b"\x03" + bytes(12) + b"\x04" + bytes(16)
    assert read_ply(header.encode() + bytes(4) + rows + faces).points.tolist() == [[1, 2, 3]] * 2


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("vertex 2", "vertex 3000000000000", "whole number"),
        ("vertex 2", "vertex 900000000000", "at most"),
        ("vertex 2", "vertex 900", "cut off"),
        ("vertex 2", "vertex -2", "whole number"),
        ("vertex 2", "vertex 0", "holds no vertices"),
        ("element vertex", "element vortex", "holds no vertices"),
        ("property float x", "property quad x", "not understood"),
        ("property float x", "property list uchar int x", "lists inside or before"),
        ("property float x\n", "", "has no field x"),
        ("property float y", "property float x", "property twice"),
        ("format ascii 1.0", "format ebcdic 1.0", "not understood"),
        ("format ascii 1.0\n", "", "names no format"),
        ("end_header", "end", "no end_header"),
    ],
)
def test_a_header_that_lies_is_refused(old, new, said):
    assert old in HEADER
    with pytest.raises(InputError, match=said):
        read_ply((HEADER.replace(old, new, 1) + ROWS).encode())
