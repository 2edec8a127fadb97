"""Demonstrations: what people did, step by step, as a file of JSON lines.

One line a step, in the order of the steps; lines of one task and agent are one demonstration, which an empty line
ends, so that the same agent can show the same task again:

    {"task": "lattice/0/goal 57", "agent": "ann", "state": 12, "action": 2}

`task` and `agent` are texts (whole numbers are taken as their digits), `state` and `action` whole numbers from 0;
further fields are left alone. Thesis: §3.4.8.
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


class Demonstration(NamedTuple):
    """What one agent did in one task: states (n,) int64 it acted in, and its actions (n,) int64."""

    task: str
    agent: str
    states: NDArray[np.int64]
    actions: NDArray[np.int64]


def demonstrations_from_lines(lines: Iterable[str], where: str = "demonstrations") -> list[Demonstration]:
    """Demonstrations in the order in which they begin.

    Raises
    ------
    InputError
        A line breaks its rule; the message gives its number and the reason.
    """
    found: list[tuple[str, str, list[tuple[int, int]]]] = []
    under_way: dict[tuple[str, str], list[tuple[int, int]]] = {}
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            under_way = {}
            continue
        try:
            task, agent, state, action = _step(line)
        except ValueError as error:
            raise InputError(f"{where}, line {number}: {error}") from None
        if (task, agent) not in under_way:
            under_way[task, agent] = []
            found.append((task, agent, under_way[task, agent]))
        under_way[task, agent].append((state, action))
    return [_demonstration(task, agent, done) for task, agent, done in found]


def read_demonstrations(path: str | Path) -> list[Demonstration]:
    """Demonstrations from a file of JSON lines; see `demonstrations_from_lines`."""
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"demonstrations {path} cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise InputError(f"demonstrations {path} must be UTF-8 text, got a bad byte at {error.start}") from None
    # Not splitlines: JSON texts may hold the further line separators of Unicode.
    return demonstrations_from_lines(text.split("\n"), str(path))


def demonstration_lines(demonstrations: Iterable[Demonstration]) -> Iterator[str]:
    """JSON lines without their line ends, one a step, and an empty one after each demonstration."""
    for one in demonstrations:
        for state, action in zip(one.states.tolist(), one.actions.tolist(), strict=True):
            yield json.dumps({"task": one.task, "agent": one.agent, "state": state, "action": action})
        yield ""


def write_demonstrations(path: str | Path, demonstrations: Iterable[Demonstration], append: bool = False) -> None:
    """Write, or with `append` add to, a file of JSON lines.

    Raises
    ------
    StoreError
        The disk refuses.
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
    """Count every step of every demonstration, each visit once, with its agent's w(π) (§3.4.8).

    Parameters
    ----------
    prior : ActionPrior
        Changed in place.
    demonstrations : iterable of Demonstration
    contexts_of : callable
        The (n,) contexts of a demonstration's states.
    weights : mapping of agent to w(π), optional
        See `competence`; default 1 for everyone.
    """
    for one in demonstrations:
        if weights is not None and one.agent not in weights:
            raise InputError(f"weights must have one for each agent, got none for '{one.agent}'")
        weight = 1.0 if weights is None else weights[one.agent]
        prior.update_trajectory(contexts_of(one), one.actions, weight)


def _demonstration(task: str, agent: str, done: list[tuple[int, int]]) -> Demonstration:
    states, actions = np.array(done, np.int64).T
    return Demonstration(task, agent, states.copy(), actions.copy())


def _step(line: str) -> tuple[str, str, int, int]:
    try:
        told = json.loads(line)
    except (json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"is no JSON ({getattr(error, 'msg', error)})") from None
    if not isinstance(told, dict):
        raise ValueError(f"must be an object with {', '.join(FIELDS)}, got {type(told).__name__}")
    missing = [name for name in FIELDS if name not in told]
    if missing:
        raise ValueError(f"field '{missing[0]}' is missing")
    task, agent = (_name(field, told[field]) for field in ("task", "agent"))
    state, action = (_number(field, told[field]) for field in ("state", "action"))
    return task, agent, state, action


def _name(field: str, value: Any) -> str:
    if isinstance(value, bool) or not isinstance(value, (str, int)) or value == "":
        raise ValueError(f"field '{field}' must be a text or a whole number, got {json.dumps(value)[:60]}")
    return str(value)


def _number(field: str, value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < LARGEST:
        raise ValueError(f"field '{field}' must be a whole number from 0, got {json.dumps(value)[:60]}")
    return value
