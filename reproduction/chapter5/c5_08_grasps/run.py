"""C5.8: grasps sought with few tries in pairs of settled scenes of one arrangement.

A try is a pose of the gripper chosen from the perceived scene alone; the simulator's true objects tell whether it
is reached and holds. Labels of the clouds are given. Symmetric scenes correspond in several ways that are equally
good; the success of a carried grasp is its mean over all of them. Thesis: §2.1, §2.4.2, §2.5.
"""

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.core.streams import stream
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.settings import TabletopScene
from lifelore.perception.scene import Scene
from lifelore.perception.topology.grasp_seeds import grasp_seeds
from reproduction.chapter2.scenes.arranged_scenes import arranged
from reproduction.chapter2.scenes.scene_lots import lots, numbers_of
from reproduction.chapter2.scenes.skeletons import perceived, reading
from reproduction.chapter2.scenes.substructure import Roles, skeleton, substructures
from reproduction.chapter5.c5_08_grasps.parallel_gripper import Grasp, GraspedTabletop
from reproduction.chapter5.c5_08_grasps.searches import anywhere, around, carried, from_above, from_seeds
from reproduction.chapter5.role_scenes import POOLS, role_scene
from reproduction.engine.estimates import UNMEASURED, mean_by_cluster
from reproduction.engine.records import nested

LOT = 5
HOLES = ("hole-other", "hole-hinged")
"""Arrangements of the tabletop with a hole through two objects; both scenes of a pair are of the same kind."""
ARRANGEMENTS = ("two", "tower", "bridge", "lean", "neighbours", "row", *HOLES)
"""Kinds of scene; the others are those of C5.2, the two scenes of a pair from pools without a common shape."""
SEARCHES = ("seeded", "anywhere", "above")
TRANSFERS = ("carried", "not carried", "above, not carried")
TRIES = 10
"""Most tries of a search."""
LEARNT_TRIES = 100
"""Most tries in the first scene of a pair, until a grasp worked that can be carried."""


def cells(settings: Mapping) -> list[dict]:
    """Pairs of scenes in lots, by arrangement."""
    return [lot for name in ARRANGEMENTS for lot in lots(settings["pairs"], LOT, arrangement=name)]


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """Whether one of `TRIES` tries succeeds, by object and search."""
    name, objects = cell["arrangement"], []
    for number in numbers_of(cell, LOT, settings["pairs"]):
        pair = [drawn_scene(name, pool, seed, number) for pool in POOLS]
        scenes = [perceived(scene.cloud) for scene in pair]
        networks = [reading(scene, ground=True) for scene in scenes]
        same = equal_topologies(*networks)
        worlds = [GraspedTabletop(scene.shapes, scene.poses) for scene in pair]
        for label in scenes[1].objects:
            names = (seed, "C5.8", name, number, label)
            found = searched(worlds[1], networks[1], label, stream(*names))
            found |= transferred(worlds, networks, same, label, names)
            objects.append({"scene": f"{name} {number}", **found})
    return {"objects": objects}


def drawn_scene(name: str, pool: str, seed: int, number: int) -> TabletopScene:
    """Scene `number` of an arrangement with the shapes of a pool."""
    if name in HOLES:
        own_seed = int(stream(seed, "C5.8", "scenes", pool).integers(2**31))
        return arranged(name, own_seed, number)
    return role_scene(name, pool, f"C5.8 {pool} {name}", seed, number)


def equal_topologies(first: Scene, second: Scene) -> list[Roles]:
    """Every correspondence of two scenes whose skeletons have the same contact points; empty if they have not."""
    if len(skeleton(first)) != len(skeleton(second)):
        return []
    return list(substructures(first, second, networks="connected"))


def searched(world: GraspedTabletop, scene: Scene, label: int, rng: np.random.Generator) -> dict:
    """Success from seeds, anywhere and from above; `seeds` counts the seeds of the object."""
    seeds = [seed for seed in grasp_seeds(scene) if seed.object_id == label]
    points = scene.cloud.of(label)
    return {
        "seeds": len(seeds),
        "seeded": is_grasped(world, label, from_seeds(seeds, rng)),
        "anywhere": is_grasped(world, label, anywhere(points, rng)),
        "above": is_grasped(world, label, from_above(points, rng)),
    }


def transferred(
    worlds: list[GraspedTabletop], scenes: list[Scene], same: list[Roles], label: int, names: tuple
) -> dict:
    """Success of grasps that worked on the counterpart in the first scene, carried over by each correspondence.

    `names` name the random streams. Empty where no grasp can be carried.
    """
    successes = []
    for roles in same:
        source = next((own[0] for own, other in roles.items() if other == (label,)), None)
        learnt = None if source is None else learnt_grasp(worlds[0], scenes[0], source, stream(*names, source))
        found = carried(learnt, scenes[0], source, scenes[1], label, roles) if source and learnt else []
        if found:
            successes.append(is_grasped(worlds[1], label, around(found, stream(*names, "carried"))))
    if not successes:
        return {}
    points, rng = scenes[1].cloud.of(label), stream(*names, "not carried")
    return {
        "carried": float(np.mean(successes)),
        "not carried": is_grasped(worlds[1], label, anywhere(points, rng)),
        "above, not carried": is_grasped(worlds[1], label, from_above(points, rng)),
    }


def learnt_grasp(world: GraspedTabletop, scene: Scene, label: int, rng: np.random.Generator) -> Grasp | None:
    """The first grasp of an object that succeeds, sought anywhere and from above in turn; else None."""
    points = scene.cloud.of(label)
    tried = zip(anywhere(points, rng), from_above(points, rng), strict=True)
    grasps = islice((grasp for both in tried for grasp in both), LEARNT_TRIES)
    return next((grasp for grasp in grasps if world.succeeds(grasp, label - FIRST_OBJECT)), None)


def is_grasped(world: GraspedTabletop, label: int, grasps: Iterable[Grasp]) -> bool:
    """Whether one of the first `TRIES` grasps succeeds."""
    return any(world.succeeds(grasp, label - FIRST_OBJECT) for grasp in islice(grasps, TRIES))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares of objects that are grasped, and differences on the same objects; intervals resample scenes.

    Searches are compared on objects with a seed, and carried grasps on objects to which one could be carried.
    """
    objects = nested(results, "objects")
    seeded, moved = [row for row in objects if row["seeds"]], [row for row in objects if "carried" in row]

    def share(rows: Sequence[Mapping], name: str, less: str | None = None) -> Estimate:
        values = [float(row[name]) - (row[less] if less else 0.0) for row in rows]
        return mean_by_cluster(values, [row["scene"] for row in rows]) if rows else UNMEASURED

    found = {name: share(seeded, name) for name in SEARCHES}
    found |= {name.replace(", ", "_").replace(" ", "_"): share(moved, name) for name in TRANSFERS}
    found["seeded_less_anywhere"] = share(seeded, "seeded", "anywhere")
    return found | {"carried_less_not_carried": share(moved, "carried", "not carried")}
