"""Choices for many users: by what each user has shown, and among the policies available to each.

Belief sampling draws a type and takes its best response, greedy selection takes the largest expected outcome. Both
run compiled and go by the mean outcomes that are expected given the user's own outcomes; of policies never tried,
by the library's. The other rules score each user by a library of the user's own, or all users that have the same
available policies at once where models are plug-in.
"""

from collections.abc import Iterator
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.task_library import TaskLibrary
from lifelore.interaction.reuse.outcome_laws import Array, Numbers, Tried
from lifelore.interaction.reuse.user_outcomes import UserOutcomes
from lifelore.interaction.selection import BeliefSampling, Greedy, SelectionRule
from lifelore.interaction.selection.choice import tied_shares
from lifelore.interaction.selection.ties import TOLERANCE

Mask = NDArray[np.bool_]


class UserChoice:
    """Choices for users of one library.

    Parameters
    ----------
    library : PolicyLibrary
    outcomes : UserOutcomes or None
        What the users have shown; None where models are plug-in.
    dtype : {"f4", "f8"}
        Precision of the beliefs.
    tolerance : float
        Greedy scores this close to the best, relative to it, are equal.
    """

    def __init__(
        self, library: PolicyLibrary, outcomes: UserOutcomes | None, dtype: str, tolerance: float
    ) -> None:
        self.library, self.outcomes, self.tolerance = library, outcomes, tolerance
        mean = library.performance.mean if outcomes is None else outcomes.law.mean
        doubt = np.zeros_like(mean) if outcomes is None else outcomes.law.doubt
        self._mean, self._doubt = np.array(mean, order="C"), np.array(doubt, order="C")
        self._order = np.argsort(-self._mean, axis=1, kind="stable").astype(np.int32)
        self._weights = np.array(mean, dtype, order="C")
        self._turned = np.ascontiguousarray(self._mean.T), np.ascontiguousarray(self._doubt.T)
        self._every = np.ones((1, self._mean.shape[1]), bool)

    def select(
        self,
        belief: NDArray[Any],
        users: Numbers,
        rule: SelectionRule,
        mask: Mask | None,
        generator: np.random.Generator,
        episodes_left: float | None = None,
    ) -> Numbers:
        """The policy to run next for each of `users`, (k,), equals at random.

        Parameters
        ----------
        belief : (k, n_types) float
        users : (k,) int64
        mask : (k, n_policies) bool, optional
            The policies available to each user.
        """
        if type(rule) is BeliefSampling:
            chosen = np.empty(len(users), np.int64)
            drawn, uniforms = self._drawn(belief, generator), generator.random(len(users))
            may = self._every if mask is None else mask
            _kernels().respond(
                drawn, uniforms, *self._tried(users), may, self._mean, self._doubt, self._order, TOLERANCE, chosen
            )
            return chosen
        return self.top(belief, users, rule, 1, mask, generator, episodes_left)[:, 0]

    def top(
        self,
        belief: NDArray[Any],
        users: Numbers,
        rule: SelectionRule,
        k: int,
        mask: Mask | None,
        generator: np.random.Generator,
        episodes_left: float | None = None,
    ) -> Numbers:
        """The `k` policies of the largest scores for each of `users`, (n, k), best first, equals at random."""
        scores = self._scores(belief, users, rule, mask, generator, episodes_left)
        if mask is not None:
            scores[~mask] = -np.inf
        tolerance = self.tolerance if type(rule) is Greedy else TOLERANCE
        best, every = np.empty((k, len(users)), np.int64), np.arange(len(users))
        for chosen in best:
            _tie_kernels().choose_rows(scores, generator.random(len(users)), tolerance, chosen)
            scores[every, chosen] = -np.inf
        return best.T

    def probabilities(
        self,
        belief: Array,
        users: Numbers,
        rule: SelectionRule,
        mask: Mask | None,
        episodes_left: float | None = None,
    ) -> Array:
        """How likely `select` takes each policy, (k, n_policies); rows sum to 1."""
        if type(rule) is Greedy:
            scores = self._scores(belief, users, rule, mask, None)
            if mask is not None:
                scores[~mask] = -np.inf
            return tied_shares(scores, self.tolerance)
        found = np.zeros((len(users), self.library.n_policies))
        for rows, library, policies in self._libraries(users, mask):
            probs = rule.probabilities(library, _normalised(belief[rows]), episodes_left=episodes_left)
            found[np.ix_(rows, policies)] = probs
        return found

    def _scores(
        self,
        belief: NDArray[Any],
        users: Numbers,
        rule: SelectionRule,
        mask: Mask | None,
        generator: np.random.Generator | None,
        episodes_left: float | None = None,
    ) -> NDArray[Any]:
        """The rule's scores, (k, n_policies); what they are where a policy is not available has no meaning."""
        if type(rule) is Greedy:
            scores, tried = belief @ self._weights, self._tried(users)
            if len(tried.policies):
                _kernels().correct_scores(belief, *tried, *self._turned, scores)
            return scores
        if type(rule) is BeliefSampling and generator is not None:
            return self._on_types(self._drawn(belief, generator), users)
        scores = np.full((len(users), self.library.n_policies), -np.inf)
        for rows, library, policies in self._libraries(users, mask):
            found = rule.scores(
                library, _normalised(belief[rows]), episodes_left=episodes_left, generator=generator
            )
            scores[np.ix_(rows, policies)] = found
        return scores

    def _on_types(self, types: Numbers, users: Numbers) -> Array:
        """The mean outcomes expected of each user if it is of the type in `types` (k,), (k, n_policies)."""
        tried, means = self._tried(users), self._mean[types]
        row = np.repeat(np.arange(len(users)), np.diff(tried.starts))
        pull = tried.counts * self._doubt[types[row], tried.policies]
        before = means[row, tried.policies]
        means[row, tried.policies] = before + pull / (1 + pull) * (tried.averages - before)
        return means

    def _drawn(self, belief: NDArray[Any], generator: np.random.Generator) -> Numbers:
        drawn = np.empty(len(belief), np.int64)
        _draw_kernels().draw_types(belief, generator.random(len(belief)), drawn)
        return drawn

    def _tried(self, users: Numbers) -> Tried:
        if self.outcomes is None:
            return Tried(np.zeros(len(users) + 1, np.int64), np.empty(0, np.int64), np.empty(0), np.empty(0))
        return self.outcomes.tried(users)

    def _libraries(self, users: Numbers, mask: Mask | None) -> Iterator[tuple[Numbers, PolicyLibrary, Numbers]]:
        """The users that share a library by their places, that library, and its policies' numbers in the whole."""
        kinds, kind = np.ones((1, self.library.n_policies), bool), np.zeros(len(users), np.int64)
        if mask is not None:
            kinds, kind = np.unique(mask, axis=0, return_inverse=True)
        for number, among in enumerate(kinds):
            rows, policies = np.flatnonzero(kind.ravel() == number), np.flatnonzero(among)
            part = self.library if among.all() else self.library.take(policies=policies.tolist())
            if self.outcomes is None:
                yield rows, part, policies
                continue
            for row in rows:
                yield rows[rows == row], self._of_user(part, int(users[row]), policies), policies

    def _of_user(self, part: PolicyLibrary, user: int, policies: Numbers) -> TaskLibrary:
        """The library's `policies`, which are `part`, given what a user has shown."""
        assert self.outcomes is not None
        keys, numbers = self.outcomes.slots(user)
        width = self.outcomes.law.n_keys // self.library.n_policies
        places = np.full(self.library.n_policies, -1)
        places[policies] = np.arange(len(policies))
        place = places[keys // width]
        here = place >= 0
        keys = place[here] * width + keys[here] % width
        return TaskLibrary(part, self.outcomes.law.task(part, keys, numbers[here]))


def checked_mask(available: Any, n_users: int, n_policies: int) -> Mask | None:
    """`available` as (n_users, n_policies) bool; None stays None.

    Raises
    ------
    InputError
        It is no bool array (n_policies,) or (n_users, n_policies), or a user has no available policy.
    """
    if available is None:
        return None
    mask = np.asarray(available)
    if mask.dtype != bool or mask.shape not in ((n_policies,), (n_users, n_policies)):
        raise InputError(
            f"available must be bool ({n_policies},), or ({n_users}, {n_policies}) with a row for each of users, "
            f"got {mask.dtype} {mask.shape}"
        )
    if not mask.any(axis=-1).all():
        raise InputError("available must have a policy for every user; leave out users that can get none")
    return np.broadcast_to(mask, (n_users, n_policies))


def _normalised(belief: NDArray[Any]) -> Array:
    belief = belief.astype(np.float64)
    return belief / belief.sum(axis=1, keepdims=True)


@cache
def _kernels() -> ModuleType:
    # Modules of kernels are imported at their first use: the import starts Numba.
    from lifelore.interaction.reuse import user_choice_kernels

    return user_choice_kernels


@cache
def _draw_kernels() -> ModuleType:
    from lifelore.interaction.reuse import user_kernels

    return user_kernels


@cache
def _tie_kernels() -> ModuleType:
    from lifelore.interaction.selection import tie_kernels

    return tie_kernels
