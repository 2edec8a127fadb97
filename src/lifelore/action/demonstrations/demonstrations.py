"""Reads and writes demonstrations as JSON lines, and counts them into an action prior.

Each line is a step. The lines of one task and agent are one demonstration. An empty line ends it, so that the same
agent can demonstrate the same task again:

    {"task": "lattice/0/goal 57", "agent": "ann", "state": 12, "action": 2}

`task` and `agent` are texts (whole numbers are read as text), `state` and `action` whole numbers from 0. Other
fields are ignored. Thesis: §3.4.8.
"""

import json
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.core.errors import InputError, StoreError

FIELDS = ("task", "agent", "state", "action")
LARGEST = 2**62
"""States and actions must be smaller, so that codes made of them fit 64 bits."""


class Demonstration(NamedTuple):
    """Steps of one agent in one task: states (n,) int64, and the actions in them (n,) int64.

    Examples
    --------
    >>> Demonstration("kitchen", "ada", np.array([0, 1]), np.array([1, 1])).agent
    'ada'
    """

    task: str
    agent: str
    states: NDArray[np.int64]
    actions: NDArray[np.int64]


def demonstrations_from_lines(lines: Iterable[str], where: str = "demonstrations") -> list[Demonstration]:
    """Demonstrations in the order in which they begin.

    Raises
    ------
    InputError
        A line breaks its rule; the message gives the number of the line and the reason.
    """
    found: list[tuple[str, str, list[tuple[int, int]]]] = []
    open_demonstrations: dict[tuple[str, str], list[tuple[int, int]]] = {}
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            open_demonstrations = {}
            continue
        try:
            task, agent, state, action = _step(line)
        except ValueError as error:
            raise InputError(f"{where}, line {number}: {error}") from None
        if (task, agent) not in open_demonstrations:
            open_demonstrations[task, agent] = []
            found.append((task, agent, open_demonstrations[task, agent]))
        open_demonstrations[task, agent].append((state, action))
    return [_demonstration(task, agent, done) for task, agent, done in found]


def read_demonstrations(path: str | Path) -> list[Demonstration]:
    """Demonstrations from a file of JSON lines; see `demonstrations_from_lines`.

    Examples
    --------
    >>> import pathlib
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "shown.jsonl")
    ...     written = path.write_text('{"task": "kitchen", "agent": "ada", "state": 0, "action": 1}')
    ...     read_demonstrations(path)[0].agent
    'ada'
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"demonstrations {path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"demonstrations {path} must be UTF-8 text, got a bad byte at {error.start}") from None
    # Not splitlines: JSON texts may hold other line separators of Unicode.
    return demonstrations_from_lines(text.split("\n"), str(path))


def demonstration_lines(demonstrations: Iterable[Demonstration]) -> Iterator[str]:
    """JSON lines without line ends: one for each step, and an empty line after each demonstration."""
    for one in demonstrations:
        for state, action in zip(one.states.tolist(), one.actions.tolist(), strict=True):
            yield json.dumps({"task": one.task, "agent": one.agent, "state": state, "action": action})
        yield ""


def write_demonstrations(path: str | Path, demonstrations: Iterable[Demonstration], append: bool = False) -> None:
    """Write a file of JSON lines, or append to it.

    Raises
    ------
    StoreError
        The file cannot be written.
    """
    text = "".join(line + "\n" for line in demonstration_lines(demonstrations))
    try:
        with Path(path).open("a" if append else "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except OSError as error:
        raise StoreError(f"demonstrations cannot be written to {path}: {error.strerror}") from None


def count_demonstrations(
    prior: ActionPrior,
    demonstrations: Iterable[Demonstration],
    contexts_of: Callable[[Demonstration], NDArray[np.int64]],
    weights: Mapping[str, float] | None = None,
) -> None:
    """Count every step of every demonstration with the w(π) of its agent (§3.4.8).

    Parameters
    ----------
    prior : ActionPrior
        Changed in place.
    demonstrations : iterable of Demonstration
    contexts_of : callable
        The (n,) contexts of a demonstration's states.
    weights : mapping of agent to w(π), optional
        See `competence`; default 1 for every agent.

    Examples
    --------
    >>> prior = ActionPrior(2)
    >>> shown = Demonstration("kitchen", "ada", np.array([0, 1]), np.array([1, 1]))
    >>> count_demonstrations(prior, [shown], lambda demonstration: demonstration.states)
    >>> prior.probs([0]).round(2).tolist()
    [[0.08, 0.92]]
    """
    for one in demonstrations:
        if weights is not None and one.agent not in weights:
            raise InputError(f"weights must have a number for each agent, got none for '{one.agent}'")
        weight = 1.0 if weights is None else weights[one.agent]
        prior.update_trajectory(contexts_of(one), one.actions, weight)


def _demonstration(task: str, agent: str, done: list[tuple[int, int]]) -> Demonstration:
    states, actions = np.array(done, np.int64).T
    return Demonstration(task, agent, states.copy(), actions.copy())


def _step(line: str) -> tuple[str, str, int, int]:
    try:
        step = json.loads(line)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"must be JSON, got other text ({getattr(error, 'msg', error)})") from None
    if not isinstance(step, dict):
        raise ValueError(f"must be an object with {', '.join(FIELDS)}, got {type(step).__name__}")
    missing = [name for name in FIELDS if name not in step]
    if missing:
        raise ValueError(f"field '{missing[0]}' is missing")
    task, agent = (_name(field, step[field]) for field in ("task", "agent"))
    state, action = (_number(field, step[field]) for field in ("state", "action"))
    return task, agent, state, action


def _name(field: str, value: Any) -> str:
    if isinstance(value, bool) or not isinstance(value, (str, int)) or value == "":
        raise ValueError(f"field '{field}' must be a text or a whole number, got {json.dumps(value)[:60]}")
    return str(value)


def _number(field: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < LARGEST:
        raise ValueError(f"field '{field}' must be a whole number from 0, got {json.dumps(value)[:60]}")
    return value
