"""`ActionPrior`: counts how often each action was best in each context, over tasks and policies.

    α_c(a) = Σ_π w(π) U_c^π(a) + α⁰        U = 1 where a is best or tied best under π, else 0

Counts are stored by context code, only for contexts with counts. Weights are fixed-point integers, and α⁰ is
stored separately, so that priors of many robots merge exactly in any order. Thesis: §3.2.2, §3.3, Eq. 3.1-3.8.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.action.priors.context_index import FEW, ContextIndex
from lifelore.action.priors.count_rows import SEQUENTIAL, draw_by_proportion, merged_rows, rising, sorted_order
from lifelore.core.errors import InputError, MissingExtraError, NotFoundError
from lifelore.core.metrics import entropy
from lifelore.core.planning.planning import best_actions, checked_best
from lifelore.core.protocols import Record

MOST_WEIGHT = 1e6
"""Largest w(π); the counts of 2**23 such policies fit a 64-bit integer."""
KIND, VERSION = "action_prior", 1
ONE = 1 << 20
"""A weight of 1 as a fixed-point integer; whole weights are exact, others wrong by at most 5e-7, sums exact."""

BLOCK = 1 << 13
"""Rows sampled at a time; larger blocks do not fit the processor's cache and take longer."""

MANY = 1 << 16
"""Number of contexts whose counts no longer fit the cache; from here on, samples are drawn in storage order."""

FORMS = ("proportion", "dirichlet", "softmax", "support", "tempered")
"""Forms of probabilities from counts (§3.2.2.1): their proportion (the mean of the Dirichlet), one draw from the
Dirichlet, a softmax of the counts, uniform over actions with counts, or the proportion to a power."""

PseudoCounts = float | Callable[[NDArray[np.int64]], ArrayLike]
"""α⁰ as one number, or as a function of (n,) context codes that gives (n, n_actions) numbers."""


