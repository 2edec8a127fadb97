"""Beliefs about very many users, numbered or named: rows of Algorithm 7, updated and read in blocks.

With float32 rows a user takes 24 bytes a type, 4 where the dynamics are given, and with models learnt from a
finite number of runs 24 bytes more a policy (4 a cell, where outcomes are counted). float32 rows agree with
float64 rows to 1e-5. A `BayesianPolicyReuse` for each user has the same numbers to 1e-12, where both know the same
spread. Thesis: §4.2, Alg. 7, with many tasks side by side.
"""

from collections.abc import Iterable, Iterator, Sequence
from math import prod
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Models, law_of
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse.reuse_algorithm import Dynamics, Precision, ReuseAlgorithm
from lifelore.interaction.reuse.user_names import UserNames, are_names
from lifelore.interaction.selection import SelectionRule, rule_of
from lifelore.interaction.selection.choice import available_mask, best_policies

Array = NDArray[Any]
Numbers = NDArray[np.int64]
Users = ArrayLike | Sequence[str]
"""Numbers of users, or their names where the users have names."""

BLOCK = 1 << 19
"""Numbers that the users of a block take: more would leave the processor's cache, fewer take more calls."""
LARGEST_BLOCK = 1 << 21
"""Numbers of the largest temporary arrays, which have a row for each user, type, policy and signal."""


