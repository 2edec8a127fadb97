"""Reading and writing `map_server` maps: its rules by hand, and one clear line for each bad input."""

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lifelore.core.errors import InputError, StoreError
from lifelore.domains.buildings.occupancy_map import (
    FREE,
    OCCUPIED,
    UNKNOWN,
    OccupancyMap,
    read_occupancy_map,
    write_occupancy_map,
)

SETTINGS = {
    "image": "map.pgm",
    "resolution": 0.1,
    "origin": [0.0, 0.0, 0.0],
    "negate": 0,
    "occupied_thresh": 0.65,
    "free_thresh": 0.196,
}


def write_yaml(folder: Path, **changes) -> Path:
    lines = [f"{key}: {value}" for key, value in (SETTINGS | changes).items() if value is not None]
    path = folder / "map.yaml"
    path.write_text("\n".join(lines))
    return path


def read_pixels(folder: Path, pixels: np.ndarray, **changes) -> list:
    Image.fromarray(pixels).save(folder / "map.png")
    return read_occupancy_map(write_yaml(folder, image="map.png", **changes)).state.tolist()


def grey_row(*values) -> np.ndarray:
    return np.array([values], np.uint8)


def test_trinary_thresholds_as_map_server(tmp_path):
    # 206 is the first free grey of the Willow map (p = 49/255 = 0.192), 89 the last occupied one (0.651).
    assert read_pixels(tmp_path, grey_row(255, 206, 205, 90, 89, 0)) == [
        [FREE, FREE, UNKNOWN, UNKNOWN, OCCUPIED, OCCUPIED]
    ]


def test_a_pixel_on_a_threshold_is_unknown(tmp_path):
    values = grey_row(255 - 51, 255 - 102)  # p = 0.2 and 0.4 exactly as written
    assert read_pixels(tmp_path, values, free_thresh=0.2, occupied_thresh=0.4) == [[UNKNOWN, UNKNOWN]]


def test_negate_reads_bright_as_occupied(tmp_path):
    assert read_pixels(tmp_path, grey_row(0, 120, 255), negate=1) == [[FREE, UNKNOWN, OCCUPIED]]
    assert read_pixels(tmp_path, grey_row(0, 120, 255), negate="true") == [[FREE, UNKNOWN, OCCUPIED]]


def test_grey_with_alpha_is_averaged_as_four_channels(tmp_path):
    # Three times 128 and 255: 159.75, p = 0.37. As two channels it would be 191.5, p = 0.249.
    image = Image.fromarray(np.array([[[128, 255]]], np.uint8))
    image.save(tmp_path / "map.png")
    path = write_yaml(tmp_path, image="map.png", free_thresh=0.3)
    assert read_occupancy_map(path).state.tolist() == [[UNKNOWN]]


def test_scale_takes_what_is_not_opaque_as_unknown(tmp_path):
    pixels = np.array([[[0, 0, 0, 255], [255, 255, 255, 254], [255, 255, 255, 255]]], np.uint8)
    assert read_pixels(tmp_path, pixels, mode="scale") == [[OCCUPIED, UNKNOWN, FREE]]


def test_raw_pixels_are_percentages(tmp_path):
    states = [[FREE, FREE, UNKNOWN, UNKNOWN, OCCUPIED, OCCUPIED, UNKNOWN, UNKNOWN]]
    assert read_pixels(tmp_path, grey_row(0, 19, 20, 65, 66, 100, 101, 255), mode="raw") == states


def test_sixteen_bits(tmp_path):
    # p = 0.192 and 0.19608 in sixteen bits: one side of the threshold each.
    values = np.array([[65535, 206 * 257, 205 * 257, 0]], np.uint16)
    assert read_pixels(tmp_path, values) == [[FREE, FREE, UNKNOWN, OCCUPIED]]


def test_palette_image_is_read_by_its_colours(tmp_path):
    image = Image.new("P", (2, 1))
    image.putpalette([255, 255, 255, 0, 0, 0])
    image.putpixel((1, 0), 1)
    image.save(tmp_path / "map.png")
    assert read_occupancy_map(write_yaml(tmp_path, image="map.png")).state.tolist() == [[FREE, OCCUPIED]]


@pytest.mark.parametrize(
    "content",
    [
        b"P2\n# made by hand\n3 1\n255\n255 205 0\n",
        b"P5\n# made by hand\n3 1\n255\n" + bytes([255, 205, 0]),
        b"P5 3 1 65535\n" + np.array([65535, 205 * 257, 0], ">u2").tobytes(),
    ],
)
def test_plain_and_binary_pgm(tmp_path, content):
    (tmp_path / "map.pgm").write_bytes(content)
    assert read_occupancy_map(write_yaml(tmp_path)).state.tolist() == [[FREE, UNKNOWN, OCCUPIED]]


def test_settings_come_along(tmp_path):
    (tmp_path / "map.pgm").write_bytes(b"P5 1 1 255\n\xff")
    path = write_yaml(tmp_path, resolution="5e-2", origin="[-1.5, 2, 0.5]")
    read = read_occupancy_map(path)
    assert (read.resolution, read.origin, read.source) == (0.05, (-1.5, 2.0, 0.5), str(path))


