"""Lets an agent of the user live the tasks of `live_in`, and measures it from outside."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from threading import Event
from typing import Any, NoReturn

from lifelore.agent.external_world.episode import check_reward
from lifelore.agent.external_world.life_summary import task_measures
from lifelore.agent.life.loop import Stopped
from lifelore.core.errors import InputError
from lifelore.core.protocols import World

OwnAgent = Callable[[World, int, list[int], int], Any]
"""``agent(world, task, seeds, max_steps)``: live one task, an episode a seed. What it returns is not used."""


class WatchedWorld:
    """The world of one task as an agent of the user meets it; observes the returns of the agent's episodes.

    returns : discounted return of each episode that was begun
    reached : whether an episode was terminated with a positive reward
    """

    def __init__(
        self,
        name: str,
        world: World,
        task: int,
        seeds: Sequence[int],
        max_steps: int,
        discount: float,
        stop: Event,
    ) -> None:
        self.name, self.world, self.task, self.seeds = name, world, task, seeds
        self.max_steps, self.discount, self.stop = max_steps, discount, stop
        self.n_actions = world.n_actions
        self.returns: list[float] = []
        self.reached = False
        self._steps_left, self._factor = 0, 1.0

    def reset(self, task: int, seed: int) -> Hashable:
        """Start the next episode; task and seed must be those that the agent was given, in their order."""
        number = len(self.returns)
        due = number < len(self.seeds) and (task, seed) == (self.task, self.seeds[number])
        if self._steps_left or not due:
            # An episode that is given up would escape its costs.
            self._refuse(f"reset({task}, {seed}) with {self._steps_left} steps left")
        self.returns.append(0.0)
        self._steps_left, self._factor = self.max_steps, 1.0
        return self.world.reset(task, seed)

    def live(self, agent: OwnAgent) -> dict:
        """Let an agent live its task; its measures, see `task_measures`.

        Raises
        ------
        InputError
            The agent did not live all episodes, or broke their order or their length.
        """
        agent(self, self.task, list(self.seeds), self.max_steps)
        if self._steps_left or len(self.returns) != len(self.seeds):
            self._refuse(f"an end after {len(self.returns)} resets with {self._steps_left} steps left")
        return task_measures(self.returns, self.reached)

    def _refuse(self, got: str) -> NoReturn:
        raise InputError(
            f"agent '{self.name}' must live an episode for each of its {len(self.seeds)} seeds, in their order, "
            f"until it is terminated, truncated or {self.max_steps} steps long, got {got} in task {self.task}"
        )

    def step(self, action: int) -> tuple[Hashable, float, bool, bool]:
        """Take an action; the reward counts for the return of the episode."""
        if self.stop.is_set():
            raise Stopped
        if not self._steps_left:
            self._refuse("a step with 0 steps left")
        state, reward, terminated, truncated = self.world.step(action)
        check_reward(reward, action, self.task)
        self.returns[-1] += self._factor * reward
        self._factor *= self.discount
        self._steps_left = 0 if terminated or truncated else self._steps_left - 1
        self.reached = self.reached or (terminated and reward > 0)
        return state, reward, terminated, truncated

    def context(self, state: Hashable, last_reward: float) -> Hashable:
        """The context of the current state."""
        return self.world.context(state, last_reward)


def check_own_agents(agents: Mapping[str, OwnAgent], taken: Sequence[str]) -> dict[str, OwnAgent]:
    """The agents of the user, checked: names that are free, and callables."""
    for name, agent in agents.items():
        if not isinstance(name, str) or not name.strip() or name in taken:
            raise InputError(f"agents must have names other than {', '.join(taken)}, got {name!r}; rename it")
        if not callable(agent):
            raise InputError(
                "agents must be functions of (world, task, seeds, max_steps), got "
                f"{type(agent).__name__} for '{name}'"
            )
    return dict(agents)