class UserBeliefs:
    """Beliefs about many users.

    Parameters
    ----------
    library : PolicyLibrary
        Not copied. Uncertain models are read once, at the start.
    users : int or iterable of str
        Number of users, at least 1; they are then numbered from 0. Or their names, none to begin with allowed.
    dtype : {"f4", "f8"}
    prior : (n_types,) float, optional
        The library's by default.
    dynamics : TypeDynamics, optional
        By default `TypeDynamics.learnt()`, a belief over hazards; `TypeDynamics.static()` as in the thesis.
        Each `update` is also the step between two episodes.
    models : {"uncertain", "plug-in"}
        As in `BayesianPolicyReuse`.
    spread : float, optional
        ρ, by how much the mean outcome of a pair differs between users of a type, as a share of the variance of an
        outcome; ≥ 0. By default the mean of the spreads that the library holds possible. A `BayesianPolicyReuse`
        holds a belief over these.
    unknown : {"error", "add"}
        Whether a new name in `select` or `update` is an error, or adds a user. Numbers never add users.
    seed : int or numpy generator

    Attributes
    ----------
    n_users : int

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
        dtype: Precision = "f4",
        *,
        prior: ArrayLike | None = None,
        dynamics: Dynamics | None = None,
        models: Models = "uncertain",
        spread: float | None = None,
        unknown: Literal["error", "add"] = "error",
        seed: int | np.random.Generator = 0,
    ) -> None:
        self.names = None if isinstance(users, int | np.integer) else UserNames(users)
        n_users = int(users) if self.names is None else len(self.names)  # pyright: ignore[reportArgumentType]
        if self.names is None and n_users < 1:
            raise InputError(f"users must be at least 1, or names, got {n_users}")
        if unknown not in ("error", "add"):
            raise InputError(f"unknown must be 'error' or 'add', got {unknown!r}")
        if spread is not None and not 0 <= spread < np.inf:
            raise InputError(f"spread must be at least 0 and finite, got {spread}")
        self.library, self.unknown = library, unknown
        known = law_of(library.signal, library.n_types, models).spread.mean if spread is None else spread
        self.algorithm = ReuseAlgorithm(
            library,
            n_users,
            prior=prior,
            dynamics=dynamics,
            models=models,
            spread=Spread.known(known),
            dtype=dtype,
        )
        self.generator = stream(seed, "user beliefs")
        self.n_users = n_users

    @property
    def log_belief(self) -> Array:
        """Normalised logs of the beliefs, (n_users, n_types) float32 or float64; not a copy."""
        return self.algorithm.log_belief[: self.n_users]

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
            new = self.n_users + np.arange(int(users))  # pyright: ignore[reportArgumentType]
        else:
            new = self.names.add(users)  # pyright: ignore[reportArgumentType]
        total = self.n_users + len(new)
        if total > self.algorithm.n_users:
            self.algorithm.grow(max(total, 2 * self.algorithm.n_users))
        self.n_users = total
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
            By default as for `BayesianPolicyReuse`.
        available : (n_policies,) or (k, n_policies) bool, optional
            The policies that can be run now, the same for all or for each of `users`; rules choose as if the
            library had no others.
        """
        rows, rule = self._checked_users(users), rule_of(rule, self.library)
        mask, chosen = self._mask(available, len(rows)), np.empty(len(rows), np.int64)
        for at in blocks(len(rows), self.algorithm, rule):
            chosen[at] = self.algorithm.select(rows[at], rule, self.generator, _part(mask, at), episodes_left)[0]
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
        rows, rule = self._checked_users(users), rule_of(rule, self.library)
        mask = self._mask(available, len(rows))
        n_policies = self.library.n_policies
        most = n_policies if mask is None else int(mask.sum(axis=1).min(initial=n_policies))
        if not 1 <= k <= most:
            raise InputError(f"k must be 1 to {most}, the number of policies available to every user, got {k}")
        best = np.empty((len(rows), k), np.int64)
        for at in blocks(len(rows), self.algorithm, rule):
            scores = self.algorithm.scores(rows[at], rule, self.generator, _part(mask, at), episodes_left)
            best[at] = best_policies(scores, k, self.generator)
        return best

    def update(self, users: Users, policies: ArrayLike, signals: Any) -> Array:
        """Learn from a signal for each of `users`; a user that comes twice is updated in turn.

        Parameters
        ----------
        users : (k,) int or str
        policies : (k,) int
        signals : sequence of length k

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
        rows, policies, signals = self._checked_signals(users, policies, signals)
        log_evidence = np.empty(len(rows))
        for at in self._distinct_blocks(rows):
            log_evidence[at] = self.algorithm.update(rows[at], policies[at], signals[at]).log_evidence
        return log_evidence

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
        rows, policies, signals = self._checked_signals(users, policies, signals)
        rule = rule_of(rule, self.library)
        mask, chosen = self._mask(available, len(rows)), np.empty(len(rows), np.int64)
        for at in self._distinct_blocks(rows, rule):
            self.algorithm.update(rows[at], policies[at], signals[at])
            chosen[at] = self.algorithm.select(rows[at], rule, self.generator, _part(mask, at), episodes_left)[0]
        return chosen

    def belief(self, users: Users) -> Array:
        """β of each of `users`, (k, n_types) float64, rows sum to 1."""
        belief = self.algorithm.belief(self._checked_users(users)).astype(np.float64)
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
        rows, rule = self._checked_users(users), rule_of(rule, self.library)
        mask, found = self._mask(available, len(rows)), np.empty((len(rows), self.library.n_policies))
        for at in blocks(len(rows), self.algorithm, rule):
            found[at] = self.algorithm.propensities(rows[at], rule, _part(mask, at), episodes_left)
        return found

    def reset(self, users: Users) -> None:
        """Set the beliefs about `users` back to the prior, and forget what they have shown."""
        self.algorithm.reset(np.unique(self._checked_users(users)))

    def _distinct_blocks(self, rows: Numbers, rule: SelectionRule | None = None) -> Iterator[slice]:
        """`blocks` in none of which a user comes twice: a second signal needs what the first has changed."""
        for at in blocks(len(rows), self.algorithm, rule):
            start, inside, ordered = at.start, set[int](), np.sort(rows[at])
            if (ordered[1:] != ordered[:-1]).all():
                yield at
                continue
            for place, user in enumerate(rows[at].tolist(), start):
                if user in inside:
                    yield slice(start, place)
                    start, inside = place, set()
                inside.add(user)
            yield slice(start, at.stop)

    def _mask(self, available: ArrayLike | None, n_rows: int) -> NDArray[np.bool_] | None:
        """`available` as (n_rows, n_policies); None where all policies are."""
        if available is None:
            return None
        mask = available_mask(available, self.library.policies, n_rows)  # pyright: ignore[reportArgumentType]
        return np.broadcast_to(mask, (n_rows, self.library.n_policies))

    def _checked_signals(self, users: Users, policies: ArrayLike, signals: Any) -> tuple[Numbers, Numbers, Any]:
        """Rows of users, numbers of policies and signals, equally many."""
        rows, policies = self._checked_users(users), _checked(policies, self.library.n_policies, "policy")
        if not len(rows) == len(policies) == len(signals):
            raise InputError(
                f"users, policies and signals must be equally many, got {len(rows)}, {len(policies)} and "
                f"{len(signals)}"
            )
        return rows, policies, signals if isinstance(signals, np.ndarray) else list(signals)

    def _checked_users(self, users: Users) -> Numbers:
        if self.names is None or not are_names(users):
            if self.names is None and are_names(users):
                raise InputError("users must be numbers: these users were made without names")
            return _checked(users, self.n_users, "user")
        named = [users] if isinstance(users, str) else list(users)  # pyright: ignore[reportArgumentType]
        if self.unknown == "add" and (new := self.names.unknown(named)):  # pyright: ignore[reportArgumentType]
            self.add_users(new)
        return self.names.rows(named)  # pyright: ignore[reportArgumentType]


def blocks(n_users: int, algorithm: ReuseAlgorithm, rule: SelectionRule | None = None) -> Iterator[slice]:
    """Blocks of users whose numbers fit the cache, and whose scores by `rule` fit the memory."""
    library = algorithm.library
    arrays = (algorithm.log_belief, *algorithm.changes.arrays(), *algorithm.signals.arrays())
    size = BLOCK // (library.n_policies + sum(prod(array.shape[1:]) for array in arrays))
    if rule is not None and not getattr(rule, "by_means", False):
        size = min(size, LARGEST_BLOCK // (library.n_types * library.n_policies * getattr(rule, "n_bins", 1)))
    size = max(size, 1)
    for start in range(0, n_users, size):
        yield slice(start, min(start + size, n_users))


def _part(mask: NDArray[np.bool_] | None, at: slice) -> NDArray[np.bool_] | None:
    return None if mask is None else mask[at]


def _checked(numbers: ArrayLike, n: int, what: str) -> Numbers:
    values = np.atleast_1d(np.ascontiguousarray(numbers))
    if values.ndim != 1 or (values.size and values.dtype.kind not in "iu"):
        raise InputError(f"{what} numbers must be whole numbers (k,), got {values.dtype} of shape {values.shape}")
    if values.size and not 0 <= values.min() <= values.max() < n:
        raise NotFoundError(f"unknown {what} {values.min() if values.min() < 0 else values.max()}; there are {n}")
    return values.astype(np.int64, copy=False)
