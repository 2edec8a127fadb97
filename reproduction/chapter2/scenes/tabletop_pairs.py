"""Pairs of objects as the thesis photographed them, simulated and real, each as a row of numbers.

A cell draws a lot of settled pairs in the thesis's class mix (or of another arrangement, or reads real scenes) and
finds their contact points under a grid of kernels, since the thesis states neither length nor cost. The table's
points are left out, as the thesis's background was (§2.3.2). Thesis: §2.4.1; its 128 pictures are not published.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any

import numpy as np

from lifelore.core.labelled_cloud import TABLE, LabelledCloud
from lifelore.core.relations import CORE_RELATIONS, PairLabel
from lifelore.core.streams import stream
from lifelore.domains.tabletop.tabletop import TabletopScene, TabletopSettings, sample_scene
from lifelore.perception.clouds.voxel import voxelised
from lifelore.perception.contacts.contact_settings import ContactSettings
from lifelore.perception.contacts.interface import DEFAULT_CONTACT_SETTINGS, Interface, interfaces
from lifelore.perception.scene import Scene
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.perturbation import only, without_table
from reproduction.chapter2.scenes.real_scenes import real_scenes
from reproduction.chapter2.scenes.scene_example import scene_row
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
    """Name of a kernel in rows and readings: ``60 mm, C 10``."""
    return f"{1000 * length:g} mm, C {cost:g}"


STANDARD = kernel_name(DEFAULT_CONTACT_SETTINGS.length, DEFAULT_CONTACT_SETTINGS.cost)
"""The kernel of `ContactSettings`."""
KERNEL_NAMES = tuple(kernel_name(*kernel) for kernel in KERNELS)


def pair_cells(settings: Mapping) -> list[dict]:
    """Lots of simulated pairs, data set by data set; then of real scenes, where asked for and present.

    Settings read: ``data_sets``, ``pairs`` (of each), ``real`` (true or false; may be missing).
    """
    sets = (lots(settings["pairs"], LOT, data_set=number) for number in range(settings["data_sets"]))
    return [*chain.from_iterable(sets), *real_lots(settings, REAL_LOT, "scenes")]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The rows of a lot, ``{"set": …, "rows": […]}``.

    `set` is the number of the data set, "real", or the name of another arrangement; of the latter, the rows are of
    the objects 2 and 3 of the scenes ``cell["numbers"]``, with pictures of one.
    """
    if "scenes" in cell:
        scenes = [scene for scene in real_scenes() if scene.name in cell["scenes"]]
        return {"set": "real", "rows": [row for s in scenes for row in pair_rows(s.name, s.cloud, s.truth)]}
    if "arrangement" in cell:
        drawn, name = TabletopSettings(camera=settings["camera"]), cell["arrangement"]
        worlds = [arranged(name, seed, number, drawn) for number in cell["numbers"]]
        rows = [row for w in worlds for row in pair_rows(w.name, only(w.cloud, (2, 3)), upper_first(w.truth))]
        return {
            "set": name,
            "rows": rows,
            "examples": network_pictures(worlds, rows) if 0 in cell["numbers"] else [],
        }
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


def upper_first(truth: Sequence[PairLabel]) -> list[PairLabel]:
    """The label of the objects 2 and 3 with A = 3, the upper; their relation is symmetric or on(3, 2)."""
    return [replace(label, a=3, b=2) for label in truth if {label.a, label.b} == {2, 3}]


def pair_rows(name: str, cloud: LabelledCloud, truth: Sequence[PairLabel]) -> list[Row]:
    """A row for each pair of objects of the cloud with a label of confidence 2 or 3.

    Returns
    -------
    list of dict
        ``scene``, ``a``, ``b``, ``relation``, ``confidence``: the truth, A and B in its order. ``centres`` leads
        from B's centre of mass to A's, metres; ``gap``, metres, None for a pair that is not near; ``contacts`` by
        kernel: of ``a`` and of ``b``, ``[x, y, z, support vectors]`` of each contact, strongest first, none
        dropped; empty where the pair is not near.
    """
    bare = without_table(cloud)
    found = [interfaces(bare, loose_settings(*kernel)) for kernel in KERNELS]
    thin = voxelised(bare, DEFAULT_CONTACT_SETTINGS.voxel)
    rows = []
    for label in truth:
        if TABLE in (label.a, label.b) or label.confidence < LEAST_CONFIDENCE:
            continue
        centres = thin.of(label.a).mean(axis=0) - thin.of(label.b).mean(axis=0)
        row = {"scene": name, **vars(label), "centres": np.round(centres, 6).tolist(), "gap": None, "contacts": {}}
        for kernel, pairs in zip(KERNEL_NAMES, found, strict=True):
            for pair in pairs:
                if {pair.a, pair.b} == {label.a, label.b}:
                    row["gap"] = round(pair.gap, 6)
                    row["contacts"][kernel] = contacts_of(pair, label.a)
        rows.append(row)
    return rows


def network_pictures(worlds: Sequence[TabletopScene], rows: Sequence[Row]) -> list[dict]:
    """The scene whose lower object comes nearest to three nodes: with every contact, and with strong ones."""
    row = min(rows, key=lambda row: abs(len(row["contacts"].get(STANDARD, {}).get("b", ())) - 3))
    cloud = next(only(world.cloud, (2, 3)) for world in worlds if world.name == row["scene"])
    found = []
    for settings in (loose_settings(*DEFAULT_CONTACT_SETTINGS.scales[0]), DEFAULT_CONTACT_SETTINGS):
        between = interfaces(without_table(cloud), settings)
        n = sum(len(one.contacts_a) for one in between)
        kept = f"of at least {settings.min_support:g} support vectors" if settings.min_support else "every contact"
        found.append(scene_row(Scene(cloud, between), f"{kept}: {n} node{'s' * (n != 1)} of the block"))
    return found


def contacts_of(found: Interface, first: int) -> dict[str, list]:
    """``{"a": [[x, y, z, support vectors], …], "b": …}``, strongest first; `a` is the object `first`."""
    sides = {found.a: found.contacts_a, found.b: found.contacts_b}
    second = found.b if first == found.a else found.a
    return {
        side: [[*np.round(contact.position, 6).tolist(), contact.n_support] for contact in sides[label]]
        for side, label in (("a", first), ("b", second))
    }


def loose_settings(length: float, cost: float) -> ContactSettings:
    """A kernel, and no contact dropped for want of support vectors: who reads the rows may drop them."""
    return replace(DEFAULT_CONTACT_SETTINGS, length=length, cost=cost, min_support=0.0)


def data_sets(results: Sequence[Mapping]) -> dict[int | str, list[Row]]:
    """The rows of each data set by its number, and of the real scenes under "real" where there are any."""
    found: dict[int | str, list[Row]] = {}
    for result in results:
        found.setdefault(result["set"], []).extend(result["rows"])
    return found


def simulated_sets(results: Sequence[Mapping]) -> list[list[Row]]:
    """The rows of each simulated data set."""
    return [rows for name, rows in data_sets(results).items() if isinstance(name, int)]
