"""Agents that live the same tasks side by side, each with what it learnt in its own earlier tasks."""

from collections.abc import Hashable, Mapping, Sequence
from threading import Event
from typing import NamedTuple

from lifelore.agent.any_tasks.experience import Experience, TaskNews
from lifelore.agent.any_tasks.moves import MoveCodes
from lifelore.agent.any_tasks.one_task import OneTask
from lifelore.agent.any_tasks.task_result import TaskResult
from lifelore.agent.any_tasks.task_settings import TaskSettings
from lifelore.agent.external_world.context_code import CONTEXT_BITS, ContextCodes
from lifelore.agent.external_world.life_summary import task_measures
from lifelore.agent.external_world.own_agent import OwnAgent, WatchedWorld, live_own
from lifelore.core.protocols import Record, World


class LivedBeside(NamedTuple):
    """A task that all agents have lived, by the names of the agents.

    measures : see `task_measures`
    returns : discounted return of each episode
    tasks : the agents' own view of it; those of the user have none
    records : what those have learnt that remember
    """

    measures: dict[str, dict]
    returns: dict[str, list[float]]
    tasks: dict[str, OneTask]
    records: dict[str, list[Record]]


class SideBySide:
    """Agents, and what each of them knows.

    Parameters
    ----------
    world : World
        All agents meet its tasks.
    agents : mapping of str to TaskSettings
        By name.
    own : mapping of str to callable
        Agents of the user, see `OwnAgent`.
    common : TaskSettings
        Its discount and steps of an episode are those of the agents of the user.
    key : str
        Meaning of states, actions and contexts.
    """

    def __init__(
        self,
        world: World,
        agents: Mapping[str, TaskSettings],
        own: Mapping[str, OwnAgent],
        common: TaskSettings,
        key: str,
    ) -> None:
        self.world, self.agents, self.own, self.common = world, agents, own, common
        self.experience = {
            name: Experience(key, world.n_actions, settings.guidance.alpha0) for name, settings in agents.items()
        }
        self.codes, self._contexts = MoveCodes(), ContextCodes(CONTEXT_BITS)

    def live(self, number: int, context: Hashable, seeds: Sequence[int], stop: Event) -> LivedBeside:
        """Live a task, an episode a seed.

        Raises
        ------
        Stopped
            The stop event is set.
        """
        found, taught = LivedBeside({}, {}, {}, {}), dict[str, TaskNews]()
        for name, settings in self.agents.items():
            experience, result = self.experience[name], TaskResult(number, context)
            code = self._contexts[context]
            task = OneTask(experience, self.world, self.codes, settings, result, code, stop, seeds=seeds)
            if (news := task.live(f"{name}.{number}")) is not None:
                taught[name] = news
            found.tasks[name], found.returns[name] = task, result.returns
            found.measures[name] = task_measures(result.returns, result.reached)
        for name, agent in self.own.items():
            most = self.common.learning.step_cap
            watched = WatchedWorld(name, self.world, number, seeds, most, self.common.discount, stop)
            found.returns[name] = live_own(agent, watched)
            found.measures[name] = task_measures(found.returns[name], watched.reached)
        # A task that was stopped has taught nobody.
        found.records.update({name: self.experience[name].learn(news) for name, news in taught.items()})
        return found
