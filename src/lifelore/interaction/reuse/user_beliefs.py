"""Beliefs about very many users: a row of log beliefs for each, updated and read in blocks that fit the cache.

With float32 rows a user takes 4 bytes a type: 272 bytes for 68 types. With models learnt from a finite number of
runs, the belief is over types and the parameters of their models; then a user takes 8 bytes more, and 144 for
every five tried policies. float64 rows have the bits of a `BayesianPolicyReuse` for each user (uncertain models:
its numbers to 1e-12). float32 rows agree with these to 1e-5, and above 1e-6 to a ten-thousandth of themselves, for
types whose belief never fell below e^-100. Beliefs below e^-87 (float64: 1e-250) count as 0 in a choice, but their
logarithms stay and may rise again. Thesis: §4.2, Alg. 7, with many tasks side by side.
"""

from collections.abc import Iterable, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.bayesian_policy_reuse import Models
from lifelore.interaction.reuse.outcome_laws import outcome_law
from lifelore.interaction.reuse.reuse_algorithm import LEAST_SCORED, TOLERANCES, ReuseAlgorithm, blocks
from lifelore.interaction.reuse.user_choice import UserChoice, checked_mask
from lifelore.interaction.reuse.user_names import UserNames, are_names
from lifelore.interaction.reuse.user_outcomes import UserOutcomes
from lifelore.interaction.selection import Greedy, SelectionRule, default_rule, rule_named

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]
Users = ArrayLike | Sequence[str]
"""Numbers of users, or their names where the users have names."""


