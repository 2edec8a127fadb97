"""Settings of `live`, with two groups: the world and the memory; and those of action priors.

The first sentence on a setting stands in ``lifelore live --settings``.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from math import ceil
from os import PathLike, fspath
from typing import Any

from lifelore.action.priors.action_prior import FORMS, MOST_WEIGHT
from lifelore.action.priors.exploration import TIES
from lifelore.agent.live.goals.job_list import Job, read_jobs
from lifelore.core.errors import InputError
from lifelore.core.keyed_settings import arguments_by_key, keys_of
from lifelore.domains.worlds import WorldSettings

MOST_REWARD = 1e6
"""Largest magnitude of rewards and of α⁰: a larger number hides the others by rounding."""
LONGEST_NAME = 200
LIFE_KEYS = {"location": "memory"}
"""The key of each setting whose key, flat beside all others, is not its name."""

Place = tuple[float, float] | str
"""In buildings x and y in metres of the map's frame, or a name that memory knows; else row and column."""


@dataclass(frozen=True)
class PriorSettings:
    """How finished tasks become an action prior, and how the prior guides exploration (Eq. 3.4, §3.2.2.1).

    Parameters
    ----------
    alpha0 : float
        Pseudo-count α⁰ of every action in the prior, > 0.
    weight : float
        Weight w(π) of each finished task in the prior, ≥ 0.
    form : {"proportion", "dirichlet", "softmax", "support", "tempered"}
        How counts become probabilities in Q-learning. See `lifelore.action.priors.action_prior.FORMS`.
    ties : {"uniform", "prior"}
        How the greedy step of Q-learning breaks ties.

    Raises
    ------
    InputError
        A setting is out of its range.
    """

    alpha0: float = 0.1
    weight: float = 1.0
    form: str = "proportion"
    ties: str = "uniform"

    def __post_init__(self) -> None:
        _check_choice("form", self.form, FORMS)
        _check_choice("ties", self.ties, TIES)
        if not 0 < self.alpha0 <= MOST_REWARD:
            raise InputError(f"alpha0 must be positive and at most {MOST_REWARD:g}, got {self.alpha0}")
        if not 0 <= self.weight <= MOST_WEIGHT:
            raise InputError(f"weight must lie in [0, {MOST_WEIGHT:g}], got {self.weight}")


@dataclass(frozen=True)
class MemorySettings:
    """Where the life is stored, and under which name.

    Parameters
    ----------
    location : str, optional
        SQLite file or ``postgresql://`` URL; None: the user's own memory.
    robot : str
        Name of the robot in memory, 1 to 200 printable characters. Processes of one name take different tasks.
    building : str, optional
        Name of the building, which otherwise is recognised. The map must fit the remembered building of this name,
        or the building is a new one. A new one without a name gets that of its map.
    refresh : bool
        Whether to recall before each task what other robots and processes have stored since the last.

    Raises
    ------
    InputError
        A name breaks its rule.

    Examples
    --------
    >>> MemorySettings("office.db", robot="rosie").refresh
    False
    """

    location: str | None = None
    robot: str = "robot"
    building: str | None = None
    refresh: bool = False

    def __post_init__(self) -> None:
        for label, name in (("robot", self.robot), ("building", self.building)):
            if name is not None and not (name.strip() and name.isprintable() and len(name) <= LONGEST_NAME):
                raise InputError(
                    f"{label} must be a name of 1 to {LONGEST_NAME} printable characters, got {name[:40]!r}"
                )


