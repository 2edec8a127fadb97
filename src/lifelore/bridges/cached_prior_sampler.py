"""Draws single actions from a prior fast: the probabilities of each context are computed once and cached."""

from bisect import bisect_right
from typing import Any

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior


class CachedPriorSampler:
    """Draws from the distribution of `ActionPrior.sample`, with the counts at the first draw of each context.

    Parameters
    ----------
    prior : ActionPrior
    form : str
        See `lifelore.action.priors.action_prior.FORMS`; ``dirichlet`` is drawn anew each time.
    form_settings : dict
        ``beta`` or ``escape`` of that form.

    Examples
    --------
    >>> prior = ActionPrior(2)
    >>> prior.update([7], [[False, True]])
    >>> CachedPriorSampler(prior, "support", {"escape": 0.0}).draw(7, np.random.default_rng(0))
    1
    """

    def __init__(self, prior: ActionPrior, form: str, form_settings: dict[str, Any]) -> None:
        self._prior, self._form, self._form_settings = prior, form, form_settings
        self._rows: dict[int, list[float]] = {}
        if form != "dirichlet":
            prior.probs([0], form, **form_settings)  # refuses wrong settings before the first draw

    def forget(self) -> None:
        """Drop the cached probabilities; later draws use the present counts."""
        self._rows.clear()

    def draw(self, code: int, generator: np.random.Generator) -> int:
        """Draw an action for one context."""
        if self._form == "dirichlet":
            return int(self._prior.sample([code], generator, "dirichlet")[0])
        row = self._rows.get(code)
        if row is None:
            # The last sum is 1 up to rounding: a number above all other sums draws the last action.
            row = np.cumsum(self._prior.probs([code], self._form, **self._form_settings)[0])[:-1].tolist()
            self._rows[code] = row
        return bisect_right(row, generator.random())
