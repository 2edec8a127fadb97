"""`LongLivedAgent`: an agent that lives in tasks of anyone's Gymnasium environments and becomes good at them."""

import warnings
from collections.abc import Callable, Hashable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event
from typing import Any, NamedTuple

import gymnasium

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.any_tasks.experience import Experience
from lifelore.agent.any_tasks.known_types import KnownTypes
from lifelore.agent.any_tasks.learners import Learner, checked_learner
from lifelore.agent.any_tasks.moves import MoveCodes
from lifelore.agent.any_tasks.one_task import OneTask
from lifelore.agent.any_tasks.reuse import SIGNALS
from lifelore.agent.any_tasks.task_result import TaskResult
from lifelore.agent.any_tasks.task_settings import AGENTS, TaskSettings, check_names
from lifelore.agent.external_world.context_code import CONTEXT_BITS, ContextCodes
from lifelore.agent.external_world.episode import Step
from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld, ResetBy
from lifelore.agent.external_world.life_warnings import new_rewards, new_states
from lifelore.agent.life.loop import LivedTask, Stopped, run_life
from lifelore.agent.live.life_settings import PriorSettings
from lifelore.agent.long_lived.curiosity import CuriousContext, curious_contexts
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.core.learning.q_learner import QLearning
from lifelore.memory import open_memory


class TypeSummary(NamedTuple):
    """A known type.

    tasks : number of tasks behind it, by belief
    contexts : number of tasks by context, the most frequent first; as it was given
    returns : mean return of each policy that ran in its tasks, by name
    """

    tasks: float
    contexts: dict[Any, float]
    returns: dict[str, float]


