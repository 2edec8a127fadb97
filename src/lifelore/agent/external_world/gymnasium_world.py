"""Turns a Gymnasium environment with discrete actions into a `World` whose tasks differ by seed or by a function.

An environment draws its layout and all random outcomes from the seed of `reset`. A *task* must stay the same in
all its episodes, so each episode is reset with the seed of the task. Then the environment's generator gets the
seed of the episode, so that outcomes (slips, dealt cards) differ.
"""

import inspect
from collections.abc import Callable, Hashable, Mapping
from contextlib import AbstractContextManager
from typing import Any, Literal, SupportsFloat, get_args

import gymnasium
import numpy as np
from gymnasium.spaces import Discrete

from lifelore.core.errors import InputError
from lifelore.core.streams import stream

ResetBy = Literal["task", "episode"]
STEP_PARTS = ("observation", "reward", "terminated", "truncated", "info")


class GymnasiumWorld(AbstractContextManager):
    """An environment of the user as a world for `live_in`; implements `lifelore.core.protocols.World`.

    Parameters
    ----------
    env_or_factory : gymnasium.Env or callable
        One environment whose tasks differ by the seed of `reset`, or a function from task number to
        environment. The environments of the function are closed when the task changes; a given environment
        is closed by `close` only.
    context : callable, optional
        ``context(observation)`` or ``context(observation, last_reward)`` to hashable features. The
        prior counts useful actions for each value and uses them in other tasks. Default: the state itself.
    state : callable, optional
        ``state(observation)`` to a hashable state, over which each task is learnt. Default: `hashable`. With a
        partial view, different places become one state; a continuous observation gives a new state at every
        step.
    seed : int
        Selects the tasks: task t is reset with a number drawn from (seed, t).
    reset_by : {"task", "episode"}
        ``task``: each episode of a task has the same layout and start. ``episode``: `reset` uses the seed of the
        episode, for environments whose `reset` draws only the start.

    Raises
    ------
    InputError
        Actions are not ``Discrete`` or differ between tasks. Errors of the environment itself pass unchanged. A
        life refuses a `context` or `state` that is not hashable.

    Examples
    --------
    >>> import gymnasium
    >>> world = GymnasiumWorld(gymnasium.make("FrozenLake-v1"), context=lambda place: place % 4)
    >>> state = world.reset(task=3, seed=1)
    >>> world.n_actions, world.context(state, 0.0) == state % 4
    (4, True)
    """

    n_actions: int

    def __init__(
        self,
        env_or_factory: gymnasium.Env | Callable[[int], gymnasium.Env],
        context: Callable[..., Any] | None = None,
        state: Callable[[Any], Any] | None = None,
        *,
        seed: int = 0,
        reset_by: ResetBy = "task",
    ) -> None:
        if reset_by not in get_args(ResetBy):
            raise InputError(f"reset_by must be one of {', '.join(get_args(ResetBy))}, got {reset_by!r}")
        for name, function in {"context": context, "state": state}.items():
            if function is not None and not callable(function):
                raise InputError(f"{name} must be a function of the observation, got {type(function).__name__}")
        self._context, self._state, self._seed, self._reset_by = context, state, seed, reset_by
        self._with_reward = context is not None and _takes_two(context)
        self._factory = None if isinstance(env_or_factory, gymnasium.Env) else env_or_factory
        # The environment of the first task is made at once, because it defines the actions.
        self._task: int | None = 0
        self._env = _made(env_or_factory, 0)
        self.n_actions, self.first_action = _actions(self._env)
        self._current: tuple[Any, Hashable] | None = None

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the environment."""
        self._env.close()

    @property
    def env(self) -> gymnasium.Env:
        """The environment of the current task."""
        return self._env

    @property
    def observation(self) -> Any:
        """The present observation, as the environment gave it; InputError before the first."""
        if self._current is None:
            raise InputError("observation needs an episode; call reset(task, seed)")
        return self._current[0]

    @property
    def name(self) -> str:
        """The environment's registered id, else the name of its class."""
        return self._env.spec.id if self._env.spec else type(self._env.unwrapped).__name__

    def reset(self, task: int, seed: int) -> Hashable:
        """Start an episode of a task; the same task and seed give the same episode for the same actions."""
        if task != self._task:
            self._change_task(task)
        episode = stream(seed, "episode")
        number = episode if self._reset_by == "episode" else stream(self._seed, "task", task)
        try:
            found = self._env.reset(seed=int(number.integers(2**31)))
        except TypeError as error:
            if "'seed'" not in str(error):
                raise
            raise InputError(
                f"reset of {self.name} must take seed=, as reset(self, *, seed=None, options=None)"
            ) from error
        observation, _ = self._parts("reset", ("observation", "info"), found)
        if self._reset_by == "task":
            self._env.unwrapped.np_random = np.random.default_rng(int(episode.integers(2**31)))
        return self.see(observation)

    def _change_task(self, task: int) -> None:
        if self._factory:
            self._env.close()
            # If the factory fails, the closed environment must not stay the current one.
            self._task = self._current = None
            self._env = _made(self._factory, task)
            actions = _actions(self._env)
            if actions != (self.n_actions, self.first_action):
                raise InputError(
                    f"env_or_factory must make environments of one action space: task {task} has {actions[0]} "
                    f"actions from {actions[1]}, the first had {self.n_actions} from {self.first_action}"
                )
        self._task = task

    def step(self, action: int) -> tuple[Hashable, float, bool, bool]:
        """Take action number `action` of [0, n_actions): (state, reward, terminated, truncated)."""
        if self._current is None:
            raise InputError("step must follow reset, got step first; call reset(task, seed)")
        found = self._env.step(self.first_action + int(action))
        observation, reward, terminated, truncated, _ = self._parts("step", STEP_PARTS, found)
        if not isinstance(reward, SupportsFloat) or getattr(reward, "ndim", 0):
            raise InputError(
                f"reward of {self.name} must be a number, got {type(reward).__name__}; correct its step"
            )
        return self.see(observation), float(reward), bool(terminated), bool(truncated)

    def _parts(self, function: str, parts: tuple[str, ...], found: Any) -> tuple[Any, ...]:
        """What `reset` or `step` of the environment returned, as a tuple of these parts."""
        if isinstance(found, tuple) and len(found) == len(parts):
            return found
        got = f"{len(found)} values" if isinstance(found, tuple) else type(found).__name__
        raise InputError(
            f"{function} of {self.name} must return ({', '.join(parts)}), got {got}; "
            "an environment of the old Gym interface needs a wrapper, such as Shimmy's"
        )

    def context(self, state: Hashable, last_reward: float) -> Hashable:
        """Features of the current state; the observations of other states are not stored."""
        if self._current is None or state != self._current[1]:
            raise InputError(
                "state must be the last state that reset or step returned; call context right after them"
            )
        if self._context is None:
            return state
        observation = self._current[0]
        return self._context(observation, last_reward) if self._with_reward else self._context(observation)

    def see(self, observation: Any) -> Hashable:
        """The state of an observation, which is now the present one."""
        state = self._state(observation) if self._state else hashable(observation)
        self._current = observation, state
        return state


