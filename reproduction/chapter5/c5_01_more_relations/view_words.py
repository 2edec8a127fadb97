"""Definitions of words of space: geometry of true shapes, some of it as the camera sees it (claim C5.1).

Of a pair of objects seen by a camera, *away* is the horizontal direction from the camera to the middle between
them, *right* its right hand. An object's place is the middle of its extent along both.

Each word holds of a and b when

- ``right_of``: they stand side by side, and from b's place to a's is within 60° of right;
- ``left_of``, ``behind``, ``in_front_of``: the same of left, away, and towards the camera;
- ``under``: seen from above they share at least a quarter of the smaller one's outline, a's middle is the lower,
  and they do not stand side by side;
- ``dwarfs``: they stand side by side and a reaches at least twice as high as b: a word that a user made up;
- ``between`` (b; a, c): b stands side by side with both and near both; seen from above the way from a's place to
  c's crosses b's outline, and b sees them at least 120° apart;
- ``in`` (a; b): a reaches at least 10 mm below b's top, so that no lid is in its pot; half way up from a's lowest
  point to the lower of the two tops, b stands around a's place, and farther out than a itself, in at least three
  quarters of the horizontal directions; and a's place is not within b itself.

*Side by side*: their heights overlap by at least half of the lower object's. Sectors of 60° to either side
overlap, so that an object may be ``behind`` and ``right_of`` at once, and every pair side by side has a word.
Thesis: §2.4.1, §5.2.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import ConvexHull

from lifelore.core.relations import NONE, PairLabel

SECTOR = np.deg2rad(60.0)
SHARED, BESIDE, TWICE = 0.25, 0.5, 2.0
OPPOSITE = np.deg2rad(120.0)
AROUND, SURROUNDED, DEPTH = 24, 0.75, 0.01
VIEW_WORDS = ("left_of", "right_of", "in_front_of", "behind")
USER_WORD = "dwarfs"
WORDS = ("under", *VIEW_WORDS, USER_WORD)
_STEPS = 32
Points = NDArray[np.float64]


def words_of_pair(a: int, b: int, first: Points, second: Points, camera: Points) -> list[PairLabel]:
    """All words of a pair in both orders; *none* where no word holds.

    Parameters
    ----------
    first, second : (n, 3), (m, 3) float64
        Points whose convex hull is a, and b; metres, z up.
    camera : (3,) float64
    """
    forward = [PairLabel(a, b, word) for word in words(first, second, camera)]
    backward = [PairLabel(b, a, word) for word in words(second, first, camera)]
    return forward + backward or [PairLabel(a, b, NONE)]


def words(a: Points, b: Points, camera: Points) -> list[str]:
    """The words that hold of (a, b), in the order of `WORDS`."""
    if not side_by_side(a, b):
        lower = _middle(a[:, 2]) < _middle(b[:, 2])
        return ["under"] if lower and shared_outline(a, b) >= SHARED else []
    to_right, to_back = offset(a, b, camera)
    turn = np.arctan2(to_back, to_right)
    towards = {"left_of": np.pi, "right_of": 0.0, "in_front_of": -np.pi / 2, "behind": np.pi / 2}
    found = [word for word in VIEW_WORDS if abs(_wrapped(turn - towards[word])) <= SECTOR]
    return [*found, USER_WORD] if a[:, 2].max() >= TWICE * b[:, 2].max() else found


def offset(a: Points, b: Points, camera: Points) -> tuple[float, float]:
    """How far a lies to the right of b, and how far behind it, metres."""
    places = [np.array([_middle(points[:, 0]), _middle(points[:, 1])]) for points in (a, b)]
    away = (places[0] + places[1]) / 2 - camera[:2]
    away = away / max(float(np.hypot(*away)), 1e-9)
    axes = np.array([[away[1], -away[0]], away])
    first, second = ([_middle(points[:, :2] @ axis) for axis in axes] for points in (a, b))
    return first[0] - second[0], first[1] - second[1]


def side_by_side(a: Points, b: Points) -> bool:
    """Whether their heights overlap by at least half of the lower object's."""
    overlap = min(a[:, 2].max(), b[:, 2].max()) - max(a[:, 2].min(), b[:, 2].min())
    return bool(overlap >= BESIDE * min(np.ptp(a[:, 2]), np.ptp(b[:, 2])))


