"""`bench views`: relations and contacts perceived from one, two and three views of the same simulated scene.

The scenes' shapes are unknown to the shipped model, which has learnt from single views. The cameras stand around
the objects, a third of a turn apart; their clouds are fused with the true poses. All numbers of views are judged
on the same pairs: those whose label does not depend on what is visible. A *contact found* is a touching pair of
which a perceived contact point lies within 20 mm of the true contact's convex hull. Written is
``benchmarks/results/views.png``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import estimated_row
from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.metrics import Estimate
from lifelore.core.protocols import Progress
from lifelore.core.relations import ADJACENT_GAP, SYMMETRIC, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.photograph import Photograph
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, tabletop_scenes, visible_gap
from lifelore.domains.tabletop.views import true_contacts, views_around
from lifelore.perception.clouds.fused_views import fused
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.relations.relation_classifier import RelationClassifier, shipped_model
from lifelore.perception.scene import Scene
from reproduction.chapter2.scoring.relation_scoring import (
    JudgedPair,
    difference,
    judged_scene,
    share,
    share_over_scenes,
)

SEED, SHAPES = 7011, "held-out"
SCENES = 20
"""Scenes of a round."""
TURNS = (0.0, 2 * np.pi / 3, 4 * np.pi / 3)
FOUND = 0.02
"""Metres between the hull of a true contact and the contact point that finds it: seven voxels."""
OUT = Path("benchmarks/results/bench_views.png")
Places = Mapping[frozenset[int], NDArray[np.float64]]


@dataclass(frozen=True)
class ViewsOfScene:
    """Judged pairs, and for each touching pair whether its contact is found, by number of views."""

    judged: dict[int, list[JudgedPair]]
    contacts: dict[int, list[bool]]


def bench_views(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows without goals; see `benchmarks.bench`. Each round adds `SCENES` scenes."""
    model, n = shipped_model(), SCENES * repeats
    found = []
    for number, scene in enumerate(tabletop_scenes(n, SEED, TabletopSettings(shapes=SHAPES))):
        found.append(judged_views(scene, number, model))
        progress(number + 1, n, scene.name)
    measures = {views: _measures(found, views) for views in range(1, len(TURNS) + 1)}
    _draw(measures, out)
    return {"rows": _rows(found, measures), "goals": []}


def judged_views(scene: TabletopScene, number: int, model: RelationClassifier) -> ViewsOfScene:
    """What one, two and three views of a scene give."""
    rng = stream(SEED, "tabletop views", number)
    photos = views_around(scene, TURNS[1:], CAMERAS["kinect"], rng)
    clouds = [scene.cloud, *(photo.cloud for photo in photos)]
    kept = lasting_labels(scene, photos)
    places = true_contacts(scene)
    judged, contacts = {}, {}
    for views in range(1, len(clouds) + 1):
        seen = perceived_scene(together(clouds[:views]), model).without_unrelated_contacts
        judged[views] = judged_scene(scene.name, kept, seen.relations)
        contacts[views] = contacts_found(seen, places)
    return ViewsOfScene(judged, contacts)


def lasting_labels(scene: TabletopScene, photos: Sequence[Photograph]) -> list[PairLabel]:
    """The labels of pairs of objects that are the same in the scene's view and in all `photos` beside it."""
    truth = [label for label in scene.truth if TABLE not in (label.a, label.b)]
    return [
        label for label in truth if label.relation not in SYMMETRIC or _same_gap(scene, photos, label.a, label.b)
    ]


def together(clouds: Sequence[LabelledCloud], last: NDArray[np.float64] | None = None) -> LabelledCloud:
    """Clouds as one; a rigid motion `last` (4, 4) moves the last of them first."""
    views = [PointCloud(cloud.points, cloud.labels, cloud.colours, camera=cloud.camera) for cloud in clouds]
    poses = np.stack([np.eye(4)] * len(views))
    if last is not None:
        poses[-1] = last
    whole = fused(views, poses)
    assert whole.labels is not None
    return LabelledCloud(
        whole.points.astype(np.float64), whole.labels, whole.colours, whole.camera, whole.other_cameras
    )


def _same_gap(scene: TabletopScene, photos: Sequence[Photograph], a: int, b: int) -> bool:
    """Whether the pair's visible gap is on the same side of the limit of *adjacent* in one view and in all."""
    first = [scene.clean[scene.cloud.labels == label] for label in (a, b)]
    everywhere = [
        np.concatenate([own, *(photo.clean[photo.cloud.labels == label] for photo in photos)])
        for own, label in zip(first, (a, b), strict=True)
    ]
    once, always = (visible_gap(own[0], own[1]) <= ADJACENT_GAP for own in (first, everywhere))
    return once == always


def contacts_found(seen: Scene, places: Places) -> list[bool]:
    """For each touching pair, whether a contact point between its objects is within `FOUND` of the contact."""
    points = {
        frozenset((part.a, part.b)): [node.position for node in (*part.contacts_a, *part.contacts_b)]
        for part in seen.interfaces
    }
    return [
        any(distance_to_hull(point, true) <= FOUND for point in points.get(pair, ()))
        for pair, true in sorted(places.items(), key=lambda item: sorted(item[0]))
    ]


def distance_to_hull(point: NDArray[np.float64], corners: NDArray[np.float64]) -> float:
    """Metres from a point (3,) to the convex hull of `corners` (k, 3)."""
    from scipy.optimize import nnls

    # Non-negative weights of the corners; a heavy last row makes them sum to 1.
    heavy = 1e3
    _, distance = nnls(
        np.vstack([(corners - point).T, np.full(len(corners), heavy)]), np.array([0.0, 0.0, 0.0, heavy])
    )
    return float(distance)


def _measures(found: Sequence[ViewsOfScene], views: int) -> dict[str, Estimate]:
    judged = [pair for scene in found for pair in scene.judged[views]]
    touching = [scene.contacts[views] for scene in found if scene.contacts[views]]
    return {
        "exact": share(judged, lambda pair: pair.exact),
        "on": share(judged, lambda pair: pair.on_right),
        "contacts found": share_over_scenes([sum(own) for own in touching], [len(own) for own in touching]),
    }


def _rows(found: Sequence[ViewsOfScene], measures: Mapping[int, Mapping[str, Estimate]]) -> list[dict]:
    rows = []
    for views, numbers in measures.items():
        for name, number in numbers.items():
            rows.append(estimated_row(f"{name}, {views} view{'s' if views > 1 else ''}", number, "share"))
    one = [pair for scene in found for pair in scene.judged[1]]
    for views in list(measures)[1:]:
        more = difference([pair for scene in found for pair in scene.judged[views]], one)
        rows.append(estimated_row(f"exact, {views} views less 1 view, the same pairs", more, "share"))
    return rows


def _draw(measures: Mapping[int, Mapping[str, Estimate]], out: Path) -> None:
    from lifelore.figures.interval_bars import draw_interval_bars
    from lifelore.figures.style import BLUE, GREEN, GREY, house_style, new_figure, save_figure

    names = list(measures[1])
    groups = {
        f"{views} view{'s' if views > 1 else ''}": [numbers[name].to_dict() for name in names]
        for views, numbers in measures.items()
    }
    with house_style():
        figure = new_figure(6.4, 3.4)
        axes = figure.subplots()
        draw_interval_bars(
            axes, names, groups, colours=dict(zip(groups, (GREY, BLUE, GREEN), strict=True)), horizontal=False,
            words="{:.2f}".format, title="What further views of a scene give", label="share of pairs of objects",
            legend=False,
        )  # fmt: skip
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), ncols=len(groups), frameon=False)
    save_figure(figure, out)