class LongLivedAgent(AbstractContextManager):
    """An agent over policies for tasks of your own environments (thesis chapter 5).

    A task is an environment whose hidden type stays for its episodes, in a context that the agent sees. The agent
    expects the types that the context usually has, runs the policy of the type that it believes most, follows
    each move by Bayes' rule, notices when no known type fits, learns a policy then, and remembers all of it.

    Parameters
    ----------
    key : str
        Meaning of states, actions and features; lives of one key share what they learn.
    memory : str or Path, optional
        SQLite file or ``postgresql://`` URL, one transaction a task. None: what is learnt ends with the agent.
    state : callable, optional
        ``state(observation)`` to a hashable state over which policies are learnt. Default: the observation.
    features : callable, optional
        ``features(observation)`` or ``features(observation, last_reward)`` to hashable features that the action
        prior is conditioned on. Default: the state.
    learner : {"q", "model", "textbook"} or callable
        Q-learning that replays each episode once, Dyna, plain Q-learning; or a function
        ``learner(env, prior, start)``, which plays episodes of ``env`` and returns a policy, from observation to
        action. ``start`` is the policy to start from, or None. Memory keeps the policy if it has ``to_bytes()``
        and the learner ``from_bytes(content)``.
    episodes, max_steps : int
        Of a task, and of an episode; ≥ 1.
    discount : float
        γ in [0, 1].
    learning_rate, epsilon : float
        First learning rate of a move, and rate of exploration where a policy is learnt; in [0, 1].
    signals : {"moves", "returns"}
        What tells types apart: each (state, action, reward, next state) within an episode; or the returns of
        episodes, where states are met too rarely.
    false_alarm : float
        Probability of an alarm in a task of a known type, in (0, 1).
    agent : str
        A name of `lifelore.agent.any_tasks.task_settings.AGENTS`: ``"full"``, or an ablation.
    robot : str
        Name of the robot in memory.
    reset_by : {"episode", "task"}
        Whether the environment is reset with another seed in each episode, or the same in all of a task.
    seed : int
        Draws the seeds of the episodes and the agent's choices.

    Attributes
    ----------
    prior : ActionPrior
        Useful actions by features; ``prior.to_frame()`` is a table.

    Raises
    ------
    InputError, NotFoundError
        An argument breaks its rule.

    Examples
    --------
    >>> import gymnasium
    >>> agent = LongLivedAgent(key="lake", episodes=5, max_steps=50)
    >>> lake = gymnasium.make("FrozenLake-v1", is_slippery=False)
    >>> first, second = agent.live(lake, context="north"), agent.live(lake, context="north")
    >>> first.new, second.new, second.type == first.type
    (True, False, True)
    """

    def __init__(
        self,
        *,
        key: str,
        memory: str | Path | None = None,
        state: Callable[[Any], Hashable] | None = None,
        features: Callable[..., Hashable] | None = None,
        learner: str | Learner = "q",
        episodes: int = 30,
        max_steps: int = 1000,
        discount: float = 0.95,
        learning_rate: float = 0.5,
        epsilon: float = 0.1,
        signals: str = "moves",
        false_alarm: float = 0.05,
        agent: str = "full",
        robot: str = "robot",
        reset_by: ResetBy = "episode",
        seed: int = 0,
    ) -> None:
        if agent not in AGENTS:
            raise NotFoundError(f"agent must be one of {', '.join(AGENTS)}, got {agent!r}")
        if signals not in SIGNALS:
            raise NotFoundError(f"signals must be {' or '.join(SIGNALS)}, got {signals!r}")
        for name, value, least in (("discount", discount, 0.0), ("false_alarm", false_alarm, 1e-4)):
            if not least <= value <= 1 or (name == "false_alarm" and value == 1):
                raise InputError(f"{name} must lie between {least:g} and 1, got {value}")
        check_names(key=key, robot=robot)
        self.settings = TaskSettings(
            QLearning(episodes, max_steps, learning_rate, epsilon, 1.0, epsilon),
            PriorSettings(form="support", ties="prior"),
            discount,
            checked_learner(learner),
            signals,
            false_alarm,
            seed,
            AGENTS[agent],
        )
        self.key, self.robot, self.seed = key, robot, seed
        self._state, self._features = state, features
        self._reset_by: ResetBy = reset_by
        self._codes, self._contexts = MoveCodes(), ContextCodes(CONTEXT_BITS)
        self._experience: Experience | None = None
        self._memory = None if memory is None else open_memory(memory)
        self._where = memory if memory is None or "://" in str(memory) else Path(memory).expanduser().absolute()
        self._revision = ""
        self._lived = 0
        self._recall()

    def __exit__(self, *error: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the memory; all tasks are stored already."""
        if self._memory is not None:
            self._memory.close()

    # ---- live --------------------------------------------------------------------------------------

    def live(self, env: gymnasium.Env, context: Hashable = None, *, stop: Event | None = None) -> TaskResult:
        """Live one task: `episodes` episodes of an environment whose hidden type stays.

        Parameters
        ----------
        env : gymnasium.Env
            With discrete actions, the same number in all tasks; not closed.
        context : hashable, optional
            What is seen of the task beforehand, such as a place, a day, or a customer's name.
        stop : threading.Event, optional
            Set it to drop the task: ``lifelore.agent.life.loop.Stopped``, and nothing of the task is kept.

        Raises
        ------
        InputError
            The environment has other actions, a state is not hashable, or a reward is not finite.
        StoreError
            Memory cannot store the task, or another process has taken it over.

        Warns
        -----
        UserWarning
            The states hardly repeat, and the learner is one of a table; or the rewards hardly repeat, and they
            tell types apart.
        """
        if not isinstance(env, gymnasium.Env):
            raise InputError(f"env must be a gymnasium.Env, got {type(env).__name__}; pass gymnasium.make(...)")
        task, lost = _NextTask(self, self.world(env), context), list[str]()
        run_life(task, 1, memory=self._memory, robot=self.robot, stop=stop, notify=lost.append)
        if task.result is None:
            raise StoreError(f"{lost[0]}; live it again") if lost else Stopped
        name, states = task.world.name, [step.state for step in task.steps]
        said = [] if callable(self.settings.learner) else new_states(name, states)
        if self.settings.signals == "moves" and self.settings.abilities.reuse:
            said += new_rewards(name, [step.reward for step in task.steps])
        for sentence in said:
            warnings.warn(sentence, stacklevel=2)
        return task.result

    def world(self, env: gymnasium.Env | Callable[[int], gymnasium.Env]) -> GymnasiumWorld:
        """An environment, or one for each task, with the states, features and resets of this agent."""
        return GymnasiumWorld(env, self._features, self._state, seed=self.seed, reset_by=self._reset_by)

    def _recall(self) -> None:
        """Read what is known again where another process has changed the memory."""
        if self._memory is not None and (self._experience is None or self._memory.revision() != self._revision):
            self._experience = Experience.recalled(self.key, self._memory, labels=self._where)
            self._revision = self._memory.revision()

    def experience_for(self, n_actions: int) -> Experience:
        """What is known for environments of so many actions; InputError if the tasks before had others.

        Types that moves told apart cannot be used with returns as signals: a task without moves would join them.
        """
        self._recall()
        if self._experience is None:
            self._experience = Experience(self.key, n_actions)
        self._experience.check_actions(n_actions)
        by_returns = self.settings.signals == "returns" and self.settings.abilities.reuse
        if by_returns and self._experience.causes:
            raise InputError(
                f"signals must be 'moves', which told the types of '{self.key}' apart, got 'returns'; or give "
                "another key"
            )
        return self._experience

    # ---- what is known -----------------------------------------------------------------------------

    @property
    def types(self) -> dict[str, TypeSummary]:
        """The known types by name; types that nothing tells apart are joined."""
        experience = self._experience
        if experience is None:
            return {}
        return {
            one.name: self._summary([experience.types[name] for name in one.members])
            for one in KnownTypes(experience).types
        }

    @property
    def policies(self) -> tuple[str, ...]:
        """Names of the known policies: each has the name of the type that it was learnt for."""
        return () if self._experience is None else self._experience.policies

    @property
    def prior(self) -> ActionPrior:
        """The action prior, by code of the features."""
        if self._experience is None:
            raise InputError("prior needs a task that was lived; live through one first")
        return self._experience.prior

    def curiosity(self) -> list[CuriousContext]:
        """Contexts by how much the agent would rather meet them next: entropy × frequency, the largest first."""
        if self._experience is None:
            return []
        found = curious_contexts(KnownTypes(self._experience).type_prior())
        return [replace(one, context=self._label(one.context)) for one in found]

    def explain(self, result: TaskResult) -> str:
        """Why the agent acted as it did in a task, in a few lines."""
        return result.explain()

    def _summary(self, members: list[Any]) -> TypeSummary:
        contexts, sums = dict[Any, float](), dict[str, Any]()
        for one in members:
            for (_, context), belief in one.sightings.items():
                contexts[self._label(context)] = contexts.get(self._label(context), 0.0) + belief
            for policy, row in one.returns.items():
                sums[policy] = sums.get(policy, 0.0) + row
        means = {policy: float(row[1] / row[0]) for policy, row in sorted(sums.items())}
        often = dict(sorted(contexts.items(), key=lambda pair: -pair[1]))
        return TypeSummary(sum(contexts.values()), often, means)

    def _label(self, code: int) -> Any:
        known = {} if self._experience is None else self._experience.labels
        return self._contexts.contexts.get(code, known.get(code, code))


@dataclass
class _NextTask:
    """The next task of an agent, as the loop of lives takes it."""

    agent: LongLivedAgent
    world: GymnasiumWorld
    context: Hashable
    result: TaskResult | None = None
    steps: Sequence[Step] = ()

    def recall(self) -> None:
        """Know what other processes have stored."""
        self.agent._recall()

    def live(self, number: int, seq: int, stop: Event) -> LivedTask:
        """Live the task and learn from it."""
        agent = self.agent
        number = number if agent._memory is not None else agent._lived
        experience, result = agent.experience_for(self.world.n_actions), TaskResult(number, self.context)
        task = OneTask(
            experience, self.world, agent._codes, agent.settings, result, agent._contexts[self.context], stop
        )  # fmt: skip
        news = task.live(f"{agent.robot}.{number}")
        records = [] if news is None else experience.learn(news)
        self.steps = task.steps
        # What memory refuses was not learnt: the agent knows it from `finish` on.
        agent._experience = None
        document = {"key": agent.key, "world": self.world.name, **result.to_dict()}
        return LivedTask(records, document, (result, experience))

    def finish(self, lived: LivedTask) -> None:
        """Keep what was learnt, which memory has stored."""
        self.result, self.agent._experience = lived.result
        self.agent._lived += 1
        if self.agent._memory is not None:
            self.agent._revision = self.agent._memory.revision()
