"""Feature functions: features of the state, the task, the last reward, or the class of the agent.

    φ(s, τ, r) -> (f_1, …, f_k)

Thesis: §3.3, §3.3.2 ("aspects of the task description, or recent rewards"), §3.7.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.features.feature_set import Columns, FeatureSet
from lifelore.core.errors import InputError, NotFoundError


class FeatureFunction(Protocol):
    """φ(state, task, last reward): a row of feature values for each state, in the order of `features`.

    `states` is (n,) int, `task` an object of the world, `last_rewards` (n,) float: the reward received on entering
    each state (0 at the start of an episode). Equal arguments must give equal rows.
    """

    @property
    def features(self) -> FeatureSet: ...

    def __call__(self, states: ArrayLike, task: Any, last_rewards: ArrayLike) -> Columns: ...


@dataclass(frozen=True, eq=False)
class StateFeatures:
    """Features from a table with a row for each state, (n_states, n_features) int.

    Examples
    --------
    >>> phi = StateFeatures(FeatureSet(("wall", "odd"), (2, 2)), np.array([[0, 0], [0, 1], [1, 0]]))
    >>> context_codes(phi, [0, 2]).tolist()
    [0, 2]
    """

    features: FeatureSet
    table: NDArray[np.integer]

    def __call__(self, states: ArrayLike, task: Any, last_rewards: ArrayLike) -> Columns:
        return np.asarray(self.table, np.int64)[np.asarray(states, np.int64).ravel()]


@dataclass(frozen=True)
class TaskFeature:
    """One feature of the task description: ``of_task(task)`` in [0, size).

    Examples
    --------
    >>> urgent = TaskFeature("urgent", 2, lambda task: int(task["due"] < 10))
    >>> context_codes(urgent, [0, 1], task={"due": 5}).tolist()
    [1, 1]
    """

    name: str
    size: int
    of_task: Callable[[Any], int]

    @property
    def features(self) -> FeatureSet:
        """The one feature."""
        return FeatureSet((self.name,), (self.size,))

    def __call__(self, states: ArrayLike, task: Any, last_rewards: ArrayLike) -> Columns:
        return np.full((np.asarray(states).size, 1), int(self.of_task(task)), np.int64)


@dataclass(frozen=True)
class LastReward:
    """The last reward as a class: the number of the ascending `edges` that it reaches.

    Examples
    --------
    >>> LastReward((0.0, 50.0))([4, 4, 4], None, [-10.0, 0.0, 100.0]).ravel().tolist()
    [0, 1, 2]
    """

    edges: tuple[float, ...]
    name: str = "last reward"

    def __post_init__(self) -> None:
        edges = np.asarray(self.edges, float)
        if not (np.isfinite(edges).all() and (np.diff(edges) > 0).all()):
            raise InputError(f"edges must be finite and ascending, got {list(self.edges)}")

    @property
    def features(self) -> FeatureSet:
        """The one feature, with a value more than there are edges."""
        return FeatureSet((self.name,), (len(self.edges) + 1,))

    def __call__(self, states: ArrayLike, task: Any, last_rewards: ArrayLike) -> Columns:
        rewards = np.asarray(last_rewards, float).ravel()
        return np.searchsorted(np.asarray(self.edges, float), rewards, side="right")[:, None].astype(np.int64)


@dataclass(frozen=True)
class AgentClass:
    """The class of the acting agent, one of `classes`; agents of a class share their counts (§3.7).

    Examples
    --------
    >>> context_codes(AgentClass(("visitor", "staff"), "staff"), [0, 1]).tolist()
    [1, 1]
    """

    classes: tuple[str, ...]
    own: str
    name: str = "agent class"

    def __post_init__(self) -> None:
        if self.own not in self.classes:
            raise NotFoundError(f"agent class must be one of {', '.join(self.classes)}, got '{self.own}'")

    @property
    def features(self) -> FeatureSet:
        """The features, with the number of values of each."""
        return FeatureSet((self.name,), (len(self.classes),))

    def __call__(self, states: ArrayLike, task: Any, last_rewards: ArrayLike) -> Columns:
        return np.full((np.asarray(states).size, 1), self.classes.index(self.own), np.int64)


@dataclass(frozen=True)
class JoinedFeatures:
    """The features of several feature functions joined.

    Examples
    --------
    >>> urgent = TaskFeature("urgent", 2, lambda task: int(task["due"] < 10))
    >>> joined = JoinedFeatures((urgent, AgentClass(("visitor", "staff"), "staff")))
    >>> joined.features.names, context_codes(joined, [0], task={"due": 5}).tolist()
    (('urgent', 'agent class'), [3])
    """

    parts: tuple[FeatureFunction, ...]

    @property
    def features(self) -> FeatureSet:
        """The features of all parts, in their order."""
        sets = [part.features for part in self.parts]
        names = tuple(name for one in sets for name in one.names)
        return FeatureSet(names, tuple(size for one in sets for size in one.sizes))

    def __call__(self, states: ArrayLike, task: Any, last_rewards: ArrayLike) -> Columns:
        states = np.asarray(states, np.int64).ravel()
        rewards = np.broadcast_to(np.asarray(last_rewards, float).ravel(), states.shape)
        return np.hstack([np.empty((len(states), 0), np.int64)] + [p(states, task, rewards) for p in self.parts])


def context_codes(
    phi: FeatureFunction, states: ArrayLike, task: Any = None, last_rewards: ArrayLike = 0.0
) -> NDArray[np.int64]:
    """Context codes of states in a task, (n,) int64, for `ActionPrior`.

    Use feature functions where a state alone does not determine the useful actions, for example where they depend
    on the last reward.

    Parameters
    ----------
    phi : FeatureFunction
    states : (n,) int
    task : any, optional
    last_rewards : (n,) float, or a number for all states
        Rewards received on entering each state; 0 at the start of an episode.

    Examples
    --------
    >>> phi = StateFeatures(FeatureSet(("wall", "odd"), (2, 2)), np.array([[0, 0], [0, 1], [1, 0]]))
    >>> context_codes(phi, [0, 1, 2]).tolist()
    [0, 1, 2]
    """
    states = np.asarray(states, np.int64).ravel()
    rewards = np.asarray(last_rewards, float).ravel()
    if rewards.size not in (1, len(states)):
        raise InputError(
            f"last_rewards must be one number or {len(states)}, a number for each state, got {rewards.size}"
        )
    return phi.features.codes(phi(states, task, np.broadcast_to(rewards, states.shape)))
