"""`live_in`: an agent lives in a world of the user, through the `World` protocol only."""

import time
import warnings
from collections.abc import Hashable, Mapping
from contextlib import nullcontext
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from threading import Event

from lifelore.agent.any_tasks.experience import Experience
from lifelore.agent.any_tasks.moves import MoveCodes, counted
from lifelore.agent.any_tasks.one_task import OneTask
from lifelore.agent.any_tasks.task_differences import TaskDifferences
from lifelore.agent.any_tasks.task_result import TaskResult
from lifelore.agent.any_tasks.task_settings import AGENTS as ABLATIONS
from lifelore.agent.any_tasks.task_settings import TaskSettings, check_names
from lifelore.agent.external_world.context_code import CONTEXT_BITS, MOST_ACTIONS, context_code
from lifelore.agent.external_world.life_summary import summarise_life, task_measures
from lifelore.agent.external_world.life_warnings import ContextNovelty, life_warnings, new_states
from lifelore.agent.external_world.own_agent import OwnAgent, WatchedWorld, check_own_agents
from lifelore.agent.life.loop import LivedTask, opened_memory, run_life
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.agent.live.output.long_table import LongTable
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.protocols import Progress, World
from lifelore.core.streams import stream
from lifelore.memory import Memory

AGENTS = ("lore", "scratch", "textbook")
MOST_COMPARED = 5000
"""Steps of a task by which tasks are told apart; more cost time and tell finer differences."""
NO_CONTEXT = context_code(None, CONTEXT_BITS)
"""Code of the context of tasks that have none."""
TEXTBOOK = {"epsilon": 0.1, "epsilon_decay": 1.0, "epsilon_floor": 0.1}
"""The textbook agent's ε: constant, as in Sutton and Barto (2018), "Reinforcement Learning", Example 6.6."""


