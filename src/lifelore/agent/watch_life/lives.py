"""The lives in a memory: the tasks of each robot, by kind of task, as `live` and `live_long` have stored them."""

from collections import Counter
from collections.abc import Iterator
from typing import Any

from lifelore.agent.live import transitions
from lifelore.agent.long_lived.explanation import explained
from lifelore.core.errors import NotFoundError
from lifelore.memory import Memory

TYPES, GRID = "types", "grid"
"""Kinds of lives: tasks of hidden types, and tasks with goals on a map."""
UNNAMED = "grid"
"""Domain of tasks on a map of which memory knows no move."""
MOST_TASKS = 2000
"""Largest number of tasks that are listed, the last ones."""


def lives_in(memory: Memory) -> list[dict[str, Any]]:
    """An entry for each robot and domain: ``robot``, ``domain``, ``kind`` (see `TYPES`), ``tasks`` (how many)."""
    found = Counter(
        (robot, domain, kind) for robot in memory.robots() for domain, kind, _ in _documents(memory, robot)
    )
    return [
        {"robot": robot, "domain": domain, "kind": kind, "tasks": tasks}
        for (robot, domain, kind), tasks in sorted(found.items())
    ]


def tasks_of(memory: Memory, robot: str, domain: str) -> list[dict[str, Any]]:
    """The last `MOST_TASKS` tasks of a life by number, each as a short document.

    Tasks of hidden types have ``task``, ``context``, ``first`` and ``last`` return, ``best`` possible return,
    ``new_type`` and ``learnt``; tasks on a map ``task``, ``goal`` (row, column), ``world``, ``agents`` (numbers of
    each agent) and ``places`` (number of known places), as far as they were stored.

    Raises
    ------
    NotFoundError
        The robot has no task of this domain.
    """
    rows = [_row(one) if kind == TYPES else _grid_row(one) for kind, one in _tasks(memory, robot, domain)]
    return sorted(rows, key=lambda row: row["task"])[-MOST_TASKS:]


def task_of(memory: Memory, robot: str, domain: str, number: int) -> dict[str, Any]:
    """A task of a life: what was stored, and for tasks of hidden types ``words``, why the agent acted so, by line.

    Raises
    ------
    NotFoundError
        There is no such task.
    """
    for kind, document in _tasks(memory, robot, domain):
        if kind == TYPES and document["task"] == number:
            return document | {"words": explained(document)}
        if kind == GRID and document["index"] == number:
            return _grid_row(document)
    raise NotFoundError(
        f"robot {robot!r} has no task {number} of {domain!r} in this memory; /v1/lives/tasks lists all"
    )


def _tasks(memory: Memory, robot: str, domain: str) -> list[tuple[str, dict[str, Any]]]:
    found = [(kind, document) for name, kind, document in _documents(memory, robot) if name == domain]
    if not found:
        raise NotFoundError(f"robot {robot!r} has no task of {domain!r} in this memory; /v1/lives lists all lives")
    return found


def _documents(memory: Memory, robot: str) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Domain and kind of a robot's tasks, and what was stored; other documents are left out."""
    world_names = {key: str(about.get("world")) for key, _, about in memory.keys(transitions.KIND)}
    for document in memory.task_descriptions(robot):
        if {"first_episode", "domain"} <= document.keys():
            yield document["domain"], TYPES, document
        elif {"index", "goal", "world"} <= document.keys():
            yield world_names.get(document["world"], UNNAMED), GRID, document


def _row(document: dict[str, Any]) -> dict[str, Any]:
    return {
        "task": document["task"],
        "context": document["context"],
        "first": document["returns"][0],
        "last": document["returns"][-1],
        "best": document["best_return"],
        "new_type": document["new_type"],
        "learnt": document["learnt"],
    }


def _grid_row(document: dict[str, Any]) -> dict[str, Any]:
    kept = {
        name: document[name] for name in ("goal", "how", "world", "agents", "places", "name") if name in document
    }
    return {"task": document["index"], **kept}
