"""Whether a task or type is another one than those known: evidence over many causes, of which a few may differ.

A type that is not known answers most causes as known types do, and differs in an unknown share ρ of them:

    log odds = Σ_kinds log mean_ρ Π_c ((1 − ρ) + ρ exp(e_c))

over the causes c of a kind (moves, rewards), where e_c is the evidence of cause c in nats for a law of its own.
Where known types differ, another one probably does too; elsewhere a single cause must be the more telling the more
causes there are, and many causes may each tell a little.

The alarm takes e_c = log p₀(o) − log P(o) of the first outcome o of each cause, with P that of the known types
given what the task has shown, and p₀ uniform over the outcomes that the cause has shown and one more. The
threshold is a quantile of the largest odds in simulated tasks of known types: the rate of false alarms is stated.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SHARES = np.array([0.0, 0.005, 0.03, 0.2, 0.8])
"""Shares ρ of causes in which another type may differ; 0 for one that differs in moves or rewards alone."""
logsumexp = np.logaddexp.reduce
AGAIN = 0.5
"""Probability that another type differs where known types differ."""
N_TASKS = 600
"""Simulated tasks behind a threshold."""
MOST_CAUSES = 300
"""Most causes of a task that the alarm judges."""
LEAST = 1e-9
"""Least probability of an outcome."""


def shares(apart: Array) -> Array:
    """Probability that another type differs in each cause, (n_shares, n_causes), from q of the known types."""
    return SHARES[:, None] + (1 - SHARES[:, None]) * AGAIN * apart


def log_odds(evidence: Array, kinds: NDArray[np.int64], apart: Array) -> float:
    """Log odds of another type from the evidence of causes in nats.

    Parameters
    ----------
    evidence, kinds, apart : (n_causes,)
        Each kind has a share ρ of its own; ``apart`` is q, see `shares`. Among causes of one kind it is not 0.
    """
    terms = np.log1p(shares(apart) * np.expm1(np.clip(evidence, -700, 700)))
    found = np.unique(kinds).tolist()
    if len(found) == 1:
        terms = terms[1:]
    return sum(float(logsumexp(terms[:, kinds == kind].sum(axis=1)) - np.log(len(terms))) for kind in found)


class NoveltyAlarm:
    """The alarm of one task that no known type fits.

    Parameters
    ----------
    laws : (n_types, n_causes, n_effects) float
        P(effect | cause; type).
    broad : (n_causes, n_effects) float
        The law p₀ of a cause of which nothing is known.
    kinds : (n_causes,) int64
        0 for moves, 1 for rewards.
    apart : (n_causes,) float
        Probability that known types differ in a cause.
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
        broad: Array,
        kinds: NDArray[np.int64],
        apart: Array,
        prior: Array,
        frequency: Array,
        horizon: float,
        false_alarm: float,
        generator: np.random.Generator,
    ) -> None:
        self._log_laws = np.log(np.maximum(laws, LEAST)).transpose(1, 2, 0).copy()
        self._log_broad = np.log(np.maximum(broad, LEAST))
        self.horizon = int(np.clip(round(horizon), 1, min(MOST_CAUSES, len(broad))))
        self._belief = np.log(np.maximum(prior, LEAST))
        self._kinds, self._shares = kinds, shares(apart)
        self._odds = np.zeros((int(kinds.max(initial=0)) + 1, len(SHARES)))
        self._judged: set[int] = set()
        self.alarm, self.score = False, 0.0
        highest = self._simulated(laws, prior, frequency, generator)
        self.threshold = float(np.quantile(highest, 1 - false_alarm, method="higher"))

    def observe(self, cause: int, effect: int) -> None:
        """Judge the first effect of a cause; later ones do not count, and beyond the horizon raise no alarm."""
        if cause in self._judged:
            return
        before = logsumexp(self._belief)
        self._belief = self._belief + self._log_laws[cause, effect]
        self._judged.add(cause)
        if len(self._judged) > self.horizon:
            return
        evidence = self._log_broad[cause, effect] - (logsumexp(self._belief) - before)
        self._odds[self._kinds[cause]] += np.log1p(self._shares[:, cause] * np.expm1(evidence))
        self.score = float((logsumexp(self._odds, axis=1) - np.log(len(SHARES))).sum())
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
        terms = np.log1p(self._shares[:, order] * np.expm1(self._log_broad[order, effects] - given))
        odds = np.zeros(order.shape)
        for kind in range(len(self._odds)):
            own = np.where(self._kinds[order] == kind, terms, 0.0).cumsum(axis=2)
            odds += logsumexp(own, axis=0) - np.log(len(SHARES))
        return odds.max(axis=1, initial=-np.inf)
