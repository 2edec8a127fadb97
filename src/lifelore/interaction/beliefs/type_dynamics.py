"""How types change between episodes: static, by a hazard rate, by a matrix of transitions, or by what is learnt.

With a hazard h, a new type is drawn from the prior with probability h before each episode:
β ← (1 - h) β + h G₀. The thesis assumes static types, h = 0. How often types change is seldom known, so the
default is a belief over hazards, `TypeDynamics.learnt`.
"""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import SUM_TOLERANCE, log_prior

if TYPE_CHECKING:
    from lifelore.interaction.beliefs.learnt_dynamics import By, LearntDynamics

Array = NDArray[Any]
ROWS_AT_ONCE = 1 << 20
"""Size of the largest temporary array when many beliefs take a step of a matrix; more is no faster."""


@dataclass(frozen=True, eq=False)
class TypeDynamics:
    """The step of a belief between two episodes; made by `static`, `hazard`, `transitions` or `learnt`.

    Parameters
    ----------
    kind : {"static", "hazard", "transitions"}
    rate : float
        For a hazard: the probability per episode of a new type, in [0, 1].
    law : array, optional
        For a hazard: the prior (n_types,) that new types are drawn from. For transitions: the matrix
        (n_types, n_types), P(next type | type) in rows.

    Raises
    ------
    InputError
        There is no such kind, or rate and law do not fit it.

    Examples
    --------
    >>> from lifelore import BayesianPolicyReuse, PolicyLibrary
    >>> library = PolicyLibrary.from_means([[9.0, 5.0], [4.0, 8.0]], 2.0)
    >>> agent = BayesianPolicyReuse(library, dynamics=TypeDynamics.hazard(0.1, library.prior))
    >>> agent.update(0, 9.0)
    >>> agent.belief.round(2).tolist()
    [0.91, 0.09]
    """

    kind: Literal["static", "hazard", "transitions"] = "static"
    rate: float = 0.0
    law: Array | None = None
    _known: dict[Any, "_HazardTerms"] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        shape = () if self.law is None else np.shape(self.law)
        axes = {"static": 0, "hazard": 1, "transitions": 2}.get(self.kind)
        if axes != len(shape) or len(set(shape)) > 1 or 0 in shape or not 0 <= self.rate <= 1:
            raise InputError(f"no dynamics of kind {self.kind!r}, rate {self.rate} and law of shape {shape}")
        law = np.ones(1) if self.law is None else np.asarray(self.law)
        if not ((law >= 0).all() and (np.abs(law.sum(axis=-1) - 1) <= SUM_TOLERANCE).all()):
            raise InputError("law must be probabilities that sum to 1")

    @classmethod
    def static(cls) -> "TypeDynamics":
        """Types never change (the thesis)."""
        return cls()

    @classmethod
    def hazard(cls, rate: float, prior: ArrayLike) -> "TypeDynamics":
        """With probability `rate` an episode meets a type drawn anew from `prior` (n_types,).

        Raises
        ------
        InputError
            `rate` lies outside [0, 1], or the prior is no distribution.

        Examples
        --------
        >>> changing = TypeDynamics.hazard(0.1, [0.5, 0.5])
        >>> np.exp(changing.step(log_prior([1.0, 0.0]))).round(3).tolist()
        [0.95, 0.05]
        """
        if not 0 <= rate <= 1:
            raise InputError(f"rate must lie in [0, 1], got {rate}")
        return cls("hazard", float(rate), np.exp(log_prior(np.ravel(prior))))

    @classmethod
    def transitions(cls, matrix: ArrayLike) -> "TypeDynamics":
        """Types change by a matrix (n_types, n_types) whose rows are P(next type | type).

        Raises
        ------
        InputError
            The matrix is not square, or a row is no distribution.
        """
        matrix = np.asarray(matrix, np.float64)
        if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or not matrix.size:
            raise InputError(f"matrix must be (n_types, n_types), got shape {matrix.shape}")
        if not ((matrix >= 0).all() and (np.abs(matrix.sum(axis=1) - 1) <= SUM_TOLERANCE).all()):
            raise InputError(
                "matrix must have rows of probabilities that sum to 1; a row is the type before the step"
            )
        return cls("transitions", 0.0, matrix / matrix.sum(axis=1, keepdims=True))

    @staticmethod
    def learnt(by: "By" = "time") -> "LearntDynamics":
        """How types change is learnt, episode by episode, as a belief over several ways.

        Parameters
        ----------
        by : {"time", "type", "outcome"}
            "time": types are static, or change at random at one of several hazards up to 0.1; the default of
            agents. "type": or by a pattern of types, as a matrix. "outcome": or by a pattern that depends on how
            the last episode ended, which ``end_episode(outcome=…)`` names, and on the last type. Costs memory for
            n_types² numbers a user, times the number of ways in which episodes end.

        Raises
        ------
        InputError
            `by` is none of the three.

        Examples
        --------
        >>> from lifelore import BayesianPolicyReuse, PolicyLibrary
        >>> library = PolicyLibrary.from_means([[1.0, 0.0], [0.0, 1.0]], 0.1)
        >>> agent = BayesianPolicyReuse(library, dynamics=TypeDynamics.learnt(by="type"))
        >>> for episode in range(10):  # an opponent that takes turns
        ...     agent.update("policy 0", float(episode % 2 == 0))
        >>> agent.belief.round(2).tolist()
        [0.89, 0.11]
        """
        from lifelore.interaction.beliefs.learnt_dynamics import LearntDynamics

        return LearntDynamics(by)

    @property
    def n_types(self) -> int | None:
        """Number of types that the dynamics are for; None where it does not matter."""
        return None if self.law is None else self.law.shape[-1]

    @property
    def moves(self) -> bool:
        """Whether a step changes beliefs."""
        return self.kind == "transitions" or self.rate > 0

    def rows(self, n_users: int, prior: Array, dtype: Any) -> "FixedRows":
        """The dynamics for each of `n_users` users, of whom nothing is learnt."""
        return FixedRows(self)

    def step(self, log_belief: Array) -> Array:
        """The log belief before the next episode, (..., n_types) to the same, normalised."""
        if not self.moves:
            return log_belief
        return self._hazarded(log_belief) if self.kind == "hazard" else np.minimum(self._moved(log_belief), 0.0)

    def changed_share(self, log_belief: Array) -> Array | None:
        """P(the type has just changed | it is now this type) after a `step`, (..., n_types).

        None where types never change, and for transitions, whose changes the belief follows by itself.
        """
        if self.kind != "hazard" or not self.rate:
            return None
        with np.errstate(invalid="ignore"):
            return np.exp(np.fmin(self._terms(log_belief.dtype).log_anew - log_belief, 0.0))

    def _hazarded(self, log_belief: Array) -> Array:
        terms = self._terms(log_belief.dtype)
        if not terms.small:
            return np.log(np.exp(log_belief) * terms.stay + terms.anew)
        return np.logaddexp(log_belief + terms.log_stay, terms.log_anew)

    def _terms(self, dtype: Any) -> "_HazardTerms":
        """The numbers of a hazard's step in the precision of the beliefs, computed once."""
        if dtype not in self._known:
            assert self.law is not None
            anew = self.rate * self.law
            with np.errstate(divide="ignore"):
                log_stay, log_anew = np.log1p(-self.rate), np.log(anew)
            small = bool((anew < np.finfo(dtype).tiny).any())
            terms = (1 - self.rate, log_stay, anew, log_anew)
            stored = [np.asarray(term, dtype) for term in terms]
            self._known[dtype] = _HazardTerms(small, *stored)
        return self._known[dtype]

    def _moved(self, log_belief: Array) -> Array:
        assert self.law is not None
        with np.errstate(divide="ignore"):
            log_law = np.log(self.law)
        n_types = len(log_law)
        rows = log_belief.reshape(-1, n_types)
        block = max(1, ROWS_AT_ONCE // n_types**2)
        moved = [
            np.logaddexp.reduce(rows[at : at + block, :, None] + log_law, axis=-2)
            for at in range(0, len(rows), block)
        ]
        return np.concatenate(moved).reshape(log_belief.shape)


class _HazardTerms(NamedTuple):
    """Whether some h G₀ is too small for a number; 1 − h and h G₀ (n_types,), with their logarithms."""

    small: bool
    stay: Array
    log_stay: Array
    anew: Array
    log_anew: Array


class FixedRows:
    """Dynamics that are the same for all users and learn nothing; methods as of `LearntRows`."""

    def __init__(self, settings: TypeDynamics) -> None:
        self.settings = settings

    def step(self, log_belief: Array, users: Any, outcome: Any = None) -> Array:
        return self.settings.step(log_belief)

    def changed_share(self, log_belief: Array, users: Any) -> Array | None:
        return self.settings.changed_share(log_belief)

    def reset(self, users: Any) -> None: ...

    def grow(self, n_users: int) -> None: ...

    def arrays(self) -> list[Array]:
        return []

    def state(self, user: int) -> dict[str, Array]:
        return {}

    def restore(self, user: int, state: Any) -> None: ...

    def learnt(self, user: int, log_belief: Array) -> TypeDynamics:
        return self.settings
