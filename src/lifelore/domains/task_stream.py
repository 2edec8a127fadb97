"""Streams of tasks with an observable context and a hidden type, for worlds in which an agent lives long.

Contexts are as frequent as the powers of their rank (Zipf); each has a usual type. A type may arrive late. Any
task can be drawn without those before it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lifelore.core.errors import InputError
from lifelore.core.streams import stream


class CountedTask:
    """A task in progress whose state is a number, and which is cut after ``longest`` actions.

    Subclasses set both class attributes, and write ``_act`` and ``_observed``.

    Parameters
    ----------
    start : int
        State at the start of an episode.
    """

    n_actions: int
    longest: int

    def __init__(self, start: int) -> None:
        self.start = start
        self._now = (start, 0, False)

    @property
    def ended(self) -> bool:
        """Whether the episode has ended by itself, or was cut."""
        return self._now[2]

    def reset(self) -> Any:
        """Back to the start; the first observation."""
        self._now = (self.start, 0, False)
        return self._observed(self.start, False)

    def step(self, action: int) -> tuple[Any, float, bool]:
        """Take an action: observation, reward, and whether the episode ended.

        Raises
        ------
        InputError
            There is no such action, or the episode has ended.
        """
        state, taken, ended = self._now
        if ended or not 0 <= action < self.n_actions:
            raise InputError(f"action must lie in [0, {self.n_actions}) before the end, got {action}")
        state, reward, over, refused = self._act(state, int(action))
        self._now = (state, taken + 1, over or taken + 1 >= self.longest)
        return self._observed(state, refused), reward, self.ended

    def _act(self, state: int, action: int) -> tuple[int, float, bool, bool]:
        """The next state, the reward, whether the episode is over, and whether the action was refused."""
        raise NotImplementedError

    def _observed(self, state: int, refused: bool) -> Any:
        """What the agent observes in a state."""
        raise NotImplementedError


@dataclass(frozen=True)
class DrawnTask:
    """A task's number, its observable context, and its hidden type."""

    number: int
    context: int
    hidden_type: str


@dataclass(frozen=True)
class TaskStream:
    """Draws the context and the hidden type of each task.

    Parameters
    ----------
    types : tuple of str
        Names of the types.
    seed : int
    n_contexts : int
        At least 1.
    zipf : float
        Context of rank r has a probability proportional to r to the power −zipf; at least 0.
    loyalty : float
        Probability in [0, 1] that a task is of its context's usual type; otherwise all types are equally likely.
    arrivals : mapping of str to int
        First task of types that arrive late; this task is surely of that type.

    Raises
    ------
    InputError
        A value breaks its rule.

    Examples
    --------
    >>> jobs = TaskStream(("careful", "hasty"), loyalty=1.0, n_contexts=1)
    >>> len({jobs.draw(number).hidden_type for number in range(20)})
    1
    """

    types: tuple[str, ...]
    seed: int = 0
    n_contexts: int = 4
    zipf: float = 1.0
    loyalty: float = 0.8
    arrivals: Mapping[str, int] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.n_contexts < 1 or not self.zipf >= 0 or not 0 <= self.loyalty <= 1:
            raise InputError(
                "n_contexts must be at least 1, zipf at least 0 and loyalty in [0, 1], got "
                f"{self.n_contexts}, {self.zipf} and {self.loyalty}"
            )
        for name, first in self.arrivals.items():
            if name not in self.types or first < 1:
                raise InputError(f"arrivals must name a type and a task from 1, got {name!r}: {first}")
        if len(set(self.arrivals.values())) < len(self.arrivals):
            raise InputError(f"arrivals must be at different tasks, got {dict(self.arrivals)}")
        if len(set(self.types)) < len(self.types) or len(self.types) <= len(self.arrivals):
            raise InputError(f"types must differ and some must be there from the start, got {self.types}")

    def present(self, number: int) -> tuple[str, ...]:
        """Types that task `number` may have."""
        return tuple(name for name in self.types if self.arrivals.get(name, 0) <= number)

    def usual_type(self, context: int) -> str:
        """The usual type of a context, one of those that are there from the start."""
        born = self.present(0)
        rng = stream(self.seed, "task stream", "usual types", 0)
        # Deal all types out before any is dealt again.
        deals = [rng.permutation(len(born)) for _ in range(-(-self.n_contexts // len(born)))]
        return born[int(np.concatenate(deals)[context])]

    def draw(self, number: int, context: int | None = None) -> DrawnTask:
        """Task `number`, from 0; in a given context, if one is chosen in place of drawn.

        Raises
        ------
        InputError
            There is no such context.
        """
        if context is not None and not 0 <= context < self.n_contexts:
            raise InputError(f"context must be from 0 to {self.n_contexts - 1}, got {context}")
        rng = stream(self.seed, "task stream", "task", number)
        weights = np.arange(1, self.n_contexts + 1) ** -float(self.zipf)
        drawn_context = int(rng.choice(self.n_contexts, p=weights / weights.sum()))
        context = drawn_context if context is None else context
        present, loyal = self.present(number), rng.random() < self.loyalty
        drawn = present[int(rng.integers(len(present)))]
        arriving = next((name for name, first in self.arrivals.items() if first == number), None)
        usual = self.usual_type(context) if loyal else drawn
        return DrawnTask(number, context, arriving or usual)
