"""Outlines on paths: contacts worked by hand, and dense samples of the outline on the paths that are found."""

from itertools import pairwise

import numpy as np
import pytest

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains import OccupancyMap, building_from_map, floor_of, office_map
from lifelore.domains.buildings.floor import Floor
from lifelore.domains.buildings.footprint import Footprint, footprint_path
from lifelore.domains.buildings.occupancy_map import FREE, OCCUPIED

LONG = [[0.6, 0.2], [0.6, -0.2], [-0.3, -0.2], [-0.3, 0.2]]


def floor_with(door: slice, yaw: float = 0.0) -> Floor:
    """Two rooms of 4 x 6 m in pixels of 0.05 m; the wall between them lies at x = 4.0 m and has a door."""
    state = np.zeros((120, 160), np.uint8)
    state[[0, -1]] = state[:, [0, -1]] = state[:, 80] = OCCUPIED
    state[door, 80] = FREE
    occupancy = OccupancyMap(state, 0.05, (0.0, 0.0, yaw))
    return floor_of(occupancy, building_from_map(occupancy, 0.5, 0.15))


def touches(solid: np.ndarray, corners: np.ndarray, at: np.ndarray, heading: float) -> bool:
    """Whether the centre of a solid pixel lies in the outline, by the sign of its side of each edge."""
    cos, sin = np.cos(heading), np.sin(heading)
    x, y = (corners @ np.array([[cos, sin], [-sin, cos]]) + at).T
    solid = solid[np.hypot(*(solid - at).T) < 1.0]
    sides = np.column_stack(
        [
            (x[k - 1] - x[k]) * (solid[:, 1] - y[k]) - (y[k - 1] - y[k]) * (solid[:, 0] - x[k])
            for k in range(len(x))
        ]
    )
    return bool((np.sign(sides) == np.sign(sides[:, :1])).all(axis=1).any())


def assert_free(floor: Floor, path: np.ndarray, footprint: Footprint) -> None:
    solid = floor.metres(np.argwhere(floor.solid))
    headings = [np.arctan2(*(b - a)[::-1]) for a, b in pairwise(path)]
    for k, (a, b) in enumerate(pairwise(path)):
        solid_near = solid[np.hypot(*(solid - (a + b) / 2).T) < np.hypot(*(b - a)) / 2 + 1]
        for t in np.linspace(0, 1, 40):
            assert not touches(solid_near, footprint.corners, a + t * (b - a), headings[k])
        turn = (headings[k] - headings[k - 1] + np.pi) % (2 * np.pi) - np.pi if k else 0.0
        for t in np.linspace(0, 1, 20):
            assert not touches(solid_near, footprint.corners, a, headings[k] - t * turn)


def test_an_outline_drives_as_close_as_its_side_and_turns_as_close_as_its_corners():
    floor, outline = floor_with(slice(0)), Footprint(LONG)
    along = np.array([[1.0, 0.275], [3.0, 0.275]])  # the wall's pixel centres lie at y = 0.025 m
    assert outline.first_contact(floor, along) is None
    assert outline.first_contact(floor, np.array([[1.0, 0.249], [3.0, 0.249]])).tolist() == [3.0, 0.249]
    ahead = np.array([[1.0, 2.0], [3.35, 2.0]])  # the wall at x = 4.025 m, the front at 3.95 m
    assert outline.first_contact(floor, ahead) is None
    assert outline.first_contact(floor, np.array([[1.0, 2.0], [3.41, 2.0]])).tolist() == [3.41, 2.0]
    # To turn about a corner, the front corner needs √(0.6² + 0.2²) = 0.63 m.
    assert outline.first_contact(floor, np.array([[2.0, 3.0], [2.0, 0.72], [1.0, 0.73]])) is None
    assert outline.first_contact(floor, np.array([[1.0, 0.5], [2.0, 0.5], [2.0, 2.0], [2.1, 3.0]])) is None
    back = np.array([[3.0, 0.4], [2.0, 0.4], [2.9, 0.41]])
    assert outline.first_contact(floor, back).tolist() == [2.0, 0.4]


def test_a_path_with_contacts_is_searched_again_with_more_clearance():
    floor, outline = floor_with(slice(20, 60), yaw=0.4), Footprint(LONG)
    ends = floor.metres([[100, 20], [100, 140]])
    path = footprint_path(floor, *ends, outline)
    assert_free(floor, path, outline)
    disc = footprint_path(floor, *ends, Footprint(0.2 * np.column_stack([np.cos(range(6)), np.sin(range(6))])))
    length, shortest = (np.hypot(*np.diff(each, axis=0).T).sum() for each in (path, disc))
    assert shortest < length < 1.2 * shortest


@pytest.mark.parametrize("seed", range(1))
def test_outlines_are_free_on_paths_in_offices(seed):
    occupancy = office_map(seed)
    world = building_from_map(occupancy, 0.5, 0.2)
    floor, outline = (
        floor_of(occupancy, world),
        Footprint([[0.35, 0.22], [0.35, -0.22], [-0.25, -0.22], [-0.25, 0.22]]),
    )
    roomy = np.flatnonzero(floor.distance[tuple(floor.anchors.T)] * occupancy.resolution > 0.6)
    for pair in np.random.default_rng(seed).choice(roomy, (4, 2)):
        assert_free(floor, footprint_path(floor, *floor.metres(floor.anchors[pair]), outline), outline)


def test_an_outline_that_does_not_fit_at_an_end_is_refused_at_once():
    """As in centimetres in place of metres: no search over a floor that is all too narrow."""
    floor = floor_with(slice(20, 60))
    with pytest.raises(
        NotFoundError, match=r"no room for the outline at 2\.00,3\.00: its inscribed circle has 20 m"
    ):
        footprint_path(floor, (2.0, 3.0), (6.0, 3.0), Footprint(np.array(LONG) * 100))


def test_a_door_that_is_too_narrow_is_refused():
    floor = floor_with(slice(60, 72))  # 0.6 m
    ends = floor.metres([[66, 20], [66, 140]])
    assert footprint_path(floor, *ends, Footprint(np.array(LONG) * [1, 0.9])) is not None
    with pytest.raises(
        NotFoundError, match="footprint: the outline touches an obstacle on every path that was tried"
    ):
        footprint_path(floor, *ends, Footprint(np.array(LONG) * [1, 1.6]))
    assert footprint_path(floor_with(slice(0)), (1.0, 1.0), (1.0, 2.0), Footprint(LONG)) is not None


@pytest.mark.parametrize(
    "text",
    [
        "disc",
        "[[1,1],[1,-1]]",
        "[[1,1],[2,1],[2,2]]",
        "[[1,1],[1,null],[0,0]]",
        "[[0,0,1],[1,0,0],[0,1,0],[1,1,2]]",
        "3",
    ],
)
def test_what_is_no_outline_is_refused(text):
    with pytest.raises(InputError, match=r"footprint must be three or more corners \[x, y\] in metres around"):
        Footprint.from_text(text)
