"""One episode in a world of the user: states and contexts as they are met, returns as they are observed."""

import math
from collections.abc import Callable, Sequence
from threading import Event
from typing import NamedTuple

from lifelore.agent.external_world.context_code import ContextCodes
from lifelore.agent.life.loop import Stopped
from lifelore.core.errors import InputError
from lifelore.core.protocols import World

STOP_CHECK = 200
"""Steps between checks of the stop event."""


class Step(NamedTuple):
    """A step of an episode.

    state, following, context : their codes
    ended : whether the world terminated the episode
    """

    state: int
    context: int
    action: int
    reward: float
    following: int
    ended: bool


def play(
    world: World,
    task: int,
    seed: int,
    codes: ContextCodes,
    most_steps: int,
    stop: Event,
    act: Callable[[int, int], int],
    observe: Callable[[Step], None],
) -> list[Step]:
    """Play an episode of a task.

    Parameters
    ----------
    codes : ContextCodes
        Of states and contexts.
    act : callable
        ``act(state, context)`` to an action.
    observe : callable
        Called with each step.

    Raises
    ------
    InputError
        A reward is not finite, or a state or context has no code.
    Stopped
        The stop event is set.
    """
    state, reward, steps = world.reset(task, seed), 0.0, list[Step]()
    name = codes[state]
    for count in range(most_steps):
        if count % STOP_CHECK == 0 and stop.is_set():
            raise Stopped
        context = codes[world.context(state, reward)]
        action = act(name, context)
        state, reward, ended, truncated = world.step(action)
        check_reward(reward, action, task)
        following = codes[state]
        steps.append(Step(name, context, action, reward, following, ended))
        observe(steps[-1])
        name = following
        if ended or truncated:
            break
    return steps


def check_reward(reward: float, action: int, task: int) -> None:
    """InputError if a reward is not finite."""
    if not math.isfinite(reward):
        raise InputError(
            f"reward must be a finite number, got {reward} for action {action} in task {task}; "
            "correct the world's step"
        )


def discounted(steps: Sequence[Step], discount: float) -> float:
    """The return of an episode."""
    total, factor = 0.0, 1.0
    for step in steps:
        total, factor = total + factor * step.reward, factor * discount
    return total


def reached(steps: Sequence[Step]) -> bool:
    """Whether an episode was terminated with a positive reward."""
    return bool(steps) and steps[-1].ended and steps[-1].reward > 0
