"""`live_in`: an agent lives in a world of the user, through the `World` protocol only."""

import time
import warnings
from collections.abc import Hashable
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from threading import Event

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.external_world.context_code import MOST_ACTIONS, ContextCodes
from lifelore.agent.external_world.stored_prior import recalled_prior
from lifelore.agent.external_world.task import ExternalLearner, ExternalTask
from lifelore.agent.life.loop import LivedTask, opened_memory, run_life
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.agent.live.output.long_table import LongTable
from lifelore.agent.live.summary import plain, third
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.metrics import mean_estimate
from lifelore.core.protocols import Progress, Record, World
from lifelore.core.streams import stream
from lifelore.memory import Memory

AGENTS = ("lore", "scratch")
MEASURES = ("first_return", "mean_return", "final_return")


def live_in(
    world: World,
    *,
    tasks: int = 20,
    episodes: int = 200,
    max_steps: int = 1000,
    memory: str | Path | None = None,
    robot: str = "robot",
    key: str | None = None,
    seed: int = 0,
    discount: float = 0.95,
    learning_rate: float = 0.5,
    epsilon: float = 1.0,
    epsilon_decay: float = 0.98,
    epsilon_floor: float = 0.01,
    alpha0: float = 0.1,
    weight: float = 1.0,
    form: str = "proportion",
    ties: str = "uniform",
    csv: str | Path | None = None,
    progress: Progress | None = None,
    stop: Event | None = None,
) -> dict:
    """Live through `tasks` tasks of a world with two agents, ``lore`` and ``scratch``, on the same random streams.

    Both agents learn each task by ε-greedy Q-learning from Q = 0. ``scratch`` explores uniformly. ``lore``
    explores by the action prior of its earlier tasks: after each task, the useful actions of the learnt policy
    are counted by context. In a task with a positive value, these are the best actions of the states with a
    positive value. In a task without (each step costs, no reward is positive), they are relative to the task's
    best return: the best of the actions taken in the best tenth of the episodes, of those that ended.

    Parameters
    ----------
    world : World
        `GymnasiumWorld`, or your own object. `live_in` does not close it.
    tasks, episodes, max_steps : int
        Tasks to live through now, episodes of a task, maximum steps of an episode; ≥ 1.
    memory : str or Path, optional
        SQLite file or ``postgresql://`` URL that holds earlier lives and stores this one, one transaction a
        task. None: start without knowledge and store nothing (`live` uses the user's memory instead).
    robot : str
        Name of the robot in memory.
    key : str, optional
        The meaning of the contexts. Lives with the same key and number of actions share their prior. Default:
        ``world.context_key``, which `GymnasiumWorld` has; its documentation names what that key cannot
        distinguish. Not needed without a memory.
    seed : int
        Draws the seeds of the episodes and the agents' choices.
    discount : float
        γ in [0, 1].
    learning_rate, epsilon, epsilon_decay, epsilon_floor : float
        As in `QLearning`.
    alpha0, weight, form, ties : float, float, str, str
        As in `PriorSettings`.
    csv : str or Path, optional
        File for the measures of each task and the return of each episode in long format, see
        `lifelore.agent.live.output.long_table`.
    progress : callable, optional
        Called as ``progress(done, total, label)`` before the first task and after each task.
    stop : threading.Event, optional
        Set it to stop early: the task in progress is dropped, the finished tasks stay.

    Returns
    -------
    dict
        The JSON document of `live`, with null for the values that such a world does not give (map, goals,
        optimum, collisions, steps and episodes to 80 %). Returns are discounted; ``final_return`` is the mean of
        a task's last tenth of episodes, ``mean_return`` of all episodes; ``reached``: an episode terminated with
        a positive reward. ``summary`` compares the agents over the last third of the tasks; ``n_contexts``: the
        number of contexts in the prior at the end. ``warnings``: sentences on what makes the life useless, such
        as a prior that is still empty; empty where all is well.

    Warns
    -----
    UserWarning
        Each sentence of ``warnings``.

    Raises
    ------
    InputError
        A setting breaks its rule; a reward is not finite; a context has no stable code (see
        `lifelore.agent.external_world.context_code.context_code`); a memory is given without a key.
    StoreError
        Memory cannot store the task, or the CSV file cannot be written; earlier tasks stay stored.
    """
    began = time.perf_counter()
    _check_tasks(tasks)
    _check_world(world)
    learning = QLearning(episodes, max_steps, learning_rate, epsilon, epsilon_decay, epsilon_floor)
    key = _key_of(world, key, needed=memory is not None)
    settings = _Settings(
        tasks, robot, key, seed, discount, learning, PriorSettings("observation", alpha0, weight, form, ties)
    )
    with (
        LongTable(csv, seed) if csv is not None else nullcontext() as table,
        opened_memory(memory) as opened,
    ):
        life = _ExternalLife(world, settings, opened, table)
        run_life(life, tasks, memory=opened, robot=robot, progress=progress, stop=stop)
        report = life.report(time.perf_counter() - began)
    for sentence in report["warnings"]:
        warnings.warn(sentence, stacklevel=2)
    return report


