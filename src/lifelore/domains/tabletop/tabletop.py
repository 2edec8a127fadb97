"""The tabletop: draw objects, let them settle, determine their relations, photograph them with a depth camera.

Thesis: §2.4.1, whose 128 stereo pictures of pairs are not published; physics settles and labels them here.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from lifelore.core.errors import InputError
from lifelore.core.relations import CORE_RELATIONS, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.arrangements import arrangement_named
from lifelore.domains.tabletop.depth_camera import CAMERAS
from lifelore.domains.tabletop.kits import Kit, kit_named
from lifelore.domains.tabletop.layout import Group
from lifelore.domains.tabletop.photograph import FIRST_OBJECT, Photograph, choose_view, photograph
from lifelore.domains.tabletop.physics import Contacts, Tabletop
from lifelore.domains.tabletop.piles import Place
from lifelore.domains.tabletop.pose import Pose
from lifelore.domains.tabletop.settings import TabletopScene, TabletopSettings, wanted_relation
from lifelore.domains.tabletop.truth import NEAR, Gap, bearing, true_relations

JAMMED = -0.001
"""Metres: surfaces that overlap more were pressed together, not set down."""
BALANCE = 0.05
"""Part of its weight by which an object's support may be off: more, and it is about to tip."""
ATTEMPTS = 400
Shows = Callable[[NDArray[np.float64], Contacts, Sequence[Pose]], bool]
"""Called with the shares of the objects' weights (see `Bearing`), the contacts and the poses."""
BLOCK = 4
"""Scenes that one process draws at a time."""

__all__ = ["TabletopScene", "TabletopSettings", "sample_scene", "settle_scene", "tabletop_scenes", "visible_gap"]


def tabletop_scenes(
    n: int, seed: int = 0, settings: TabletopSettings | None = None, jobs: int = 1
) -> Iterator[TabletopScene]:
    """`n` scenes in order, the same bit for bit for any number of `jobs` (processes)."""
    settings = settings or TabletopSettings()
    if jobs == 1:
        for number in range(n):
            yield sample_scene(seed, number, settings)
        return
    from joblib import Parallel, delayed

    with Parallel(n_jobs=jobs) as parallel:
        at_once = 2 * BLOCK * jobs
        for start in range(0, n, at_once):
            stop = min(start + at_once, n)
            blocks = [range(k, min(k + BLOCK, stop)) for k in range(start, stop, BLOCK)]
            for block in parallel(delayed(_draw_block)(seed, numbers, settings) for numbers in blocks):
                yield from block or ()


def _draw_block(seed: int, numbers: range, settings: TabletopSettings) -> list[TabletopScene]:
    return [sample_scene(seed, number, settings) for number in numbers]


def sample_scene(seed: int, number: int, settings: TabletopSettings | None = None) -> TabletopScene:
    """Scene `number` of a seed: drawn until one settles, shows its arrangement and can be seen.

    Raises
    ------
    MissingExtraError
        MuJoCo is not installed.
    InputError
        The settings name something unknown, or nothing fits in `ATTEMPTS` draws.
    """
    settings = settings or TabletopSettings()
    arrangement = arrangement_named(settings.arrangement)
    kit = kit_named(settings.shapes)
    wanted = wanted_relation(number, settings.mix) if settings.mix else ""
    for attempt in range(ATTEMPTS):
        rng = stream(seed, "tabletop", settings.arrangement, number, attempt)
        found = _attempt(rng, settings, arrangement, kit, wanted)
        if found is not None:
            return replace(found, name=f"sim{number:05d}", attempts=attempt + 1)
    raise InputError(f"nothing fits {settings} in {ATTEMPTS} draws: change n_objects, mix or arrangement")


def _attempt(
    rng: np.random.Generator, settings: TabletopSettings, place: Place, kit: Kit, wanted: str
) -> TabletopScene | None:
    """One draw; None where it does not settle, jams, shows something else, or an object cannot be seen."""
    aim = wanted or CORE_RELATIONS[int(rng.integers(4))]
    placed = place(rng, kit, settings, aim)
    # Labels are dealt at random, so that their order tells nothing.
    return settle_scene([placed[i] for i in rng.permutation(len(placed))], rng, settings, wanted=wanted)


