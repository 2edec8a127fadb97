"""Objects that cannot rest on the table: they begin above it, and the support or the air below them is seen.

An object whose foot is hidden may reach down to the table, so its raised visible foot alone proves nothing. The
object is not on the table where the top of another object ends right below it, or where the camera sees past its
bottom edge to something farther away.
"""

from collections.abc import Iterable, Iterator, Mapping
from math import inf

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import NONE, ON
from lifelore.perception.clouds.view_image import ViewImage
from lifelore.perception.contacts.object_shape import DIRECTIONS, ObjectShape, shape_of
from lifelore.perception.relations.relation import PairBelief

RAISED = 0.05
"""Metres above the table from which an object is raised; more than the noise and the shadow of a foot."""
GAP = 0.035
"""Metres between a raised foot and the top below it."""
UNDER = 0.25
"""Least share of the object's low points over the outline of what is below it, grown by `BESIDE`."""
BESIDE = 0.025
"""Metres by which an object may stand over the visible part of what carries it."""
PIXEL = 0.006
"""Radians; three points of a Kinect, so that a surface has no gaps in it."""
BEHIND = 0.04
"""Metres by which a point must be farther than the bottom edge to be behind it."""
EDGE_SEEN = 0.7
"""Least share of the bottom edge below which something farther is seen."""
STILL = 0.1
"""Probability that a raised object rests on the table after all."""


def off_the_table(
    beliefs: Iterable[PairBelief], cloud: LabelledCloud, shapes: Mapping[int, ObjectShape] | None = None
) -> tuple[PairBelief, ...]:
    """The beliefs of the pairs of a scene, in which raised objects do not rest on the table.

    `cloud` and `shapes` are those of `raised_objects`.
    """
    beliefs = tuple(beliefs)
    raised = raised_objects(cloud, shapes)
    gaps = {belief.a + belief.b - TABLE: belief.gap for belief in beliefs if TABLE in (belief.a, belief.b)}
    others = (b for b in beliefs if not (TABLE in (b.a, b.b) and b.a + b.b - TABLE in raised))
    shares = {NONE: 1 - STILL, ON: STILL}
    return (*others, *(PairBelief(label, TABLE, gaps.get(label, inf), shares) for label in sorted(raised)))


def raised_objects(cloud: LabelledCloud, shapes: Mapping[int, ObjectShape] | None = None) -> frozenset[int]:
    """Objects of a scene that cannot rest on the table.

    Parameters
    ----------
    cloud : LabelledCloud
        In the scene's frame: z up, the table at z = 0.
    shapes : mapping of int to ObjectShape, optional
        Of each object, where they are known.
    """
    if shapes is None:
        shapes = {label: shape_of(cloud.of(label)) for label in cloud.objects}
    high = [label for label, shape in shapes.items() if shape.foot >= RAISED]
    raised = {label for label in high if any(_tops_below(label, shapes))}
    unsupported = [label for label in high if label not in raised]
    if unsupported and cloud.camera is not None:
        view = ViewImage(cloud.points - cloud.camera, PIXEL)
        raised |= {label for label in unsupported if _edge_seen(view, cloud.labels == label) >= EDGE_SEEN}
    return frozenset(raised)


def _tops_below(label: int, shapes: Mapping[int, ObjectShape]) -> Iterator[bool]:
    """For each other object, whether its top ends right below the foot of `label`, under its low points."""
    shape = shapes[label]
    for other, below in shapes.items():
        if other != label and -GAP <= below.top - shape.foot <= GAP / 2 and below.foot < shape.foot - GAP:
            within = shape.sample[shape.low, :2] @ DIRECTIONS <= below.outline + BESIDE
            yield bool(within.all(axis=1).mean() >= UNDER)


def _edge_seen(view: ViewImage, own: NDArray[np.bool_]) -> float:
    """Share of the columns of the image of an object's `own` points (n,) in which something farther is seen right
    below it, 0 to 1."""
    wins = (view.depths == view.nearest[view.at]) & own
    seen, depths = np.zeros(len(view.nearest), bool), view.nearest.reshape(view.shape)
    seen[view.at[wins]] = True
    seen = seen.reshape(view.shape)
    columns = np.flatnonzero(seen.any(axis=1))
    lowest = seen[columns].argmax(axis=1)
    behind = np.zeros(len(columns), bool)
    for step in (1, 2):
        below = depths[columns, np.maximum(lowest - step, 0)]
        behind |= (below > depths[columns, lowest] + BEHIND) & np.isfinite(below) & (lowest >= step)
    return float(behind.mean()) if len(columns) else 0.0
