"""What the long-lived agent asks of a family of tasks: causes and effects, features, and plans of its behaviours.

An *act* is an action in words of the perceived scene ("pick the object on top"). A *cause* is an act together
with the features that its effect may depend on; an *effect* is a category of what followed. How effects depend on
causes is what the agent learns of each type. A *behaviour* acts best if the task is of one type.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from lifelore.action.priors.action_prior import ActionPrior
from lifelore.domains.task_stream import DrawnTask

Array = NDArray[np.float64]
Value = TypeVar("Value")

SAME_SCENE = 0.5
"""A usual `TaskFamily.constancy`: the same scene mostly answers alike."""


@dataclass(frozen=True)
class Step:
    """The result of an act.

    Parameters
    ----------
    reward : float
    effects : tuple of (int, int)
        Causes and their effects; none for an act that shows nothing.
    ended : bool
        Whether the episode ended.

    Examples
    --------
    >>> Step(reward=1.0, effects=((0, 1),), ended=False).effects
    ((0, 1),)
    """

    reward: float
    effects: tuple[tuple[int, int], ...]
    ended: bool


@dataclass(frozen=True, eq=False)
class Plan:
    """The act of each behaviour now, and its expected return under each type.

    Parameters
    ----------
    values : (n_types, n_behaviours) float64
        Expected return from now on of a behaviour in a task of a type; behaviour k is the best one for type k.
    acts : (n_behaviours,) int64
    trying : (n_behaviours,) int64
        The same where giving up is ruled out, because it teaches nothing.

    Examples
    --------
    >>> Plan(values=np.array([[1.0, 0.0]]), acts=np.array([2, 0]), trying=np.array([1])).acts.tolist()
    [2, 0]
    """

    values: Array
    acts: NDArray[np.int64]
    trying: NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Abilities:
    """Which parts of the agent work; ablations switch them off.

    Parameters
    ----------
    perception : bool
        Whether relations of the scene are features.
    prior : bool
        Whether action priors guide: acts that were best before, and types that came before in a context.
    reuse : bool
        Whether types and their behaviours are remembered; without, all tasks teach one model.
    memory : bool
        Whether anything is carried from task to task.
    """

    perception: bool = True
    prior: bool = True
    reuse: bool = True
    memory: bool = True


AGENTS = {
    "full": Abilities(),
    "no-perception": Abilities(perception=False),
    "no-prior": Abilities(prior=False),
    "no-reuse": Abilities(reuse=False),
    "scratch": Abilities(prior=False, reuse=False, memory=False),
}
"""The agent and its ablations."""


@dataclass(eq=False)
class SharedKnowledge:
    """What is the same for all types of a family.

    Parameters
    ----------
    acts : ActionPrior
        How often each act was best, by context.
    causes : ActionPrior
        Number of tasks that showed each cause, and after the last cause the number of tasks; of a single action.
    guided : bool
        Whether the prior over acts guides plans.
    """

    acts: ActionPrior
    causes: ActionPrior
    guided: bool = True

    @classmethod
    def empty(cls, family: "TaskFamily") -> "SharedKnowledge":
        """Without counts."""
        return cls(ActionPrior(len(family.acts)), ActionPrior(1))


class AgentTask(Protocol):
    """A task as the agent meets it; its type is hidden. A class that derives from it has the defaults.

    Examples
    --------
    A coin that shows 1: the only cause is the throw, an act says what it will show, and a right one pays 1:

    >>> class Throw(AgentTask):
    ...     def begin(self):
    ...         pass
    ...     def plan(self, laws, tried, new, shared):
    ...         acts = laws[:, 0].argmax(axis=1)
    ...         return Plan(laws[:, 0][:, acts], acts, acts)
    ...     def act(self, act):
    ...         return Step(reward=float(act == 1), effects=((0, 1),), ended=True)
    >>> Throw().act(1).reward, Throw().context
    (1.0, 0)
    """

    @property
    def context(self) -> int:
        """Code of the perceived features, for the prior over acts. Default: 0."""
        return 0

    def begin(self) -> None:
        """Begin an episode: look at the scene."""
        ...

    def plan(self, laws: Array, tried: NDArray[np.bool_], new: int | None, shared: SharedKnowledge) -> Plan:
        """Plan from here.

        Parameters
        ----------
        laws : (n_types, n_causes, n_effects) float64
            P(effect | cause; type).
        tried : (n_causes,) bool
            Whether anything is known of a cause.
        new : int, optional
            The row that stands for an unknown type: its behaviour also tries what was never tried.
        shared : SharedKnowledge
        """
        ...

    def best_acts(self, laws: Array, shared: SharedKnowledge) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
        """Contexts of this task (n,) and their best acts (n, n_acts) under a type's laws (n_causes, n_effects).

        Default: none, because which act is best depends on the type alone.
        """
        return np.zeros(0, np.int64), np.zeros((0, shared.acts.n_actions), np.bool_)

    def act(self, act: int) -> Step:
        """Act."""
        ...

    def describe(self) -> str:
        """The perceived scene in a few words, for explanations. Default: none."""
        return ""


def _default(compute: Callable[[Any], Value]) -> Value:
    """An attribute that is computed once, unless a subclass has an attribute or a property of this name."""
    return cast(Value, cached_property(compute))


class TaskFamily(ABC):
    """Tasks of one kind, by number; a family of your own derives from it.

    A family states its ``name``, ``acts``, ``n_causes`` and ``n_effects``, and has the methods `meet` and
    `best_return`. All else has a default, which a family replaces by an attribute, a property or a method of that
    name. `check_family` plays some tasks and names what is wrong.

    Attributes
    ----------
    name : str
        Name in memory.
    acts : tuple of str
        Names of the acts.
    n_causes, n_effects : int
        Causes are the integers in [0, n_causes), effects those in [0, n_effects).

    Examples
    --------
    Coins that show 0 or 1, which is the hidden type of a task:

    >>> from lifelore.agent.long_lived.check_family import check_family
    >>> from lifelore.domains.task_stream import TaskStream
    >>> class Throw(AgentTask):
    ...     def __init__(self, shows):
    ...         self.shows = shows
    ...     def begin(self):
    ...         pass
    ...     def plan(self, laws, tried, new, shared):
    ...         acts = laws[:, 0].argmax(axis=1)
    ...         return Plan(laws[:, 0][:, acts], acts, acts)
    ...     def act(self, act):
    ...         return Step(float(act == self.shows), ((0, self.shows),), ended=True)
    >>> class Coins(TaskFamily):
    ...     name, acts, n_causes, n_effects = "coins", ("say 0", "say 1"), 1, 2
    ...     def meet(self, number, abilities, context=None):
    ...         drawn = TaskStream(("0", "1")).draw(number, context)
    ...         return drawn, Throw(int(drawn.hidden_type))
    ...     def best_return(self, number, context=None):
    ...         return 1.0
    >>> check_family(Coins())
    """

    name: str
    acts: tuple[str, ...]
    n_causes: int
    n_effects: int

    @abstractmethod
    def meet(self, number: int, abilities: Abilities, context: int | None = None) -> tuple[DrawnTask, AgentTask]:
        """Task `number`, drawn and met; in a given context, if the agent chooses one in its spare time.

        The same number is the same task again: a `TaskStream` draws so.
        """

    @abstractmethod
    def best_return(self, number: int, context: int | None = None) -> float:
        """The best possible return of task `number`, for scoring; the agent never asks."""

    @_default
    def domain(self) -> str:
        """Name of the family in reports: by default its `name`."""
        return self.name

    @_default
    def possible(self) -> Array:
        """(n_causes, n_effects) P(effect | cause) before anything was seen; rows sum to 1. Default: all alike."""
        return np.full((self.n_causes, self.n_effects), 1 / self.n_effects)

    @_default
    def groups(self) -> NDArray[np.int64]:
        """(n_causes,) causes of one group are alike: what is known of the group stands in for an untried cause.

        Default: no cause is like another.
        """
        return np.arange(self.n_causes)

    @_default
    def kinds(self) -> NDArray[np.int64]:
        """(n_causes,) types differ about as much in all causes of a kind; how much is learnt. Default: one."""
        return np.zeros(self.n_causes, np.int64)

    @_default
    def judges(self) -> NDArray[np.bool_]:
        """(n_causes,) whether a cause tells types apart; the others serve plans alone. Default: all do."""
        return np.ones(self.n_causes, np.bool_)

    @_default
    def constancy(self) -> Array:
        """(n_causes,) weight of a type's law beside observations of the present task, in observations.

        Little where the same task answers the same cause alike, much where a cause is met in several forms.
        Default: 0.5, the same scene mostly answers alike.
        """
        return np.full(self.n_causes, SAME_SCENE)

    def smoothed(self, counts: Array) -> Array:
        """Counts (n, n_causes, n_effects) shared among similar effects. Default: no effects are similar."""
        return counts

    def cause_name(self, cause: int) -> str:
        """A cause in words. Default: the act of this number, if there are as many causes as acts."""
        return self.acts[cause] if self.n_causes == len(self.acts) else f"cause {cause}"

    def effect_name(self, cause: int, effect: int) -> str:
        """An effect in words. Default: its number."""
        return f"effect {effect}"