@dataclass(frozen=True)
class _Settings:
    """Checked settings of a life."""

    tasks: int
    robot: str
    key: str | None
    seed: int
    discount: float
    learning: QLearning
    guidance: PriorSettings

    def __post_init__(self) -> None:
        if not 0 <= self.discount <= 1:
            raise InputError(f"discount must lie in [0, 1], got {self.discount}")
        if not self.robot.strip():
            raise InputError("robot must have a name, got an empty text; name the robot")

    def to_dict(self) -> dict:
        learning, guidance = self.learning, self.guidance
        return {
            "tasks": self.tasks,
            "robot": self.robot,
            "key": self.key,
            "discount": self.discount,
            "episodes": learning.episodes,
            "max_steps": learning.max_steps,
            "learning_rate": learning.learning_rate,
            "epsilon": learning.epsilon,
            "epsilon_decay": learning.epsilon_decay,
            "epsilon_floor": learning.epsilon_floor,
            "alpha0": guidance.alpha0,
            "weight": guidance.weight,
            "form": guidance.form,
            "ties": guidance.ties,
        }


def _check_tasks(tasks: int) -> None:
    if not isinstance(tasks, int) or not 1 <= tasks <= 10**9:
        raise InputError(f"tasks must be a whole number from 1 to 10^9, got {tasks}")


def _check_world(world: World) -> None:
    if not isinstance(world, World):
        raise InputError(
            "world must have n_actions, reset, step and context (lifelore.core.protocols.World), got "
            f"{type(world).__name__}; wrap a Gymnasium environment in GymnasiumWorld"
        )
    if not 1 <= world.n_actions <= MOST_ACTIONS:
        raise InputError(f"world.n_actions must lie in [1, {MOST_ACTIONS}], got {world.n_actions}")


def _key_of(world: World, key: str | None, needed: bool) -> str | None:
    if key is None and needed:
        key = getattr(world, "context_key", None)
        if not key:
            raise InputError(
                f"key must name the meaning of the contexts of {type(world).__name__} for the memory, "
                'got none; pass key="..."'
            )
    elif key is not None and not key.strip():
        raise InputError(
            "key must name the meaning of the contexts, got an empty text; leave it out for the key of the world"
        )
    return key


