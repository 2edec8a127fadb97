"""Actions drawn from a prior one at a time and fast: each context's probabilities are read once and kept."""

from bisect import bisect_right
from typing import Any

import numpy as np

from lifelore.action.priors.action_prior import ActionPrior


class KeptDraws:
    """The law of `ActionPrior.sample`, of the counts as they stood when a context was first asked for.

    Parameters
    ----------
    prior : ActionPrior
    form : str
        See `lifelore.action.priors.action_prior.FORMS`; a new draw of ``dirichlet`` is made each time.
    how : dict
        ``beta`` or ``escape`` of that form.

    Examples
    --------
    >>> prior = ActionPrior(2)
    >>> prior.update([7], [[False, True]])
    >>> KeptDraws(prior, "support", {"escape": 0.0}).draw(7, np.random.default_rng(0))
    1
    """

    def __init__(self, prior: ActionPrior, form: str, how: dict[str, Any]) -> None:
        self._prior, self._form, self._how = prior, form, how
        self._rows: dict[int, list[float]] = {}
        if form != "dirichlet":
            prior.probs([0], form, **how)  # refuses what cannot be drawn from, before anything is learnt

    def forget(self) -> None:
        """Read the counts anew from now on."""
        self._rows.clear()

    def draw(self, code: int, generator: np.random.Generator) -> int:
        """An action for one context."""
        if self._form == "dirichlet":
            return int(self._prior.sample([code], generator, "dirichlet")[0])
        row = self._rows.get(code)
        if row is None:
            # The last sum is 1 but for rounding: what exceeds all the others falls to the last action.
            row = np.cumsum(self._prior.probs([code], self._form, **self._how)[0])[:-1].tolist()
            self._rows[code] = row
        return bisect_right(row, generator.random())
