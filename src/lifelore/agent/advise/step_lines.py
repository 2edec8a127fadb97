"""Reads steps of agents from JSON lines, or their objects: ``{"agent": …, "state": …, "action": …}``, a step each.

``state`` is the number of a state or its cell ``[row, column]``. ``action`` is the number or name of the move that
the agent tried in that state, or null: the agent has reached its goal, or asks for advice before it moves.
``class`` may name the class of agents that it shows.
"""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.json_lines import Lines, read_objects
from lifelore.domains.grids.grid_world import MOVE_NAMES, GridWorld

NO_ACTION = -1


class StepLine(NamedTuple):
    """The action that an agent tried in a state, -1: no action; and the class that it shows there, if any."""

    agent: str | int
    state: int
    action: int
    shown: str | None = None


def read_steps(lines: Lines, world: GridWorld, name: str, classes: Sequence[str] = ()) -> Iterator[StepLine]:
    """The steps in order; empty lines are skipped.

    Parameters
    ----------
    classes : sequence of str
        The classes that agents can show; without any, ``class`` is not read.

    Raises
    ------
    InputError
        A line is no such object; the message gives `name` and the number of the line.
    """
    for number, document in read_objects(lines, name):
        try:
            shown = _shown(document, classes)
            yield StepLine(_agent(document), state_number(document, world), _action(document), shown)
        except InputError as error:
            raise InputError(f"{name} line {number}: {error}") from None


def read_classes(lines: Lines, name: str) -> dict[str | int, str]:
    """The ``class`` of each agent, such as staff or visitor.

    Raises
    ------
    InputError
        A line has no class, or an agent two; the message gives `name` and the number of the line.
    """
    found: dict[str | int, str] = {}
    for number, document in read_objects(lines, name):
        given = document.get("class")
        if not isinstance(given, str) or not given:
            raise InputError(f"{name} line {number}: class must be a name such as staff, got {given!r}")
        agent = _agent(document)
        if found.setdefault(agent, given) != given:
            raise InputError(
                f"{name} line {number}: agent {agent!r} must have one class, got {given!r} after {found[agent]!r}"
            )
    return found


def _agent(document: dict[str, Any]) -> str | int:
    agent = document.get("agent")
    if isinstance(agent, bool) or not isinstance(agent, (str, int)):
        raise InputError(f"agent must be a name or a number, got {agent!r}")
    return agent


def _shown(document: dict[str, Any], classes: Sequence[str]) -> str | None:
    given = document.get("class")
    if not classes or given is None:
        return None
    if given not in classes:
        raise InputError(f"class must be one of {', '.join(classes)}, or left out, got {given!r}")
    return given


def state_number(document: dict[str, Any], world: GridWorld) -> int:
    """The number of the state in an object."""
    state = document.get("state")
    if _is_whole(state) and 0 <= state < world.n_states:  # type: ignore[operator]
        return int(state)  # type: ignore[arg-type]
    if isinstance(state, list) and len(state) == 2 and all(map(_is_whole, state)):
        row, column = state
        if 0 <= row < world.shape[0] and 0 <= column < world.shape[1] and world.state_of[row, column] >= 0:
            return int(world.state_of[row, column])
    raise InputError(
        f"state must be a number in [0, {world.n_states}) or a free cell [row, column] of this world "
        f"({world.shape[0]} rows, {world.shape[1]} columns), got {state!r}"
    )


def _action(document: dict[str, Any]) -> int:
    action = document.get("action")
    if action is None and "action" in document:
        return NO_ACTION
    if isinstance(action, str) and action in MOVE_NAMES:
        return MOVE_NAMES.index(action)
    if _is_whole(action) and 0 <= action < len(MOVE_NAMES):  # type: ignore[operator]
        return int(action)  # type: ignore[arg-type]
    raise InputError(f"action must be 0 to 3, {', '.join(MOVE_NAMES)}, or null, got {action!r}")


def _is_whole(value: Any) -> bool:
    return isinstance(value, (int, np.integer)) and not isinstance(value, bool)
