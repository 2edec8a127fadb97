"""Pairs of objects as the thesis photographed them, simulated and real, each as a row of numbers.

A cell draws a lot of settled pairs in the thesis's class mix (or reads some real scenes), finds their contact
points under a grid of kernels (the thesis states neither length nor cost) and stores places, support and features:
all data that claims about displacements need. The table's points are left out, as the thesis's background was
(§2.3.2). Thesis: §2.4.1, whose 128 stereo pictures are not published.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import CORE_RELATIONS, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.experiments.chapter2.scenes.real_scenes import real_scenes, real_scenes_folder
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, Interface, interfaces
from lifelore.perception.pairs.pair_features import pair_features
from lifelore.perception.peers import PEERS

MIX: dict[str, float] = dict(zip(CORE_RELATIONS, (70, 32, 30, 0), strict=True))
"""The thesis's numbers of pairs by relation: the columns of its confusion matrix."""
LEAST_CONFIDENCE = 2
"""Doubtful labels are left out: the thesis's pictures were arranged and labelled by a person."""
LOT = 22
REAL_LOT = 6
KERNELS = ((0.03, 1.0), (0.03, 10.0), (0.06, 1.0), (0.06, 10.0), (0.12, 1.0), (0.12, 10.0))
"""(length in metres, cost per point at 3 mm spacing)."""

Row = dict[str, Any]


def kernel_name(length: float, cost: float) -> str:
    """Name of a kernel in rows and tables: ``60 mm, C 10``."""
    return f"{1000 * length:g} mm, C {cost:g}"


STANDARD = kernel_name(DEFAULT_CONTACT_SETTINGS.length, DEFAULT_CONTACT_SETTINGS.cost)
"""The kernel of `ContactSettings`."""
BESIDE_US = ("majority", "bounding-box rule", "centroid k-NN", "closest-point k-NN")
"""The peers that describe each pair too."""


def pair_cells(settings: Mapping) -> list[dict]:
    """Lots of simulated pairs, data set by data set; then of real scenes, where asked for and present.

    Settings read: ``data_sets``, ``pairs`` (of each), ``real`` (true or false).
    """
    simulated = [
        {"data_set": number, "first": first}
        for number in range(settings["data_sets"])
        for first in range(0, settings["pairs"], LOT)
    ]
    if not settings["real"] or real_scenes_folder() is None:
        return simulated
    names = [scene.name for scene in real_scenes()]
    return simulated + [{"scenes": names[at : at + REAL_LOT]} for at in range(0, len(names), REAL_LOT)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The rows of a lot, ``{"set": …, "rows": […]}``; `set` is the number of the data set, or "real"."""
    if "scenes" in cell:
        wanted = set(cell["scenes"])
        rows = [
            row
            for scene in real_scenes()
            if scene.name in wanted
            for row in pair_rows(scene.name, scene.cloud, scene.truth)
        ]
        return {"set": "real", "rows": rows}
    number = cell["data_set"]
    drawn = TabletopSettings(arrangement="pair", mix=MIX, camera=settings["camera"], shapes="all")
    rows = []
    for k in range(cell["first"], min(cell["first"] + LOT, settings["pairs"])):
        scene = _undoubted(stream(seed, "tabletop pairs", number, k), k, drawn)
        rows += pair_rows(f"{number}-{k}", scene.cloud, scene.truth)
    return {"set": number, "rows": rows}


def _undoubted(rng: np.random.Generator, number: int, drawn: TabletopSettings) -> TabletopScene:
    """A scene whose pair has a label beyond doubt; drawn again until it has."""
    while True:
        scene = sample_scene(int(rng.integers(2**31)), number, drawn)
        if all(label.confidence >= LEAST_CONFIDENCE for label in scene.truth if label.a != TABLE != label.b):
            return scene


def pair_rows(name: str, cloud: LabelledCloud, truth: Sequence[PairLabel]) -> list[Row]:
    """A row for each pair of things with a label of confidence 2 or 3.

    Returns
    -------
    list of dict
        ``scene``, ``a``, ``b``, ``relation``, ``confidence``: what is true. ``pair`` is (a, b) with a < b, and all
        of the rest is in that order: ``gap`` (metres, None for a pair that is not near, which has nothing else);
        ``contacts`` by kernel, on either side ``[x, y, z, support vectors]`` of each contact, none dropped;
        ``features`` of both orders; ``peers``, what each of `BESIDE_US` sees of both orders.
    """
    bare = without_table(cloud)
    found = {(one.a, one.b): one for one in interfaces(bare)}
    contacts = {kernel_name(*kernel): _contacts_by_pair(bare, *kernel) for kernel in KERNELS}
    features = pair_features(bare, tuple(found.values())).matrix
    peers = {name: {(one.a, one.b): one.rows for one in PEERS[name]().describe_pairs(bare)} for name in BESIDE_US}
    rows = []
    for label in truth:
        if TABLE in (label.a, label.b) or label.confidence < LEAST_CONFIDENCE:
            continue
        pair = (min(label.a, label.b), max(label.a, label.b))
        row = {"scene": name, **vars(label), "pair": list(pair), "gap": None}
        if pair in found:
            at = list(found).index(pair)
            row |= {
                "gap": round(found[pair].gap, 6),
                "contacts": {kernel: by_pair[pair] for kernel, by_pair in contacts.items()},
                "features": _rounded(features[2 * at : 2 * at + 2]),
                "peers": {name: _rounded(by_pair[pair]) for name, by_pair in peers.items()},
            }
        rows.append(row)
    return rows


def data_sets(results: Sequence[Mapping]) -> dict[int | str, list[Row]]:
    """The rows of each data set by its number, and of the real scenes under "real" where there are any."""
    found: dict[int | str, list[Row]] = {}
    for result in results:
        found.setdefault(result["set"], []).extend(result["rows"])
    return found


def without_table(cloud: LabelledCloud) -> LabelledCloud:
    """The points of the objects alone."""
    kept = cloud.labels > TABLE
    return LabelledCloud(cloud.points[kept], cloud.labels[kept], None, cloud.camera)


def contacts_of(one: Interface) -> dict[str, list]:
    """``{"a": [[x, y, z, support vectors], …], "b": …}``, strongest first."""
    sides = {"a": one.contacts_a, "b": one.contacts_b}
    return {
        side: [[*_rounded(contact.position), contact.n_support] for contact in contacts]
        for side, contacts in sides.items()
    }


def loose_settings(length: float, cost: float) -> ContactSettings:
    """A kernel, and no contact dropped for want of support vectors: who reads the rows may drop them."""
    return replace(DEFAULT_CONTACT_SETTINGS, length=length, cost=cost, min_support=0.0)


def _contacts_by_pair(cloud: LabelledCloud, length: float, cost: float) -> dict[tuple[int, int], dict]:
    return {(one.a, one.b): contacts_of(one) for one in interfaces(cloud, loose_settings(length, cost))}


def _rounded(values: NDArray[np.float64]) -> list:
    return np.round(values, 6).tolist()
