"""Algorithm 7 on rows of log beliefs, for a single user or very many: score, choose, likelihood, belief, dynamics.

    β⁰ ← G₀                                                      `start`
    in each episode:  π ← argmax of the rule's scores under β    `belief`, `select`
                      run π, obtain σ
                      β ← F(σ | ·, π) β, normalised              `update`, `update_row`
                      β ← the dynamics' step from β              `update`, `update_row`, `step_row`

`BayesianPolicyReuse` is a single row with its history and explanation, `UserBeliefs` holds many rows, and the
experiments of chapter 4 run hundreds of tasks as rows. Thesis: §4.2, Alg. 7; §4.5.2, Alg. 8.
"""

from collections.abc import Callable, Iterator
from functools import cache
from types import ModuleType
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.compiled.compiler_start import kernel_pays
from lifelore.core.errors import InputError
from lifelore.interaction.beliefs.bayes_rule import bayes_rule
from lifelore.interaction.beliefs.belief import ROW_COST, log_prior
from lifelore.interaction.beliefs.hazard import hazard_rule
from lifelore.interaction.beliefs.type_dynamics import DEFAULT_HAZARD, TypeDynamics
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.library.task_library import TaskLibrary
from lifelore.interaction.outcomes.batch_likelihood import batch_likelihood
from lifelore.interaction.outcomes.outcome_model import LARGEST
from lifelore.interaction.reuse.task_step import learn
from lifelore.interaction.reuse.user_outcomes import UserOutcomes
from lifelore.interaction.selection import BeliefSampling, Greedy, SelectionRule
from lifelore.interaction.selection.choice import choose, tied_shares

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]
Precision = Literal["f4", "f8"]

BLOCK = 512
"""Users handled at a time: their likelihoods and beliefs stay in the processor's cache."""
TOLERANCES: dict[str, float] = {"f4": 1e-6, "f8": 1e-9}
"""Scores this close to the best, relative to it, are equal where beliefs are of that precision."""
LEAST_SCORED = 1e-250
"""The usual `least` for many users: subnormal numbers slow arithmetic down and have no finite inverse."""


