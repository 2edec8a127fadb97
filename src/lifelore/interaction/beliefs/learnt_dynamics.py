"""Dynamics of types that are learnt: a belief over ways in which types change, for each user.

    static, hazard    a new type from the prior with probability h an episode, h of `HAZARDS`; 0 is static
    by type           P(next type | type), a matrix
    by outcome        P(next type | how the episode ended), and P(next type | that, and the type)

Rows of matrices have Dirichlet laws, whose counts are the transitions that the belief has seen, and whose prior is
how often each type was next in any row. With the belief p(d, τ) over ways d and types τ, a signal with likelihoods
L(τ) and the end of an episode are

    p(d, τ) ∝ L(τ) p(d, τ)        so that p(d | τ) stays: a signal changes the belief over types alone
    p(d, τ') ← Σ_τ p(d, τ) A_d(τ' | τ, outcome)

The belief over hazards is exact. Counts are expectations given the signals until the end of the next episode.
Switching opponents: Hernandez-Leal and others (2016, BPR+); patterns: Chen and others (2020, Bayes-OKR).
"""

import json
from collections.abc import Hashable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.law import of_users

Array = NDArray[Any]
By = Literal["time", "type", "outcome"]

HAZARDS = np.array([0.0, 0.001, 0.01, 0.03, 0.1])
"""Probabilities per episode of a new type; 0 is a static type."""
HAZARD_WEIGHTS = np.array([0.5, 0.2, 0.1, 0.1, 0.1])
"""Their probabilities at the start, relative to one another."""
WEIGHT_OF_TABLES = 0.25
"""Probability at the start that types change by a matrix, where one may be learnt."""
CONCENTRATION = 1.0
"""Number of transitions that the types' popularity counts as in a row, and the prior in the popularity."""
MOST_CATEGORIES = 64
"""Largest number of ways in which an episode may end."""
PARTS = ("counts", "before", "category")
"""Arrays of a table."""
LEAST = 1e-30
"""Added to probabilities that are divided by: types of probability 0 then have this one."""


class LearntDynamics:
    """Settings of dynamics that learn, and where a life has learnt, what it starts from.

    Parameters
    ----------
    by : {"time", "type", "outcome"}
        What the next type may depend on: nothing but the last type, which lasts or not; a pattern of types; how
        the last episode ended too, see `TypeDynamics.learnt`.
    learnt : mapping of str to array, optional
        A user's `LearntRows.learnt`, to go on from.
    categories : sequence, optional
        The ways in which episodes ended, in the order of `learnt`.

    Raises
    ------
    InputError
        `by` is none of the three.
    """

    kind, moves, rate, law = "learnt", True, 0.0, None

    def __init__(
        self, by: By = "time", learnt: Mapping[str, Array] | None = None, categories: Sequence[Hashable] = ()
    ) -> None:
        if by not in ("time", "type", "outcome"):
            raise InputError(f"by must be 'time', 'type' or 'outcome', got {by!r}")
        self.by: By = by
        self.start, self.categories = dict(learnt or {}), list(categories)

    @property
    def n_types(self) -> int | None:
        """Number of types of what was learnt; None before."""
        return self.start["by_type"].shape[-1] if "by_type" in self.start else None

    def rows(self, n_users: int, prior: Array, dtype: Any) -> "LearntRows":
        """What is to be learnt of each of `n_users` users, whose new types are drawn from `prior` (n_types,)."""
        return LearntRows(self, n_users, prior, dtype)


class TransitionCounts:
    """Counts of the next type of each user given the last type, the last outcome, both or neither.

    Parameters
    ----------
    n_rows : int
        The number of types, or 1 where the next type does not depend on the last.
    prior : (n_types,) float
        Of the next type, where nothing was counted.
    """

    def __init__(self, n_users: int, n_rows: int, by_outcome: bool, prior: Array, dtype: Any) -> None:
        self.by_outcome, self._prior, n_types = by_outcome, CONCENTRATION * prior.astype(dtype) + LEAST, len(prior)
        self.counts = np.zeros((n_users, 1, n_rows, n_types), dtype)
        # Belief over types before the last step, and the category it was made by; -1 before the first step.
        self.before = np.zeros((n_users, n_rows), dtype)
        self.category = np.full(n_users, -1)

    def chances(self, users: Any) -> Array:
        """P(next type | row) in the category of the last step, (..., n_rows, n_types)."""
        popular = self.counts[users].sum(axis=(-3, -2)) + self._prior
        popular *= CONCENTRATION / popular.sum(axis=-1, keepdims=True)
        counts = self.counts[users, self.category[users]] + popular[..., None, :]
        return counts / counts.sum(axis=-1, keepdims=True)

    def learn(self, users: Any, after: Array) -> None:
        """Count the last step of `users`, whose belief now is `after` (..., n_types)."""
        joint = self.before[users][..., None] * self.chances(users)
        share = after / np.maximum(joint.sum(axis=-2), LEAST)
        stepped = self.category[users] >= 0
        self.counts[users, self.category[users]] += joint * (share * stepped[..., None])[..., None, :]

    def step(self, users: Any, belief: Array, category: Any) -> tuple[Array, Array]:
        """The belief (..., n_types) after a step, and of that the part whose type stays."""
        rows = self.counts.shape[2]
        self.before[users] = belief if rows > 1 else belief.sum(axis=-1, keepdims=True)
        self.category[users] = category if self.by_outcome else 0
        chances = self.chances(users)
        stays = np.diagonal(chances, axis1=-2, axis2=-1) if rows > 1 else chances[..., 0, :]
        return (self.before[users][..., None] * chances).sum(axis=-2), belief * stays

    def fit(self, n_categories: int) -> None:
        """Make room for more ways in which episodes end."""
        n_users, n, *shape = self.counts.shape
        if self.by_outcome and n_categories > n:
            more = np.zeros((n_users, n_categories - n, *shape), self.counts.dtype)
            self.counts = np.concatenate([self.counts, more], axis=1)


