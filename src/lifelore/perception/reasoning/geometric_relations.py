"""`between` and `in` by the points: definitions beside the thesis's, which the relations alone cannot give (E14).

*enclosed between*: b touches or nearly touches a and c, and they lie on opposite sides of it: seen from above, the
directions in which b's contact points face a and c are at least `OPPOSITE` apart.

*contained*: walls of b stand around a. Seen from above, from the middle of a, b stands beyond a's own reach, at
heights between `WALL` above a's lowest point and its highest, in at least `SURROUNDED` of the directions. A
leaning plank and a block on the foot of an L fail this; a ball in a bowl passes although it is not adjacent to
anything.

Thesis: §5.2 proposes between = two adjacents, and in = on with adjacent. §2.2 cites Sjöö (2011) for containment by
the convex hull, which a block on the foot of an L would pass.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE
from lifelore.core.relations import ADJACENT, BOTH
from lifelore.perception.reasoning.fact import Fact
from lifelore.perception.scene import Scene

OPPOSITE = np.deg2rad(120.0)
"""Nearer to opposite (180°) than to a corner (90°), with room for the noise of a contact's direction."""

DIRECTIONS = 24
WALL = 0.01
"""Metres. Clear of the noise of the floor that a stands on."""

SURROUNDED = 0.75
"""Three walls of a square: an open drawer contains, two walls of a corner do not."""


def geometric_relations(scene: Scene) -> tuple[Fact, ...]:
    """All facts ``enclosed_between(b, a, c)`` (a before c) and ``contained(a, b)`` of a scene, sorted."""
    return tuple(sorted([*_enclosed(scene), *_contained(scene)]))


def _enclosed(scene: Scene) -> list[Fact]:
    beside = {frozenset((r.a, r.b)) for r in scene.relations if r.relation in (ADJACENT, BOTH)}
    facts = []
    for b in scene.objects:
        sides = [(a, _bearing(scene, b, a)) for a in scene.objects if frozenset((a, b)) in beside]
        known = [(a, bearing) for a, bearing in sides if bearing is not None]
        for number, (a, towards_a) in enumerate(known):
            for c, towards_c in known[number + 1 :]:
                if np.arccos(np.clip(towards_a @ towards_c, -1, 1)) >= OPPOSITE:
                    facts.append(Fact("enclosed_between", (b, a, c)))
    return facts


def _bearing(scene: Scene, b: int, other: int) -> NDArray[np.float64] | None:
    """Horizontal unit vector in which b's contact points face `other`, by their strength; None without any."""
    contacts = [node for node in scene.networks[b].nodes if node.other == other]
    # A contact's normal points into b, so the other object lies against it.
    towards = -sum((node.strength * node.normal[:2] for node in contacts), np.zeros(2))
    length = float(np.linalg.norm(towards))
    return towards / length if length > 0 else None


def _contained(scene: Scene) -> list[Fact]:
    points_of = cache(scene.cloud.of)
    pairs = [(i.a, i.b) for i in scene.interfaces if TABLE not in (i.a, i.b)]
    ordered = [step for a, b in pairs for step in ((a, b), (b, a))]
    return [
        Fact("contained", (a, b)) for a, b in ordered if surrounded_share(points_of(a), points_of(b)) >= SURROUNDED
    ]


def surrounded_share(inner: NDArray[np.float64], outer: NDArray[np.float64]) -> float:
    """Share of the horizontal directions, from the middle of `inner`, in which `outer` stands around it.

    Parameters
    ----------
    inner, outer : (n, 3), (m, 3) float64
        Clouds in the scene frame, metres, n ≥ 1.

    Returns
    -------
    float
        In [0, 1], in steps of 1 / `DIRECTIONS`. Lowest and highest are the 1 % and 99 % quantiles.
    """
    middle = (inner[:, :2].min(axis=0) + inner[:, :2].max(axis=0)) / 2
    low, high = np.quantile(inner[:, 2], [0.01, 0.99])
    walls = outer[(outer[:, 2] >= low + WALL) & (outer[:, 2] <= high)]
    reach, beyond = _reach(inner[:, :2] - middle), _reach(walls[:, :2] - middle)
    return float(((beyond > 0) & (beyond >= reach)).mean())


def _reach(offsets: NDArray[np.float64]) -> NDArray[np.float64]:
    """Farthest of the points (n, 2) in each direction, shape ``(DIRECTIONS,)``; 0 where there is none."""
    turn = np.arctan2(offsets[:, 1], offsets[:, 0]) / (2 * np.pi) % 1.0
    reach = np.zeros(DIRECTIONS)
    np.maximum.at(reach, (turn * DIRECTIONS).astype(np.int64) % DIRECTIONS, np.hypot(*offsets.T))
    return reach