def settle_scene(
    placed: Group,
    rng: np.random.Generator,
    settings: TabletopSettings,
    shows: Shows | None = None,
    wanted: str = "",
) -> TabletopScene | None:
    """Let objects fall from where they were put, judge and photograph them.

    `shows` says whether what has settled is what the scene is to show.

    Returns
    -------
    TabletopScene or None
        None where they do not settle within four seconds, jam, show another arrangement or relation than the
        `wanted` one, or cannot all be seen.
    """
    table = Tabletop([item.shape for item in placed], [item.pose for item in placed])
    if not table.settle():
        return None
    contacts = table.contacts()
    if len(contacts.distances) and contacts.distances.min() < JAMMED:
        return None
    shapes, poses = table.shapes, table.poses
    outlines = [pose.apply(shape.outline()) for shape, pose in zip(shapes, poses, strict=True)]
    borne = bearing(contacts, table.weights)
    if (np.abs(borne.lift[:-1].sum(axis=1) - 1) > BALANCE).any():
        return None
    if shows is not None and not shows(borne.share, contacts, poses):
        return None
    camera = CAMERAS[settings.camera]
    view = choose_view(outlines, rng, camera)
    photo = photograph(table, outlines, view, camera, rng) if view is not None else None
    if photo is None:
        return None
    gaps = _gaps(table, photo)
    labels = range(FIRST_OBJECT, FIRST_OBJECT + len(placed))
    heights = np.array([(outline[:, 2].min(), outline[:, 2].max()) for outline in outlines])
    truth = true_relations(borne, gaps, heights, labels)
    if settings.arrangement == "pair" and _pair_relation(truth) not in ((wanted,) if wanted else CORE_RELATIONS):
        return None
    near = tuple(
        replace(gap, a=gap.a + FIRST_OBJECT, b=gap.b + FIRST_OBJECT)
        for gap in gaps.values()
        if gap.visible <= NEAR or borne.touching[gap.a, gap.b]
    )
    return TabletopScene("", photo.cloud, truth, near, shapes, poses, photo.view, photo.clean)


def _pair_relation(truth: tuple[PairLabel, ...]) -> str:
    """The relation of the only two objects; none where they are too far apart for a label."""
    return next((label.relation for label in truth if label.b >= FIRST_OBJECT), "")


def _gaps(table: Tabletop, photo: Photograph) -> dict[tuple[int, int], Gap]:
    """Visible and true distances of all pairs that are nearer than `NEAR`."""
    labels = photo.cloud.labels
    seen = [photo.clean[labels == label] for label in range(FIRST_OBJECT, FIRST_OBJECT + len(table.weights))]
    trees: dict[int, KDTree] = {}
    gaps = {}
    for i in range(len(seen)):
        for j in range(i + 1, len(seen)):
            true, way = table.distance(i, j, NEAR)
            if true >= NEAR:
                continue
            few, many = sorted((i, j), key=lambda k: len(seen[k]))
            if many not in trees:
                trees[many] = KDTree(seen[many])
            visible = visible_gap(seen[few], seen[many], trees[many])
            gaps[i, j] = Gap(i, j, visible, true, bool(np.hypot(way[0], way[1]) >= abs(way[2])))
    return gaps


def visible_gap(points: NDArray[np.float64], others: NDArray[np.float64], tree: KDTree | None = None) -> float:
    """Smallest distance between two clouds, metres; `tree`, where known, is that of `others`."""
    tree = KDTree(others) if tree is None else tree
    # A few points bound the answer, and the bound leaves few points to ask about.
    bound = float(tree.query(points[:: max(1, len(points) // 100)])[0].min()) * (1 + 1e-9)
    low, high = others.min(axis=0) - bound, others.max(axis=0) + bound
    close = points[(points >= low).all(axis=1) & (points <= high).all(axis=1)]
    return min(bound, float(tree.query(close, distance_upper_bound=bound)[0].min(initial=np.inf)))
