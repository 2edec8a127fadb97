"""Near pairs of objects and their visible gaps: boxes first, then the closest points."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lifelore.core.compiled.jit import kernel
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.perception.clouds.cell_cloud import CellCloud, cell_cloud, closest_distances
from lifelore.perception.clouds.voxel import box_of
from lifelore.perception.contacts.object_shape import ObjectShape, shape_of

CLOSEST = 5
"""Number of smallest distances in the mean gap; more make it robust to stray points, and larger."""


@dataclass(frozen=True, eq=False)
class ObjectCloud:
    """The points of one object, ``(k, 3)`` float64 metres, with its box."""

    label: int
    points: NDArray[np.float64]

    @cached_property
    def box(self) -> NDArray[np.float64]:
        """Least and greatest corner, ``(2, 3)``."""
        return box_of(self.points)

    @property
    def low(self) -> NDArray[np.float64]:
        """The box's least corner, ``(3,)``."""
        return self.box[0]

    @property
    def high(self) -> NDArray[np.float64]:
        """The box's greatest corner, ``(3,)``."""
        return self.box[1]

    @cached_property
    def shape(self) -> ObjectShape:
        """Foot, top and outline."""
        return shape_of(self.points)

    @cached_property
    def cells(self) -> CellCloud:
        """The points sorted into cells, for distances."""
        return cell_cloud(self.points)

    def within(self, low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
        """The points inside a box, ``(m, 3)``."""
        return self.points[_rows_within(self.points, low, high)]


@dataclass(frozen=True, eq=False)
class NearPair:
    """Two objects (or an object and the piece of table around it) and their `visible_gap` in metres."""

    first: ObjectCloud
    second: ObjectCloud
    gap: float


@kernel
def _rows_within(
    points: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]
) -> NDArray[np.int64]:
    """The rows of the points inside a box, ascending.

    One pass, because the table is large and searched for every object.
    """
    rows = np.empty(len(points), np.int64)
    count = 0
    for i in range(len(points)):
        inside = True
        for axis in range(3):
            inside = inside and low[axis] <= points[i, axis] <= high[axis]
        if inside:
            rows[count] = i
            count += 1
    return rows[:count]


def split_objects(cloud: LabelledCloud) -> dict[int, ObjectCloud]:
    """Every labelled object, and the table where there is one, by label, ascending."""
    if not len(cloud.labels):
        return {}
    order = np.argsort(cloud.labels, kind="stable")
    labels, starts = np.unique(cloud.labels[order], return_index=True)
    parts = np.split(cloud.points[order], starts[1:])
    return {int(n): ObjectCloud(int(n), part) for n, part in zip(labels, parts, strict=True) if n >= TABLE}


def near_pairs(objects: dict[int, ObjectCloud], near: float, table_margin: float) -> list[NearPair]:
    """Pairs whose gap is at most `near`: objects (a < b) in order; then every object with the table around it.

    The table is near at any gap, because an object's foot may be hidden.

    Parameters
    ----------
    objects : dict of int to ObjectCloud
        From `split_objects`.
    near : float
        Metres.
    table_margin : float
        Width of the strip of table around an object's box, metres.
    """
    bodies = [body for label, body in objects.items() if label != TABLE]
    pairs = [_near(a, b, near) for i, a in enumerate(bodies) for b in bodies[i + 1 :]]
    if TABLE in objects:
        table_cloud = objects[TABLE]
        pairs += [_standing(body, _around(table_cloud, body, table_margin), near) for body in bodies]
    return [pair for pair in pairs if pair is not None]


def _around(table: ObjectCloud, body: ObjectCloud, margin: float) -> ObjectCloud:
    """The strip of table around an object, widened where objects in front hide all of it."""
    far = max(box_distance(table, body), float((table.high - table.low).max()))
    while True:
        low, high = body.low - margin, body.high + margin
        low[2], high[2] = -np.inf, np.inf
        piece = table.within(low, high)
        if len(piece) >= CLOSEST or margin > far:
            return ObjectCloud(TABLE, piece if len(piece) else table.points)
        margin *= 2


def _near(first: ObjectCloud, second: ObjectCloud, near: float) -> NearPair | None:
    if not len(second.points) or box_distance(first, second) > near:
        return None
    gap = visible_gap(first, second, near)
    return NearPair(first, second, gap) if gap <= near else None


def _standing(body: ObjectCloud, table: ObjectCloud, near: float) -> NearPair:
    while not np.isfinite(gap := visible_gap(body, table, near)):
        near *= 2
    return NearPair(body, table, gap)


def box_distance(first: ObjectCloud, second: ObjectCloud) -> float:
    """Distance between two boxes, 0 where they overlap, metres."""
    between = np.maximum(first.low - second.high, second.low - first.high)
    return float(np.linalg.norm(np.maximum(between, 0.0)))


def visible_gap(first: ObjectCloud, second: ObjectCloud, near: float) -> float:
    """Visible gap, metres; infinity where no distance is within `near`, a bound on the search.

    In each direction, the mean of the up to `CLOSEST` smallest distances from a point of the cloud to the nearest
    point of the other, of those within `near`; the gap is the larger mean. So the order of the clouds does not
    matter, and a stray point of either moves the gap by a fifth of its way at most.
    """
    there = closest_distances(first.cells, second.cells, CLOSEST, near)
    back = closest_distances(second.cells, first.cells, CLOSEST, near)
    return float(max(there.mean(), back.mean())) if there.size else np.inf
