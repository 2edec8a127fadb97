"""A telephone service that learns which language model a caller needs.

A type is the caller's preference, a policy the language model used, one episode one call. With L models and
ρ = (L − |policy − type|) / L, a call that is still open irritates the caller, succeeds, or is hung up:

| reading | irritated | succeeds | hangs up |
|---|---|---|---|
| A | η | (1 − η) ρ | (1 − η)(1 − ρ) |
| B | (1 − ρ) η | ρ | (1 − ρ)(1 − η) |

η = 0.3, and 0 for the preferred model. A caller who is irritated is first frustrated, then annoyed, then angry,
and an angry one is handed to a human. Success pays 10 in all, every other end 3. Reading A is the default: of
the two only it leaves the way to *angry* independent of ρ, as the text says; under B (s, a, s′) tells no more than
the rewards.

Thesis: §4.6.2, Figure 4.5.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError

STATES = ("start", "frustrated", "annoyed", "angry", "success", "hung up")
START, FRUSTRATED, ANNOYED, ANGRY, SUCCESS, HUNG_UP = range(6)
OPEN = (START, FRUSTRATED, ANNOYED)
"""States in which the call goes on."""
READINGS = ("A", "B")
SOLVED, UNSOLVED = 10.0, 3.0
IRRITATION = 1.0
"""Reward of an irritation that does not end the call; taken off what ends it, so that the sum stays 10 or 3."""
PATHS = tuple(
    [(*OPEN[: k + 1], end) for k in range(3) for end in (SUCCESS, HUNG_UP)] + [(START, FRUSTRATED, ANNOYED, ANGRY)]
)
"""Every call there can be, as its states in order: (s, a, s′) of the whole call."""


def reward(before: int, after: int) -> float:
    """Reward of the transition between two states, as printed in Figure 4.5's manner."""
    if after in OPEN:
        return IRRITATION
    return (SOLVED if after == SUCCESS else UNSOLVED) - IRRITATION * OPEN.index(before)


def rewards_of(path: tuple[int, ...]) -> tuple[float, ...]:
    """The rewards along a call."""
    return tuple(reward(s, s2) for s, s2 in pairwise(path))


REWARD_SEQUENCES = tuple(dict.fromkeys(rewards_of(path) for path in PATHS))
"""Every sequence of rewards there can be; hanging up when annoyed and growing angry share one."""
UTILITIES = (UNSOLVED, SOLVED)
REWARDS_OF_PATH = tuple(REWARD_SEQUENCES.index(rewards_of(path)) for path in PATHS)
UTILITY_OF_PATH = tuple(UTILITIES.index(sum(rewards_of(path))) for path in PATHS)


