"""Regions: boxes and ranges that crop a cloud, and the limit of objects."""

import numpy as np
import pytest

from lifelore.core.errors import InputError
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.segmentation.object_segmentation import TABLE_BAND, SegmentationSettings, cut_cloud
from lifelore.perception.segmentation.region import Region, empty_places, inside
from lifelore.perception.segmentation.table_frame import segmented_scene
from tests.perception.segmentation.test_parted_objects import block, face

POINTS = np.array([[0.0, 0, 1], [0.5, 0, 1], [0, 0, 3], [np.nan, 0, 1]])


@pytest.mark.parametrize(
    ("region", "kept"),
    [
        (Region(roi=(-1, 0.2, -1, 1, 0, 2)), [0]),
        (Region(roi=(-1, np.inf, -1, 1, 0, 5)), [0, 1, 2]),
        (Region(max_range=1.05), [0]),
        (Region(roi=(0.1, 1, -1, 1, -1, 5), max_range=2.0), [1]),
    ],
)
def test_points_in_the_box_and_the_range_are_used(region, kept):
    found = inside(PointCloud(POINTS, np.array([1, 2, 3, 0])), region)
    assert found.points.tolist() == POINTS[kept].tolist()
    assert found.labels.tolist() == (np.array(kept) + 1).tolist()


def test_the_range_is_measured_from_the_camera():
    cloud = PointCloud(POINTS, camera=np.array([0.0, 0, 3]))
    assert inside(cloud, Region(max_range=0.1)).points.tolist() == [[0, 0, 3]]


def test_without_limits_the_cloud_is_the_same():
    cloud = PointCloud(POINTS)
    assert inside(cloud, Region()) is cloud


def test_an_empty_region_says_where_the_cloud_is():
    with pytest.raises(InputError, match=r"holds no point of the cloud, which spans x 0.00 to 0.50"):
        inside(PointCloud(POINTS), Region(max_range=0.5))


@pytest.mark.parametrize(
    "bad",
    [
        {"roi": (1, 0, 0, 1, 0, 1)},
        {"roi": (0, 1, 0, 1, 0)},
        {"roi": (0, 1, 0, np.nan, 0, 1)},
        {"max_range": 0.0},
        {"max_range": np.nan},
    ],
)
def test_a_region_that_cannot_be_is_refused(bad):
    with pytest.raises(InputError, match=next(iter(bad))):
        Region(**bad)


def test_too_many_objects_stop_with_one_line(monkeypatch):
    rng = np.random.default_rng(1)
    table = rng.uniform([0, 0, 0], [1, 1, 0], (20_000, 3))
    block = rng.uniform([0, 0, 0], [0.04, 0.04, 0.06], (500, 3))
    blocks = [block + np.array([0.05 + 0.1 * i, 0.05 + 0.1 * j, 0]) for i in range(4) for j in range(3)]
    cloud = PointCloud(np.concatenate([table, *blocks]))
    clusters = SegmentationSettings(method="clusters")
    assert len(segmented_scene(cloud, "z", clusters).cloud.objects) == 12
    monkeypatch.setattr("lifelore.perception.segmentation.table_frame.MAX_OBJECTS", 11)
    with pytest.raises(InputError, match=r"cut into 12 objects, but at most 11 .*--roi, --max-range"):
        segmented_scene(cloud, "z", clusters)


CAMERA = np.array([0.5, -0.8, 0.9])


def sheet(low, high, spacing=0.005):
    """Points on a level or upright rectangle, or in a box of no thickness along one axis."""
    steps = [np.arange(a, b + spacing / 2, spacing) for a, b in zip(low, high, strict=True)]
    return np.stack(np.meshgrid(*steps, indexing="ij"), -1).reshape(-1, 3)


def box_faces(low, high):
    """The front and the top of a box, as a camera at `CAMERA` sees them."""
    front = sheet(low, (high[0], low[1], high[2]))
    return np.concatenate([front, sheet((low[0], low[1], high[2]), high)])


@pytest.mark.parametrize("back", [0.65, 0.70, 0.80])
def test_an_object_beyond_the_visible_table_keeps_its_points_and_a_wall_stays_out(back):
    """A box hides the end of the table: its top reaches beyond what is visible, as far as `back` says."""
    table, box = sheet((0, 0, 0), (1, 0.6, 0)), box_faces((0.4, 0.55, 0), (0.6, back, 0.12))
    wall = sheet((0, 0.9, -0.5), (1, 0.9, 0.5))
    rng = np.random.default_rng(3)
    parts = [table, box, wall, box_faces((0.1, 0.2, 0), (0.2, 0.3, 0.1))]
    points = np.concatenate(parts)
    cloud = PointCloud(points + rng.normal(0, 0.001, points.shape), camera=CAMERA)
    of_table, of_box, of_wall, _ = np.split(
        segmented_scene(cloud).cloud.labels, np.cumsum([len(part) for part in parts])[:-1]
    )
    label = np.bincount(of_box).argmax()
    assert label > 1
    # Below 10 mm, a twelfth of the front counts as table.
    assert np.mean(of_box == label) > 0.9
    assert (of_wall == 0).all()
    assert np.mean(of_table == 1) > 0.95


def test_furniture_beside_the_table_is_no_object():
    """A chair's back 1 cm behind the table's end is linked to a box, but stands beside the table."""
    table, box = sheet((0, 0, 0), (1, 0.6, 0)), box_faces((0.4, 0.45, 0), (0.6, 0.6, 0.12))
    chair = sheet((0.3, 0.61, -0.3), (0.7, 0.61, 0.4))
    rng = np.random.default_rng(3)
    points = np.concatenate([table, box, chair])
    cloud = PointCloud(points + rng.normal(0, 0.001, points.shape), camera=CAMERA)
    labels = segmented_scene(cloud).cloud.labels
    assert labels.max() == 2
    assert np.mean(labels[-len(chair) :] == 0) > 0.95


def test_an_object_stands_where_the_table_is_not_seen_unless_the_camera_sees_through_its_plane_beside_it():
    # A block beyond the end of the visible table. A floor 0.7 m below is seen past it, where no table can be.
    table = face((-0.4, -0.4, 0), (0.5, 0, 0), (0, 0.8, 0))
    thing = block(0.15, 0.0, 0.1, 0.1, 0.12)
    points = np.concatenate([table, thing[thing[:, 2] > TABLE_BAND]])
    camera = np.array([0.2, -0.6, 0.7])
    floor = face((0.0, 0.3, -0.7), (0.8, 0, 0), (0, 0.9, 0))
    places = empty_places(floor, np.full(len(floor), TABLE_BAND), camera)
    assert np.allclose(places[0], [0.1, -0.15])  # half way between the camera and the floor's corner

    def n_objects(empty):
        return cut_cloud(points, None, SegmentationSettings(), camera, empty).labels.max() - 1

    assert n_objects(np.empty((0, 2))) == 1
    assert n_objects(places) == 0
