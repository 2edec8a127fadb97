"""One task of an agent that lives in anyone's environments, from top to bottom.

β ← prior over types, given the context and the date                                   recognise
for each episode:
    π ← the policy of the most believed type                                           reuse
    until the episode ends:
        act by π, or by the learner; each move teaches what acted
        β, alarm ← the outcome of the move                                             notice
    explore, if no type fits, returns fall short, or now and then, ever more rarely    learn
a new type, if all moves of the task say so; else the most believed type learns:
moves, returns, useful actions, and the belief in this context                         remember
"""

from collections import Counter
from collections.abc import Callable, Sequence
from threading import Event
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.agent.any_tasks.experience import Experience, TaskNews
from lifelore.agent.any_tasks.known_types import KnownTypes
from lifelore.agent.any_tasks.learners import FixedPolicy, Player
from lifelore.agent.any_tasks.moves import Counts, MoveCodes, counted, totals
from lifelore.agent.any_tasks.policies import QTable, StoredPolicy
from lifelore.agent.any_tasks.recorded_env import RecordedEnv
from lifelore.agent.any_tasks.reuse import TaskReuse
from lifelore.agent.any_tasks.task_result import LEARNER, TaskResult
from lifelore.agent.any_tasks.task_settings import TaskSettings
from lifelore.agent.external_world.episode import Step, discounted, play, reached
from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld
from lifelore.agent.external_world.table_learner import TableLearner
from lifelore.core.errors import InputError
from lifelore.core.protocols import World
from lifelore.core.streams import stream

NOWHERE = -1
"""A context that no task has."""
SURE = 0.9
"""Least belief in a type whose policy a task goes on to learn."""
SHORT = 2.0
"""Deviations by which returns fall short of what a policy usually gets, from where the task is worth learning."""
STRANGE = 0.1
"""Share of steps in states that a policy does not know, above which it is explored again."""


