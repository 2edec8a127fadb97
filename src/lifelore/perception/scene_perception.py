"""`perceived_scene`: from labelled points to a consistent scene with relations (thesis §2.3, Algorithm 1)."""

from collections.abc import Sequence
from math import inf

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import TABLE, UNLABELLED, LabelledCloud
from lifelore.core.relations import NONE
from lifelore.perception.clouds.cloud_scale import MAX_SPAN
from lifelore.perception.clouds.voxel import box_of
from lifelore.perception.contacts.interface import Interface, interfaces
from lifelore.perception.contacts.object_shape import ObjectShape
from lifelore.perception.pairs.scene_pairs import scene_pairs
from lifelore.perception.pairs.side_faces import pairs_beside
from lifelore.perception.reasoning.raised_objects import off_the_table
from lifelore.perception.reasoning.scene_logic import alternatives, most_likely_scene
from lifelore.perception.relations.relation import Relation
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.scene import Scene

FLAT = 0.15
"""Largest height of a table, noise of a distant camera included, as a share of its width; larger refuses fewer."""
LEVEL = 0.35
"""Largest height of a labelled table's top beside objects, as a share of its width: a tilt of 20°."""
_SAMPLE = 5000
"""Points of the table of which its width and height are measured."""


def perceived_scene(
    cloud: LabelledCloud, model: RelationClassifier | None = None, *, consistent: bool = True
) -> Scene:
    """Contacts, networks and relations of a cloud; `Scene.optimal` is False where the solver reached its bound.

    Parameters
    ----------
    cloud : LabelledCloud
        With any number of objects, also without any. Without a point of the table, no relation names the table.
    model : RelationClassifier, optional
        Predicts the relations; default: the shipped classifier. A model with other names than *on*, *adjacent*,
        *both* and *none* adds them: these four then come from the shipped classifier, whatever the model learned
        of them.
    consistent : bool
        Whether logic makes *on*, *adjacent*, *both* and *none* consistent (see `scene_logic`). No rules are known
        for other names, nor for a model that gives a pair several of the four.

    Raises
    ------
    InputError
        The labels are 0 and 1 alone, and what is labelled 1 is too high to be the table: two objects of a user who
        numbers from 0, as the thesis does. Or the table is not level, or the cloud not in metres.

    Examples
    --------
    >>> from lifelore import LabelledCloud
    >>> plane = np.stack(np.meshgrid(np.linspace(0, 1, 30), np.linspace(0, 1, 30)), -1).reshape(-1, 2)
    >>> table = np.column_stack([plane, np.zeros(900)])
    >>> block = np.column_stack([0.1 * plane, np.full(900, 0.05)])
    >>> scene = perceived_scene(LabelledCloud(np.concatenate([table, block]), np.repeat([1, 2], 900)))
    >>> scene.objects
    (2,)
    """
    _check_frame(cloud)
    model = model or shipped_model()
    core = shipped_model() if model.words.names else model
    found = interfaces(cloud, core.settings)
    scene = _core_scene(cloud, core, found, consistent)
    if model is core:
        return scene
    shared = found if model.settings == core.settings else None
    return scene.with_words(_stated_words(model, cloud, shared), model.words)


def _core_scene(
    cloud: LabelledCloud, model: RelationClassifier, found: tuple[Interface, ...], consistent: bool
) -> Scene:
    if not consistent or model.multi_label:
        return Scene(cloud, found, model.predict(cloud, found))
    pairs = scene_pairs(cloud, found, model.settings)
    beliefs = model.beliefs(pairs)
    if cloud.has_table:
        beliefs = off_the_table(beliefs, cloud, _shapes(found))
    decided = most_likely_scene(alternatives(beliefs), cloud.objects, beside=pairs_beside(pairs))
    # Logic puts on the table what nothing carries; where no table was seen, that is no perception.
    seen = (r for r in decided.relations if cloud.has_table or TABLE not in (r.a, r.b))
    stated = tuple(r for r in seen if r.relation != NONE or r.gap < inf)
    return Scene(cloud, found, stated, decided.optimal, beliefs)


def _shapes(found: Sequence[Interface]) -> dict[int, ObjectShape]:
    """The shape of each object: with a table, all are in its pairs."""
    bodies = (body for one in found if one.pair is not None for body in (one.pair.first, one.pair.second))
    return {body.label: body.shape for body in bodies if body.label != TABLE}


def _stated_words(
    model: RelationClassifier, cloud: LabelledCloud, found: Sequence[Interface] | None
) -> tuple[Relation, ...]:
    return tuple(r for r in model.predict(cloud, found) if r.relation in model.words.names)


def _check_frame(cloud: LabelledCloud) -> None:
    """Refuse other units than metres, objects numbered from 0, and a table that is not level."""
    if not isinstance(cloud, LabelledCloud):
        raise InputError(f"cloud must be a LabelledCloud (to_scene makes one), got {type(cloud).__name__}")
    span = float(np.ptp(box_of(cloud.points), axis=0).max()) if len(cloud.points) else 0.0
    if span > MAX_SPAN:  # stray points apart, as where a file is read
        span = float(np.ptp(np.quantile(cloud.points, [0.01, 0.99], axis=0), axis=0).max())
    if span > MAX_SPAN:
        raise InputError(
            f"points must be in metres, and at most {MAX_SPAN:.0f} m wide, got {span:,.0f}; divide millimetres by "
            "1000, or crop the cloud"
        )
    if not cloud.has_table:
        return
    table = cloud.rows_of(TABLE)
    some = cloud.points[table[:: max(1, len(table) // _SAMPLE)]]
    low, high = np.quantile(some, [0.05, 0.95], axis=0)
    width, height = float((high - low)[:2].max()), float((high - low)[2])
    size = f"the points labelled 1 are {100 * height:.0f} cm high and {100 * width:.0f} cm wide"
    if not cloud.objects and height > FLAT * width and (cloud.labels == UNLABELLED).any():
        raise InputError(
            f"labels must number objects from 2 (0 is no object, 1 is the table), got 0 and 1 alone, and {size}, "
            "which is no table: add 2 to every label, or call contact_networks(points_a, points_b)"
        )
    if cloud.objects and height > LEVEL * width and not _has_level_top(cloud, width):
        raise InputError(
            f"label 1 must be the table, and z up, but {size}, which is no level table: number objects from 2, or "
            "turn the cloud by to_scene(read_cloud(rows)), a row being x, y, z and label"
        )


def _has_level_top(cloud: LabelledCloud, width: float) -> bool:
    """Whether a table of this width is far wider than any object, and a third of its points lie in one level.

    The rest is below the top: legs, sides, a shelf.
    """
    widest = max(float(np.ptp(cloud.of(label)[:, :2], axis=0).max()) for label in cloud.objects)
    heights = np.sort(cloud.of(TABLE)[:, 2])
    third = -(-len(heights) // 3)
    thickness = float((heights[third - 1 :] - heights[: len(heights) - third + 1]).min())
    return width > 2 * widest and 3 * thickness <= LEVEL * width
