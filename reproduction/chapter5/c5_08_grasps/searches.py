"""Searches for grasps in a perceived scene: from seeds, without seeds, and carried over from another scene."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop.pose import aligned
from lifelore.perception.scene import Scene
from lifelore.perception.topology.grasp_seeds import GraspSeed
from reproduction.chapter2.scenes.substructure import Roles
from reproduction.chapter5.c5_08_grasps.parallel_gripper import OPENING, Grasp

JITTER, TURN, BACK = 0.01, 0.3, 0.04
"""Around a pose that is tried again: metres (standard deviation), radians (the same), metres that the hand stays
back at most."""
DEEP = 0.01
"""Metres behind a seen point at which unseeded fingers close."""
UP = np.array([0.0, 0.0, 1.0])


def from_seeds(seeds: list[GraspSeed], rng: np.random.Generator) -> Iterator[Grasp]:
    """Each seed that the open hand spans, first as it is, then near it; nothing without such seeds."""
    fit = [Grasp(seed.position, seed.approach, seed.closing) for seed in seeds if seed.width <= OPENING]
    return around(fit, rng, BACK)


def around(grasps: list[Grasp], rng: np.random.Generator, back: float = 0.0) -> Iterator[Grasp]:
    """Each grasp as it is, then near it, the hand up to `back` metres farther back."""
    yield from grasps
    while grasps:
        for grasp in grasps:
            yield near(grasp, rng, back)


def near(grasp: Grasp, rng: np.random.Generator, back: float) -> Grasp:
    """A grasp moved and turned a little, the hand up to `back` metres farther back."""
    angle = rng.normal(0, TURN)
    closing = np.cos(angle) * grasp.closing + np.sin(angle) * np.cross(grasp.approach, grasp.closing)
    shift = rng.normal(0, JITTER, 3) - rng.uniform(0, back) * grasp.approach
    return Grasp(grasp.position + shift, grasp.approach, closing)


def anywhere(points: NDArray[np.float64], rng: np.random.Generator) -> Iterator[Grasp]:
    """Grasps behind random seen points ``(n, 3)``, from random directions above the horizon."""
    while True:
        approach = rng.normal(size=3)
        approach[2] = -abs(approach[2])
        approach /= np.linalg.norm(approach)
        yield Grasp(points[rng.integers(len(points))] + DEEP * approach, approach, _across(approach, rng))


def from_above(points: NDArray[np.float64], rng: np.random.Generator) -> Iterator[Grasp]:
    """Grasps at the middle of the seen points ``(n, 3)`` straight from above, the fingers turned at random."""
    while True:
        yield Grasp(points.mean(axis=0), -UP, _across(-UP, rng))


def _across(approach: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.float64]:
    """A random unit vector at right angles to another."""
    frame, angle = aligned(approach), rng.uniform(0, 2 * np.pi)
    return frame[:, 0] * np.cos(angle) + frame[:, 1] * np.sin(angle)


def carried(grasp: Grasp, first: Scene, label: int, second: Scene, other: int, roles: Roles) -> list[Grasp]:
    """A grasp of an object carried to the object that corresponds to it, by their contact points; both ways round.

    The frame of an object has its origin amid the contact points, its first axis along the longest level distance
    between two of them, and its third axis up. Along the first axis, lengths scale with that distance. Contact
    points of the same kind may be exchanged, so the grasp turned by 180° about the third axis comes second. Empty
    if the contact points lie above one another.
    """
    own = sorted(role for role in roles if len(role) == 2 and role[0] == label)
    before = np.array([first.position(*node) for node in own]).reshape(-1, 3)
    after = np.array([second.position(*roles[node]) for node in own]).reshape(-1, 3)
    if len(own) < 2 or any(roles[node][0] != other for node in own):
        return []
    apart = np.linalg.norm((before[:, None] - before[None])[..., :2], axis=2)
    i, j = np.unravel_index(int(apart.argmax()), apart.shape)
    old, new = _frame(before[j] - before[i]), _frame(after[j] - after[i])
    if old is None or new is None:
        return []
    scale = np.linalg.norm((after[j] - after[i])[:2]) / np.linalg.norm((before[j] - before[i])[:2])
    local = (grasp.position - before.mean(axis=0)) @ old
    local[0] *= scale
    both = []
    for frame in (new, new * [-1, -1, 1]):
        turn = frame @ old.T
        both.append(Grasp(after.mean(axis=0) + frame @ local, turn @ grasp.approach, turn @ grasp.closing))
    return both


def _frame(along: NDArray[np.float64]) -> NDArray[np.float64] | None:
    level = along * [1, 1, 0]
    length = float(np.linalg.norm(level))
    if length < 0.01:
        return None
    return np.stack([level / length, np.cross(UP, level / length), UP], axis=1)
