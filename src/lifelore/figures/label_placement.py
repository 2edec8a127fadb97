"""Labels on a picture: each close to its object, none upon another, off the marks where there is room.

Why not adjustText: on five real scenes its labels did not overlap either, but it covered a mark once and took 1.2
to 8 times as long.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

_RINGS, _ROUND, _SWEEPS, _PLACES = 14, 16, 3, 300
_OVERLAP, _OUTSIDE, _MARKED, _FOREIGN, _CROWDED = 1e3, 1e3, 2.0, 12.0, 5.0
"""What a fault costs, in label sizes from the anchor; overlap and what falls outside are all but forbidden."""
_ROOM = 3.5
"""Label sizes from centre to centre that leave room for an arrow between."""


def place_labels(
    anchors: ArrayLike,
    sizes: ArrayLike,
    bounds: tuple[float, float],
    *,
    marks: ArrayLike = (),
    grounds: NDArray[np.int64] | None = None,
    owners: Sequence[int] = (),
) -> NDArray[np.float64]:
    """Centres of the labels, ``(n, 2)``.

    Parameters
    ----------
    anchors : (n, 2)
        Where each label would best be.
    sizes : (n, 2)
        Width and height of each.
    bounds : (width, height)
        Of the picture; labels stay inside.
    marks : (m, 2), optional
        Points better left uncovered.
    grounds : (height, width) int64, optional
        What is drawn at each pixel; a label is better on its own object.
    owners : sequence of int
        The number in `grounds` of each label's object.
    """
    anchors, sizes = np.reshape(np.asarray(anchors, float), (-1, 2)), np.reshape(np.asarray(sizes, float), (-1, 2))
    marks = np.reshape(np.asarray(marks, float), (-1, 2))
    placed = anchors.copy()
    if not len(anchors):
        return placed
    candidates = [anchor + _candidates(size) for anchor, size in zip(anchors, sizes, strict=True)]
    if grounds is not None:
        candidates = [
            np.vstack([at, _within(grounds, owner)]) for at, owner in zip(candidates, owners, strict=True)
        ]
    costs = []
    for number, at in enumerate(candidates):
        cost = np.linalg.norm((at - anchors[number]) / sizes[number].mean(), axis=1)
        cost += _OUTSIDE * ((at < sizes[number] / 2) | (at > np.array(bounds) - sizes[number] / 2)).any(axis=1)
        cost += _MARKED * _covers(at, marks, sizes[number] / 2 + sizes[number].min() / 4).sum(axis=1)
        if grounds is not None:
            cost += _FOREIGN * (_ground(grounds, at) != owners[number])
        costs.append(cost)
    for _ in range(_SWEEPS):
        for number, at in enumerate(candidates):
            others = np.delete(np.arange(len(anchors)), number)
            reach = 1.1 * (sizes[others] + sizes[number]) / 2
            overlap = (np.abs(at[:, None] - placed[others]) < reach).all(axis=2).sum(axis=1)
            apart = np.linalg.norm(at[:, None] - placed[others], axis=2) / sizes[number].mean()
            crowded = np.clip(1 - apart / _ROOM, 0, None).sum(axis=1)
            placed[number] = at[np.argmin(costs[number] + _OVERLAP * overlap + _CROWDED * crowded)]
    return placed


def _candidates(size: NDArray[np.float64]) -> NDArray[np.float64]:
    """Offsets to try, ``(k, 2)``: the anchor itself, then rings about it."""
    turn = np.arange(_ROUND) * 2 * np.pi / _ROUND
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    rings = [radius * circle * size.mean() for radius in 0.5 * np.arange(1, _RINGS + 1)]
    return np.vstack([np.zeros((1, 2)), *rings])


def _within(grounds: NDArray[np.int64], owner: int) -> NDArray[np.float64]:
    """Places all over an object, so that one half hidden is found too."""
    seen = np.argwhere(grounds == owner)[:, ::-1].astype(float)
    return seen[:: -(-len(seen) // _PLACES) or 1]


def _covers(at: NDArray, marks: NDArray, reach: NDArray) -> NDArray[np.bool_]:
    return np.all(np.abs(at[:, None] - marks[None]) < reach, axis=2)


def _ground(grounds: NDArray[np.int64], at: NDArray) -> NDArray[np.int64]:
    height, width = grounds.shape
    column, row = np.clip(at.astype(int), 0, [width - 1, height - 1]).T
    return grounds[row, column]