class LearntRows:
    """The belief over ways in which the types of users change, a row for each user.

    Attributes
    ----------
    shares : (n_users, n_ways, n_types) float
        P(way | type), columns sum to 1: hazards, then the matrices.
    moved : (n_users, n_types) float
        P(the type has just changed by a matrix | it is now this type), after the last step.
    tables : dict of str to TransitionCounts
    """

    def __init__(self, settings: LearntDynamics, n_users: int, prior: Array, dtype: Any) -> None:
        self.settings, self._prior, n_types = settings, prior.astype(dtype), len(prior)
        made = {"by_type": (n_types, False), "by_outcome": (1, True), "by_both": (n_types, True)}
        wanted = {"time": (), "type": ("by_type",), "outcome": tuple(made)}[settings.by]
        self.tables = {name: TransitionCounts(n_users, *made[name], prior, dtype) for name in wanted}
        weights = HAZARD_WEIGHTS / HAZARD_WEIGHTS.sum()
        if wanted:
            of_tables = np.full(len(wanted), WEIGHT_OF_TABLES / len(wanted))
            weights = np.concatenate([(1 - WEIGHT_OF_TABLES) * weights, of_tables])
        rates = np.concatenate([HAZARDS, np.zeros(len(wanted))])
        stay = np.concatenate([1 - HAZARDS, np.zeros(len(wanted))])
        # A row for each type: products of equal shapes are faster.
        self._rates, self._stay = rates.astype(dtype), np.repeat(stay[:, None], n_types, axis=1).astype(dtype)
        self._anew = self._rates[:, None] * self._prior + LEAST
        # h / (1 - h) and h² / (1 - h) of each way.
        self._drawn_after = (rates / np.maximum(stay, LEAST)).astype(dtype)
        self._drawn_twice = (rates * rates / np.maximum(stay, LEAST)).astype(dtype)
        self._ones, self._ways = np.ones(n_types, dtype), np.ones((len(rates), len(rates)), dtype)
        self._categories: dict[Hashable, int] = {None: 0}
        for category in settings.categories:
            self._categories.setdefault(category, len(self._categories))
        self._fit()
        weights = settings.start.get("weights", weights)
        self._first = np.repeat(weights[:, None], n_types, axis=1).astype(dtype)
        self.shares = np.empty((n_users, len(weights), n_types), dtype)
        self.moved = np.zeros((n_users, n_types if wanted else 0), dtype)
        self.reset(slice(None))

    # ---- the belief --------------------------------------------------------------------------------------

    def step(self, log_belief: Array, users: Any, outcome: Any = None) -> Array:
        """The log belief of `users` (..., n_types) before the next episode.

        Parameters
        ----------
        outcome : hashable, or for many users a sequence of these, optional
            How the episode ended, such as ``"won"``.
        """
        joint = self._joint(users, log_belief)
        # Products with ones: sums over short axes are slow; not with `@`, see `log_sum`.
        weights = np.vecdot(joint, self._ones)
        after = weights[..., None] * self._anew
        after += joint * self._stay
        moved: Any = 0.0
        if self.tables:
            category = self._category(outcome)
            for way, table in enumerate(self.tables.values(), len(HAZARDS)):
                table.learn(users, joint[..., way, :] / np.maximum(weights[..., way, None], LEAST))
                after[..., way, :], stayed = table.step(users, joint[..., way, :], category)
                moved = moved + after[..., way, :] - stayed
        totals = self._ways @ after
        after /= totals
        self.shares[users] = after
        total = totals[..., 0, :]
        if self.tables:
            self.moved[users] = moved / total
        return np.log(total)

    def changed_share(self, log_belief: Array, users: Any) -> Array:
        """P(the type was another | it is now this type) after a `step`, (..., n_types)."""
        joint = self._joint(users, log_belief)
        weights = np.vecdot(joint, self._ones)
        # Of the types drawn anew with probability h, those that were the same type before have not changed. The
        # step had made joint = (1 - h) before + h weights G; the sum of h (weights - before) is taken in parts.
        anew, twice = np.vecdot(weights, self._rates), np.vecdot(weights, self._drawn_twice)
        others = anew[..., None] + twice[..., None] * self._prior
        others = (others - self._drawn_after @ joint) * self._prior
        share = others / np.maximum(np.exp(log_belief), LEAST)
        return np.minimum(np.maximum(share + self.moved[users] if self.tables else share, 0.0), 1.0)

    def _joint(self, users: Any, log_belief: Array) -> Array:
        """p(way, type), (..., n_ways, n_types)."""
        return np.exp(log_belief)[..., None, :] * of_users(self.shares, users)

    def learnt(self, user: int, log_belief: Array) -> LearntDynamics:
        """Settings that start from what a user has shown."""
        learnt = {name: table.counts[user].copy() for name, table in self.tables.items()}
        weights = np.vecdot(self._joint(user, log_belief), self._ones)
        return LearntDynamics(self.settings.by, {"weights": weights, **learnt}, list(self._categories)[1:])

    # ---- rows ----------------------------------------------------------------------------------------------

    def reset(self, users: Any) -> None:
        """Set `users` back to what the settings start from."""
        self.shares[users], self.moved[users] = self._first, 0
        for name, table in self.tables.items():
            table.counts[users], table.before[users], table.category[users] = 0, 0, -1
            if (start := self.settings.start.get(name)) is not None:
                table.counts[users, : len(start)] = start

    def grow(self, n_users: int) -> None:
        """Make room for `n_users` users."""
        old = len(self.shares)
        for owner, name in self._arrays():
            array = getattr(owner, name)
            more = np.zeros((n_users - old, *array.shape[1:]), array.dtype)
            setattr(owner, name, np.concatenate([array, more]))
        self.reset(slice(old, n_users))

    def state(self, user: int) -> dict[str, Array]:
        """What a user has shown, as small arrays."""
        found = {"shares": self.shares[user].copy()}
        for name, table in self.tables.items():
            found |= {f"{name}.{part}": np.array(getattr(table, part)[user]) for part in PARTS}
        if self.tables:
            found["moved"] = self.moved[user].copy()
            found["categories"] = np.frombuffer(json.dumps(list(self._categories)).encode(), np.uint8)
        return found

    def restore(self, user: int, state: Mapping[str, Array]) -> None:
        """Take over a `state`; InputError where it is of other dynamics, nothing where it is empty."""
        self.reset(user)
        if not state:
            return
        try:
            self.shares[user] = state["shares"]
            if not self.tables:
                return
            self.moved[user] = state["moved"]
            # Rows may know the ways in which episodes end in another order.
            known = self._category(json.loads(np.asarray(state["categories"]).tobytes()))
            for name, table in self.tables.items():
                counts, last = np.asarray(state[f"{name}.counts"]), int(state[f"{name}.category"])
                table.counts[user, known if table.by_outcome else [0]] = counts
                table.before[user] = state[f"{name}.before"]
                table.category[user] = known[last] if table.by_outcome and last >= 0 else last
        except (KeyError, ValueError, TypeError) as error:
            raise InputError(f"the dynamics' state is not of these dynamics: {error}") from None

    def arrays(self) -> list[Array]:
        """Every array with a row for each user."""
        return [getattr(owner, name) for owner, name in self._arrays()]

    def _arrays(self) -> list[tuple[Any, str]]:
        """Every array with a row for each user: its owner and its name."""
        of_tables = [(table, part) for table in self.tables.values() for part in PARTS]
        return [(self, "shares"), (self, "moved"), *of_tables]

    def _category(self, outcome: Any) -> Any:
        if isinstance(outcome, list | np.ndarray):
            found = np.array([self._number(each) for each in outcome])
        else:
            found = self._number(outcome)
        self._fit()
        return found

    def _number(self, outcome: Any) -> int:
        outcome = outcome.item() if isinstance(outcome, np.generic) else outcome
        if not isinstance(outcome, str | float | int | None) or outcome != outcome:
            raise InputError(f"outcome must be a word, a number or None, got {outcome!r:.80}")
        if outcome not in self._categories and len(self._categories) > MOST_CATEGORIES:
            raise InputError(
                f"episodes may end in at most {MOST_CATEGORIES} ways; name few categories, not every return"
            )
        return self._categories.setdefault(outcome, len(self._categories))

    def _fit(self) -> None:
        for table in self.tables.values():
            table.fit(len(self._categories))