class ActionPrior:
    """Counts of useful actions by context.

    Parameters
    ----------
    n_actions : int
        At least 1.
    alpha0 : float or callable
        Pseudo-count α⁰ of every action in every context, > 0; the weight of the uniform policy π₀. Or a function
        of (n,) contexts that gives α⁰_c(a), (n, n_actions), all > 0 (Eq. 3.4).
    key : str
        Meaning of the contexts, usually a hash of their definition and the actions. Priors of different keys
        do not merge.

    Attributes
    ----------
    labels : mapping of int to features
        Context code to the features behind it, where they are known. Tables and pictures show them; records and
        files of the prior do not hold them.

    Notes
    -----
    A context is an int64 code of magnitude at most 2**63 / (n_actions + 1). A context without counts has the
    uniform distribution in every form but ``dirichlet``, whose draws scatter around it, widely if α⁰ is small.

    Examples
    --------
    >>> prior = ActionPrior(2, alpha0=0.5)
    >>> prior.update([7, 7, 9], [[True, False], [True, True], [False, False]])
    >>> prior.probs([7, 9]).tolist()
    [[0.625, 0.375], [0.5, 0.5]]
    >>> prior
    <ActionPrior: 2 actions, 1 contexts, 3 counts, alpha0=0.5>
    """

    def __init__(self, n_actions: int, alpha0: PseudoCounts = 0.1, key: str = "") -> None:
        if n_actions < 1:
            raise InputError(f"n_actions must be at least 1, got {n_actions}")
        if not (callable(alpha0) or (alpha0 > 0 and np.isfinite(alpha0))):
            raise InputError(f"alpha0 must be positive and finite, got {alpha0}")
        self.n_actions, self.alpha0, self.key = n_actions, alpha0 if callable(alpha0) else float(alpha0), key
        self.labels: Mapping[int, Any] = {}
        self._index = ContextIndex(np.empty(0, np.int64))
        self._counts = np.empty((0, n_actions), np.int64)

    @property
    def _codes(self) -> NDArray[np.int64]:
        return self._index.codes

    def __len__(self) -> int:
        return len(self._codes)

    def __repr__(self) -> str:
        key = f", key='{self.key}'" if self.key else ""
        size = f"{len(self)} contexts, {self._counts.sum(dtype=float) / ONE:g} counts"
        alpha0 = "by context" if callable(self.alpha0) else f"{self.alpha0:g}"
        return f"<ActionPrior: {self.n_actions} actions, {size}, alpha0={alpha0}{key}>"

    @property
    def contexts(self) -> NDArray[np.int64]:
        """The (n,) sorted codes of contexts with counts."""
        return self._codes.copy()

    @property
    def uniform_alpha0(self) -> float:
        """α⁰ as one number.

        Raises
        ------
        InputError
            It is a function of the context.
        """
        if callable(self.alpha0):
            raise InputError("alpha0 must be one number here, got a function of the context")
        return self.alpha0

    # ---- learning --------------------------------------------------------------------------------

    def update(self, contexts: ArrayLike, best: ArrayLike, weight: ArrayLike = 1.0) -> None:
        """Count a policy's best actions (Eq. 3.5, 3.7).

        Parameters
        ----------
        contexts : (n,) int
            Context of each state to count; codes may repeat (§3.3.1: states with the same percept share counts).
        best : (n, n_actions) bool
            Best or tied-best actions of each state; rows without any are not counted. Leave out, or pass as all
            False: goal rows (where every action ties), completed rows, and states without a learnt policy.
        weight : float, (n,) or (n, n_actions) float
            w(π) in [0, `MOST_WEIGHT`], of all rows, of each, or of each action. Whole weights are exact; others
            are rounded to a multiple of 2⁻²⁰, by at most 5e-7.

        Raises
        ------
        InputError
            `best` is not boolean (π(s, ·) is for `update_policy`), a shape is wrong, or a number out of range.
        """
        contexts, best = _whole(contexts), checked_best(best)
        weights = np.asarray(weight, np.float64)
        if best.shape != (len(contexts), self.n_actions):
            raise InputError(
                f"best must have shape ({len(contexts)}, {self.n_actions}), one row a context, got {best.shape}"
            )
        if weights.shape not in ((), (len(contexts),), best.shape):
            raise InputError(
                f"weight must be a number, ({len(contexts)},), one a row, or {best.shape}, one a row and action, "
                f"got {weights.shape}"
            )
        if not ((weights >= 0) & (weights <= MOST_WEIGHT)).all():
            raise InputError(f"weight must lie in [0, {MOST_WEIGHT:.0f}], got {weight}")
        # A slot of a record is code · n_actions + action, which must not overflow.
        largest = (2**63 - 1) // (self.n_actions + 1)
        if contexts.size and not (-largest <= contexts.min() and contexts.max() <= largest):
            raise InputError(f"contexts must be codes of magnitude at most {largest}; shorten the hash")
        fixed_point = np.rint(weights * ONE).astype(np.int64)
        if fixed_point.ndim:
            best = best * (fixed_point[:, None] if fixed_point.ndim == 1 else fixed_point)
        counted = np.logical_or.reduce(list(best.T))  # column by column: rows are short
        if not counted.all():
            contexts, best = contexts[counted], best[counted]
        if fixed_point.ndim or fixed_point:
            self._add(contexts, best, 1 if fixed_point.ndim else int(fixed_point))

    def update_policy(self, contexts: ArrayLike, policy: ArrayLike, weight: ArrayLike = 1.0) -> None:
        """Count the actions of the largest probability π(s, a) in each row, ties included (Eq. 3.5).

        Parameters
        ----------
        contexts : (n,) int
        policy : (n, n_actions) float
            Rows sum to 1, or are all 0 where the policy takes no action, such as at the goal.
        weight : float, (n,) or (n, n_actions) float
            As for `update`: the thesis counts w(π), not the probability.

        Raises
        ------
        InputError
            A row is no probabilities; as for `update`.

        Examples
        --------
        >>> prior = ActionPrior(3)
        >>> prior.update_policy([7], [[0.2, 0.5, 0.3]])
        >>> prior.counts([7]).tolist()
        [[0.0, 1.0, 0.0]]
        """
        given = np.asarray(policy, np.float64)
        total = given.sum(axis=-1)
        if given.ndim != 2 or not (given >= 0).all() or not ((np.abs(total - 1) <= 1e-6) | (total == 0)).all():
            raise InputError(
                "policy must hold probabilities (n, n_actions), at least 0, in rows that sum to 1 or are all 0; "
                f"got shape {given.shape}, rows from {total.min(initial=np.inf):g} to {total.max(initial=0):g}"
            )
        self.update(contexts, best_actions(given) & (given > 0), weight)

    def update_trajectory(self, contexts: ArrayLike, actions: ArrayLike, weight: float = 1.0) -> None:
        """Count the actions of a trajectory or demonstration, each visit once (§3.4.8)."""
        actions = np.asarray(actions, np.int64).ravel()
        if actions.size and not (actions.min() >= 0 and actions.max() < self.n_actions):
            raise InputError(f"actions must lie in [0, {self.n_actions}), got {actions.min()}..{actions.max()}")
        self.update(contexts, np.eye(self.n_actions, dtype=bool)[actions], weight)

    def merge(self, other: "ActionPrior") -> None:
        """Add another prior's counts, exact in any order and grouping; and its labels of other contexts."""
        if (other.n_actions, other.key) != (self.n_actions, self.key):
            raise InputError(
                f"priors must agree in actions and key, got {self.n_actions} '{self.key}' "
                f"and {other.n_actions} '{other.key}'"
            )
        self._add(other._codes, other._counts)
        if other.labels:
            self.labels = {**other.labels, **self.labels}

    def _add(self, codes: NDArray[np.int64], rows: NDArray, factor: int = 1) -> None:
        """Add `factor` times each row of integers or booleans; no row may be all zero."""
        if len(codes) >= FEW:
            codes, self._counts = merged_rows(self._codes, self._counts, codes, rows, factor)
            self._index = ContextIndex(codes)
            return
        place = self._index.places(codes)
        if (place < 0).any():
            self._make_room(np.unique(codes[place < 0]))
            place = self._index.places(codes)
        np.add.at(self._counts, place, rows * np.int64(factor))

    def _make_room(self, codes: NDArray[np.int64]) -> None:
        """Insert rows of zeros for distinct ascending new codes."""
        at = np.searchsorted(self._codes, codes)
        self._index = ContextIndex(np.insert(self._codes, at, codes))
        self._counts = np.insert(self._counts, at, 0, axis=0)

    # ---- reading ---------------------------------------------------------------------------------

    def counts(self, contexts: ArrayLike) -> NDArray[np.float64]:
        """Weighted counts Σ w U without α⁰, (n, n_actions); zeros for contexts without counts."""
        return self._counts_at(self._index.places(_whole(contexts)))

    def _counts_at(self, place: NDArray[np.int64]) -> NDArray[np.float64]:
        if not len(self):
            return np.zeros((len(place), self.n_actions))
        result = np.take(self._counts, place, axis=0, mode="clip") / ONE
        result[place < 0] = 0.0
        return result

    def unseen(self, contexts: ArrayLike) -> NDArray[np.bool_]:
        """Whether each context has no counts, (n,) bool; the mean is the unseen rate."""
        return np.logical_not(self.counts(contexts).any(axis=1))

    def probs(
        self,
        contexts: ArrayLike,
        form: str = "proportion",
        *,
        generator: np.random.Generator | None = None,
        beta: float = 1.0,
        escape: float = 0.02,
    ) -> NDArray[np.float64]:
        """Action probabilities θ_c, (n, n_actions), rows sum to 1.

        Parameters
        ----------
        contexts : (n,) int
        form : {"proportion", "dirichlet", "softmax", "support", "tempered"}
            See `FORMS`.
        generator : numpy generator
            Needed for ``dirichlet``: one draw for each row.
        beta : float
            Exponent of ``tempered``, ≥ 0; scale of the counts in ``softmax``.
        escape : float
            Probability in [0, 1] that ``support`` spreads over all actions, so that it excludes no action.
        """
        contexts = _whole(contexts)
        return self._probs_of(contexts, self._index.places(contexts), form, generator, beta, escape)

    def _alpha0_of(self, contexts: NDArray[np.int64]) -> float | NDArray[np.float64]:
        if not callable(self.alpha0):
            return self.alpha0
        rows = np.asarray(self.alpha0(contexts), np.float64)
        if rows.shape != (len(contexts), self.n_actions) or not ((rows > 0) & np.isfinite(rows)).all():
            raise InputError(
                f"alpha0 must give positive numbers of shape ({len(contexts)}, {self.n_actions}) for as many "
                f"contexts, got shape {rows.shape}"
            )
        return rows

    def _probs_of(self, contexts, place, form, generator=None, beta=1.0, escape=0.02) -> NDArray[np.float64]:
        if not (beta >= 0 and np.isfinite(beta)):
            raise InputError(f"beta must be finite and at least 0, got {beta}")
        counts = self._counts_at(place)
        alpha = counts + self._alpha0_of(contexts)
        match form:
            case "proportion":
                mass = alpha
            case "dirichlet":
                if generator is None:
                    raise InputError("form 'dirichlet' draws probabilities: pass generator=")
                # Gamma draws with a small shape underflow to 0; the floor prevents 0 / 0.
                mass = np.maximum(generator.standard_gamma(alpha), 1e-300)
            case "softmax":
                mass = np.exp(beta * (counts - counts.max(axis=1, keepdims=True)))
            case "support":
                return self._support(counts > 0, escape)
            case "tempered":
                mass = np.exp(beta * np.log(alpha / alpha.max(axis=1, keepdims=True)))
            case _:
                raise NotFoundError(f"form must be one of {', '.join(FORMS)}, got '{form}'")
        return mass / mass.sum(axis=1, keepdims=True)

    def _support(self, counted: NDArray[np.bool_], escape: float) -> NDArray[np.float64]:
        if not 0 <= escape <= 1:
            raise InputError(f"escape must lie in [0, 1], got {escape}")
        counted = counted | ~counted.any(axis=1, keepdims=True)
        inside = counted / counted.sum(axis=1, keepdims=True)
        return (1 - escape) * inside + escape / self.n_actions

    def sample(
        self, contexts: ArrayLike, generator: np.random.Generator, form: str = "proportion", **form_settings: float
    ) -> NDArray[np.int64]:
        """One action for each context, (n,) int64, drawn from `probs`."""
        contexts = _whole(contexts)
        plain = form == "proportion" and not form_settings and not callable(self.alpha0)
        if plain and len(contexts) >= FEW and self.n_actions <= SEQUENTIAL:
            return self._sample_many(contexts, generator.random(len(contexts)))
        place = self._index.places(contexts)
        if form == "dirichlet":
            probs = self._probs_of(contexts, place, form, generator, **form_settings)
            return _drawn(probs, generator.random(len(place)))
        uniform = generator.random(len(place))
        actions = np.empty(len(place), np.int64)
        for first in range(0, max(1, len(place)), BLOCK):
            rows = slice(first, first + BLOCK)
            actions[rows] = _drawn(
                self._probs_of(contexts[rows], place[rows], form, **form_settings), uniform[rows]
            )
        return actions

    def _sample_many(self, contexts: NDArray[np.int64], uniform: NDArray[np.float64]) -> NDArray[np.int64]:
        if len(self) < MANY or rising(contexts):
            return draw_by_proportion(
                self._counts, self._index.places(contexts), 1 / ONE, self.uniform_alpha0, uniform
            )
        order, in_order = sorted_order(np.ascontiguousarray(contexts))
        actions = np.empty(len(contexts), np.int64)
        actions[order] = self._sample_many(in_order, uniform[order])
        return actions

    def mask(self, contexts: ArrayLike, threshold: float = 0.0) -> NDArray[np.bool_]:
        """Actions whose proportion of the counts exceeds `threshold`, (n, n_actions) bool.

        All True for a context without counts or without such an action. A mask can exclude the best action:
        measure `exclusion_rate` before you rely on it.
        """
        counts = self.counts(contexts)
        total = counts.sum(axis=1, keepdims=True)
        share = np.divide(counts, total, out=np.zeros_like(counts), where=total > 0)
        allowed = share > threshold
        return allowed | ~allowed.any(axis=1, keepdims=True)

    def exclusion_rate(self, contexts: ArrayLike, best: ArrayLike, threshold: float = 0.0) -> float:
        """Share of contexts whose every best action `mask` excludes; `best` as in `update`."""
        best = checked_best(best)
        counted = np.asarray(best.any(axis=1))
        allowed = np.asarray((self.mask(contexts, threshold) & best).any(axis=1))
        return float(np.mean(~allowed[counted])) if counted.any() else 0.0

    def entropy(self, contexts: ArrayLike) -> NDArray[np.float64]:
        """Entropy in nats of the proportions of the counts without α⁰, (n,); log |A| without counts."""
        counts = self.counts(contexts)
        total = counts.sum(axis=1, keepdims=True)
        share = np.divide(counts, total, out=np.full_like(counts, 1 / self.n_actions), where=total > 0)
        return entropy(share)

    def marginalise(self, coarser: ArrayLike, key: str = "") -> "ActionPrior":
        """The prior over coarser contexts; `coarser` (len(self),) holds the new code of each of `contexts`."""
        coarser = np.asarray(coarser, np.int64).ravel()
        if len(coarser) != len(self):
            raise InputError(f"coarser must have one code for each of {len(self)} contexts, got {len(coarser)}")
        result = ActionPrior(self.n_actions, self.uniform_alpha0, key)
        result._add(coarser, self._counts)
        return result

    # ---- tables ----------------------------------------------------------------------------------

    def to_columns(self, labels: Mapping[int, Any] | None = None) -> dict[str, NDArray[Any]]:
        """The prior as columns in long format, one row for each context with counts and each action.

        Parameters
        ----------
        labels : mapping, optional
            Context code to a readable label, such as the features behind it; default: the prior's own labels.

        Returns
        -------
        dict of (n_contexts · n_actions,) arrays
            ``context`` (code), ``label`` (text, if there are labels; the code where they have none), ``action``,
            ``count`` (Σ w U), ``probability`` (``proportion``, sums to 1 over the actions of a context).
        """
        codes = self._codes
        columns: dict[str, NDArray[Any]] = {"context": np.repeat(codes, self.n_actions)}
        shown = self.labels if labels is None else labels
        if shown or labels is not None:
            named = np.array([str(shown.get(code, code)) for code in codes.tolist()], str)
            columns["label"] = np.repeat(named, self.n_actions)
        columns["action"] = np.tile(np.arange(self.n_actions), len(codes))
        columns["count"] = self.counts(codes).ravel()
        columns["probability"] = self.probs(codes).ravel()
        return columns

    def to_frame(self, labels: Mapping[int, Any] | None = None) -> Any:
        """The columns of `to_columns` as a ``pandas.DataFrame``.

        Raises
        ------
        MissingExtraError
            pandas is not installed; Lifelore does not require it.
        """
        try:
            from pandas import DataFrame  # pyright: ignore[reportMissingImports, reportMissingModuleSource]
        except ImportError:
            raise MissingExtraError(
                "to_frame needs pandas, which is not installed: pip install pandas, or use to_columns()"
            ) from None
        return DataFrame(self.to_columns(labels))

    # ---- storing ---------------------------------------------------------------------------------

    def fixed_point_counts(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Contexts (n,) and counts (n, n_actions) as multiples of 1 / `ONE`, without rounding."""
        return self._codes.copy(), self._counts.copy()

    @classmethod
    def from_fixed_point_counts(
        cls, contexts: NDArray[np.int64], counts: NDArray[np.int64], alpha0: float = 0.1, key: str = ""
    ) -> "ActionPrior":
        """The prior of `fixed_point_counts`; contexts must be distinct and ascending, no row of counts all 0."""
        prior = cls(counts.shape[1], alpha0, key)
        prior._index, prior._counts = ContextIndex(contexts.copy()), np.ascontiguousarray(counts.copy())
        return prior

    def to_record(self, about: Mapping[str, Any] | None = None) -> Record:
        """The counts as a record that memory adds; without α⁰, which the reader chooses."""
        context, action = np.nonzero(self._counts)
        slots = self._codes[context] * self.n_actions + action
        return Record(KIND, self.key, VERSION, "add", slots, self._counts[context, action], about or {})

    @classmethod
    def from_record(cls, record: Record, n_actions: int, alpha0: PseudoCounts = 0.1) -> "ActionPrior":
        """The prior in a record."""
        if (record.kind, record.version) != (KIND, VERSION):
            raise InputError(f"record must be {KIND} version {VERSION}, got {record.kind} {record.version}")
        prior = cls(n_actions, alpha0, record.key)
        slots, values = record.slots[record.values != 0], record.values[record.values != 0]
        counts = np.zeros((len(slots), n_actions), np.int64)
        counts[np.arange(len(slots)), slots % n_actions] = values
        prior._add(slots // n_actions, counts)
        return prior

    @classmethod
    def merged(cls, priors: Iterable["ActionPrior"]) -> "ActionPrior":
        """A new prior with the sum of the counts; needs at least one prior."""
        first, *rest = priors
        total = cls(first.n_actions, first.alpha0, first.key)
        for prior in (first, *rest):
            total.merge(prior)
        return total


def _whole(contexts: ArrayLike) -> NDArray[np.int64]:
    given = np.asarray(contexts).ravel()
    if given.dtype.kind not in "iub" and given.size:
        raise InputError(f"contexts must be whole numbers, the codes of contexts, got {given.dtype}")
    return given.astype(np.int64, copy=False)


def _drawn(probs: NDArray[np.float64], uniform: NDArray[np.float64]) -> NDArray[np.int64]:
    """Draw an action from each row (n, n_actions) with a uniform number (n,)."""
    cum = np.ascontiguousarray(probs.T)
    for action in range(1, len(cum)):
        cum[action] += cum[action - 1]
    drawn = uniform * cum[-1]
    actions = np.zeros(len(drawn), np.int64)
    for below in cum[:-1]:
        actions += drawn >= below
    return actions