@dataclass(frozen=True)
class LifeSettings:
    """Settings of `live`.

    Parameters
    ----------
    world : WorldSettings
        The world to live in; `world.seed` draws the tasks and the agents' choices too.
    alpha0 : float
        Pseudo-count α⁰ of every action in the prior, > 0.
    weight : float
        Weight w(π) of each finished task in the prior, ≥ 0.
    episodes : int, optional
        Maximum number of episodes of a task; by default 100, or as many as give ten steps to each state.
    max_steps : int, optional
        Maximum number of steps of an episode; by default 2,000 in buildings, 1,000 in the thesis's worlds.
    memory : MemorySettings
    agent : str
        The agent that lives and whose knowledge is stored, one of `lifelore.agent.live.baselines.AGENTS`;
        ``scratch`` lives the same tasks for comparison. ``all``: `lore` and every baseline.
    compare : bool, optional
        Whether ``scratch`` lives the same tasks for comparison; by default up to 100,000 places. Of driven jobs,
        whether they are also planned on the map alone; by default in a busy building.
    tasks : int
        Tasks to live through now, ≥ 1; `goals` overrides it, see `n_tasks`.
    destinations : int
        Number of recurring places that hidden goals are drawn from and remembered at; 0: every place. Agents that
        remember transitions then remember where goals were found, and try those first (``goals.goal_counts``).
        Known goals are not drawn: with `goal` or `goals` it changes nothing.
    start : (x, y) or str, or (row, column), optional
        Place in which every episode, and every drive to `goal`, starts: X,Y in metres or a known name, or ROW,COL;
        by default any. X and Y are for buildings, in the map's frame; ROW and COL are for other worlds. The first
        job of `goals` starts there, every other one where the robot stands.
    goal : (x, y) or str, or (row, column), optional
        Goal of every task; in a building the robot knows where it is, and drives there. None: drawn, and hidden.
    goals : tuple of Job
        Buildings alone: known goals of the tasks in order, one task a job, see ``goals.job_list.read_jobs``.
    again : bool
        Whether to start an interrupted job list with its first job. Otherwise with its first unfinished one.
    busy : bool, optional
        Whether the simulated building has rush hours, slow corridors, and doors and passages that are closed at
        times, while goals are driven to; by default in a generated office and not on your own map.
    move_names : bool
        Whether a name of `goals` may move from its remembered place to one that is more than a cell away.
    jobs : int
        Number of threads, on which results do not depend.

    Raises
    ------
    InputError
        A setting is out of its range.

    Examples
    --------
    >>> settings = LifeSettings(WorldSettings("lattice", seed=3), tasks=5)
    >>> settings.seed, settings.step_cap, settings.episode_cap(n_states=342)
    (3, 1000, 100)
    """

    world: WorldSettings = field(default_factory=WorldSettings)
    alpha0: float = 0.1
    weight: float = 1.0
    episodes: int | None = None
    max_steps: int | None = None
    memory: MemorySettings = field(default_factory=MemorySettings)
    agent: str = "lore"
    compare: bool | None = None
    tasks: int = 30
    destinations: int = 0
    start: Place | None = None
    jobs: int = 2
    goal: Place | None = None
    goals: tuple[Job, ...] = ()
    busy: bool | None = None
    move_names: bool = False
    again: bool = False

    def __post_init__(self) -> None:
        PriorSettings(self.alpha0, self.weight)  # checks them
        for name, value in (("episodes", self.episodes), ("max_steps", self.max_steps)):
            if value is not None:
                _check_whole(name, value, 1, 10**8)
        _check_whole("tasks", self.tasks, 1, 10**6)
        _check_whole("destinations", self.destinations, 0, 10**9)
        _check_whole("jobs", self.jobs, 1, 256)
        _check_world(self.world)
        if self.goal is not None and self.goals:
            raise InputError("goal and goals exclude each other; add the goal to the list, or leave it out")
        if self.driven:
            if self.agent != "lore":
                raise InputError(
                    f"agent applies to hidden goals, which are searched, got '{self.agent}' with known goals, "
                    "which are driven to; leave out agent, or goal and goals"
                )
        elif self.goal is not None and self.destinations:
            raise InputError("goal and destinations exclude each other in worlds without a map; give one of them")
        elif self.busy or self.move_names:
            raise InputError(
                f"{'busy' if self.busy else 'move_names'} applies to goals that are driven to, got none; "
                "give goal or goals in a building, or leave it out"
            )
        if self.again and not self.goals:
            raise InputError("again applies to a job list, got none; give goals, or leave again out")
        if self.goals and self.world.domain != "building":
            raise InputError(
                f"goals needs a building, whose places have metres, got domain '{self.world.domain}'; "
                "use goal with ROW,COL"
            )

    @property
    def driven(self) -> bool:
        """Whether the goals are known, so that the robot drives to them and does not search."""
        return self.world.domain == "building" and (self.goal is not None or bool(self.goals))

    @property
    def in_busy_building(self) -> bool:
        """Whether the simulated building slows and refuses moves: by default in a generated office."""
        return self.world.map is None if self.busy is None else self.busy

    @property
    def n_tasks(self) -> int:
        """Number of tasks of this life: that of the jobs, if there are any."""
        return len(self.goals) or self.tasks

    @property
    def seed(self) -> int:
        """The seed of the world, the tasks and the agents' choices."""
        return self.world.seed

    def episode_cap(self, n_states: int) -> int:
        """Maximum number of episodes of a task in a world of `n_states`."""
        return self.episodes or max(100, ceil(10 * n_states / self.step_cap))

    @property
    def step_cap(self) -> int:
        """Maximum number of steps of an episode."""
        return self.max_steps or (2000 if self.world.domain == "building" else 1000)


def _check_world(world: WorldSettings) -> None:
    """Check what the worlds themselves allow, and a life does not."""
    if world.discount is not None and not 0 < world.discount < 1:
        raise InputError(f"discount must lie in (0, 1), got {world.discount}")
    if world.goal_reward is not None and not 0 < world.goal_reward <= MOST_REWARD:
        raise InputError(f"goal_reward must be positive and at most {MOST_REWARD:g}, got {world.goal_reward}")
    if world.wall_reward is not None and not -MOST_REWARD <= world.wall_reward <= 0:
        raise InputError(f"wall_reward must be at most 0 and at least {-MOST_REWARD:g}, got {world.wall_reward}")


def _check_choice(name: str, value: str, known: tuple[str, ...]) -> None:
    if value not in known:
        raise InputError(f"{name} must be one of {', '.join(known)}, got '{value}'")


def _check_whole(name: str, value: int, least: int, most: int) -> None:
    if not (isinstance(value, int) and least <= value <= most):
        raise InputError(f"{name} must be a whole number from {least} to {most:,}, got {value}")


def life_settings(keys: Mapping[str, Any]) -> LifeSettings:
    """The settings of a life from flat keys, see `live`.

    Raises
    ------
    InputError
        A key is unknown, or a setting breaks its rule.
    """
    known = list(keys_of(LifeSettings, LIFE_KEYS))
    for key in keys:
        if key not in known:
            near = ", ".join(get_close_matches(key, known, 3)) or "lifelore live --settings lists them"
            raise InputError(f"no setting has the key '{key}'; near: {near}")
    given = {key: fspath(value) if isinstance(value, PathLike) else value for key, value in keys.items()}
    if isinstance(given.get("goals"), str):
        given["goals"] = read_jobs(given["goals"])
    return LifeSettings(**arguments_by_key(LifeSettings, given, LIFE_KEYS))