class UserBeliefs:
    """Beliefs about many users.

    Parameters
    ----------
    library : PolicyLibrary
        Call `refresh` after its models have learnt in place.
    users : int or iterable of str
        Number of users, at least 1; they are then numbered from 0. Or their names, none to begin with allowed.
    dtype : {"f4", "f8"}
    prior : (n_types,) float, optional
        The library's by default.
    dynamics : TypeDynamics, optional
        By default a hazard of 0.002 that draws from the library's prior; `TypeDynamics.static()` as in the thesis.
        Each `update` is also the step between two episodes.
    models : {"uncertain", "plug-in"}
        As in `BayesianPolicyReuse`. Uncertain models need returns as signals; other signals are plug-in.
    spread : float, optional
        ρ, by how much the mean outcome of a pair differs between users of a type, as a share of the variance of an
        outcome; ≥ 0. By default the mean of the spreads that the library holds possible. A `BayesianPolicyReuse`
        holds a belief over these.
    unknown : {"error", "add"}
        Whether a new name in `select` or `update` is an error, or adds a user. Numbers never add users.
    seed : int or numpy generator

    Attributes
    ----------
    log_prior : (n_types,) float32 or float64
        Log belief about a new user.
    outcomes : UserOutcomes or None
        What the users have shown; None where models are plug-in or exact.

    Raises
    ------
    InputError
        An argument breaks its rule.

    Examples
    --------
    >>> library = PolicyLibrary.from_means([[10.0, 0.0], [0.0, 10.0]], 2.0)
    >>> users = UserBeliefs(library, ["ada", "ben"], unknown="add")
    >>> evidence = users.update(["ada", "carl"], policies=[0, 0], signals=[9.0, 1.0])
    >>> users.select(["ada", "carl"], "greedy").tolist(), users.n_users
    ([0, 1], 3)
    """

    def __init__(
        self,
        library: PolicyLibrary,
        users: int | Iterable[str],
        dtype: Literal["f4", "f8"] = "f4",
        *,
        prior: ArrayLike | None = None,
        dynamics: TypeDynamics | None = None,
        models: Models = "uncertain",
        spread: float | None = None,
        unknown: Literal["error", "add"] = "error",
        seed: int | np.random.Generator = 0,
    ) -> None:
        self.names = None if isinstance(users, int | np.integer) else UserNames(users)
        n_users = int(users) if self.names is None else len(self.names)  # pyright: ignore[reportArgumentType]
        if self.names is None and n_users < 1:
            raise InputError(f"users must be at least 1, or names, got {n_users}")
        if dtype not in TOLERANCES:
            raise InputError(f"dtype must be 'f4' or 'f8', got {dtype!r}")
        if models not in ("uncertain", "plug-in"):
            raise InputError(f"models must be 'uncertain' or 'plug-in', got {models!r}")
        if unknown not in ("error", "add"):
            raise InputError(f"unknown must be 'error' or 'add', got {unknown!r}")
        if spread is not None and not 0 <= spread < np.inf:
            raise InputError(f"spread must be at least 0 and finite, got {spread}")
        self.library, self.dtype, self.models, self.unknown = library, dtype, models, unknown
        self.spread = spread
        self.algorithm = ReuseAlgorithm(library, dynamics, dtype=dtype, least=LEAST_SCORED)
        self.generator = stream(seed, "user beliefs") if isinstance(seed, int | np.integer) else seed
        self.log_prior = self.algorithm.start(prior)
        self._n_users, self._rows = n_users, np.empty((n_users, library.n_types), dtype)
        self._rows[:] = self.log_prior
        law = outcome_law(library, spread) if models == "uncertain" else None
        self.outcomes = None if law is None else UserOutcomes(law, n_users)
        self._choice: UserChoice | None = None

    def refresh(self) -> None:
        """Read the library's models again; beliefs and what users have shown stay."""
        self.algorithm.refresh()
        self._choice = None
        if self.outcomes is not None:
            law = outcome_law(self.library, self.spread)
            assert law is not None
            self.outcomes.law = law

    @property
    def dynamics(self) -> TypeDynamics:
        """How types change between episodes."""
        return self.algorithm.dynamics

    @property
    def n_users(self) -> int:
        """Number of users."""
        return self._n_users

    @property
    def log_belief(self) -> NDArray[Any]:
        """Normalised logs of the beliefs, (n_users, n_types) float32 or float64; not a copy."""
        return self._rows[: self._n_users]

    @property
    def nbytes(self) -> int:
        """Memory of all users in bytes, without their names."""
        return self._rows.nbytes + (0 if self.outcomes is None else self.outcomes.nbytes)

    def add_users(self, users: int | Iterable[str]) -> Numbers:
        """Add a number of users, or users of these names; their numbers, (k,).

        Memory doubles where it is full, so a single addition may take long, and many take constant time each.

        Raises
        ------
        InputError
            A name is there already, or names are given where users have numbers, or the other way round.
        """
        if isinstance(users, int | np.integer) != (self.names is None):
            own, given = ("numbers", "names") if self.names is None else ("names", "a number")
            raise InputError(f"users must be added as before, by {own}; got {given}")
        if self.names is None:
            if users < 0:  # pyright: ignore[reportOperatorIssue]
                raise InputError(f"users must be at least 0, got {users}")
            new = self._n_users + np.arange(int(users))  # pyright: ignore[reportArgumentType]
        else:
            new = self.names.add(users)  # pyright: ignore[reportArgumentType]
        total = self._n_users + len(new)
        if total > len(self._rows):
            room = max(total, 2 * len(self._rows))
            rows = np.empty((room, self.library.n_types), self.dtype)
            rows[: self._n_users] = self.log_belief
            self._rows = rows
            if self.outcomes is not None:
                self.outcomes.grow(room)
        self._rows[self._n_users : total] = self.log_prior
        self._n_users = total
        return new

    # ---- many users at once ----------------------------------------------------------------------------

    def select(
        self,
        users: Users,
        rule: SelectionRule | str | None = None,
        *,
        available: ArrayLike | None = None,
        episodes_left: float | None = None,
    ) -> Numbers:
        """The number of the policy to run next for each of `users` (k,), (k,).

        Parameters
        ----------
        rule : SelectionRule or str, optional
            By default as for `BayesianPolicyReuse`. "sampling" and "greedy" run compiled. The other rules score
            users block by block; with uncertain models each user by itself, which takes about a millisecond.
        available : (n_policies,) or (k, n_policies) bool, optional
            The policies that can be run now, the same for all or for each of `users`; rules choose as if the
            library had no others.
        """
        rows, rule = self._checked_users(users), self._rule(rule)
        mask = checked_mask(available, len(rows), self.library.n_policies)
        chosen = np.empty(len(rows), np.int64)
        for at, own in blocks(rows):
            belief = self.algorithm.belief(self.log_belief, own)
            chosen[at] = self._chosen(belief, own, rule, None if mask is None else mask[at], episodes_left)
        return chosen

    def select_top(
        self,
        users: Users,
        k: int,
        rule: SelectionRule | str | None = None,
        *,
        available: ArrayLike | None = None,
        episodes_left: float | None = None,
    ) -> Numbers:
        """The `k` policies of the largest scores for each of `users` (n,), (n, k), best first, equals at random.

        Rules that draw rank by a single draw for each user: belief sampling by the mean outcomes on one type.

        Raises
        ------
        InputError
            `k` is below 1 or above the number of policies available to a user.
        """
        rows, rule = self._checked_users(users), self._rule(rule)
        mask = checked_mask(available, len(rows), self.library.n_policies)
        most = self.library.n_policies if mask is None or not len(rows) else int(mask.sum(axis=1).min())
        if not 1 <= k <= most:
            raise InputError(f"k must be 1 to {most}, the number of policies available to every user, got {k}")
        best = np.empty((len(rows), k), np.int64)
        for at, own in blocks(rows):
            belief, may = self.algorithm.belief(self.log_belief, own), None if mask is None else mask[at]
            best[at] = self._chooser.top(belief, own, rule, k, may, self.generator, episodes_left)
        return best

    def update(self, users: Users, policies: ArrayLike, signals: Any) -> Array:
        """Learn from a signal for each of `users`; a user that comes twice is updated in turn.

        Parameters
        ----------
        users : (k,) int or str
        policies : (k,) int
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
        rows, policies = self._checked_users(users), self._checked_policies(policies)
        return self.algorithm.update(self.log_belief, rows, policies, signals, outcomes=self.outcomes)[0]

    def update_and_select(
        self,
        users: Users,
        policies: ArrayLike,
        signals: Any,
        rule: SelectionRule | str | None = None,
        *,
        available: ArrayLike | None = None,
        episodes_left: float | None = None,
    ) -> Numbers:
        """`update`, and the policy to run next, (k,), in one pass."""
        rows, policies, rule = self._checked_users(users), self._checked_policies(policies), self._rule(rule)
        mask = checked_mask(available, len(rows), self.library.n_policies)

        def select(belief: NDArray[Any], at: slice) -> Numbers:
            return self._chosen(belief, rows[at], rule, None if mask is None else mask[at], episodes_left)

        return self.algorithm.update(self.log_belief, rows, policies, signals, select, self.outcomes)[1]

    def belief(self, users: Users) -> Array:
        """β of each of `users`, (k, n_types) float64, rows sum to 1."""
        rows = self._checked_users(users)
        belief = np.exp(self.log_belief[rows].astype(np.float64))
        return belief / belief.sum(axis=1, keepdims=True)

    def probabilities(
        self,
        users: Users,
        rule: SelectionRule | str | None = None,
        *,
        available: ArrayLike | None = None,
        episodes_left: float | None = None,
    ) -> Array:
        """Probability that `select` takes each policy, (k, n_policies); log it beside the selected policy."""
        rows, rule = self._checked_users(users), self._rule(rule)
        mask = checked_mask(available, len(rows), self.library.n_policies)
        if self.outcomes is None and mask is None:
            if type(rule) is Greedy:
                # As `select` compares them: policies that float32 cannot tell apart are equal.
                return self.algorithm.greedy_shares(self.algorithm.belief(self.log_belief, rows))
            return rule.probabilities(self.library, self.belief(rows), episodes_left=episodes_left)
        belief = self.algorithm.belief(self.log_belief, rows)
        return self._chooser.probabilities(belief, rows, rule, mask, episodes_left)

    def reset(self, users: Users) -> None:
        """Set the beliefs about `users` back to the prior, and forget what they have shown."""
        rows = np.unique(self._checked_users(users))
        self.log_belief[rows] = self.log_prior
        if self.outcomes is not None:
            self.outcomes.reset(rows)

    @property
    def _chooser(self) -> UserChoice:
        if self._choice is None:
            self._choice = UserChoice(self.library, self.outcomes, self.dtype, TOLERANCES[self.dtype])
        return self._choice

    def _chosen(
        self, belief: NDArray[Any], rows: Numbers, rule: SelectionRule, mask: Any, episodes_left: float | None
    ) -> Numbers:
        if self.outcomes is None and mask is None:
            return self.algorithm.select_fast(belief, rule, self.generator, episodes_left)
        return self._chooser.select(belief, rows, rule, mask, self.generator, episodes_left)

    def _rule(self, rule: SelectionRule | str | None) -> SelectionRule:
        if rule is None:
            return default_rule(self.library)
        return rule_named(rule) if isinstance(rule, str) else rule

    def _checked_users(self, users: Users) -> Numbers:
        if self.names is None or not are_names(users):
            if self.names is None and are_names(users):
                raise InputError("users must be numbers: these users were made without names")
            return _checked(users, self.n_users, "user")
        named = [users] if isinstance(users, str) else list(users)  # pyright: ignore[reportArgumentType]
        if self.unknown == "add" and (new := self.names.unknown(named)):  # pyright: ignore[reportArgumentType]
            self.add_users(new)
        return self.names.rows(named)  # pyright: ignore[reportArgumentType]

    def _checked_policies(self, policies: ArrayLike) -> Numbers:
        return _checked(policies, self.library.n_policies, "policy")


def _checked(numbers: ArrayLike, n: int, what: str) -> Numbers:
    values = np.atleast_1d(np.ascontiguousarray(numbers))
    if values.ndim != 1 or (values.size and values.dtype.kind not in "iu"):
        raise InputError(f"{what} numbers must be whole numbers (k,), got {values.dtype} of shape {values.shape}")
    if values.size and not 0 <= values.min() <= values.max() < n:
        raise NotFoundError(f"unknown {what} {values.min() if values.min() < 0 else values.max()}; there are {n}")
    return values.astype(np.int64, copy=False)
