"""`live_in`: an agent lives in a world of the user, through the `World` protocol only."""

import time
import warnings
from collections.abc import Hashable, Mapping
from contextlib import nullcontext
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from threading import Event

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.external_world.context_code import MOST_ACTIONS, ContextCodes
from lifelore.agent.external_world.context_labels import labels_record
from lifelore.agent.external_world.episode import discounted, play, reached
from lifelore.agent.external_world.life_summary import summarise_life, task_measures
from lifelore.agent.external_world.life_warnings import ContextNovelty, life_warnings
from lifelore.agent.external_world.own_agent import OwnAgent, WatchedWorld, check_own_agents, live_own
from lifelore.agent.external_world.stored_prior import recalled_prior
from lifelore.agent.external_world.table_learner import TableLearner
from lifelore.agent.external_world.task_differences import TaskDifferences
from lifelore.agent.life.loop import LivedTask, opened_memory, run_life
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.agent.live.output.long_table import LongTable
from lifelore.core.errors import InputError
from lifelore.core.learning.q_learner import QLearning
from lifelore.core.protocols import Progress, Record, World
from lifelore.core.streams import stream
from lifelore.memory import Memory

AGENTS = ("lore", "scratch", "textbook")
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
        The meaning of the contexts. Lives with the same key and number of actions share their prior. Default:
        ``world.context_key``, which `GymnasiumWorld` has; its documentation names what that key cannot
        distinguish. Not needed without a memory.
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
        every context is new, or that the final return of ``lore`` is certainly below that of ``scratch`` or
        ``textbook``.

    Warns
    -----
    UserWarning
        Each sentence of ``warnings``.

    Raises
    ------
    InputError
        A setting breaks its rule; an agent of yours lives other episodes; a reward is not finite; a context
        has no stable code (see `lifelore.agent.external_world.context_code.context_code`); a memory is given
        without a key.
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
    if not robot.strip():
        raise InputError("robot must have a name, got an empty text; name the robot")
    own_agents = check_own_agents(agents or {}, AGENTS)
    learning = QLearning(episodes, max_steps, learning_rate, epsilon, epsilon_decay, epsilon_floor)
    guidance = PriorSettings("observation", alpha0, weight, form, ties)
    key = _key_of(world, key, needed=memory is not None)
    names = [*AGENTS, *own_agents]
    settings = {"tasks": tasks, "robot": robot, "key": key, "discount": discount}
    settings |= asdict(learning) | asdict(guidance) | {"agents": names}
    del settings["annealed"], settings["condition"]
    with (
        LongTable(csv, seed) if csv is not None else nullcontext() as table,
        opened_memory(memory) as opened,
    ):
        life = _ExternalLife(world, learning, guidance, discount, seed, key, own_agents, opened, table)
        before = opened.tasks(robot) if opened else 0
        run_life(life, tasks, memory=opened, robot=robot, progress=progress, stop=stop)
    done = life.finished
    summary = summarise_life(done, names) if done else {}
    found = life_warnings(
        life.name, len(done), len(life.prior), life.novelty.late, life.differences.one_task, summary
    )  # fmt: skip
    for sentence in found:
        warnings.warn(sentence, stacklevel=2)
    return {
        "domain": life.name,
        "map": None,
        "n_states": len(life.states),
        "n_contexts": len(life.prior),
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


@dataclass(eq=False)
class _ExternalLife:
    """A life in progress: its prior, and the memory that stores it."""

    world: World
    learning: QLearning
    guidance: PriorSettings
    discount: float
    seed: int
    key: str | None
    own_agents: Mapping[str, OwnAgent]
    memory: Memory | None
    table: LongTable | None

    def __post_init__(self) -> None:
        self.name = str(getattr(self.world, "name", type(self.world).__name__))
        self.codes, self.states, self.finished = ContextCodes(), set[Hashable](), list[dict]()
        self.differences = TaskDifferences()
        self.labelled = set[int]()  # contexts whose features this life has stored

    def recall(self) -> None:
        """Read the prior of the key; an empty one without a memory."""
        self.prior = recalled_prior(self.memory, self.key, self.world.n_actions, self.guidance.alpha0)
        if not self.finished:
            self.novelty = ContextNovelty(self.prior.contexts.tolist())

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live a task with each agent."""
        drawn = stream(self.seed, "task", number, "world").integers(2**31, size=self.learning.episode_cap)
        seeds, agents, returns = drawn.tolist(), {}, {}
        learners = {name: self._learner(name, number) for name in AGENTS}
        for name, learner in learners.items():
            ended_well = [self._episode(name, learner, number, seed, stop) for seed in seeds]
            returns[name] = learner.returns.returns
            agents[name] = task_measures(returns[name], any(ended_well))
        for name, agent in self.own_agents.items():
            watched = WatchedWorld(name, self.world, number, seeds, self.learning.step_cap, self.discount, stop)
            returns[name] = live_own(agent, watched)
            agents[name] = task_measures(returns[name], watched.reached)
        self.differences.end_task()
        lore = learners["lore"]
        self.novelty.end_task([context for _, context in lore.visited])
        # The policy of the finished task counts in the prior (Eq. 3.5, 3.7).
        news = ActionPrior(self.prior.n_actions, self.prior.alpha0, self.prior.key)
        news.update(*lore.best(), self.guidance.weight)
        self.prior.merge(news)
        about = {"index": number, "world": self.name}
        return LivedTask(self._records(news), about, (number, agents, learners, returns, news.contexts.tolist()))

    def _learner(self, name: str, number: int) -> TableLearner:
        learning = replace(self.learning, **TEXTBOOK) if name == "textbook" else self.learning
        prior = self.prior if name == "lore" else None
        # Equal streams for all agents make their comparison paired.
        own = stream(self.seed, "task", number, "own")
        return TableLearner(self.world.n_actions, prior, learning, self.discount, self.guidance, own)

    def _episode(self, name: str, learner: TableLearner, number: int, seed: int, stop: Event) -> bool:
        """An episode of a learner; whether it was terminated with a positive reward."""
        most = self.learning.step_cap
        steps = play(self.world, number, seed, self.codes, most, stop, learner.act, learner.observe)
        learner.end_episode(steps, discounted(steps, self.discount), steps[-1].ended)
        # Transitions are compared where exploration is uniform.
        for step in steps if name == "scratch" else ():
            self.differences.see(step.state, step.action, step.following, step.reward, step.ended)
        return reached(steps)

    def finish(self, lived: LivedTask) -> None:
        """Report a task, which memory has stored."""
        number, agents, learners, returns, contexts = lived.result
        self.labelled.update(contexts)
        for learner in learners.values():
            self.states.update(learner.q)
        self.finished.append({"index": number, "goal": None, "optimal_return": None, "agents": agents})
        if self.table:
            self.table.add(self.finished[-1], {name: {"return": values} for name, values in returns.items()})

    def _records(self, news: ActionPrior) -> list[Record]:
        """A task's counts, and the features of contexts that this life has not stored."""
        about = {"prior": "foreign", "world": self.name, "means": self.key}
        contexts = self.codes.contexts
        new = {code: contexts[code] for code in news.contexts.tolist() if code not in self.labelled}
        records = [news.to_record(about)] if len(news) else []
        return records + ([labels_record(news.key, new, about)] if new else [])
