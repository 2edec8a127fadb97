"""Beliefs about very many users: a row of log beliefs for each, updated and read in blocks that fit the cache.

With float32 rows a user takes 4 bytes a type: 272 bytes for 68 types. float64 rows have the bits of a
`BayesianPolicyReuse` for each user. float32 rows agree with these to 1e-5, and above 1e-6 to a ten-thousandth of
themselves, for types whose belief never fell below e^-100. Beliefs below e^-87 (float64: 1e-250) count as 0 in a
choice, but their logarithms stay and may rise again. Thesis: §4.2, Alg. 7, with many tasks side by side.
"""

from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.reuse_algorithm import LEAST_SCORED, TOLERANCES, ReuseAlgorithm, blocks
from lifelore.interaction.selection import Greedy, SelectionRule, rule_named

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]


class UserBeliefs:
    """Beliefs about `n_users` users.

    Parameters
    ----------
    library : PolicyLibrary
        Call `refresh` after its models have learnt in place.
    n_users : int
        At least 1.
    dtype : {"f4", "f8"}
    prior : (n_types,) float, optional
        The library's by default.
    dynamics : TypeDynamics, optional
        By default a hazard of 0.002 that draws from the library's prior; `TypeDynamics.static()` as in the thesis.
        Each `update` is also the step between two episodes.
    seed : int or numpy generator

    Attributes
    ----------
    log_belief : (n_users, n_types) float32 or float64
        Normalised logs; the whole state.
    log_prior : (n_types,) of the same
        Log belief about a new user.

    Raises
    ------
    InputError
        An argument breaks its rule.

    Examples
    --------
    >>> library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0)
    >>> users = UserBeliefs(library, 1000)
    >>> evidence = users.update([7, 9], policies=[0, 0], signals=[9.0, 1.0])
    >>> users.select([7, 9], "greedy").tolist()
    [0, 1]
    """

    def __init__(
        self,
        library: PolicyLibrary,
        n_users: int,
        dtype: Literal["f4", "f8"] = "f4",
        *,
        prior: ArrayLike | None = None,
        dynamics: TypeDynamics | None = None,
        seed: int | np.random.Generator = 0,
    ) -> None:
        if n_users < 1:
            raise InputError(f"n_users must be at least 1, got {n_users}")
        if dtype not in TOLERANCES:
            raise InputError(f"dtype must be 'f4' or 'f8', got {dtype!r}")
        self.library, self.dtype = library, dtype
        self.algorithm = ReuseAlgorithm(library, dynamics, dtype=dtype, least=LEAST_SCORED)
        self.generator = stream(seed, "user beliefs") if isinstance(seed, int | np.integer) else seed
        self.log_prior = self.algorithm.start(prior)
        self.log_belief = np.empty((n_users, library.n_types), dtype)
        self.log_belief[:] = self.log_prior

    def refresh(self) -> None:
        """Read the library's models again; beliefs stay."""
        self.algorithm.refresh()

    @property
    def dynamics(self) -> TypeDynamics:
        """How types change between episodes."""
        return self.algorithm.dynamics

    @property
    def n_users(self) -> int:
        """Number of users."""
        return len(self.log_belief)

    # ---- many users at once ----------------------------------------------------------------------------

    def select(
        self, users: ArrayLike, rule: SelectionRule | str = "sampling", *, episodes_left: float | None = None
    ) -> Numbers:
        """The number of the policy to run next for each of `users` (k,), (k,).

        Parameters
        ----------
        rule : SelectionRule or str
            "sampling" and "greedy" run compiled; the other rules score the users block by block.
        """
        users, rule = self._checked_users(users), _rule(rule)
        chosen = np.empty(len(users), np.int64)
        for at, own in blocks(users):
            belief = self.algorithm.belief(self.log_belief, own)
            chosen[at] = self.algorithm.select_fast(belief, rule, self.generator, episodes_left)
        return chosen

    def update(self, users: ArrayLike, policies: ArrayLike, signals: Any) -> Array:
        """Learn from a signal for each of `users`; a user that comes twice is updated in turn.

        Parameters
        ----------
        users, policies : (k,) int
        signals : sequence of length k
            Numbers for returns, category numbers for categories.

        Returns
        -------
        (k,) float64
            Log evidence of each signal; minus infinity where no type explains it and the belief stays.

        Raises
        ------
        NotFoundError
            There is no such user or policy.
        InputError
            The model cannot have made a signal, or gave NaN. Blocks before that signal are updated.
        """
        users, policies = self._checked_users(users), self._checked_policies(policies)
        return self.algorithm.update(self.log_belief, users, policies, signals)[0]

    def update_and_select(
        self,
        users: ArrayLike,
        policies: ArrayLike,
        signals: Any,
        rule: SelectionRule | str = "sampling",
        *,
        episodes_left: float | None = None,
    ) -> Numbers:
        """`update`, and the policy to run next, (k,), in one pass."""
        users, policies, rule = self._checked_users(users), self._checked_policies(policies), _rule(rule)

        def select(belief: NDArray[Any]) -> Numbers:
            return self.algorithm.select_fast(belief, rule, self.generator, episodes_left)

        return self.algorithm.update(self.log_belief, users, policies, signals, select)[1]

    def belief(self, users: ArrayLike) -> Array:
        """β of each of `users`, (k, n_types) float64, rows sum to 1."""
        users = self._checked_users(users)
        belief = np.exp(self.log_belief[users].astype(np.float64))
        return belief / belief.sum(axis=1, keepdims=True)

    def probabilities(
        self, users: ArrayLike, rule: SelectionRule | str = "sampling", *, episodes_left: float | None = None
    ) -> Array:
        """Probability that `select` takes each policy, (k, n_policies); log it beside the selected policy."""
        users, rule = self._checked_users(users), _rule(rule)
        if type(rule) is Greedy:
            # As `select` compares them: policies that float32 cannot tell apart are equal.
            return self.algorithm.greedy_shares(self.algorithm.belief(self.log_belief, users))
        return rule.probabilities(self.library, self.belief(users), episodes_left=episodes_left)

    def reset(self, users: ArrayLike) -> None:
        """Set the beliefs about `users` back to the prior."""
        self.log_belief[self._checked_users(users)] = self.log_prior

    def _checked_users(self, users: ArrayLike) -> Numbers:
        return _checked(users, self.n_users, "user")

    def _checked_policies(self, policies: ArrayLike) -> Numbers:
        return _checked(policies, self.library.n_policies, "policy")


def _checked(numbers: ArrayLike, n: int, what: str) -> Numbers:
    values = np.atleast_1d(np.ascontiguousarray(numbers))
    if values.ndim != 1 or (values.size and values.dtype.kind not in "iu"):
        raise InputError(f"{what} numbers must be whole numbers (k,), got {values.dtype} of shape {values.shape}")
    if values.size and not 0 <= values.min() <= values.max() < n:
        raise NotFoundError(f"unknown {what} {values.min() if values.min() < 0 else values.max()}; there are {n}")
    return values.astype(np.int64, copy=False)


def _rule(rule: SelectionRule | str) -> SelectionRule:
    return rule_named(rule) if isinstance(rule, str) else rule