class _ExternalLife:
    """A life in progress: its prior, and the memory that stores it."""

    def __init__(self, world: World, settings: _Settings, memory: Memory | None, table: LongTable | None) -> None:
        self.world, self.settings, self.memory, self.table = world, settings, memory, table
        self.name = str(getattr(world, "name", type(world).__name__))
        self.tasks_before = memory.tasks(settings.robot) if memory else 0
        self.codes, self.states, self.finished = ContextCodes(), set[Hashable](), list[dict]()

    def recall(self) -> None:
        """Read the prior of the key; an empty one without a memory."""
        alpha0 = self.settings.guidance.alpha0
        self.prior = recalled_prior(self.memory, self.settings.key, self.world.n_actions, alpha0)

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task with each agent."""
        task = self._task(number, stop)
        learners = {name: self._learner(name, number) for name in AGENTS}
        agents = {name: task.live(learner) for name, learner in learners.items()}
        counts = self._learn(learners["lore"])
        records = [counts] if len(counts.slots) else []
        return LivedTask(records, {"index": number, "world": self.name}, (number, agents, learners))

    def finish(self, lived: LivedTask) -> None:
        """Report a task."""
        number, agents, learners = lived.result
        for learner in learners.values():
            self.states.update(learner.q)
        self.finished.append({"index": number, "goal": None, "optimal_return": None, "agents": agents})
        if self.table:
            returns = {name: {"return": learner.returns.returns} for name, learner in learners.items()}
            self.table.add(self.finished[-1], returns)

    def _task(self, index: int, stop: Event) -> ExternalTask:
        learning, discount = self.settings.learning, self.settings.discount
        drawn = stream(self.settings.seed, "task", index, "world").integers(2**31, size=learning.episode_cap)
        return ExternalTask(self.world, self.codes, learning, discount, index, drawn.tolist(), stop)

    def _learner(self, name: str, index: int) -> ExternalLearner:
        # Equal streams for both agents make their comparison paired.
        own = stream(self.settings.seed, "task", index, "own")
        prior = self.prior if name == "lore" else None
        return ExternalLearner(self.world.n_actions, prior, self.settings.guidance, own)

    def _learn(self, learner: ExternalLearner) -> Record:
        """Count the policy of a finished task (Eq. 3.5, 3.7); return the contribution."""
        news = ActionPrior(self.prior.n_actions, self.prior.alpha0, self.prior.key)
        news.update(*learner.best(), self.settings.guidance.weight)
        self.prior.merge(news)
        return news.to_record({"prior": "foreign", "world": self.name, "means": self.settings.key})

    def report(self, seconds: float) -> dict:
        location = self.memory.location if self.memory else None
        return {
            "domain": self.name,
            "map": None,
            "n_states": len(self.states),
            "n_contexts": len(self.prior),
            "seed": self.settings.seed,
            "settings": self.settings.to_dict() | {"memory": location},
            "tasks": self.finished,
            "summary": _summarise(self.finished) if self.finished else {},
            "memory": {"tasks_before": self.tasks_before, "tasks_after": self.tasks_before + len(self.finished)},
            "warnings": self._warnings(),
            "seconds": round(seconds, 3),
        }

    def _warnings(self) -> list[str]:
        if len(self.prior) or not self.finished:
            return []
        return [
            f"The action prior is empty after {len(self.finished)} tasks in {self.name}, so lore explores like "
            "scratch: no task had a positive value, nor an ended episode with a better return than others. "
            "Use more episodes or steps, or another reward."
        ]


def _summarise(tasks: list[dict]) -> dict:
    last = third(tasks, "last")
    return {
        "lore_vs_scratch": {
            "jumpstart": _difference(last, "first_return"),
            "mean_return_difference": _difference(last, "mean_return"),
            "final_return_difference": _difference(last, "final_return"),
            "never_reached": {who: sum(not t["agents"][who]["reached"] for t in last) for who in AGENTS},
        },
        "agents": {
            name: {which: _means(third(tasks, which), name) for which in ("first", "last")} for name in AGENTS
        },
    }


def _difference(tasks: list[dict], measure: str) -> dict:
    """The paired difference of lore and scratch, and their means."""
    values = np.array([[task["agents"][name][measure] for name in AGENTS] for task in tasks], float)
    raw = dict(zip(AGENTS, values.mean(axis=0).tolist(), strict=True))
    return plain(mean_estimate(values[:, 0] - values[:, 1])) | {"raw": raw}


def _means(tasks: list[dict], name: str) -> dict:
    return {m: plain(mean_estimate([task["agents"][name][m] for task in tasks])) for m in MEASURES}
