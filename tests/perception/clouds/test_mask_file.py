"""Masks as labels: label images, stacks with overlaps, and one line for each mistake."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from lifelore.core.errors import InputError
from lifelore.perception.clouds.mask_file import numbers_of_stack, read_masks
from lifelore.perception.clouds.point_cloud import PointCloud

POINTS = np.arange(18, dtype=float).reshape(6, 3)
CLOUD = PointCloud(POINTS, np.full(6, 7), grid=(2, 3))
IMAGE = np.array([[0, 1, 1], [5, 5, 2]], np.uint8)


def labels(path: Path, table_mask: int | None = None, cloud: PointCloud = CLOUD) -> list[int]:
    found = read_masks(path, cloud, table_mask).labels
    return found.tolist()


@pytest.mark.parametrize("kind", ["L", "I;16", "P"])
def test_a_label_image_replaces_the_labels(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "masks.png"
    if kind == "P":
        image = Image.fromarray(IMAGE, mode=None).convert("L")
        image.putpalette(list(range(256)) * 3)
        assert image.mode == "P"
    else:
        image = Image.fromarray(IMAGE.astype(np.uint16) if kind == "I;16" else IMAGE)
    image.save(path)
    assert labels(path) == [0, 2, 2, 6, 6, 3]
    assert labels(path, table_mask=5) == [0, 2, 2, 1, 1, 3]


def test_points_of_a_part_take_the_labels_of_their_pixels(tmp_path: Path) -> None:
    Image.fromarray(IMAGE).save(tmp_path / "masks.png")
    part = CLOUD.only(np.array([5, 0, 4]))
    assert labels(tmp_path / "masks.png", cloud=part) == [3, 0, 6]


def test_arrays_in_npz_and_npy(tmp_path: Path) -> None:
    stack = np.stack([number == IMAGE for number in (1, 2, 5)])
    np.savez(tmp_path / "stack.npz", masks=stack)
    assert labels(tmp_path / "stack.npz", table_mask=3) == [0, 2, 2, 1, 1, 3]
    np.save(tmp_path / "stack.npy", stack)
    assert labels(tmp_path / "stack.npy") == [0, 2, 2, 4, 4, 3]
    np.savez(tmp_path / "image.npz", labels=IMAGE.astype(np.int32))
    assert labels(tmp_path / "image.npz") == [0, 2, 2, 6, 6, 3]
    np.savez(tmp_path / "flat.npz", labels=IMAGE.reshape(-1))
    assert labels(tmp_path / "flat.npz", cloud=PointCloud(POINTS)) == [0, 2, 2, 6, 6, 3]


def test_overlaps_go_to_the_smaller_mask_and_equal_masks_to_the_first() -> None:
    wide, small = [1, 1, 1, 0], [0, 1, 0, 0]
    assert numbers_of_stack(np.array([[wide], [small]], bool)).tolist() == [[1, 2, 1, 0]]
    assert numbers_of_stack(np.array([[small], [wide]], bool)).tolist() == [[2, 1, 2, 0]]
    assert numbers_of_stack(np.array([[wide], [wide]], bool)).tolist() == [[1, 1, 1, 0]]


def refused(path: Path, said: str, cloud: PointCloud = CLOUD, table_mask: int | None = None) -> None:
    with pytest.raises(InputError, match=said) as caught:
        read_masks(path, cloud, table_mask)
    assert str(caught.value).startswith(f"{path}: ")
    assert "\n" not in str(caught.value)


def test_mistakes_are_one_line(tmp_path: Path) -> None:
    path = tmp_path / "masks.png"
    Image.fromarray(IMAGE).save(path)
    refused(path, "the cloud is not organised", PointCloud(POINTS))
    refused(path, "masks of 3 × 2 pixels, but the cloud has 2 × 3", PointCloud(POINTS, grid=(3, 2)))
    refused(path, "no mask 9 for the table; its masks are 1, 2, 5", table_mask=9)
    Image.fromarray(np.zeros((2, 3), np.uint8)).save(path)
    refused(path, "holds no mask over any point")
    Image.fromarray(np.zeros((2, 3, 3), np.uint8)).save(path)
    refused(path, "mode RGB, but a label image has a single channel")
    path.write_text("hello")
    refused(path, "holds no masks; give a PNG")
    refused(tmp_path / "none.png", "no such file")


@pytest.mark.parametrize(
    ("arrays", "said"),
    [
        ({"other": IMAGE}, "either an array .labels. or an array .masks.; its arrays are other"),
        ({"labels": IMAGE, "masks": IMAGE}, "either an array"),
        ({"labels": IMAGE.reshape(-1)[:5]}, "holds 5 labels, but the cloud 6 points"),
        ({"labels": IMAGE + 0.5}, "labels must be whole numbers"),
        ({"masks": np.full((2, 2, 3), 2)}, "must be true or false"),
        ({"masks": np.zeros((1001, 2, 3), bool)}, "1001 masks where at most 1000"),
        ({"masks": np.zeros((1, 2, 3, 1), bool)}, "must have shape"),
    ],
)
def test_arrays_that_break_a_rule(tmp_path: Path, arrays: dict, said: str) -> None:
    np.savez(tmp_path / "masks.npz", **arrays)
    refused(tmp_path / "masks.npz", said)
