"""Beliefs about very many users at once: one row of logs a user, and everything else in blocks that fit the cache.

With float32 rows a user takes 4 bytes a type, and nothing else: 272 bytes for 68 types. Beliefs agree with one
agent a user to 1e-12 in float64. In float32 they agree to 1e-5, and above 1e-6 to a ten-thousandth of
themselves, for types whose belief never fell below e^-100; what is below e^-87 counts as 0 in a choice, but
its logarithm is kept and may rise again. Thesis: §4.2, Alg. 7, with many tasks side by side.
"""

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.beliefs.belief import log_prior
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.reuse.user_kernels import absorb_f4, absorb_f8, draw_types, read_f4
from lifelore.interaction.reuse.user_likelihood import said_by
from lifelore.interaction.selection import BeliefSampling, Greedy, SelectionRule, rule_named, tied_shares
from lifelore.interaction.selection.choice import choose
from lifelore.interaction.selection.tie_kernels import choose_rows

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

BLOCK = 512
"""Users handled at a time: their likelihoods and beliefs stay in the processor's cache."""
TOLERANCES = {"f4": 1e-6, "f8": 1e-9}
"""Scores this close to the best, relative to it, are equal."""


class UserBeliefs:
    """What is believed of each of `n_users` users.

    Parameters
    ----------
    library : PolicyLibrary
        Its model arrays are copied; call `refresh` after it has learnt in place.
    n_users : int
        At least 1.
    dtype : {"f4", "f8"}
    prior : (n_types,) float, optional
        The library's unless given.
    dynamics : TypeDynamics, optional
        Static unless given; every update is then also a step.
    seed : int or numpy generator

    Attributes
    ----------
    log_belief : (n_users, n_types) float32 or float64
        Normalised logs. All the state there is.
    log_prior : (n_types,) of the same
        What a user starts from.

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
        self.dynamics = dynamics or TypeDynamics.static()
        self.generator = stream(seed, "user beliefs") if isinstance(seed, int | np.integer) else seed
        self.log_prior = log_prior(library.prior if prior is None else prior).astype(dtype)
        if self.log_prior.shape != (library.n_types,):
            raise InputError(f"prior must be ({library.n_types},), got {self.log_prior.shape}")
        if self.dynamics.n_types not in (None, library.n_types):
            raise InputError(f"dynamics are for {self.dynamics.n_types} types, the library has {library.n_types}")
        self.log_belief = np.empty((n_users, library.n_types), dtype)
        self.log_belief[:] = self.log_prior
        self.refresh()

    def refresh(self) -> None:
        """Take the library's models anew; beliefs stay."""
        self._said, self._checked_signals = said_by(self.library)
        mean = self.library.performance.mean
        self._mean = np.ascontiguousarray(mean, self.dtype)
        # Best responses to each type, equals included; and their numbers where no type has two.
        self._responses = tied_shares(mean) > 0
        self._best = self._responses.argmax(axis=1) if (self._responses.sum(axis=1) == 1).all() else None

    @property
    def n_users(self) -> int:
        """Number of users."""
        return len(self.log_belief)

    # ---- many users at once ----------------------------------------------------------------------------

    def select(
        self, users: ArrayLike, rule: SelectionRule | str = "sampling", *, episodes_left: float | None = None
    ) -> Numbers:
        """The policy to run next for each of `users` (k,), by number (k,).

        Parameters
        ----------
        rule : SelectionRule or str
            "sampling" and "greedy" run compiled; all other rules in blocks.
        """
        users, rule = self._checked_users(users), _rule(rule)
        chosen = np.empty(len(users), np.int64)
        for at, own in _blocks(users):
            chosen[at] = self._decided(self._read(own), rule, episodes_left)
        return chosen

    def update(self, users: ArrayLike, policies: ArrayLike, signals: Any) -> Array:
        """Learn from one signal for each of `users`; a user may come twice, and is then updated in turn.

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
            A signal is none of the model's, or the model gave NaN. Blocks before that one are updated.
        """
        return self._updated(users, policies, signals, None, None)[0]

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
        return self._updated(users, policies, signals, _rule(rule), episodes_left)[1]

    def belief(self, users: ArrayLike) -> Array:
        """β of each of `users`, (k, n_types) float64, rows sum to 1."""
        users = self._checked_users(users)
        belief = np.exp(self.log_belief[users].astype(np.float64))
        return belief / belief.sum(axis=1, keepdims=True)

    def probabilities(
        self, users: ArrayLike, rule: SelectionRule | str = "sampling", *, episodes_left: float | None = None
    ) -> Array:
        """How likely `select` is to take each policy, (k, n_policies); to be logged beside what was selected."""
        users, rule = self._checked_users(users), _rule(rule)
        if type(rule) is Greedy:
            # As `select` has them: what float32 cannot tell apart is equal, and may be selected.
            return tied_shares(self._read(users) @ self._mean, TOLERANCES[self.dtype])
        return rule.probabilities(self.library, self.belief(users), episodes_left=episodes_left)

    def reset(self, users: ArrayLike) -> None:
        """Forget all that is believed of `users`: they start from the prior."""
        self.log_belief[self._checked_users(users)] = self.log_prior

    # ---- blocks ----------------------------------------------------------------------------------------

    def _updated(
        self,
        users: ArrayLike,
        policies: ArrayLike,
        signals: Any,
        rule: SelectionRule | None,
        episodes_left: float | None,
    ) -> tuple[Array, Numbers]:
        users, policies = self._checked_users(users), self._checked_policies(policies)
        signals = self._checked_signals(signals)
        if not len(users) == len(policies) == len(signals):
            raise InputError(
                f"users, policies and signals must be equally many, got {len(users)}, {len(policies)} and "
                f"{len(signals)}"
            )
        if self.dynamics.kind != "static" and len(np.unique(users)) < len(users):
            raise InputError("users must be distinct where types change between episodes; update them in turn")
        evidence, chosen = np.empty(len(users)), np.empty(len(users) if rule else 0, np.int64)
        size = min(BLOCK, len(users))
        said = np.empty((size, self.library.n_types))
        linear = np.empty((size, self.library.n_types), self.dtype)
        absorb = absorb_f4 if self.dtype == "f4" else absorb_f8
        for at, own in _blocks(users):
            here = len(own)
            self._said(policies[at], signals[at], said[:here])
            absorb(self.log_belief, own, said[:here], linear[:here], evidence[at])
            if self.dynamics.kind != "static":
                self.log_belief[own] = self.dynamics.step(self.log_belief[own].astype(np.float64))
                linear[:here] = self._read(own)
            if rule is not None:
                chosen[at] = self._decided(linear[:here], rule, episodes_left)
        return evidence, chosen

    def _read(self, users: Numbers) -> NDArray[Any]:
        if self.dtype == "f8":
            return np.exp(self.log_belief[users])
        linear = np.empty((len(users), self.library.n_types), np.float32)
        read_f4(self.log_belief, users, linear)
        return linear

    def _decided(self, linear: NDArray[Any], rule: SelectionRule, episodes_left: float | None) -> Numbers:
        if type(rule) is BeliefSampling:
            return self._sampled(linear)
        if type(rule) is Greedy:
            return self._best_of(linear @ self._mean)
        belief = linear.astype(np.float64)
        belief /= belief.sum(axis=1, keepdims=True)
        scores = rule.scores(self.library, belief, episodes_left=episodes_left, generator=self.generator)
        return choose(scores, self.generator)

    def _sampled(self, linear: NDArray[Any]) -> Numbers:
        drawn = np.empty(len(linear), np.int64)
        draw_types(linear, self.generator.random(len(linear)), drawn)
        if self._best is not None:
            return self._best[drawn]
        return self._best_of(self._responses[drawn].astype(self.dtype))

    def _best_of(self, scores: NDArray[Any]) -> Numbers:
        chosen = np.empty(len(scores), np.int64)
        choose_rows(scores, self.generator.random(len(scores)), TOLERANCES[self.dtype], chosen)
        return chosen

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


def _blocks(users: Numbers) -> Iterator[tuple[slice, Numbers]]:
    for start in range(0, len(users), BLOCK):
        at = slice(start, min(start + BLOCK, len(users)))
        yield at, users[at]
