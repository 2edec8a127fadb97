"""Pairs of objects as the thesis photographed them, simulated and real, each as a row of numbers.

A cell draws a lot of settled pairs in the thesis's class mix (or reads some real scenes), finds their contact
points under a grid of kernels (the thesis states neither length nor cost) and stores places, support and features:
all data that claims about displacements need. The table's points are left out, as the thesis's background was
(§2.3.2). Thesis: §2.4.1, whose 128 stereo pictures are not published.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import CORE_RELATIONS, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import (
    DEFAULT_CONTACT_SETTINGS,
    Interface,
    interfaces_by_settings,
)
from lifelore.perception.pairs.pair_features import pair_features
from lifelore.perception.peers import PEERS
from reproduction.chapter2.scenes.perturbation import without_table
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of, real_lots

MIX: dict[str, float] = dict(zip(CORE_RELATIONS, (70, 32, 30, 0), strict=True))
"""The thesis's numbers of pairs by relation: the columns of its confusion matrix."""
LEAST_CONFIDENCE = 2
"""Doubtful labels are left out: the thesis's pictures were arranged and labelled by a person."""
LOT = 22
REAL_LOT = 6
KERNELS = ((0.03, 1.0), (0.03, 10.0), (0.06, 1.0), (0.06, 10.0), (0.12, 1.0), (0.12, 10.0))
"""(length in metres, cost per point at 3 mm spacing)."""

SETTINGS_OF_A_CELL = ("pairs", "camera")
"""The settings that `run_cell` reads: claims that agree in them share their cells."""
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
    sets = (lots(settings["pairs"], LOT, data_set=number) for number in range(settings["data_sets"]))
    return [*chain.from_iterable(sets), *real_lots(settings, REAL_LOT, "scenes")]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The rows of a lot, ``{"set": …, "rows": […]}``; `set` is the number of the data set, or "real"."""
    if "scenes" in cell:
        scenes = [scene for scene in real_scenes() if scene.name in cell["scenes"]]
        return {"set": "real", "rows": [row for s in scenes for row in pair_rows(s.name, s.cloud, s.truth)]}
    number = cell["data_set"]
    drawn = TabletopSettings(arrangement="pair", mix=MIX, camera=settings["camera"], shapes="all")
    rows = []
    for k in numbers_of(cell, LOT, settings["pairs"]):
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
    """A row for each pair of objects with a label of confidence 2 or 3.

    Returns
    -------
    list of dict
        ``scene``, ``a``, ``b``, ``relation``, ``confidence``: the truth. ``pair`` is (a, b) with a < b, and all
        of the rest is in that order: ``gap`` (metres, None for a pair that is not near, which has nothing else);
        ``contacts`` by kernel, on either side ``[x, y, z, support vectors]`` of each contact, none dropped;
        ``features`` of both orders; ``peers``, the description of both orders by each of `BESIDE_US`.
    """
    bare = without_table(cloud)
    loose = [loose_settings(*kernel) for kernel in KERNELS]
    standard, *others = interfaces_by_settings(bare, [DEFAULT_CONTACT_SETTINGS, *loose])
    found = {(near.a, near.b): near for near in standard}
    contacts = {kernel_name(*k): _contacts_by_pair(own) for k, own in zip(KERNELS, others, strict=True)}
    features = pair_features(bare, tuple(found.values())).matrix
    peers = {name: {(p.a, p.b): p.rows for p in PEERS[name]().describe_pairs(bare)} for name in BESIDE_US}
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


def contacts_of(found: Interface) -> dict[str, list]:
    """``{"a": [[x, y, z, support vectors], …], "b": …}``, strongest first."""
    sides = {"a": found.contacts_a, "b": found.contacts_b}
    return {
        side: [[*_rounded(contact.position), contact.n_support] for contact in contacts]
        for side, contacts in sides.items()
    }


def loose_settings(length: float, cost: float) -> ContactSettings:
    """A kernel, and no contact dropped for want of support vectors: who reads the rows may drop them."""
    return replace(DEFAULT_CONTACT_SETTINGS, length=length, cost=cost, min_support=0.0)


def _contacts_by_pair(found: Sequence[Interface]) -> dict[tuple[int, int], dict]:
    return {(pair.a, pair.b): contacts_of(pair) for pair in found}


def _rounded(values: NDArray[np.float64]) -> list:
    return np.round(values, 6).tolist()
