"""Whether a task or type is another one than those known: evidence over many causes, of which a few may differ.

A type that is not known answers most causes as known types do, and differs in an unknown share ρ of them:

    log odds = log mean_ρ Π_c ((1 − ρ) + ρ exp(e_c))

where e_c is the evidence of cause c in nats for a law of its own. A single cause must be the more telling the more
causes there are, and many causes may each tell a little.

The alarm takes e_c = log p₀(o) − log P(o) of the first outcome o of each cause, with P that of the known types
given what the task has shown, and p₀ uniform over the outcomes that the cause has shown and one more. The
threshold is a quantile of the largest odds in simulated tasks of known types: the rate of false alarms is stated.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp as _logsumexp

Array = NDArray[np.float64]

SHARES = np.array([0.005, 0.03, 0.2, 0.8])
"""Shares ρ of causes in which another type may differ."""
logsumexp: Any = _logsumexp
N_TASKS = 1000
"""Simulated tasks behind a threshold."""
MOST_CAUSES = 300
"""Most causes of a task that the alarm judges."""
LEAST = 1e-9
"""Least probability of an outcome."""


def log_odds(evidence: Array) -> Any:
    """Log odds of another type, (...), from the evidence of causes in nats, (..., n_causes)."""
    terms = np.log1p(SHARES[:, None] * np.expm1(np.clip(evidence, -700, 700))[..., None, :])
    return logsumexp(terms.sum(axis=-1), axis=-1) - np.log(len(SHARES))


class NoveltyAlarm:
    """The alarm of one task that no known type fits.

    Parameters
    ----------
    laws : (n_types, n_causes, n_effects) float
        P(effect | cause; type).
    base : (n_causes, n_effects) float
        The law p₀ of a cause that a type has for itself.
    prior : (n_types,) float
    frequency : (n_causes,) float
        Number of earlier tasks that showed each cause.
    horizon : float
        Usual number of causes that a task shows.
    false_alarm : float
        Probability of an alarm in a task of a known type, in (0, 1).
    generator : numpy generator

    Attributes
    ----------
    alarm : bool
        Whether it was raised; it stays.
    score : float
        The log odds so far.
    """

    def __init__(
        self,
        laws: Array,
        base: Array,
        prior: Array,
        frequency: Array,
        horizon: float,
        false_alarm: float,
        generator: np.random.Generator,
    ) -> None:
        self._log_laws = np.log(np.maximum(laws, LEAST)).transpose(1, 2, 0).copy()
        self._log_base = np.log(np.maximum(base, LEAST))
        self.horizon = int(np.clip(round(horizon), 1, min(MOST_CAUSES, len(base))))
        self._belief = np.log(np.maximum(prior, LEAST))
        self._odds = np.zeros(len(SHARES))
        self._judged: set[int] = set()
        self.alarm, self.score = False, 0.0
        highest = self._simulated(laws, prior, frequency, generator)
        self.threshold = float(np.quantile(highest, 1 - false_alarm, method="higher"))

    def observe(self, cause: int, effect: int) -> None:
        """Judge the first effect of a cause; later ones, and causes beyond the horizon, do not count."""
        if cause in self._judged or len(self._judged) >= self.horizon:
            return
        self._judged.add(cause)
        before = logsumexp(self._belief)
        self._belief = self._belief + self._log_laws[cause, effect]
        evidence = self._log_base[cause, effect] - (logsumexp(self._belief) - before)
        self._odds += np.log1p(SHARES * np.expm1(evidence))
        self.score = float(logsumexp(self._odds) - np.log(len(SHARES)))
        self.alarm |= self.score > self.threshold

    def _simulated(self, laws: Array, prior: Array, frequency: Array, generator: np.random.Generator) -> Array:
        """The largest log odds in each of `N_TASKS` tasks of known types, (N_TASKS,)."""
        # The largest of log frequency + Gumbel noise come first: a draw without replacement, by frequency.
        noise = generator.gumbel(size=(N_TASKS, len(frequency)))
        order = np.argsort(-(np.log(np.maximum(frequency, 0.5)) + noise), axis=1)[:, : self.horizon]
        types = generator.choice(len(prior), N_TASKS, p=prior)
        levels = generator.random(order.shape)
        effects = (laws[types[:, None], order].cumsum(axis=2) <= levels[..., None]).sum(axis=2)
        effects = np.minimum(effects, laws.shape[2] - 1)
        joint = np.log(np.maximum(prior, LEAST)) + self._log_laws[order, effects].cumsum(axis=1)
        mixture = logsumexp(joint, axis=2)
        given = np.diff(mixture, axis=1, prepend=0.0)
        terms = np.log1p(SHARES[:, None, None] * np.expm1(self._log_base[order, effects] - given))
        return (logsumexp(terms.cumsum(axis=2), axis=0) - np.log(len(SHARES))).max(axis=1)
