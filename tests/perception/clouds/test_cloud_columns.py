"""Columns to clouds: colours packed three ways, and coordinates that must be there."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.cloud_columns import (
    cast_to_header_type,
    cloud_from_columns,
    colours_as_bytes,
    unpack_colours,
)

XYZ = {name: np.array([0.0, 1.0], np.float32) for name in "xyz"}


def test_a_packed_colour_is_the_same_as_an_integer_and_as_the_bits_of_a_float() -> None:
    packed = np.array([0x00FF8001, 0xFF0A0B0C], np.uint32)
    expected = [[255, 128, 1], [10, 11, 12]]
    assert unpack_colours(packed).tolist() == expected
    assert unpack_colours(np.array([0x00FF8001, 0x000A0B0C], np.uint32).view(np.float32)).tolist() == expected


def test_colours_as_bytes_and_as_shares() -> None:
    assert colours_as_bytes(np.array([[0.0, 0.5, 1.0]])).tolist() == [[0, 128, 255]]
    assert colours_as_bytes(np.array([[0, 128, 255]])).tolist() == [[0, 128, 255]]
    assert colours_as_bytes(np.array([[np.nan, 2.0, 255.0]])).tolist() == [[0, 2, 255]]
    with pytest.raises(InputError, match="0 to 255"):
        colours_as_bytes(np.array([[256, 0, 0]]))


def test_separate_channels_and_names_in_capitals() -> None:
    channels = {name: np.array([7, 8], np.uint8) for name in ("Red", "GREEN", "blue")}
    cloud = cloud_from_columns({**{name.upper(): column for name, column in XYZ.items()}, **channels})
    assert cloud.colours.tolist() == [[7, 7, 7], [8, 8, 8]]


def test_singles_stay_singles_and_doubles_doubles() -> None:
    assert cloud_from_columns(XYZ).points.dtype == np.float32
    far = {**XYZ, "x": np.array([4e6, 4e6 + 0.001])}
    assert cloud_from_columns(far).points[1, 0] - 4e6 == pytest.approx(0.001, abs=1e-9)


def test_a_row_of_points_is_no_image() -> None:
    assert cloud_from_columns(XYZ, grid=(1, 2)).grid is None
    four = {name: np.zeros(4) for name in "xyz"}
    assert cloud_from_columns(four, grid=(2, 2)).grid == (2, 2)


def test_a_missing_coordinate_is_named() -> None:
    with pytest.raises(InputError, match="has no field z; its fields are x y"):
        cloud_from_columns({"x": XYZ["x"], "y": XYZ["y"]})


def test_whole_columns_read_as_text() -> None:
    assert cast_to_header_type(np.array([4294967295.0]), np.dtype(np.uint32)).tolist() == [4294967295]
    assert np.isnan(cast_to_header_type(np.array([np.nan, 1.0]), np.dtype(np.uint32))[0])
