"""Simulated people in a maze who do not know the way: fixed policies as tables over place and heading.

    probs[s, h + 1, a]      h the direction of the last move attempted, -1 before the first

What they know is what a person would: which moves are open where they stand, and, for the bug, in which direction
its goal lies. The learning explorer is Q-learning itself (`core.q_learning`).

Thesis: §3.7.2.2.
"""

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.domains.grids.grid_world import MOVES, GridWorld

EXPLORERS = ("random", "avoid", "left", "bug")
"""Completely random; random with obstacle avoidance; always turn left; goal seeking bug."""
LEFT_FIRST = np.array([[3, 0, 2, 1], [2, 1, 3, 0], [0, 2, 1, 3], [1, 3, 0, 2]])
"""For who is heading north, south, east, west: left, straight on, right, back."""


def explorer_probs(world: GridWorld, explorer: str, goal: int | None = None) -> NDArray[np.float64]:
    """The action probabilities of an explorer, (n_states, 5, 4), rows sum to 1.

    Parameters
    ----------
    world : GridWorld
    explorer : {"random", "avoid", "left", "bug"}
    goal : int, optional
        State the bug is bound for; the others know none.

    Raises
    ------
    NotFoundError
        No explorer has this name.
    InputError
        The bug has no goal, or another has one.
    """
    if explorer not in EXPLORERS:
        raise NotFoundError(f"explorer must be one of {', '.join(EXPLORERS)}, got '{explorer}'")
    if (goal is not None) != (explorer == "bug"):
        raise InputError(f"goal must be given for the bug and for no other, got {goal} for '{explorer}'")
    is_open = world.neighbour >= 0
    match explorer:
        case "random":
            return _whatever_the_heading(np.ones(is_open.shape, bool))
        case "avoid":
            return _whatever_the_heading(is_open)
        case "left":
            return _always_left(is_open)
        case _:
            return _whatever_the_heading(_towards(world, int(goal)))  # type: ignore[arg-type]


def _whatever_the_heading(chosen: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Each of the chosen actions as likely; any action where none is chosen."""
    chosen = chosen | ~chosen.any(axis=1, keepdims=True)
    probs = chosen / chosen.sum(axis=1, keepdims=True)
    return np.ascontiguousarray(np.broadcast_to(probs[:, None], (len(probs), len(MOVES) + 1, len(MOVES))))


def _always_left(is_open: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The leftmost open way; before the first move, any."""
    probs = _whatever_the_heading(is_open)
    for heading, order in enumerate(LEFT_FIRST):
        first = order[np.argmax(is_open[:, order], axis=1)]
        probs[:, heading + 1] = np.eye(len(MOVES))[first]
    return probs


def _towards(world: GridWorld, goal: int) -> NDArray[np.bool_]:
    """The moves that most reduce the distance in a straight line, (n_states, 4); blocked ones reduce nothing.

    Where no open move brings it nearer, the bug pushes against the wall between it and its goal: it has no memory
    and goes no way round.
    """
    offset = (world.cells[goal] - world.cells).astype(np.float64)
    now = (offset**2).sum(axis=1, keepdims=True)
    after = ((offset[:, None, :] - MOVES) ** 2).sum(axis=2)
    gain = now - after
    reachable = np.where(world.neighbour >= 0, gain, -np.inf)
    helps = reachable.max(axis=1, keepdims=True) > 0
    wanted = np.where(helps, reachable, gain)
    return wanted >= wanted.max(axis=1, keepdims=True)