class ReuseAlgorithm:
    """The steps of Algorithm 7. The arrays of log beliefs are the caller's and are updated in place.

    Parameters
    ----------
    library : PolicyLibrary
        Not copied. Call `refresh` after its models have learnt in place.
    dynamics : TypeDynamics, optional
        By default a hazard of `DEFAULT_HAZARD` that draws from the library's prior; the thesis's types are static.
    dtype : {"f8", "f4"}
        Precision of the log beliefs. float32 is faster and needs half the memory; see `UserBeliefs` for its error.
    least : float
        Beliefs below `least` are scored as 0; float64 only. 0 scores every belief as it is. Published results of
        single agents were computed with 0, those of many tasks at once with `LEAST_SCORED`; the two may differ
        where all scores are tiny.

    Raises
    ------
    InputError
        The dynamics are for another number of types.
    """

    def __init__(
        self,
        library: PolicyLibrary,
        dynamics: TypeDynamics | None = None,
        *,
        dtype: Precision = "f8",
        least: float = 0.0,
    ) -> None:
        self.library, self.least = library, least
        self.dtype: Precision = dtype
        self.dynamics = dynamics or TypeDynamics.hazard(DEFAULT_HAZARD, library.prior)
        if self.dynamics.n_types not in (None, library.n_types):
            raise InputError(f"dynamics are for {self.dynamics.n_types} types, the library has {library.n_types}")
        self._hazard = self.dynamics.hazard_terms(dtype)
        self._moving = self.dynamics.kind == "transitions"
        self._rows_updated, self._compiled = 0, False
        self.refresh()

    def refresh(self) -> None:
        """Read the library's models again."""
        self._likelihood = batch_likelihood(self.library.signal)
        self._normals = self._likelihood.normals
        self._responses: BestResponses | None = None

    def start(self, prior: ArrayLike | None = None) -> NDArray[Any]:
        """The log belief before the first episode, (n_types,): that of `prior`, by default the library's.

        Raises
        ------
        InputError
            The prior has another number of types or is no distribution.
        """
        log_belief = log_prior(self.library.prior if prior is None else prior).astype(self.dtype)
        if log_belief.shape != (self.library.n_types,):
            raise InputError(f"prior must be ({self.library.n_types},), got {log_belief.shape}")
        return log_belief

    # ---- score and choose --------------------------------------------------------------------------------

    def belief(self, log_belief: NDArray[Any], users: Numbers | None = None) -> NDArray[Any]:
        """The beliefs that rules score, of all rows or those of `users` (k,); rows sum to 1 up to rounding."""
        if self.dtype == "f4":
            users = np.arange(len(log_belief)) if users is None else users
            linear = np.empty((len(users), self.library.n_types), np.float32)
            _user_kernels().read_f4(log_belief, users, linear)
            return linear
        belief = np.exp(log_belief if users is None else log_belief[users])
        if self.least:
            belief[belief < self.least] = 0.0
        return belief

    def select(
        self,
        belief: Array,
        rule: SelectionRule,
        generator: np.random.Generator,
        episodes_left: float | None = None,
    ) -> tuple[Any, Array]:
        """The policy to run next and the scores of all policies.

        Parameters
        ----------
        belief : (n_types,) or (n_users, n_types) float64
        rule : SelectionRule
        generator : numpy generator
            Serves the rule first, then the choice among equals: one number for each of many users, for a single
            user one number where policies tie.
        episodes_left : float, optional
            Number of episodes after this selection.

        Returns
        -------
        policy : int or (n_users,) int64
        scores : (n_policies,) or (n_users, n_policies) float64
        """
        scores = rule.scores(self.library, belief, episodes_left=episodes_left, generator=generator)
        return choose(scores, generator), scores

    def select_fast(
        self,
        belief: NDArray[Any],
        rule: SelectionRule,
        generator: np.random.Generator,
        episodes_left: float | None = None,
    ) -> Numbers:
        """The policy to run next for many users, (n_users,); belief sampling and greedy selection run compiled.

        The compiled rules choose with the same probabilities as `select`, but draw other random numbers (sampling:
        one for each user in place of two) and compare scores in the precision of the beliefs.
        """
        if type(rule) is BeliefSampling:
            return self._best_responses().sampled(belief, generator)
        if type(rule) is Greedy:
            return self._best_responses().greedy(belief, generator)
        if self.dtype == "f4":
            belief = belief.astype(np.float64)
            belief /= belief.sum(axis=1, keepdims=True)
        return self.select(belief, rule, generator, episodes_left)[0]

    def greedy_shares(self, belief: NDArray[Any]) -> Array:
        """How likely `select_fast` takes each policy under the greedy rule, (n_users, n_policies)."""
        return tied_shares(belief @ self._best_responses().mean, TOLERANCES[self.dtype])

    # ---- likelihood, belief, dynamics --------------------------------------------------------------------

    def update(
        self,
        log_beliefs: NDArray[Any],
        users: Numbers,
        policies: Numbers,
        signals: Any,
        select: Callable[[NDArray[Any], slice], Numbers] | None = None,
        outcomes: UserOutcomes | None = None,
    ) -> tuple[Array, Numbers]:
        """Learn from a signal for each of `users`, in blocks and in order, and select in the same pass.

        Parameters
        ----------
        log_beliefs : (n_users, n_types) float of `dtype`
            Updated in place.
        users, policies : (k,) int64
            A user may come twice, except where the dynamics are a matrix of transitions.
        signals : sequence of length k
            Numbers for returns, category numbers for categories.
        select : callable, optional
            Beliefs of a block of users after the update, (m, n_types), and the users' places in `users` to the
            policies to run next, (m,).
        outcomes : UserOutcomes, optional
            What the users have shown: likelihoods are then given that, and the signals are added to it.

        Returns
        -------
        log_evidence : (k,) float64
            log Σ F β; minus infinity where no type explains the signal and the belief stays.
        policies : (k,) int64
            Of `select`; empty without it.

        Raises
        ------
        InputError
            The model cannot have made a signal, or gave NaN. Blocks before that signal are updated.
        """
        signals = (self._likelihood if outcomes is None else outcomes.law).checked(signals)
        if not len(users) == len(policies) == len(signals):
            raise InputError(
                f"users, policies and signals must be equally many, got {len(users)}, {len(policies)} and "
                f"{len(signals)}"
            )
        if outcomes is not None and self.dynamics.kind == "hazard" and self.dynamics.rate:
            return self._update_changing(log_beliefs, users, policies, signals, select, outcomes)
        if self._moving and len(np.unique(users)) < len(users):
            raise InputError("users must be distinct where types change by a matrix; update them in turn")
        log_evidence, chosen = np.empty(len(users)), np.empty(len(users) if select else 0, np.int64)
        work = np.empty((min(BLOCK, len(users)), self.library.n_types))
        linear = np.empty_like(work, np.float32) if self.dtype == "f4" else None
        for at, own in blocks(users):
            here = len(own)
            if outcomes is None:
                self._likelihood.write(policies[at], signals[at], work[:here])
            else:
                outcomes.write(own, policies[at], signals[at], work[:here])
            found = None if linear is None else linear[:here]
            self._update_block(log_beliefs, own, work[:here], found, log_evidence[at])
            if self._moving:
                log_beliefs[own] = self.dynamics.step(log_beliefs[own].astype(np.float64))
            if select is not None:
                known = linear is not None and not self._moving
                chosen[at] = select(linear[:here] if known else self.belief(log_beliefs, own), at)  # pyright: ignore
        return log_evidence, chosen

    def _update_changing(
        self,
        log_beliefs: NDArray[Any],
        users: Numbers,
        policies: Numbers,
        signals: Array,
        select: Callable[[NDArray[Any], slice], Numbers] | None,
        outcomes: UserOutcomes,
    ) -> tuple[Array, Numbers]:
        """`update` of users whose types change by a hazard and whose models are uncertain."""
        log_evidence, chosen = np.empty(len(users)), np.empty(len(users) if select else 0, np.int64)
        shown, keeps = np.empty((min(BLOCK, len(users)), self.library.n_types)), np.empty(BLOCK)
        new, rate = np.empty_like(shown), self.dynamics.rate
        with np.errstate(divide="ignore"):
            log_stay, log_anew = float(np.log1p(-rate)), np.log(rate) + np.log(self.dynamics.law)  # pyright: ignore
        for at, own in distinct_blocks(users):
            n = len(own)
            outcomes.predict(own, policies[at], signals[at], shown[:n], new[:n])
            _user_step_kernels().changing_users(
                log_beliefs, own, shown[:n], new[:n], log_stay, log_anew, log_evidence[at], keeps[:n]
            )
            outcomes.add(own, policies[at], signals[at], keeps[:n])
            if select is not None:
                chosen[at] = select(self.belief(log_beliefs, own), at)
        return log_evidence, chosen

    def _update_block(
        self,
        log_beliefs: NDArray[Any],
        users: Numbers,
        log_likelihood: Array,
        linear: NDArray[Any] | None,
        log_evidence: Array,
    ) -> None:
        """Bayes' rule for a block of users and the step of a hazard, if there is one; arrays as in the kernels."""
        rows = (log_beliefs, users, log_likelihood)
        if linear is not None:
            if self._hazard is None:
                _user_kernels().bayes_users_f4(*rows, linear, log_evidence)
            else:
                _hazard_user_kernels().hazard_users_f4(*rows, linear, log_evidence, self._hazard)
        elif self._hazard is None:
            (_loaded or _load()).bayes_users(*rows, log_evidence)
        else:
            _hazard_kernels().hazard_users(*rows, log_evidence, self._hazard)

    def update_row(
        self, log_belief: Array, policy: int, signal: Any, outcome: float | None = None
    ) -> tuple[Array, float]:
        """Learn from a single signal, in place; the same bits as `update` without the start of a compiler.

        Parameters
        ----------
        log_belief : (n_types,) float64
            Updated in place.
        policy : int
            Number of the policy.
        signal
            As the library's signal model takes it.
        outcome : float, optional
            The return, where the signal is another one; teaches the outcomes of a `TaskLibrary`.

        Returns
        -------
        log_likelihood : (n_types,) float64
            log F(signal | type, policy).
        log_evidence : float
            As in `update`.

        Raises
        ------
        InputError
            The model cannot have made the signal, or gave NaN or infinity. The belief stays as it was.
        """
        normals = self._normals
        compiled = self._compiled or self._starts_compiler()
        if isinstance(self.library, TaskLibrary):
            log_likelihood, log_evidence = learn(
                self.library, log_belief, policy, signal, outcome, self._hazard, compiled
            )
        elif compiled and normals is not None and isinstance(signal, float) and -LARGEST <= signal <= LARGEST:
            log_likelihood = np.empty(len(log_belief))
            row = (log_belief, policy, signal, *normals, log_likelihood)
            if self._hazard is None:
                log_evidence = (_loaded or _load()).normal_row(*row)
            else:
                log_evidence = _hazard_kernels().hazard_normal_row(*row, self._hazard)
        else:
            log_likelihood = self._log_likelihood(policy, signal)
            log_evidence = self._learn_row(log_belief, log_likelihood, compiled)
        if log_evidence != log_evidence:
            raise InputError(
                f"signal model {type(self.library.signal).__name__} gave NaN or infinity as a log likelihood for "
                f"policy {self.library.policies[policy]!r}; minus infinity is allowed, they are not"
            )
        if self._moving:
            self.step_row(log_belief)
        return log_likelihood, log_evidence

    def _learn_row(self, log_belief: Array, log_likelihood: Array, compiled: bool) -> float:
        """Bayes' rule for a log belief in place, and the step of a hazard, if there is one; the log evidence."""
        if compiled:
            if self._hazard is None:
                return (_loaded or _load()).bayes_row(log_belief, log_likelihood)
            return _hazard_kernels().hazard_row(log_belief, log_likelihood, self._hazard)
        if self._hazard is None:
            log_belief[:], log_evidence = bayes_rule(log_belief, log_likelihood)
        else:
            log_belief[:], log_evidence = hazard_rule(log_belief, log_likelihood, self._hazard)
        return log_evidence

    def step_row(self, log_belief: Array) -> None:
        """The dynamics' step of a log belief (n_types,) alone, in place: an episode without a signal."""
        log_belief[:] = self.dynamics.step(log_belief)

    def _log_likelihood(self, policy: int, signal: Any) -> Array:
        # A copy: callers keep it, and a model may write its next answer into the same array.
        found = np.array(self.library.signal.log_likelihood(policy, signal), np.float64)
        if found.shape != (self.library.n_types,):
            raise InputError(
                f"signal model {type(self.library.signal).__name__} must give ({self.library.n_types},) "
                f"log likelihoods, gave {found.shape}"
            )
        return found

    def _starts_compiler(self) -> bool:
        """Whether rows are updated by kernels from now on: Numba is loaded, or many updates have been made."""
        self._rows_updated += 1
        self._compiled = kernel_pays(ROW_COST * self._rows_updated * self.library.n_types)
        return self._compiled

    def _best_responses(self) -> "BestResponses":
        if self._responses is None:
            self._responses = BestResponses(self.library.performance.mean, self.dtype)
        return self._responses


