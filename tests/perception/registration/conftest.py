"""A table of 0.8 m with blocks on it, as points of all their tops and sides."""

from collections.abc import Callable

import numpy as np
import pytest

from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.registration.tabletop_view import TabletopView, tabletop_view

STEP = 0.003
BLOCKS = ((-0.12, -0.06, 0.10, 0.05, 0.08), (0.04, -0.02, 0.06, 0.06, 0.15), (-0.02, 0.10, 0.16, 0.04, 0.05))
"""Corner x, y, and length, width and height of each block, metres; no turn lays them on themselves."""
Blocks = tuple[tuple[float, float, float, float, float], ...]


def grid(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    return np.stack(np.meshgrid(first, second, indexing="ij"), axis=-1).reshape(-1, 2)


def block_points(x: float, y: float, length: float, width: float, height: float) -> np.ndarray:
    across, along = np.arange(x, x + length, STEP), np.arange(y, y + width, STEP)
    up = np.arange(STEP, height, STEP)
    top = np.column_stack([grid(across, along), np.full(len(across) * len(along), height)])
    faces = [np.insert(grid(along, up), 0, side, axis=1) for side in (x, x + length)]
    faces += [np.insert(grid(across, up), 1, side, axis=1) for side in (y, y + width)]
    return np.concatenate([top, *faces])


def cloud_of(blocks: Blocks, motion: np.ndarray) -> PointCloud:
    """The cloud of a camera 0.9 m above the table, in whose frame the table lies after `motion`."""
    flat = grid(np.arange(-0.4, 0.4, STEP), np.arange(-0.4, 0.4, STEP))
    for x, y, length, width, _ in blocks:
        flat = flat[~((flat >= (x, y)) & (flat <= (x + length, y + width))).all(axis=1)]
    points = np.concatenate([np.insert(flat, 2, 0.0, axis=1), *(block_points(*block) for block in blocks)])
    camera = np.array([0.0, -0.3, 0.9])
    return PointCloud(points @ motion[:3, :3].T + motion[:3, 3], camera=motion[:3, :3] @ camera + motion[:3, 3])


@pytest.fixture(scope="session")
def blocks_seen() -> Callable[..., TabletopView]:
    """``blocks_seen(motion, blocks)``: a view of blocks; `motion` (4, 4) maps the table's frame to the view's."""

    def seen(motion: np.ndarray | None = None, blocks: Blocks = BLOCKS) -> TabletopView:
        return tabletop_view(cloud_of(blocks, np.eye(4) if motion is None else motion))

    return seen
