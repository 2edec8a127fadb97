"""Algorithm 7 on rows of log beliefs, a row for each user.

    β⁰ ← G₀
    in each episode:  π ← argmax of the rule's scores under β    `select`
                      run π, obtain signals σ
                      β ← F(σ | ·, π) β, normalised              `observe`, for each signal
                      β ← the dynamics' step from β              `end_episode`

`update` is a signal and the end of its episode. The belief is over types and, where models are uncertain, over the
parameters of each user's own outcomes (`UserModel`). `BayesianPolicyReuse` is a single row with its history and
explanation, `UserBeliefs` many rows with names. Thesis: §4.2, Alg. 7; §4.5.2, Alg. 8.
"""

from collections.abc import Mapping
from copy import copy
from math import prod
from typing import Any, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.belief import log_prior, update
from lifelore.interaction.beliefs.learnt_dynamics import LearntDynamics
from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.law import Law, Models, Numbers, law_of, of_users
from lifelore.interaction.outcomes.normal_law import NormalLaw
from lifelore.interaction.outcomes.spread import Spread
from lifelore.interaction.reuse.unknown_law import unknown_law
from lifelore.interaction.reuse.unknown_users import UnknownUsers
from lifelore.interaction.reuse.user_library import UserLibrary
from lifelore.interaction.reuse.user_model import UserModel
from lifelore.interaction.selection import SelectionRule
from lifelore.interaction.selection.choice import Mask, choose, propensities, scored, tied_shares
from lifelore.interaction.signals.return_signal import ReturnSignal

Array = NDArray[Any]
Precision = Literal["f4", "f8"]
Dynamics = TypeDynamics | LearntDynamics


class Observed(NamedTuple):
    """The evidence of signals.

    log_likelihood : (..., n_types) float, log F(σ | τ, π)
    log_evidence : (...) float, log Σ F β; minus infinity where no type explains the signal and the belief stays
    """

    log_likelihood: Array
    log_evidence: Array