class BestResponses:
    """Compiled belief sampling and greedy selection for rows of beliefs.

    Parameters
    ----------
    mean : (n_types, n_policies) float
        E[U | type, policy]; copied.
    dtype : {"f8", "f4"}
        Precision of the beliefs.
    """

    def __init__(self, mean: Array, dtype: Precision) -> None:
        self.mean, self.tolerance = np.array(mean, dtype, order="C"), TOLERANCES[dtype]
        self._best = tied_shares(mean) > 0
        # The number of each type's best response, where no type has two.
        self._single = self._best.argmax(axis=1) if (self._best.sum(axis=1) == 1).all() else None

    def sampled(self, belief: NDArray[Any], generator: np.random.Generator) -> Numbers:
        """The best response to a type drawn from each row of `belief`, equals at random, (n,)."""
        drawn = np.empty(len(belief), np.int64)
        _user_kernels().draw_types(belief, generator.random(len(belief)), drawn)
        if self._single is not None:
            return self._single[drawn]
        return self._largest(self._best[drawn].astype(self.mean.dtype), generator)

    def greedy(self, belief: NDArray[Any], generator: np.random.Generator) -> Numbers:
        """The policy of the largest expected utility, equals at random, (n,)."""
        return self._largest(belief @ self.mean, generator)

    def _largest(self, scores: NDArray[Any], generator: np.random.Generator) -> Numbers:
        chosen = np.empty(len(scores), np.int64)
        _tie_kernels().choose_rows(scores, generator.random(len(scores)), self.tolerance, chosen)
        return chosen


