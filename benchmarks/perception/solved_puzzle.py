"""A block puzzle from the camera to the goal: perceive a cloud, plan, carry out every step, and look at the truth.

A look whose facts allow no plan is followed by another from a third of the way around the table. Without labels
the goal names segments: a segment stands for the block with which it has an IoU of at least 0.5.
"""

from dataclasses import dataclass, field

import numpy as np

from lifelore.bridges.planner import Step, solve
from lifelore.core.errors import InputError
from lifelore.core.labelled_cloud import LabelledCloud
from lifelore.core.streams import stream
from lifelore.domains.tabletop.block_puzzle import BlockPuzzle, block_puzzle
from lifelore.domains.tabletop.photograph import FIRST_OBJECT
from lifelore.domains.tabletop.pick_and_place import PickAndPlace
from lifelore.perception.clouds.point_cloud import PointCloud
from lifelore.perception.perceived_scene import perceived_scene
from lifelore.perception.reasoning.planning_domain import DOMAIN
from lifelore.perception.reasoning.planning_goal import read_goal
from lifelore.perception.reasoning.planning_problem import scene_problem
from lifelore.perception.reasoning.planning_state import PLAN_CONFIDENCE
from lifelore.perception.relations.relation_classifier import shipped_model
from lifelore.perception.scene import Scene
from lifelore.perception.segmentation.table_frame import segmented_scene
from reproduction.chapter2.scoring.segmentation_scoring import matched_objects, overlaps

SEED = 2512
LOOKS = 3
"""Most looks at a puzzle, from all around the table."""
SOLVED = "solved"
NOT_FOUND, NO_PLAN, NO_BLOCK, NOT_REACHED = "a block is not found", "no plan", "moves no block", "goal not reached"
"""How a puzzle may end, beside the faults of `pick_and_place`."""


@dataclass(frozen=True)
class Ending:
    """What became of a puzzle: `SOLVED` or why not, the looks that it took, and the steps that were carried out.

    `clouds` are photographs of the start and after each step that puts a block down, where they were asked for.
    """

    outcome: str
    looks: int
    steps: tuple[Step, ...]
    clouds: tuple[LabelledCloud, ...] = field(default=(), repr=False)


def solved_puzzle(number: int, labels: bool, pictures: bool = False) -> Ending:
    """Puzzle `number`, perceived with the true labels of its blocks or without labels.

    Raises
    ------
    MissingExtraError
        MuJoCo, unified-planning or the engine is not installed.
    """
    puzzle, hand = started(number)
    camera = stream(SEED, "puzzle", "camera", number)
    outcome, found, looks = NO_PLAN, None, 0
    for looks in range(1, LOOKS + 1):
        outcome, found = _planned(puzzle, hand, camera, 2 * np.pi / LOOKS * (looks - 1), labels)
        if found is not None:
            break
    if found is None:
        return Ending(outcome, looks, ())
    plan, stands_for = found
    view, clouds, done = None, [], []
    for step in (None, *plan):
        if step is not None:
            if (fault := _carried_out(hand, step, stands_for)) is not None:
                return Ending(fault, looks, tuple(done), tuple(clouds))
            done.append(step)
        if pictures and hand.held is None:
            photo = hand.photograph(stream(SEED, "puzzle", "picture", number, len(done)), view=view)
            if photo is not None:
                view, clouds = photo.view, [*clouds, photo.cloud]
    reached = all(hand.holds(relation, *blocks) for relation, blocks in puzzle.wishes())
    return Ending(SOLVED if reached else NOT_REACHED, looks, tuple(done), tuple(clouds))


def started(number: int) -> tuple[BlockPuzzle, PickAndPlace]:
    """The puzzle and its blocks on the table."""
    drawn = stream(SEED, "puzzle", number)
    puzzle = block_puzzle(drawn)
    return puzzle, PickAndPlace(puzzle.placed(drawn), stream(SEED, "puzzle", "hand", number))


def _planned(
    puzzle: BlockPuzzle, hand: PickAndPlace, generator: np.random.Generator, yaw: float, labels: bool
) -> tuple[str, tuple[tuple[Step, ...], dict[str, int]] | None]:
    """A plan from one look and the block that each of its names stands for; else the reason and None."""
    photo = hand.photograph(generator, yaw)
    if photo is None:
        return NOT_FOUND, None
    cloud = photo.cloud
    if not labels:
        try:
            cloud = segmented_scene(PointCloud(cloud.points, None, cloud.colours, camera=cloud.camera), "z").cloud
        except InputError:
            return NOT_FOUND, None
    scene = perceived_scene(cloud, shipped_model())
    matched = {label: label for label in scene.objects}
    if not labels:
        matched = matched_objects(overlaps(photo.cloud.labels, cloud.labels))
    names = {true - FIRST_OBJECT: f"o{found}" for found, true in matched.items()}
    if set(names) < set(range(len(puzzle.cubes))):
        return NOT_FOUND, None
    plan = _plan(scene, puzzle, names)
    return NO_PLAN, None if plan is None else (plan, {name: block for block, name in names.items()})


def _plan(scene: Scene, puzzle: BlockPuzzle, names: dict[int, str]) -> tuple[Step, ...] | None:
    """The planner's plan for the goal in the names of the perceived objects."""
    goal = goal_text(puzzle, names)
    return solve(DOMAIN, scene_problem(scene, PLAN_CONFIDENCE, read_goal(goal)))


def goal_text(puzzle: BlockPuzzle, names: dict[int, str]) -> str:
    """The goal as `lifelore perceive --goal` takes it."""
    return " and ".join(
        f"{relation}({', '.join(names[block] for block in blocks)})" for relation, blocks in puzzle.wishes()
    )


def _carried_out(hand: PickAndPlace, step: Step, stands_for: dict[str, int]) -> str | None:
    """The fault of a step, or None."""
    if not all(name in stands_for for name in step.arguments):
        return NO_BLOCK
    moves = {
        "pick-up": hand.pick_up,
        "put-on": hand.put_on,
        "put-on-table": hand.put_on_table,
        "put-beside": hand.put_beside,
    }
    return moves[step.action](*(stands_for[name] for name in step.arguments))
