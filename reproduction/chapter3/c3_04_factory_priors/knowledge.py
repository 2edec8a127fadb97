"""What a person knows about factories: the hand-made priors of Fig. 3.7 and the invariances of §3.4.2.

Arrays of actions by state, (n_states, n_actions) bool, in the form in which policies are counted: a row says which
actions are advised. Rows of completed states are empty.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.core.learning.known_world import GOAL, goal_distances
from lifelore.domains.factory.contexts import TO_ASSEMBLE, TO_PROCURE, items_flag
from lifelore.domains.factory.factory import ASSEMBLE, PROCURE, Factory, FactoryTask


def expert_actions(task: FactoryTask) -> NDArray[np.bool_]:
    """The expert of Fig. 3.7: to the procurement area while any item is unprocured, else to the assembly area.

    Outside the area one direction is advised, the first of a shortest path, counted in cells: a person's eye for
    distance, blind to express routes. Inside, every move that stays inside, and at each of the area's points its
    use; which point serves which component is not part of the advice.
    """
    return _advice(task, (TO_PROCURE, TO_ASSEMBLE))


def incorrect_actions(task: FactoryTask) -> NDArray[np.bool_]:
    """The expert's advice with the two areas swapped: the "critical mistake" of Fig. 3.7.

    It still moves into no wall and away from the start.
    """
    return _advice(task, (TO_ASSEMBLE, TO_PROCURE))


def _advice(task: FactoryTask, target_of_flag: tuple[int, int]) -> NDArray[np.bool_]:
    by_area = np.stack([_area_advice(task.factory, area) for area in (TO_PROCURE, TO_ASSEMBLE)])
    flags = items_flag(task)
    advice = np.zeros((task.n_configurations, *by_area.shape[1:]), np.bool_)
    for flag, area in enumerate(target_of_flag):
        advice[flags == flag] = by_area[area]
    return advice.reshape(task.domain.n_states, -1)


def _area_advice(factory: Factory, which: int) -> NDArray[np.bool_]:
    """(n_cells, n_actions) advice of one who wants to be, and work, in one of the two areas."""
    area = factory.procure_area if which == TO_PROCURE else factory.assemble_area
    use, points = (PROCURE, factory.procure_at) if which == TO_PROCURE else (ASSEMBLE, factory.assemble_at)
    nearer = _nearer(factory, area)
    first = np.arange(4) == nearer.argmax(axis=1)[:, None]
    inside = (factory.floor.neighbour >= 0) & area[factory.floor.neighbour]
    advice = np.zeros((factory.n_cells, ASSEMBLE + 1), np.bool_)
    advice[:, :4] = np.where(area[:, None], inside, first & nearer)
    advice[points, use] = True
    return advice


def distances(factory: Factory, targets: NDArray[np.bool_]) -> NDArray[np.int32]:
    """(n_cells,) moves to the nearest cell of `targets` (n_cells,) bool; walls are walked round."""
    return goal_distances(factory.floor.neighbour, np.where(targets, GOAL, 0).astype(np.int8))


def _nearer(factory: Factory, area: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(n_cells, 4) bool: the moves that bring the robot nearer to an area; none inside it."""
    distance, neighbour = distances(factory, area), factory.floor.neighbour
    return (neighbour >= 0) & (distance[neighbour] < distance[:, None])


class Invariance(NamedTuple):
    """Something that holds in every task: `actions` (n_states, n_actions) bool, in `states` (n_states,) bool.

    `wanted`: whether a prior that has learnt it favours the actions or shuns them.
    """

    states: NDArray[np.bool_]
    actions: NDArray[np.bool_]
    wanted: bool

    def mass(self, probs: NDArray[np.float64]) -> float:
        """Mean probability of the actions over the states, of `probs` (n_states, n_actions)."""
        return float((probs * self.actions).sum(axis=1)[self.states].mean()) if self.states.any() else float("nan")


def invariances(task: FactoryTask) -> dict[str, Invariance]:
    """The invariances that §3.4.2 names, by name.

    Returns
    -------
    "wall moves"
        Shunned; where at least one move is refused.
    "express routes"
        Favoured: moves onto a route, where there is the choice between a route and a free cell.
    "uses elsewhere"
        Shunned: Procure where no procurement point is, Assemble where no assembly point is.
    "procurement first"
        Favoured: moves nearer to the procurement area while any item is unprocured; outside that area.
    "then assembly"
        Favoured: moves nearer to the assembly area once all are procured; outside that area.
    """
    factory, flags = task.factory, items_flag(task)
    neighbour = factory.floor.neighbour
    refused, onto = neighbour < 0, (neighbour >= 0) & factory.express[neighbour]
    choice = onto.any(axis=1) & (~refused & ~onto).any(axis=1)
    points = np.zeros((factory.n_cells, 2), np.bool_)
    points[factory.procure_at, 0] = points[factory.assemble_at, 1] = True
    acting, first = flags <= TO_ASSEMBLE, flags == TO_PROCURE
    everywhere = np.ones(factory.n_cells, np.bool_)

    def invariance(phase, cells, moves, uses, wanted):
        actions = np.column_stack([moves, uses if uses is not None else np.zeros((factory.n_cells, 2), bool)])
        states = np.logical_and.outer(phase, cells).ravel()
        return Invariance(states, np.tile(actions, (len(flags), 1)) & states[:, None], wanted)

    to_procure, to_assemble = (_nearer(factory, area) for area in (factory.procure_area, factory.assemble_area))
    no_moves = np.zeros_like(refused)
    return {
        "wall moves": invariance(acting, refused.any(axis=1), refused, None, False),
        "express routes": invariance(acting, choice, onto, None, True),
        "uses elsewhere": invariance(acting, everywhere, no_moves, ~points, False),
        "procurement first": invariance(first, ~factory.procure_area, to_procure, None, True),
        "then assembly": invariance(acting & ~first, ~factory.assemble_area, to_assemble, None, True),
    }