def blocks(users: Numbers) -> Iterator[tuple[slice, Numbers]]:
    """Blocks of at most `BLOCK` users: their places in `users`, and the users."""
    for start in range(0, len(users), BLOCK):
        at = slice(start, min(start + BLOCK, len(users)))
        yield at, users[at]


def distinct_blocks(users: Numbers) -> Iterator[tuple[slice, Numbers]]:
    """`blocks` in none of which a user comes twice; a user's second signal needs what the first has changed."""
    for at, own in blocks(users):
        if len(np.unique(own)) == len(own):
            yield at, own
            continue
        start, inside = at.start, set[int]()
        for place, user in enumerate(own.tolist(), at.start):
            if user in inside:
                yield slice(start, place), users[start:place]
                start, inside = place, set()
            inside.add(user)
        yield slice(start, at.stop), users[start : at.stop]


# Modules of kernels are imported at their first use: the import starts Numba.


_loaded: Any = None


def _load() -> Any:
    """The module of belief kernels, stored for later updates: a single update takes a microsecond."""
    global _loaded
    from lifelore.interaction.beliefs import belief_kernels

    _loaded = belief_kernels
    return belief_kernels


@cache
def _hazard_kernels() -> ModuleType:
    from lifelore.interaction.beliefs import hazard_kernels

    return hazard_kernels


@cache
def _hazard_user_kernels() -> ModuleType:
    from lifelore.interaction.reuse import hazard_user_kernels

    return hazard_user_kernels


@cache
def _user_kernels() -> ModuleType:
    from lifelore.interaction.reuse import user_kernels

    return user_kernels


@cache
def _user_step_kernels() -> ModuleType:
    from lifelore.interaction.reuse import user_step_kernels

    return user_step_kernels


@cache
def _tie_kernels() -> ModuleType:
    from lifelore.interaction.selection import tie_kernels

    return tie_kernels
