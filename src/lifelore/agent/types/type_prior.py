"""Prior over types in a context, learnt from past posteriors: an action prior whose actions are the types.

    n_d(c, τ) = Σ of β_end(τ) over the tasks of date d in context c        as counts of actions
    N_h(c, τ) = Σ_d 2^(−age of d / h) n_d(c, τ)                            decay on read, half-life h
    P_h(τ)    = (N_h(·, τ) + k₀ G₀(τ)) / (ΣN_h + k₀)                       in any context
    P_hk(τ|c) = (N_h(c, τ) + k P_h(τ)) / (ΣN_h(c) + k)                     in context c
    P(τ|c)    = Σ_hk w_hk P_hk(τ|c),   w_hk ∝ Π_d Π_c,τ P_hk(τ | c, before d)^n_d(c, τ)

Nobody has to say how fast types drift or whether contexts tell anything: half-lives h and weights k of all
contexts compete by how well they predicted the dates that followed, and k = ∞ ignores the context. Counts are
dated and never decay in memory, so those of several robots merge by addition. Thesis: §5.2, with §3.2's class.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lifelore.core.errors import InputError

Array = NDArray[np.float64]

HALF_LIVES = (np.inf, 64.0, 16.0, 4.0)
"""Half-lives that compete, in dates; more cost time in proportion."""
SHARED = (0.5, 2.0, 8.0, np.inf)
"""Weights k of all contexts that compete, in tasks; at infinity the context is ignored, below 1 one task in a
context tells more than all others."""
LIBRARY_TASKS = 4.0
"""Weight k₀ of the library's prior, in tasks; more trust it longer."""


class TypePrior:
    """Prior over types, by context and date.

    Parameters
    ----------
    library_prior : (n_types,) float
        G₀; sums to 1.
    half_lives : sequence of float
        Half-lives h that compete, in dates, above 0; infinity never forgets.

    Raises
    ------
    InputError
        The library's prior is no distribution, or a half-life is not above 0.

    Examples
    --------
    >>> prior = TypePrior([0.5, 0.5])
    >>> for date in range(20):
    ...     prior.learn(context=7, belief=[0.9, 0.1], date=date)
    ...     prior.learn(context=8, belief=[0.0, 1.0], date=date)
    >>> prior.prior(7, date=20).round(2).tolist(), prior.prior(8, date=20).round(2).tolist()
    ([0.88, 0.12], [0.02, 0.98])
    """

    def __init__(self, library_prior: ArrayLike, half_lives: Sequence[float] = HALF_LIVES) -> None:
        self.library_prior: Array = np.asarray(library_prior, np.float64)
        given = self.library_prior
        if given.ndim != 1 or not (len(given) and (given >= 0).all() and abs(given.sum() - 1) <= 1e-9):
            raise InputError(f"library_prior must be at least 0 and sum to 1, got shape {given.shape}")
        if not len(half_lives) or not all(half_life > 0 for half_life in half_lives):
            raise InputError(f"half_lives must be above 0, at least one, got {half_lives}")
        self.half_lives = tuple(half_lives)
        self.dates: dict[int, dict[int, Array]] = {}
        self._forget_past()

    @classmethod
    def of_types(cls, types: Sequence[Iterable[Mapping[tuple[int, int], float]]]) -> Self:
        """The prior over types, with a uniform G₀, from the belief in their members by date and context."""
        n_types = max(len(types), 1)  # without types, of one that was never seen
        made = cls(np.full(n_types, 1 / n_types))
        for type_, members in enumerate(types):
            for seen in members:
                for (date, context), belief in seen.items():
                    counts = made.dates.setdefault(date, {})
                    if context not in counts:
                        counts[context] = np.zeros(n_types)
                    counts[context][type_] += belief
        made._forget_past()
        return made

    @property
    def n_types(self) -> int:
        """Number of types."""
        return len(self.library_prior)

    # ---- learning --------------------------------------------------------------------------------

    def learn(self, context: int, belief: ArrayLike, date: int) -> None:
        """Count the belief over types (n_types,) at the end of a task, or the sum of those of several tasks.

        Parameters
        ----------
        context : int
            Code of the tasks' context.
        belief : (n_types,) float
            At least 0; it sums to the number of tasks.
        date : int
            Number of the day, or of any other span in which types hardly drift; tasks may come in any order.

        Raises
        ------
        InputError
            The belief is not of the types, or below 0.
        """
        belief = np.asarray(belief, np.float64)
        if belief.shape != (self.n_types,) or not (belief >= 0).all():
            raise InputError(f"belief must be ({self.n_types},) and at least 0, got {belief!r:.80}")
        counts = self.dates.setdefault(date, {})
        counts[context] = counts.get(context, 0.0) + belief
        if date < self._next_date:
            self._forget_past()

    # ---- reading ---------------------------------------------------------------------------------

    def prior(self, context: int, date: int) -> Array:
        """Prior over types in a context, (n_types,), sums to 1; from the counts of this date and those before."""
        self._read_until(date)
        experts = self._predictions([context], date, self.dates.get(date, {}))[0]
        return np.einsum("hk,hkt->t", self._weights(), experts)

    def _weights(self) -> Array:
        weights = np.exp(self._log_weights - self._log_weights.max())
        return weights / weights.sum()

    def _predictions(self, contexts: Iterable[int], date: int, today: Mapping[int, Array]) -> Array:
        """P_hk(τ | c), (n_contexts, n_half_lives, n_shared, n_types), with the counts of `today`."""
        in_context = np.stack([self._decayed(context, date) + today.get(context, 0.0) for context in contexts])
        everywhere = self._decayed(None, date) + sum(today.values())
        total = everywhere.sum(axis=-1, keepdims=True)
        anywhere = (everywhere + LIBRARY_TASKS * self.library_prior) / (total + LIBRARY_TASKS)
        total = in_context.sum(axis=-1, keepdims=True)
        found = np.empty((len(in_context), len(self.half_lives), len(SHARED), self.n_types))
        for place, shared in enumerate(SHARED):
            weight = 0.0 if np.isinf(shared) else 1 / (total + shared)
            found[:, :, place] = weight * in_context + (1 - weight * total) * anywhere
        return found

    # ---- the past, decayed -----------------------------------------------------------------------

    def _forget_past(self) -> None:
        """Read all dates again at the next question."""
        self._past: dict[int | None, tuple[int, Array]] = {}
        self._log_weights = np.zeros((len(self.half_lives), len(SHARED)))
        self._next_date = min(self.dates, default=0)

    def _read_until(self, date: int) -> None:
        """Take the dates before `date` into the past, and weigh the experts by how they predicted each."""
        if date < self._next_date:
            self._forget_past()
        for past in sorted(one for one in self.dates if self._next_date <= one < date):
            counts = self.dates[past]
            logs = np.log(np.maximum(self._predictions(counts, past, {}), np.finfo(float).tiny))
            self._log_weights += np.einsum("ct,chkt->hk", np.stack(list(counts.values())), logs)
            for context, row in (*counts.items(), (None, sum(counts.values()))):
                self._past[context] = past, self._decayed(context, past) + row
        self._next_date = max(self._next_date, date)

    def _decayed(self, context: int | None, date: int) -> Array:
        """N_h(c, ·) of the dates before, (n_half_lives, n_types); None is any context."""
        if context not in self._past:
            return np.zeros((len(self.half_lives), self.n_types))
        last, rows = self._past[context]
        return rows * 0.5 ** ((date - last) / np.array(self.half_lives))[:, None]