@dataclass(frozen=True)
class Telephone:
    """The telephone domain of §4.6.2: callers and language models as numbers.

    Parameters
    ----------
    n_models : int
        L, at least 1: as many types as policies.
    eta : float
        η in [0, 1) with a model that is not the preferred one.
    reading : {"A", "B"}
        Which outcome η is split from; see the module.
    matched_eta : float
        η with the preferred model.

    Examples
    --------
    >>> phone = Telephone(n_models=2)
    >>> phone.path_probs[0, 1].round(4).tolist()  # a caller of type 0 and the other model: ρ is a half
    [0.35, 0.35, 0.105, 0.105, 0.0315, 0.0315, 0.027]
    >>> phone.mean[0].round(4).tolist()
    [10.0, 6.4055]
    """

    n_models: int = 10
    eta: float = 0.3
    reading: str = "A"
    matched_eta: float = 0.0

    def __post_init__(self) -> None:
        if self.n_models < 1:
            raise InputError(f"n_models must be at least 1, got {self.n_models}")
        if not (0 <= self.eta < 1 and 0 <= self.matched_eta < 1):
            raise InputError(f"eta and matched_eta must lie in [0, 1), got {self.eta} and {self.matched_eta}")
        if self.reading not in READINGS:
            raise NotFoundError(f"reading must be one of {', '.join(READINGS)}, got {self.reading!r}")

    @cached_property
    def rho(self) -> NDArray[np.float64]:
        """How well each model is understood by each caller, (L, L) in (0, 1]."""
        every = np.arange(self.n_models)
        return (self.n_models - np.abs(every[:, None] - every)) / self.n_models

    @cached_property
    def outcome_probs(self) -> NDArray[np.float64]:
        """Irritated, succeeds, hangs up: from any open state, (L, L, 3); rows sum to 1."""
        eta, rho = np.where(np.eye(self.n_models, dtype=bool), self.matched_eta, self.eta), self.rho
        if self.reading == "A":
            return np.stack([eta, (1 - eta) * rho, (1 - eta) * (1 - rho)], axis=-1)
        return np.stack([(1 - rho) * eta, rho, (1 - rho) * (1 - eta)], axis=-1)

    @cached_property
    def transition_probs(self) -> NDArray[np.float64]:
        """T(s′ | s) by type and policy, (L, L, 6, 6): there is one action a policy. Closed states stay."""
        probs = np.zeros((self.n_models, self.n_models, len(STATES), len(STATES)))
        for s in OPEN:
            probs[..., s, [s + 1, SUCCESS, HUNG_UP]] = self.outcome_probs
        for s in (ANGRY, SUCCESS, HUNG_UP):
            probs[..., s, s] = 1.0
        return probs

    @cached_property
    def path_probs(self) -> NDArray[np.float64]:
        """Probability of each call of `PATHS`, (L, L, 7): the signal (s, a, s′)."""
        steps = [[self.transition_probs[..., s, s2] for s, s2 in pairwise(p)] for p in PATHS]
        return np.stack([np.prod(step, axis=0) for step in steps], axis=-1)

    @cached_property
    def reward_probs(self) -> NDArray[np.float64]:
        """Probability of each of `REWARD_SEQUENCES`, (L, L, 6): the signal (s, a, r)."""
        return _summed(self.path_probs, REWARDS_OF_PATH, len(REWARD_SEQUENCES))

    @cached_property
    def utility_probs(self) -> NDArray[np.float64]:
        """Probability of each of `UTILITIES`, (L, L, 2): the signal U."""
        return _summed(self.path_probs, UTILITY_OF_PATH, len(UTILITIES))

    @cached_property
    def mean(self) -> NDArray[np.float64]:
        """Expected utility by type and policy, (L, L), between 3 and 10."""
        return self.utility_probs @ np.array(UTILITIES)

    @cached_property
    def _path_ends(self) -> NDArray[np.float64]:
        """Cumulative probabilities of all calls but the last, (6, L, L): sums over a long last axis are faster."""
        return np.ascontiguousarray(np.moveaxis(self.path_probs.cumsum(axis=-1)[..., :-1], -1, 0))

    def path_of(self, uniform: ArrayLike, type_: ArrayLike, policy: ArrayLike) -> NDArray[np.int64]:
        """Which call of `PATHS` a uniform number in [0, 1) stands for; all broadcast."""
        uniform, type_, policy = np.broadcast_arrays(uniform, type_, policy)
        return (uniform >= self._path_ends[:, type_, policy]).sum(axis=0)

    def sample(self, generator: np.random.Generator, type_: ArrayLike, policy: ArrayLike) -> NDArray[np.int64]:
        """Calls as places in `PATHS`, one for each pair of `type_` and `policy` (broadcast)."""
        type_, policy = np.broadcast_arrays(np.asarray(type_), np.asarray(policy))
        return self.path_of(generator.random(type_.shape), type_, policy)


def _summed(probs: NDArray[np.float64], group: tuple[int, ...], n: int) -> NDArray[np.float64]:
    """Probabilities of groups of the last axis."""
    return probs @ np.eye(n)[list(group)]