def shared_outline(a: Points, b: Points) -> float:
    """Share of the smaller outline, seen from above, that lies within the other; convex outlines."""
    small, large = sorted((ConvexHull(points[:, :2]) for points in (a, b)), key=lambda hull: hull.volume)
    low, high = small.min_bound, small.max_bound
    steps = (np.arange(_STEPS) + 0.5) / _STEPS
    grid = low + (high - low) * np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    inside = _within(small, grid)
    return float((inside & _within(large, grid)).sum() / max(inside.sum(), 1))


def is_between(b: Points, a: Points, c: Points) -> bool:
    """Whether b stands between a and c, which are near it."""
    if not (side_by_side(a, b) and side_by_side(c, b)):
        return False
    at = [np.array([_middle(points[:, 0]), _middle(points[:, 1])]) for points in (a, b, c)]
    to_a, to_c = at[0] - at[1], at[2] - at[1]
    lengths = float(np.linalg.norm(to_a) * np.linalg.norm(to_c))
    if lengths < 1e-12 or np.arccos(np.clip(to_a @ to_c / lengths, -1, 1)) < OPPOSITE:
        return False
    way = at[0] + np.linspace(0, 1, 8 * _STEPS)[:, None] * (at[2] - at[0])
    return bool(_within(ConvexHull(b[:, :2]), way).any())


def is_in(a: Points, parts: Sequence[Points]) -> bool:
    """Whether a is in an object made of convex `parts`, each points ``(n, 3)``."""
    low, top = a[:, 2].min(), min(a[:, 2].max(), max(part[:, 2].max() for part in parts))
    if top - low < DEPTH:
        return False
    start = np.array([_middle(a[:, 0]), _middle(a[:, 1]), (low + top) / 2])
    turns = 2 * np.pi * np.arange(AROUND) / AROUND
    rays = np.column_stack([np.cos(turns), np.sin(turns), np.zeros(AROUND)])
    beyond = np.zeros(AROUND)
    for hull in (ConvexHull(part, qhull_options="QJ") for part in parts):
        if _within(hull, start[None])[0]:
            return False  # a place inside the material is no hollow: a cup is not in its ball
        beyond = np.maximum(beyond, _exits(hull, start, rays))
    reach = _exits(ConvexHull(a, qhull_options="QJ"), start, rays)
    return bool(((beyond > 0) & (beyond >= reach)).mean() >= SURROUNDED)


def _exits(hull: ConvexHull, start: Points, rays: Points) -> NDArray[np.float64]:
    """How far along each ray from `start` it leaves a convex body, metres; 0 where it never meets it.

    What a body has of a ray is the stretch left when every face has cut it.
    """
    distance = hull.equations[:, :-1] @ start + hull.equations[:, -1]
    speed = rays @ hull.equations[:, :-1].T
    with np.errstate(divide="ignore", invalid="ignore"):
        at = -distance / speed
    near = np.where(speed < 0, at, 0.0).max(axis=1)
    far = np.where(speed > 0, at, np.inf).min(axis=1)
    passes_by = ((np.abs(speed) < 1e-12) & (distance > 0)).any(axis=1)
    return np.where((near <= far) & ~passes_by, far, 0.0)


def _within(hull: ConvexHull, points: Points) -> NDArray[np.bool_]:
    beyond = points @ hull.equations[:, :-1].T + hull.equations[:, -1]
    return np.asarray((beyond <= 1e-12).all(axis=1), np.bool_)


def _middle(values: NDArray[np.float64]) -> float:
    return float(values.min() + values.max()) / 2


def _wrapped(angle: float) -> float:
    """The same angle in [-π, π)."""
    return float((angle + np.pi) % (2 * np.pi) - np.pi)