def live_in(
    world: World,
    *,
    tasks: int = 20,
    episodes: int = 200,
    max_steps: int = 1000,
    memory: str | Path | None = None,
    robot: str = "robot",
    key: str | None = None,
    agents: Mapping[str, OwnAgent] | None = None,
    seed: int = 0,
    discount: float = 0.95,
    learning_rate: float = 0.5,
    epsilon: float = 1.0,
    epsilon_decay: float = 0.5,
    epsilon_floor: float = 0.05,
    alpha0: float = 0.1,
    weight: float = 1.0,
    form: str = "proportion",
    ties: str = "uniform",
    csv: str | Path | None = None,
    progress: Progress | None = None,
    stop: Event | None = None,
) -> dict:
    """Live through `tasks` tasks of a world with several agents, on the same episodes and random streams.

    ``lore``, ``scratch`` and ``textbook`` learn each task by ε-greedy Q-learning from Q = 0. ``lore`` explores by
    the action prior of its earlier tasks, ``scratch`` uniformly with the same ε. ``textbook`` explores uniformly
    with a constant ε of 0.1, whatever `epsilon` is. Agents of your own may live beside them. After each task, the
    useful actions of the policy that ``lore`` learnt are counted by context. In a task with a positive value,
    these are the best actions of the states with a positive value. In a task without (each step costs, no reward
    is positive), they are relative to the task's best return: the best of the actions taken in the best tenth of
    the episodes, of those that ended.

    By default ε halves with each episode from 1 to 0.05: the first episodes try what the prior proposes, the
    others mostly what was learnt. Claim O3 measures this default against ``textbook`` in thirteen worlds.

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
        Meaning of actions and contexts, needed with a memory. Lives of one key share their prior, also with
        `LongLivedAgent`.
    agents : mapping of str to callable, optional
        Your own agents by name, each called once a task as ``agent(world, task, seeds, max_steps)``. It lives one
        episode a seed, in their order: it calls ``world.reset(task, seed)``, then ``world.step(action)`` until the
        episode is terminated, truncated or `max_steps` long. The world that it gets observes the discounted
        returns, so the agent need not return any. An object that keeps what it learnt is a lifelong learner.
    seed : int
        Draws the seeds of the episodes and the agents' choices.
    discount : float
        γ in [0, 1].
    learning_rate, epsilon, epsilon_decay, epsilon_floor : float
        As in `QLearning`; ``textbook`` has the learning rate, and its own ε.
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
        a positive reward. ``summary`` compares ``lore`` with each other agent over the last third of the tasks,
        for instance in ``lore_vs_textbook``. An interval ``ci95`` is null for fewer than three tasks, and has two
        equal ends where all differences are equal. ``n_contexts``: the number of contexts in the prior at the
        end. ``warnings``: sentences on what makes the life useless or its comparison misleading; empty where all
        is well. They say that the prior is still empty, that nothing observed tells the tasks apart, that nearly
        every state or context is new, or that the final return of ``lore`` is certainly below that of ``scratch``
        or ``textbook``.

    Warns
    -----
    UserWarning
        Each sentence of ``warnings``.

    Raises
    ------
    InputError
        A setting breaks its rule; an agent of yours lives other episodes; a reward is not finite; a state or
        context has no stable code (see `lifelore.agent.external_world.context_code.context_code`); a memory is
        given without a key, or its key has another number of actions.
    StoreError
        Memory cannot store the task, or the CSV file cannot be written; earlier tasks stay stored.

    Examples
    --------
    >>> import gymnasium as gym
    >>> from lifelore import GymnasiumWorld
    >>> make = lambda task: gym.make("CliffWalking-v1", is_slippery=task % 2 == 1)
    >>> world = GymnasiumWorld(make, state=int, context=lambda place: place // 12)
    >>> report = live_in(world, tasks=2, episodes=30, max_steps=200)
    >>> sorted(report["summary"])
    ['agents', 'lore_vs_scratch', 'lore_vs_textbook']
    """
    began = time.perf_counter()
    _check_world(world)
    if not isinstance(tasks, int) or not 1 <= tasks <= 10**9:
        raise InputError(f"tasks must be a whole number from 1 to 10^9, got {tasks}")
    if not 0 <= discount <= 1:
        raise InputError(f"discount must lie in [0, 1], got {discount}")
    if memory is not None and key is None:
        raise InputError('key must name the meaning of the contexts in the memory, got none; pass key="..."')
    name = str(getattr(world, "name", type(world).__name__))
    check_names(robot=robot, **({} if key is None else {"key": key}))
    own_agents = check_own_agents(agents or {}, AGENTS)
    learning = QLearning(episodes, max_steps, learning_rate, epsilon, epsilon_decay, epsilon_floor)
    guidance = PriorSettings(alpha0, weight, form, ties)
    names = [*AGENTS, *own_agents]
    settings = {"tasks": tasks, "robot": robot, "key": key, "discount": discount}
    settings |= asdict(learning) | asdict(guidance) | {"agents": names}
    del settings["annealed"]
    lore = TaskSettings(
        learning, guidance, discount, "textbook", "moves", 0.05, seed, ABLATIONS["no-reuse"], cautious=False
    )  # fmt: skip
    scratch = replace(lore, abilities=ABLATIONS["scratch"])
    lived = {
        "lore": lore,
        "scratch": scratch,
        "textbook": replace(scratch, learning=replace(learning, **TEXTBOOK)),
    }
    with (
        LongTable(csv, seed) if csv is not None else nullcontext() as table,
        opened_memory(memory) as opened,
    ):
        life = _ExternalLife(name, world, lived, own_agents, key or name, opened, table)
        before = opened.tasks(robot) if opened else 0
        run_life(life, tasks, memory=opened, robot=robot, progress=progress, stop=stop)
    done, n_contexts = life.finished, len(life.lore.prior)
    summary = summarise_life(done, names) if done else {}
    found = new_states(name, life.last_states)
    novelty = 0.0 if found else life.novelty.late  # where states are new, their contexts are, too
    found += life_warnings(name, len(done), n_contexts, novelty, life.differences.one_task, summary)
    for sentence in found:
        warnings.warn(sentence, stacklevel=2)
    return {
        "domain": name,
        "map": None,
        "n_states": len(life.states),
        "n_contexts": n_contexts,
        "seed": seed,
        "settings": settings | {"memory": opened.location if opened else None},
        "tasks": done,
        "summary": summary,
        "memory": {"tasks_before": before, "tasks_after": before + len(done)},
        "warnings": found,
        "seconds": round(time.perf_counter() - began, 3),
    }