@pytest.mark.parametrize(
    ("key", "values", "words"),
    [
        ("resolution", (0, -0.1), "resolution must be positive"),
        ("resolution", (".nan", "nan", ".inf", "fine", "true"), "resolution must be a finite number"),
        ("occupied_thresh", (1.01,), "thresholds must satisfy"),
        ("free_thresh", (-0.1, 0.65), "thresholds must satisfy"),
        ("free_thresh", ("[0.1]",), "free_thresh must be a finite number"),
        ("origin", ("[0, 0]", "[0, 0, 0, 0]", "here"), "origin must be three numbers"),
        ("origin", ("[0, .nan, 0]",), "origin must be a finite number"),
        ("mode", ("grey", "[raw]"), "mode must be one of trinary, scale, raw"),
        ("negate", (2, "[1]"), "negate must be 0 or 1"),
        ("image", ("''", "[a]"), "image must name an image file"),
        ("image", ("gone.pgm", "."), "' not found"),
    ],
)
def test_each_broken_rule_is_one_clear_line(tmp_path, key, values, words):
    (tmp_path / "map.pgm").write_bytes(b"P5 1 1 255\n\xff")
    for value in values:
        assert words in error_of(write_yaml(tmp_path, **{key: value})), value


@pytest.mark.slow
@pytest.mark.parametrize(
    ("contents", "words"),
    [
        ((b"", b"just words", b"- a\n- list"), "is not a map YAML"),
        ((b"image: [unclosed", b"\x89PNG\r\n\x1a\n\x00\x00", b"[" * 5000), "is not YAML"),
        ((b"a: 1\n" * 300_000,), "too large for a map YAML"),
    ],
    ids=["no map", "no YAML", "too large"],
)
def test_not_a_map_yaml(tmp_path, contents, words):
    for content in contents:
        (tmp_path / "map.yaml").write_bytes(content)
        assert words in error_of(tmp_path / "map.yaml")


@pytest.mark.parametrize("content", [b"", b"not an image", b"P5 10 10 255\n" + b"\xff" * 50, b"P2 2 2 255\n255 0",
                                     b"P5 -3 10 255\n"])  # fmt: skip
def test_damaged_images(tmp_path, content):
    (tmp_path / "map.pgm").write_bytes(content)
    assert "damaged or no image" in error_of(write_yaml(tmp_path))


@pytest.mark.parametrize("size", [b"20000 6000", b"1000000 1000000"])
def test_absurd_images(tmp_path, size):
    (tmp_path / "map.pgm").write_bytes(b"P5 " + size + b" 255\n")
    assert "at most 100000000 pixels" in error_of(write_yaml(tmp_path))


def error_of(path) -> str:
    with pytest.raises(InputError) as caught:
        read_occupancy_map(path)
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_what_is_written_is_read_back(tmp_path):
    state = np.random.default_rng(1).integers(0, 3, (7, 5)).astype(np.uint8)
    image = write_occupancy_map(tmp_path / "out.yaml", OccupancyMap(state, 0.05, (-3.0, 1.5, 0.25)))
    read = read_occupancy_map(tmp_path / "out.yaml")
    assert image == tmp_path / "out.pgm"
    assert read.state.tolist() == state.tolist()
    assert (read.resolution, read.origin) == (0.05, (-3.0, 1.5, 0.25))


def test_an_array_is_written_as_it_is(tmp_path):
    percent = np.arange(101, dtype=np.uint8).reshape(1, -1)
    image = write_occupancy_map(tmp_path / "prior.yaml", percent, 0.5, (1, 2, 0), mode="raw")
    assert np.asarray(Image.open(image)).tolist() == percent.tolist()
    assert (read_occupancy_map(tmp_path / "prior.yaml").state == OCCUPIED).sum() == 35  # 66 … 100


def test_writing_refuses_what_breaks_a_rule(tmp_path):
    grey = np.zeros((2, 2), np.uint8)
    for arguments, words in (
        ((tmp_path / "a.yaml", grey.astype(float), 0.1), "grey must be a uint8 array"),
        ((tmp_path / "a.yaml", grey[0], 0.1), "must be a (rows, columns) array"),
        ((tmp_path / "a.yaml", grey), "resolution must be a positive number"),
        ((tmp_path / "a.pgm", grey, 0.1), "path must name the YAML file"),
        ((tmp_path / "a.yaml", grey, 0.1, (0.0, np.inf, 0.0)), "origin must be three numbers"),
    ):
        with pytest.raises(InputError) as caught:
            write_occupancy_map(*arguments)
        assert words in str(caught.value)
    with pytest.raises(InputError, match="mode must be one of"):
        write_occupancy_map(tmp_path / "a.yaml", grey, 0.1, mode="grey")
    assert not list(tmp_path.iterdir())
    with pytest.raises(StoreError, match="the map cannot be written to"):
        write_occupancy_map(tmp_path / "no" / "such" / "folder.yaml", grey, 0.1)


@pytest.mark.skipif("LIFELORE_DATA" not in os.environ, reason="LIFELORE_DATA is not set")
def test_the_willow_map():
    willow = read_occupancy_map(Path(os.environ["LIFELORE_DATA"]) / "maps" / "willow-full.yaml")
    assert (willow.state.shape, willow.resolution) == ((526, 584), 0.1)
    assert np.bincount(willow.state.ravel()).tolist() == [134715, 6961, 165508]