class ReuseAlgorithm:
    """Rows of Algorithm 7.

    `users` are a number, or distinct numbers (k,); what comes for each user (policies, signals) then has the same
    shape, and answers have it as their leading axis.

    Parameters
    ----------
    library : PolicyLibrary
        Not copied. Uncertain models are read once, at the start.
    n_users : int
    prior : (n_types,) float, optional
        The library's by default.
    dynamics : TypeDynamics, optional
        By default `TypeDynamics.learnt`, a belief over hazards; the thesis's types are static.
    models : {"uncertain", "plug-in"}
        Whether a model learnt from a finite number of runs is known to be uncertain.
    spread : Spread, optional
        Of the users of a type; by default as the library's runs leave it.
    dtype : {"f8", "f4"}
        Precision of the rows. float32 is faster and needs half the memory.
    unknown : Law, optional
        Of the signals of an unknown type: users whom no known type fits are looked for, see `unknown_users`. By
        default `unknown_law` where the outcomes are the signals and their means uncertain, else none; costs
        memory for three numbers a policy.

    Attributes
    ----------
    log_belief : (n_users, n_types) float of `dtype`
        Normalised; minus infinity where a belief is 0.

    Raises
    ------
    InputError
        The prior or the dynamics are for another number of types, or an argument breaks its rule.
    """

    def __init__(
        self,
        library: PolicyLibrary,
        n_users: int = 1,
        *,
        prior: ArrayLike | None = None,
        dynamics: Dynamics | None = None,
        models: Models = "uncertain",
        spread: Spread | None = None,
        dtype: Precision = "f8",
        unknown: Law | Literal["default"] | None = "default",
    ) -> None:
        if models not in ("uncertain", "plug-in"):
            raise InputError(f"models must be 'uncertain' or 'plug-in', got {models!r}")
        if dtype not in ("f4", "f8"):
            raise InputError(f"dtype must be 'f4' or 'f8', got {dtype!r}")
        self.library = library
        self.models: Models = models
        self.dynamics: Dynamics = dynamics or TypeDynamics.learnt()
        if self.dynamics.n_types not in (None, library.n_types):
            raise InputError(f"dynamics are for {self.dynamics.n_types} types, the library has {library.n_types}")
        self._dtype = dtype
        self.log_prior: Array = self.start(prior)
        settings: dict[str, Any] = {"dtype": dtype} if spread is None else {"dtype": dtype, "spread": spread}
        laws = {"signal": law_of(library.signal, library.n_types, models, **settings)}
        if not (isinstance(library.signal, ReturnSignal) and library.signal.outcomes is library.performance):
            laws["outcomes"] = law_of(library.performance, library.n_types, models, **settings)
        if unknown == "default":
            looked_for = "outcomes" not in laws and isinstance(laws["signal"], NormalLaw) and library.n_types > 1
            unknown = unknown_law(library, dtype) if looked_for else None
        if unknown is not None:
            laws["unknown"] = unknown
        self._begin(n_users, laws)

    def _begin(self, n_users: int, laws: Mapping[str, Any]) -> None:
        """Set up rows with the prior; without a law of outcomes these are the signals."""
        self.log_belief: Array = np.tile(self.log_prior, (n_users, 1))
        # Whether an episode has begun since the last signal: only then may the type have changed.
        self._begun = np.ones(n_users, bool)
        self.changes = self.dynamics.rows(n_users, self.library.prior, self._dtype)
        self._models = {
            name: (UnknownUsers if name == "unknown" else UserModel)(law, n_users) for name, law in laws.items()
        }
        self.unknown: Any = self._models.get("unknown")
        self.signals = self._models["signal"]
        self.outcomes = self._models.get("outcomes", self.signals)
        self._learns = self.signals.law.learns or self.outcomes.law.learns

    def new_rows(self, n_users: int = 1) -> Self:
        """Another algorithm with the same laws and dynamics, whose `n_users` users have the prior."""
        other = copy(self)
        other._begin(n_users, {name: model.law for name, model in self._models.items()})
        return other

    @property
    def n_users(self) -> int:
        """Number of rows."""
        return len(self.log_belief)

    def start(self, prior: ArrayLike | None = None) -> Array:
        """The log belief before the first episode, (n_types,): that of `prior`, by default the library's.

        Raises
        ------
        InputError
            The prior has another number of types or is no distribution.
        """
        log_belief = log_prior(self.library.prior if prior is None else prior).astype(self._dtype)
        if log_belief.shape != (self.library.n_types,):
            raise InputError(f"prior must be ({self.library.n_types},), got {log_belief.shape}")
        return log_belief

    # ---- score and choose --------------------------------------------------------------------------------

    def belief(self, users: Numbers) -> Array:
        """β of `users` (...), (..., n_types), rows sum to 1 up to rounding."""
        return np.exp(of_users(self.log_belief, users))

    def known(self, users: Numbers) -> Any:
        """The library as rules read it for `users`, given what they have shown."""
        if not self._learns:
            return self.library
        return UserLibrary(self.library, self.signals, self.outcomes, users)

    def select(
        self,
        users: Numbers,
        rule: SelectionRule,
        generator: np.random.Generator,
        available: Mask | None = None,
        episodes_left: float | None = None,
    ) -> tuple[Any, Array]:
        """The policy to run next for `users` (...), (...) int64, and all policies' scores, (..., n_policies).

        Parameters
        ----------
        generator : numpy generator
            Serves the rule first, then the choice among equals.
        available : (n_policies,) or (k, n_policies) bool, optional
            The policies that can be run now; scores of the others are minus infinity.
        episodes_left : float, optional
            Number of episodes after this selection.
        """
        scores = self.scores(users, rule, generator, available, episodes_left)
        return choose(scores, generator), scores

    def scores(
        self,
        users: Numbers,
        rule: SelectionRule,
        generator: np.random.Generator | None = None,
        available: Mask | None = None,
        episodes_left: float | None = None,
    ) -> Array:
        """The rule's scores for `users` (...), (..., n_policies); arguments as for `select`.

        Those of users whom perhaps no type fits are `UnknownUsers.bounds`, where the rule tries policies on them.
        """
        known, belief = self.known(users), self.belief(users)
        scores = scored(rule, known, belief, available, episodes_left=episodes_left, generator=generator)
        if (unknown := self._of_unknown(users, rule, known, belief, available)) is not None:
            tried, bounds = unknown
            scores[tried] = bounds
        return scores

    def propensities(
        self,
        users: Numbers,
        rule: SelectionRule,
        available: Mask | None = None,
        episodes_left: float | None = None,
    ) -> Array:
        """Probability that `select` takes each policy for `users` (...), (..., n_policies); rows sum to 1."""
        belief = self.belief(users).astype(np.float64, copy=False)
        belief = belief / belief.sum(axis=-1, keepdims=True)
        known = self.known(users)
        shares = propensities(rule, known, belief, available, episodes_left=episodes_left)
        if (unknown := self._of_unknown(users, rule, known, belief, available)) is not None:
            tried, bounds = unknown
            shares[tried] = tied_shares(bounds)
        return shares

    def unknown_probability(self, user: int) -> float | None:
        """Probability that no known type fits a user; None where such users are not looked for."""
        if self.unknown is None or self.unknown.log_odds[user] == -np.inf:
            return None
        return float(self.unknown.probability(user))

    # ---- likelihood, belief, dynamics --------------------------------------------------------------------

    def observe(self, users: Numbers, policies: Numbers, signals: Any, outcomes: Any = None) -> Observed:
        """Learn from a signal of each of `users` (...), within an episode.

        Parameters
        ----------
        signals
            For a single user as the library's signal model takes it, else a sequence of these.
        outcomes : float or (k,) float, optional
            The returns, where signals are something else: they teach how well policies do for a user.

        Raises
        ------
        InputError
            The model cannot have made a signal, or gave NaN or infinity. All stays as it was.
        """
        law, before, raw = self.signals.law, of_users(self.log_belief, users), signals
        signals = law.checked(signals)
        outcomes = None if outcomes is None else self.outcomes.law.checked(outcomes)
        if law.single and not isinstance(signals, float) and np.shape(signals) != np.shape(users):
            raise InputError(f"there must be a signal for each user {np.shape(users)}, got {np.shape(signals)}")
        if law.learns:
            changed = self._changed(users, before)
            log_likelihood, changed, gain = self.signals.evidence(users, policies, signals, before, changed)
        else:
            log_likelihood, changed, gain = law.log_likelihoods(policies, signals), None, None
        after, log_evidence = update(before, log_likelihood)
        if law.learns:
            explained = log_evidence > -np.inf
            if changed is not None:
                keep = 1 - np.minimum(np.vecdot(np.exp(after), changed), 1.0) * explained
                for model in self._models.values():
                    model.fade(users, keep)
            if _any(explained):
                self.signals.learn(*_explained(explained, users, policies, signals, gain))
        if self.unknown is not None:
            self.unknown.weigh(users, policies, raw, log_evidence)
        if outcomes is not None and self.outcomes is not self.signals and self.outcomes.law.learns:
            self._learn_outcomes(users, policies, outcomes, before)
        self.log_belief[users] = after
        if self.dynamics.moves:
            self._begun[users] = False
        return Observed(log_likelihood, log_evidence)

    def end_episode(self, users: Numbers, outcome: Any = None) -> None:
        """Take the dynamics' step for `users`; dynamics that learn read by `outcome` how the episodes ended."""
        if self.dynamics.moves:
            self.log_belief[users] = self.changes.step(of_users(self.log_belief, users), users, outcome)
            self._begun[users] = True

    def update(self, users: Numbers, policies: Numbers, signals: Any, outcomes: Any = None) -> Observed:
        """`observe`, and `end_episode`."""
        observed = self.observe(users, policies, signals, outcomes)
        self.end_episode(users)
        return observed

    # ---- rows ----------------------------------------------------------------------------------------------

    def reset(self, users: Numbers) -> None:
        """Set `users` back to the prior, and forget what they have shown."""
        self.log_belief[users], self._begun[users] = self.log_prior, True
        self.changes.reset(users)
        for model in self._models.values():
            model.reset(users)

    def grow(self, n_users: int) -> None:
        """Make room for `n_users` users; new users have the prior."""
        more = n_users - self.n_users
        self.log_belief = np.concatenate([self.log_belief, np.tile(self.log_prior, (more, 1))])
        self._begun = np.concatenate([self._begun, np.ones(more, bool)])
        self.changes.grow(n_users)
        for model in self._models.values():
            model.grow(n_users)

    def state(self, user: int) -> dict[str, Array]:
        """What a user has shown, as small arrays; empty between episodes where only the belief learns."""
        states = {name: model.state(user) for name, model in self._models.items()}
        states["changes"] = self.changes.state(user)
        found = {f"{name}.{key}": array for name, state in states.items() for key, array in state.items()}
        return found if self._begun[user] else found | {"begun": np.array(False)}

    def restore(self, user: int, log_belief: ArrayLike, state: Mapping[str, Any]) -> None:
        """Take over a log belief (n_types,) and a `state`; InputError where they are of another library."""
        row = np.asarray(log_belief)
        if row.shape != (self.library.n_types,) or not abs(np.exp(row.astype(np.float64)).sum() - 1) < 1e-5:
            raise InputError(f"log_belief must be the logs of a belief over {self.library.n_types} types")
        arrays = [array for model in self._models.values() for array in model.arrays()]
        before = [array[user].copy() for array in arrays]
        try:
            for name, model in self._models.items():
                model.restore(user, named_part(state, f"{name}."))
            self.changes.restore(user, named_part(state, "changes."))
        except InputError:
            for array, old in zip(arrays, before, strict=True):
                array[user] = old
            raise
        self.log_belief[user], self._begun[user] = row, bool(state.get("begun", True))

    def packed(self, users: Numbers) -> Array:
        """All that is known of distinct `users` (k,), a row each, (k, width) float64; `unpack` restores it.

        Between episodes only. The `width` depends on the library, the dynamics and the models.
        """
        rows = np.atleast_1d(users)
        return np.concatenate(
            [array[rows].reshape(len(rows), -1).astype(np.float64) for array in self._user_arrays()], axis=1
        )

    def unpack(self, users: Numbers, rows: ArrayLike) -> None:
        """Take over `packed` rows (k, width) for distinct `users` (k,).

        Raises
        ------
        InputError
            The rows are of another library, other dynamics or other models.
        """
        rows, at = np.asarray(rows, np.float64), 0
        if self.width != rows.shape[-1]:
            raise InputError(f"rows must have {self.width} numbers for this library, got {rows.shape[-1]}")
        for array in self._user_arrays():
            size = prod(array.shape[1:])
            array[users] = rows[:, at : at + size].reshape(-1, *array.shape[1:])
            at += size
        self._begun[users] = True

    @property
    def width(self) -> int:
        """Number of numbers of a `packed` row."""
        return sum(prod(array.shape[1:]) for array in self._user_arrays())

    def _user_arrays(self) -> list[Array]:
        """Every array with a row for each user, but for whether an episode has begun."""
        of_models = [array for model in self._models.values() if model.law.learns for array in model.arrays()]
        return [array for array in (self.log_belief, *of_models, *self.changes.arrays()) if prod(array.shape[1:])]

    @property
    def nbytes(self) -> int:
        """Memory of all rows in bytes."""
        of_models = [array for model in self._models.values() for array in model.arrays()]
        return sum(array.nbytes for array in (self.log_belief, self._begun, *of_models, *self.changes.arrays()))

    def _changed(self, users: Numbers, log_belief: Array) -> Array | None:
        """P(the type has just changed to this), (..., n_types); None where it cannot have."""
        begun = self._begun[users]
        share = self.changes.changed_share(log_belief, users) if _any(begun) else None
        return None if share is None else share * begun[..., None]

    def _of_unknown(
        self, users: Numbers, rule: SelectionRule, known: Any, belief: Array, available: Mask | None
    ) -> tuple[Any, Array] | None:
        """Which `users` (...) policies are tried on, and their scores on these, (m, n_policies); None for none."""
        if self.unknown is None or not getattr(rule, "tries_unknown", False):
            return None
        bounds, means = self.unknown.bounds(users), known.performance.mean
        if available is not None:
            bounds = np.where(available, bounds, -np.inf)
            means = np.where(np.expand_dims(available, -2), means, -np.inf)
        tried = np.asarray(self.unknown.tried(users, bounds, np.vecdot(belief, means.max(axis=-1))))
        return (tried, bounds[tried]) if tried.any() else None

    def _learn_outcomes(self, users: Numbers, policies: Numbers, outcomes: Any, log_belief: Array) -> None:
        found = self.outcomes.evidence(users, policies, outcomes, log_belief, None)
        explained = (found.log_likelihood > -np.inf).any(axis=-1)
        if _any(explained):
            self.outcomes.learn(*_explained(explained, users, policies, outcomes, found.gain))


def _any(flags: Any) -> bool:
    """Whether a flag of users (...) is set; of a single user without NumPy, whose call takes a microsecond."""
    return bool(flags if flags.ndim == 0 else flags.any())


def _explained(explained: Any, *of_users: Any) -> tuple[Any, ...]:
    """The parts of what comes for each user that `explained` (...) marks."""
    if explained.ndim == 0 or explained.all():
        return of_users
    rows = np.flatnonzero(explained)
    return tuple(
        [each[row] for row in rows] if isinstance(each, list) else each if each is None else each[rows]
        for each in of_users
    )


def named_part(state: Mapping[str, Any], prefix: str) -> dict[str, Any]:
    """The arrays whose names begin with `prefix`, by the rest of their names."""
    return {name.removeprefix(prefix): array for name, array in state.items() if name.startswith(prefix)}