def _check_world(world: World) -> None:
    if not isinstance(world, World):
        raise InputError(
            "world must have n_actions, reset, step and context (lifelore.core.protocols.World), got "
            f"{type(world).__name__}; wrap a Gymnasium environment in GymnasiumWorld"
        )
    if not 1 <= world.n_actions <= MOST_ACTIONS:
        raise InputError(f"world.n_actions must lie in [1, {MOST_ACTIONS}], got {world.n_actions}")


@dataclass(eq=False)
class _ExternalLife:
    """A life in progress: agents live the same tasks side by side; memory stores what ``lore`` learns."""

    name: str
    world: World
    agents: Mapping[str, TaskSettings]
    own: Mapping[str, OwnAgent]
    key: str
    memory: Memory | None
    table: LongTable | None

    def __post_init__(self) -> None:
        self.codes, self.states, self.finished = MoveCodes(), set[Hashable](), list[dict]()
        self.differences, self.last_states = TaskDifferences(), list[int]()
        self.common = self.agents["lore"]
        self.lore = Experience(self.key, self.world.n_actions, self.common.guidance.alpha0)

    def recall(self) -> None:
        """Read what memory holds under the key."""
        if self.memory is not None:
            found = Experience.recalled(self.key, self.memory, self.common.guidance.alpha0)
            self.lore = found or Experience(self.key, self.world.n_actions, self.common.guidance.alpha0)
            self.lore.check_actions(self.world.n_actions)
        if not self.finished:
            self.novelty = ContextNovelty(self.lore.prior.contexts.tolist())

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task with each agent."""
        most, episodes = self.common.learning.step_cap, self.common.learning.episode_cap
        seeds = stream(self.common.seed, "task", number, "world").integers(2**31, size=episodes).tolist()
        measures, returns, tasks, news = dict[str, dict](), dict[str, list[float]](), dict[str, OneTask](), None
        for name, settings in self.agents.items():
            # The others start each task without a past.
            known = self.lore if name == "lore" else Experience(self.key, self.world.n_actions)
            result = TaskResult(number, None)
            task = OneTask(known, self.world, self.codes, settings, result, NO_CONTEXT, stop, seeds=seeds)
            news, tasks[name] = task.live(f"{name}.{number}") or news, task
            measures[name], returns[name] = task_measures(result.returns, result.reached), result.returns
        for name, agent in self.own.items():
            watched = WatchedWorld(name, self.world, number, seeds, most, self.common.discount, stop)
            measures[name], returns[name] = watched.live(agent), watched.returns
        # Moves are compared where exploration is uniform.
        steps = tasks["scratch"].steps
        self.differences.end_task(counted(steps[:MOST_COMPARED], self.codes))
        self.last_states = [step.state for step in steps]
        self.novelty.end_task(tasks["lore"].running.best()[0].tolist())
        for task in tasks.values():
            self.states.update(task.running.policy())
        assert news is not None, "lore remembers"
        report = {"index": number, "goal": None, "optimal_return": None, "agents": measures}
        return LivedTask(self.lore.learn(news), {"index": number, "world": self.name}, (report, returns))

    def finish(self, lived: LivedTask) -> None:
        """Report a task, which memory has stored."""
        report, returns = lived.result
        self.finished.append(report)
        if self.table:
            self.table.add(report, {name: {"return": values} for name, values in returns.items()})