def hashable(observation: Any) -> Hashable:
    """An observation as a hashable value, the same in every process; equal observations give equal values.

    Numbers and text stay, arrays become (dtype, shape, bytes), dicts tuples of sorted (key, value), tuples and
    lists tuples.

    Raises
    ------
    InputError
        The observation holds a value of another type.
    """
    if observation is None or isinstance(observation, bool | int | float | str | bytes):
        return observation
    if isinstance(observation, np.generic):
        return observation.item()
    if isinstance(observation, np.ndarray) and not observation.dtype.hasobject:
        return (observation.dtype.str, observation.shape, observation.tobytes())
    if isinstance(observation, Mapping):
        return tuple((str(key), hashable(observation[key])) for key in sorted(observation, key=str))
    if isinstance(observation, tuple | list):
        return tuple(hashable(part) for part in observation)
    raise InputError(
        f"observation must be made of numbers, text, arrays, dicts and tuples, got {type(observation).__name__}; "
        "pass state= to convert it to a hashable value"
    )


def _made(env_or_factory: Any, task: int) -> gymnasium.Env:
    if not isinstance(env_or_factory, gymnasium.Env) and not callable(env_or_factory):
        raise InputError(
            "env_or_factory must be a gymnasium.Env or a function from task number to one, "
            f"got {type(env_or_factory).__name__}; pass gymnasium.make(...)"
        )
    env = env_or_factory if isinstance(env_or_factory, gymnasium.Env) else env_or_factory(task)
    if not isinstance(env, gymnasium.Env):
        raise InputError(f"env_or_factory must make a gymnasium.Env, got {type(env).__name__} for task {task}")
    return env


def _actions(env: gymnasium.Env) -> tuple[int, int]:
    """Number of actions, and the environment's number of the first action."""
    space = env.action_space
    if not isinstance(space, Discrete):
        raise InputError(f"actions must be Discrete, got {space}; wrap the environment so that they are")
    return int(space.n), int(space.start)


def _takes_two(function: Callable) -> bool:
    """Whether a function requires two positional arguments; False where Python cannot inspect it."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return False
    places = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    return sum(p.kind in places and p.default is p.empty for p in parameters) == 2