class OneTask:
    """A task in progress; `live` lives it.

    Parameters
    ----------
    experience : Experience
        Only read.
    world : World
        Its hidden type stays.
    codes : MoveCodes
    settings : TaskSettings
    result : TaskResult
        Filled in.
    context : int
        Code of the task's context.
    stop : threading.Event
        Set it to drop the task: `live` raises `Stopped`.
    seeds : sequence of int
        With which the world is reset, one for each episode; `episode_seed` gives those that are missing.
    """

    def __init__(
        self,
        experience: Experience,
        world: World,
        codes: MoveCodes,
        settings: TaskSettings,
        result: TaskResult,
        context: int,
        stop: Event,
        seeds: Sequence[int] = (),
    ) -> None:
        self.experience, self.world, self.codes, self.settings = experience, world, codes, settings
        self.abilities, self.result, self.context = settings.abilities, result, context
        self.stop, self.seeds = stop, seeds
        self.generator = stream(settings.seed, "task", result.number, "own")
        self.reuse: TaskReuse | None = None
        self.players: dict[str, Player] = {}  # policies that ran; each learns from the moves that it makes
        self.learner: Player | None = None  # explores in episodes that are worth it
        self.exploring = False
        self.draw: float | None = None  # decides whether a known policy is explored
        self.goes_on_with: str | None = None  # whose policy the learner goes on with
        self.steps: list[Step] = []
        self.ran: dict[str, list[float]] = {}  # returns of policies that ran from begin to end of an episode
        self.strange = 0  # steps in states that what acted did not know
        self.whole = True  # whether the episode was played by what began it

    def live(self, name: str) -> TaskNews | None:
        """Live the task; `name` is that of the new type, if it has one."""
        self.recognise()
        while len(self.result.returns) < self.settings.learning.episode_cap:
            self.exploring = self.worth_learning()
            if self.exploring:
                self.explore()
            self.live_episode()
        return self.remember(name)

    # ---- recognise ---------------------------------------------------------------------------------

    def recognise(self) -> None:
        """Which types does this context usually have?"""
        experience = self.experience
        if not self.abilities.reuse or not experience.policies:
            return
        known = KnownTypes(experience)
        prior = self.prior_over(known)
        self.reuse = TaskReuse(experience, known, prior, self.settings)
        self.result.prior = self.reuse.by_name(prior)

    def prior_over(self, known: KnownTypes) -> NDArray[np.float64]:
        """The prior over the known types, given the context and the date."""
        context = self.context if self.abilities.context else NOWHERE
        return known.type_prior().prior(context, self.result.number)

    @property
    def alarmed(self) -> bool:
        """Whether no known type fits."""
        return self.reuse is not None and self.reuse.alarmed

    # ---- reuse, and notice -------------------------------------------------------------------------

    def live_episode(self) -> None:
        """Play an episode by the learner, or by a known policy; take in each move."""
        number, episode = self.result.number, len(self.result.returns)
        # A learner of the user may have played more episodes than the task has.
        known = episode < len(self.seeds)
        seed = self.seeds[episode] if known else episode_seed(self.settings.seed, number, episode)
        began = LEARNER if self.exploring or self.reuse is None else self.reuse.begin_episode()
        self.whole = True
        most = self.settings.learning.step_cap
        steps = play(self.world, number, seed, self.codes.states, most, self.stop, self.act, self.take_in)
        earned = discounted(steps, self.settings.discount)
        self.running.end_episode(steps, earned, steps[-1].ended)
        self.end_episode(steps, earned, began)

    @property
    def policy(self) -> str | None:
        """The policy in reuse, by name."""
        return None if self.reuse is None else self.reuse.policy

    @property
    def running(self) -> Player:
        """What acts now: the learner, or the policy in reuse."""
        return self.learner if self.exploring and self.learner is not None else self.player(str(self.policy))

    def act(self, state: int, context: int) -> int:
        """The action of what acts now."""
        self.strange += not self.running.knows(state)
        return self.running.act(state, context, explore=self.exploring)

    def take_in(self, step: Step) -> None:
        """Learn from a move: its value, the belief in types, and whether any known type fits."""
        before = self.running
        before.observe(step)
        if self.reuse is not None:
            self.reuse.observe(self.codes.pairs(step))
            if self.alarmed and not self.exploring and not callable(self.settings.learner):
                self.explore()
            self.whole = self.whole and self.running is before

    def end_episode(self, steps: list[Step], earned: float, began: str) -> None:
        """Note what an episode has shown."""
        result = self.result
        self.steps += steps
        ran = began if self.whole and began != LEARNER else None
        if ran is not None:
            self.ran.setdefault(ran, []).append(earned)
        if self.reuse is not None:
            self.reuse.end_episode(ran, earned, began != LEARNER)
            result.beliefs.append(self.reuse.by_name(self.reuse.belief))
        if self.alarmed and not result.alarm:
            result.alarm, result.alarm_episode = True, len(result.returns)
        result.returns.append(earned)
        result.policies.append(began)
        result.reached = result.reached or reached(steps)

    # ---- learn -------------------------------------------------------------------------------------

    def worth_learning(self) -> bool:
        """Whether to explore: no type fits, returns fall short, or the policy of the type may still improve.

        A policy that n tasks have taught is explored in 1 / (n + 1) of the episodes: it is played greedily in the
        limit, and explored without end (Singh et al. 2000).
        """
        taught = callable(self.settings.learner)
        if self.reuse is None or self.alarmed or self.reuse.shortfall > SHORT or (taught and self.learner):
            return True
        own = self.reuse.own_policy()
        if not self.result.returns or self.reuse.belief.max() < SURE or own is None:
            return False
        strange = self.strange > STRANGE * max(len(self.steps), 1)
        n_tasks = 1 + self.experience.types[own].rounds.get(own, 0)
        if self.draw is None or not taught:  # the user's learner is asked once a task
            self.draw = float(self.generator.random())
        return strange or self.experience.is_hopeless(own) or self.draw < 1 / (n_tasks + 1)

    def explore(self) -> None:
        """Explore from here on: the policy that still improves, or one of its own from the policy in reuse."""
        self.exploring = True
        if self.learner is not None:
            return
        sure = self.reuse is not None and not self.alarmed and self.reuse.belief.max() >= SURE
        own = self.reuse.own_policy() if self.reuse is not None and sure else None
        start, self.goes_on_with = own or self.policy, own
        if callable(self.settings.learner) and self.abilities.learner is None:
            self.learner = self.taught(self.settings.learner, None if start is None else self.known_policy(start))
        elif own is not None:
            self.learner = self.player(own)
        else:
            learner = self.table({} if start is None else self.experience.types[start].policy, Counter())
            learner.take_over(self.steps)
            self.learner = learner

    def player(self, name: str) -> Player:
        """The policy of a name, which learns in this task from the moves that it makes."""
        if name not in self.players:
            known = self.experience.types[name]
            if isinstance(known.policy, dict):
                self.players[name] = self.table(known.policy, known.moves)
            else:
                self.players[name] = self.fixed(self.known_policy(name))
        return self.players[name]

    def table(self, start: QTable, moves: Counts) -> TableLearner:
        """A learner by table that starts from a policy, and from what its type has shown before."""
        settings, prior = self.settings, self.experience.prior if self.abilities.prior else None
        own = self.abilities.learner or (settings.learner if isinstance(settings.learner, str) else "q")

        number = totals(moves)

        def met(state: int, action: int) -> float:
            return number[self.codes.cause(state, action)]

        return TableLearner(
            self.experience.n_actions, prior, settings.learning, settings.discount, settings.guidance,
            self.generator, own, cautious=settings.cautious, start=start, met=met,
        )  # fmt: skip

    def taught(self, learner: Callable[..., Any], start: Any) -> FixedPolicy:
        """The policy that the user's learner makes; what it plays counts as episodes of the task."""
        played: list[tuple[list[Step], float, bool]] = []

        def record(steps: list[Step], earned: float, ended: bool) -> None:
            played.append((steps, earned, ended))
            self.end_episode(steps, earned, LEARNER)

        env = RecordedEnv(self.gymnasium_world, self.codes, self.result.number, self.settings.discount, record)
        made = self.fixed(learner(env, self.experience.prior, start))
        for steps, earned, ended in played:
            made.end_episode(steps, earned, ended)
        return made

    def fixed(self, policy: Callable[[Any], int]) -> FixedPolicy:
        """A policy of the user's learner."""
        world = self.gymnasium_world
        return FixedPolicy(policy, lambda: world.observation, world.first_action, self.experience.n_actions)

    @property
    def gymnasium_world(self) -> GymnasiumWorld:
        """The world, whose environment and observations the user's learner knows."""
        assert isinstance(self.world, GymnasiumWorld), "a learner of the user lives in a Gymnasium environment"
        return self.world

    def known_policy(self, name: str) -> Any:
        """A known policy by name, made again by the user's learner where memory holds its bytes."""
        policy = self.experience.types[name].policy
        if isinstance(policy, StoredPolicy):
            read = getattr(self.settings.learner, "from_bytes", None)
            if read is None:
                raise InputError(
                    f"policy {name!r} is stored as bytes; pass a learner with from_bytes(content) -> policy"
                )
            policy = self.experience.types[name].policy = read(policy.content)
        return policy

    # ---- remember ----------------------------------------------------------------------------------

    def remember(self, name: str) -> TaskNews | None:
        """What the task has taught; None where the agent carries nothing from task to task."""
        if not self.abilities.memory:
            return None
        result, experience = self.result, self.experience
        by_moves = self.settings.signals == "moves" and self.abilities.reuse
        moves = counted(self.steps, self.codes) if by_moves else Counter()
        belief = self.learning_types(name, moves)
        if result.new:
            self.explore()
        prior = ActionPrior(experience.n_actions, experience.prior.alpha0, experience.prior.key)
        if self.learner is not None:
            prior.update(*self.learner.best(), self.settings.guidance.weight)
        features = self.codes.states.contexts
        prior.labels = {code: features[code] for code in prior.contexts.tolist()}
        own = result.type if result.new or self.reuse is None else self.reuse.own_policy()
        returns, player = dict(self.ran), None
        if belief and own is not None:
            # A learner that began elsewhere does not replace a known policy: its few returns may be luck.
            if self.learner is not None and (result.new or self.goes_on_with == own):
                by = zip(result.returns, result.policies, strict=True)
                learnt = [earned for earned, policy in by if policy == LEARNER]
                returns[own] = [*returns.get(own, []), *learnt[len(learnt) // 2 :]]
                player = self.learner
            else:
                player = self.players.get(own)
        taught, policy = (None, None) if player is None else (own, player.policy())
        alarm = None if result.new or self.reuse is None else self.alarmed
        return TaskNews(
            result.number, self.context, belief, moves, returns, prior, result.context, taught, policy, alarm
        )

    def learning_types(self, name: str, moves: Counts) -> dict[str, float]:
        """How much each type learns from the task; a new one has the given name."""
        if not self.abilities.reuse:
            return {}
        if self.reuse is not None and not self.reuse.differs(moves):
            self.result.type = self.reuse.names[self.reuse.best]
            return self.reuse.best_member()
        self.result.type, self.result.new = name, True
        return {name: 1.0}


def episode_seed(seed: int, task: int, episode: int) -> int:
    """With what a world is reset; the same for all agents of a seed."""
    return int(stream(seed, "task", task, "world", episode).integers(2**31))
