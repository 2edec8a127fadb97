"""NumPy files and arrays: shapes that are understood, and archives that lie."""

import io
import zipfile

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.npz_file import cloud_from_arrays, read_npy, read_npz

POINTS = np.arange(12.0).reshape(4, 3)


def packed(**arrays):
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


def test_every_array_comes_back():
    cloud = read_npz(
        packed(
            points=POINTS.astype(np.float32),
            labels=np.array([0, 1, 20, 31], np.uint8),
            colors=np.eye(4, 3),
            camera=np.array([0.0, 0, 1]),
            other=np.zeros(3),
        )
    )
    assert cloud.points.dtype == np.float32
    assert cloud.points.tolist() == POINTS.tolist()
    assert cloud.labels.tolist() == [0, 1, 2, 3]
    assert cloud.colours.tolist() == [[255, 0, 0], [0, 255, 0], [0, 0, 255], [0, 0, 0]]
    assert cloud.camera.tolist() == [0, 0, 1]


def test_an_image_of_points_keeps_its_shape_and_a_fourth_column_is_labels():
    assert cloud_from_arrays(POINTS.reshape(2, 2, 3)).grid == (2, 2)
    cloud = cloud_from_arrays(np.column_stack([POINTS, [0, 1, 2, 3]]))
    assert cloud.points.tolist() == POINTS.tolist()
    assert cloud.labels.tolist() == [0, 1, 2, 3]


def test_columns_stored_in_fortran_order_are_not_mixed_up():
    file = io.BytesIO()
    np.save(file, np.asfortranarray(POINTS))
    assert read_npy(file.getvalue()).points.tolist() == POINTS.tolist()


@pytest.mark.parametrize("bad", [np.zeros(3), np.zeros((4, 2)), np.zeros((4, 3), complex), np.array([["a"] * 3])])
def test_what_is_no_points_is_refused(bad):
    with pytest.raises(InputError, match="points must be numbers of shape"):
        cloud_from_arrays(bad)


def test_labels_of_another_length_are_refused():
    with pytest.raises(InputError, match="labels must be 4"):
        read_npz(packed(points=POINTS, labels=np.zeros(3)))


def test_an_archive_without_points_names_what_it_has():
    with pytest.raises(InputError, match="no array 'points'; its arrays are xyz"):
        read_npz(packed(xyz=POINTS))


def test_objects_are_never_unpickled():
    file = io.BytesIO()
    np.savez(file, points=np.array([print, 1, 2], object))
    with pytest.raises(InputError, match="must hold numbers"):
        read_npz(file.getvalue())


def test_a_shape_larger_than_the_file_is_refused_before_it_is_allocated():
    header = io.BytesIO()
    shape = {"descr": "<f8", "fortran_order": False, "shape": (10**12, 3)}
    np.lib.format.write_array_header_1_0(header, shape)
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("points.npy", header.getvalue() + bytes(100))
    with pytest.raises(InputError, match="more than the file holds"):
        read_npz(file.getvalue())
