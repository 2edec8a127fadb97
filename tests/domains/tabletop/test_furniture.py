"""Rays that meet boards: distances and normals worked by hand, and against a slow march along the ray."""

import numpy as np
import pytest

from lifelore.domains.tabletop.furniture import Board, cast_boards, standing_table

EYE = np.array([0.0, -2.0, 0.5])


def test_the_nearest_board_with_its_face():
    wall = Board("wall", (0, 1, 0), (3, 0.1, 3))
    box = Board("box", (0.5, 0, 0.5), (0.1, 0.1, 0.2))
    rays = np.array([[0.0, 1, 0], [0.5 / 1.9, 1, 0], [0, -1, 0]])
    number, along, normal = cast_boards([wall, box], EYE, rays)
    assert number.tolist() == [0, 1, -1]
    assert along == pytest.approx([2.9, 1.9, np.inf])
    assert normal.tolist() == [[0, -1, 0], [0, -1, 0], [0, 0, 0]]


def test_turned_boards_against_a_march_along_the_ray():
    boards = [Board("a", (0.1, 0, 0.4), (0.3, 0.2, 0.1), 0.7), Board("b", (-0.4, 0.5, 0.6), (0.2, 0.2, 0.3), -0.3)]
    rays = np.random.default_rng(1).normal([0, 1, 0], [0.2, 0.05, 0.15], (300, 3))
    number, along, _ = cast_boards(boards, EYE, rays)
    steps, grazes = np.arange(0, 4, 0.002), 0
    for ray, met, distance in zip(rays, number, along, strict=True):
        places = EYE + steps[:, None] * ray
        first = [np.inf, np.inf]
        for k, board in enumerate(boards):
            c, s = np.cos(board.yaw), np.sin(board.yaw)
            local = (places - board.middle) @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
            within = (np.abs(local) <= board.half).all(axis=1)
            if within.any():
                first[k] = steps[within.argmax()]
        if min(first) < np.inf:
            assert distance <= min(first) <= distance + 0.002 + 1e-9
            assert met == int(np.argmin(first)) or abs(first[0] - first[1]) <= 0.002
        else:
            grazes += met >= 0
    assert grazes < 5  # a way through a corner that is shorter than a step escapes the march


def test_a_table_stands_on_its_floor():
    top, *legs = standing_table("table", 1.0, 2.0, 0.0, -0.7, (0.5, 0.3), 0.4, 0.03)
    assert top.middle[2] + top.half[2] == pytest.approx(0)
    assert len(legs) == 4
    for leg in legs:
        assert leg.middle[2] - leg.half[2] == pytest.approx(-0.7)
        assert leg.middle[2] + leg.half[2] == pytest.approx(-0.03)
        assert np.hypot(leg.middle[0] - 1, leg.middle[1] - 2) < np.hypot(0.5, 0.3)
