"""`compare_agents`: the agent beside its ablations, a textbook's learner and the user's own, on the same tasks."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from threading import Event
from typing import Any

import gymnasium

from lifelore.agent.any_tasks.long_lived_agent import LongLivedAgent
from lifelore.agent.any_tasks.one_task import episode_seed
from lifelore.agent.any_tasks.task_settings import AGENTS
from lifelore.agent.external_world.life_summary import summarise_life, task_measures
from lifelore.agent.external_world.own_agent import OwnAgent, WatchedWorld, check_own_agents
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.protocols import Progress


def compare_agents(
    make: Callable[[int], gymnasium.Env],
    contexts: Sequence[Hashable],
    agents: Sequence[str] | Mapping[str, OwnAgent | None] = ("full", "scratch", "textbook"),
    *,
    progress: Progress | None = None,
    stop: Event | None = None,
    **settings: Any,
) -> dict:
    """Live the same tasks with several agents, each with what it learnt in its own earlier tasks.

    Parameters
    ----------
    make : callable
        Task number to its environment, in which all agents live; closed after the task.
    contexts : sequence of hashable
        The context of each task.
    agents : sequence of str, or mapping
        Names of `lifelore.agent.any_tasks.task_settings.AGENTS`; in a mapping also agents of your own by name,
        called as for `live_in`: ``mine(world, task, seeds, max_steps)``. The first is compared with the others.
    progress : callable, optional
        Called as ``progress(done, total, label)`` after each task.
    stop : threading.Event, optional
        Set it to drop the task in progress: ``lifelore.agent.life.loop.Stopped``.
    **settings
        Of `LongLivedAgent`; nothing is stored.

    Returns
    -------
    dict
        ``tasks``: for each task its ``index``, ``context`` and by agent ``first_return``, ``mean_return`` and
        ``final_return`` (of the last tenth of the episodes). ``summary``: the first agent less each other over the
        last third of the tasks with 95 % intervals, for instance ``full_vs_textbook``, and each agent's means.

    Raises
    ------
    InputError, NotFoundError
        A setting or an agent breaks its rule.

    Examples
    --------
    >>> import gymnasium as gym
    >>> make = lambda number: gym.make("CliffWalking-v1", is_slippery=number % 2 == 1)
    >>> how = {"key": "cliff", "state": int, "features": int, "episodes": 3, "max_steps": 20}
    >>> report = compare_agents(make, ["monday", "monday"], ("scratch", "textbook"), **how)
    >>> sorted(report)
    ['summary', 'tasks']
    """
    given = dict(agents) if isinstance(agents, Mapping) else dict.fromkeys(agents)
    own = check_own_agents({name: one for name, one in given.items() if one is not None}, tuple(AGENTS))
    for name in given.keys() - own.keys():
        if name not in AGENTS:
            raise NotFoundError(f"agents must be of {', '.join(AGENTS)}, or functions, got {name!r}")
    if not given or not len(contexts):
        raise InputError("compare_agents needs an agent and the context of a task; give at least one")
    if settings.pop("memory", None) is not None:
        raise InputError("compare_agents stores nothing; leave out memory, or use LongLivedAgent.live")
    if not callable(make):
        raise InputError(f"make must be a function from task number to environment, got {type(make).__name__}")
    settings.pop("agent", None)
    lives = {name: LongLivedAgent(**settings, agent=name) for name in given if name not in own}
    usual, stop, tasks = LongLivedAgent(**settings), stop or Event(), list[dict]()
    how = usual.settings
    for number, context in enumerate(contexts):
        seeds = [episode_seed(how.seed, number, episode) for episode in range(how.learning.episode_cap)]
        found = dict[str, dict]()
        with usual.world(make(number)) as world:
            for name in given:
                if name in own:
                    watched = WatchedWorld(name, world, number, seeds, how.learning.step_cap, how.discount, stop)
                    found[name] = watched.live(own[name])
                else:
                    result = lives[name].live(world.env, context, stop=stop)
                    found[name] = task_measures(result.returns, result.reached)
        tasks.append({"index": number, "context": context, "agents": found})
        if progress:
            progress(number + 1, len(contexts), f"task {number}")
    return {"tasks": tasks, "summary": summarise_life(tasks, list(given))}
