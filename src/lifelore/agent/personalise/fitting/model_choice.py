"""Which model of outcomes, and with how many types, serves users best who were held out when it was fitted.

Candidates are types with categories where outcomes have few values, types with normal outcomes, and jointly normal
outcomes with a single type and with the types found. Where outcomes differ between contexts beyond chance, each
family has candidates with types by context too. Each of `PARTS` parts of the users is held out once; they come
with their contexts.

Among numbers of types, the smallest wins that is not clearly below the number with the best log score, by log
scores and choices together. Of all candidates whose choices are not clearly worse than the best, the first wins in
the same way: categories before normal and these before jointly normal outcomes, types by context before types of
everybody, few types before many. So what is not needed is not personalised, but contexts that differ count.
"""

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.fitting.held_out import COUNTED, HeldOut, Scores
from lifelore.agent.personalise.fitting.library_from_log import Fitted
from lifelore.agent.personalise.fitting.types_by_context import contexts_differ, priors_by_context
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.core.errors import InputError

Array = NDArray[np.float64]

PARTS = 3
"""Parts of the users, each held out once; more cost time."""
LEAST_USERS = 12
"""Number of users with two outcomes below which nothing is held out."""
MOST_USERS, MOST_NUMBERS = (1500, 3000), 100_000
"""Size of the random sample of users, and most pairs of a user and a policy, to which the sample is cut between
these sizes; more cost time."""
FEW_VALUES = 10
"""Outcomes of at most so many different values may be categories."""
MOST_TYPES, PATIENCE = 12, 2
"""Largest number of types, and numbers of types tried beyond the best so far."""
CLEARLY, TOGETHER = 1.64, 1.0
"""Standard errors of the mean difference between users beyond which a candidate is clearly worse: by choices alone
or where it personalises nothing; and by log scores and choices together."""


class Kind(NamedTuple):
    """A kind of library: a model, a number of types (None: those that the log names), and whether by context."""

    model: str
    types: int | None
    by_context: bool = False


Fit = Callable[[ReuseLog, Kind], Fitted]


class Candidate(NamedTuple):
    """A kind of library, its scores of the held-out users, and the libraries of the parts."""

    kind: Kind
    scores: Scores
    fitted: list[Fitted]


class ModelChoice(NamedTuple):
    """A kind of library, and how it was chosen.

    held_out : None where too few users could be held out
    """

    kind: Kind
    held_out: dict[str, Any] | None = None


def chosen_model(
    log: ReuseLog, model: str, types: int | None, fit: Fit, generator: np.random.Generator
) -> ModelChoice:
    """The model and number of types for a log.

    Parameters
    ----------
    model : str
        A family, or ``auto`` for all. Joint-normal outcomes have a single type where `types` is not given.
    types : int, optional
        Number of types; by default chosen.
    fit : callable
        ``fit(log, kind)`` gives the library of a part of the log.

    Raises
    ------
    InputError
        The log names types and `types` is given.
    """
    if types is not None and log.says_types:
        raise InputError("types must be left out where the log has a column 'type'; it names them")
    given = None if log.says_types else types or 1
    if model == "joint-normal" or (model != "auto" and (types or log.says_types)):
        return ModelChoice(Kind(model, given))
    rows, users = _sample(log, generator)
    differ = not (log.says_types or log.feature_names) and contexts_differ(log)
    if users < max(LEAST_USERS, 2 * (types or 0)):
        return ModelChoice(Kind(_families(log, model)[-1], given, differ))
    trial = _Trial(log.take(rows), fit, generator)
    sizes = range(1, min(MOST_TYPES, users // 2) + 1) if types is None else [types]
    plain = [trial.best_size(family, [None] if log.says_types else sizes) for family in _families(log, model)]
    kinds = [one.kind for one in plain]
    if model == "auto" and not log.says_types and log.weights is None:
        kinds += [Kind("joint-normal", size) for size in sorted({types or 1, kinds[-1].types or 1})]
    best = _best(trial.candidates(_with_contexts(kinds, types or 1) if differ else kinds))
    return ModelChoice(best.kind, trial.document(best))


def _with_contexts(kinds: list[Kind], least: int) -> list[Kind]:
    """The kinds, and before those of each family the same by context, also with the least number of types."""
    found: list[Kind] = []
    for model in dict.fromkeys(kind.model for kind in kinds):
        own = [kind for kind in kinds if kind.model == model]
        sizes = {least, *(kind.types or 1 for kind in own)}
        if model == "joint-normal":
            sizes &= {1}  # by context, its means are those of a single type
        found += [Kind(model, size, True) for size in sorted(sizes)] + own
    return found


def _families(log: ReuseLog, model: str) -> list[str]:
    """Models of types to compare, the simplest first."""
    if model != "auto":
        return [model]
    n_values = len(np.unique(log.outcomes))
    return ["categorical"] * (1 < n_values <= FEW_VALUES) + ["gaussian"] * (n_values != 2)


class _Trial:
    """Candidates tried on the same held-out users."""

    def __init__(self, log: ReuseLog, fit: Fit, generator: np.random.Generator) -> None:
        self._fit, self.tried = fit, list[Candidate]()
        part = generator.permutation(len(log.user.names)) % PARTS
        rows = [np.flatnonzero(part[log.user.codes] == number) for number in range(PARTS)]
        self._logs = [log.take(np.flatnonzero(part[log.user.codes] != number)) for number in range(PARTS)]
        self._held_out = [HeldOut(log.take(own)) for own in rows]
        means = [_policy_means(*pair) for pair in zip(self._logs, self._held_out, strict=True)]
        pairs = list(zip(self._held_out, means, strict=True))
        self.single = np.concatenate([users.by_means(mean) for users, mean in pairs])
        self.counting = np.concatenate([users.by_means(mean, COUNTED) for users, mean in pairs])

    def best_size(self, model: str, sizes: Iterable[int | None]) -> Candidate:
        """The candidate of a family with the number of types that serves best."""
        found: list[Candidate] = []
        for size in sizes:
            found.append(self._candidate(Kind(model, size)))
            means = [one.scores.log_score.mean() for one in found]
            if len(found) - 1 - int(np.argmax(means)) >= PATIENCE:
                break
        return _simplest(found)

    def candidates(self, kinds: list[Kind]) -> list[Candidate]:
        """The candidates of these kinds, in this order."""
        known = {one.kind: one for one in self.tried}
        return [known.get(kind) or self._candidate(kind) for kind in kinds]

    def _candidate(self, kind: Kind) -> Candidate:
        fitted = [self._fit(log, kind) for log in self._logs]
        self.tried.append(Candidate(kind, self._scores(fitted), fitted))
        return self.tried[-1]

    def _scores(self, fitted: list[Fitted], with_contexts: bool = True) -> Scores:
        parts = []
        for log, users, found in zip(self._logs, self._held_out, fitted, strict=True):
            priors = priors_by_context(log, found) if with_contexts else {}
            parts.append(users.of_library(found.library, priors))
        return Scores(*(np.concatenate(part) for part in zip(*parts, strict=True)))

    def document(self, best: Candidate) -> dict[str, Any]:
        """The choice as plain data; differences have 95 % intervals."""
        value, blind = best.scores.value, self._scores(best.fitted, with_contexts=False).value
        return {
            "users": int((~np.isnan(value)).sum()),
            "value": _mean(value),
            "over_single": _interval(value - self.single),
            "over_counting": _interval(value - self.counting),
            "over_unknown_context": _interval(value - blind),
            "candidates": [
                {
                    **one.kind._asdict(),
                    "log_score": float(one.scores.log_score.mean()),
                    "over_single": _interval(one.scores.value - self.single),
                }
                for one in self.tried
            ],
        }


def _sample(log: ReuseLog, generator: np.random.Generator) -> tuple[NDArray[np.int64], int]:
    """Rows of users with two outcomes, or of a sample of them, and the number of these users."""
    serves = log.type_of_user >= 0 if log.says_types else np.ones(len(log.user.names), bool)
    users = np.flatnonzero(serves & (np.bincount(log.user.codes) > 1))
    most = int(np.clip(MOST_NUMBERS // len(log.policy.names), *MOST_USERS))
    if len(users) > most:
        users = generator.choice(users, most, replace=False)
    return np.flatnonzero(np.isin(log.user.codes, users)), len(users)


def _policy_means(log: ReuseLog, held_out: HeldOut) -> Array:
    """Mean outcome in `log` of each policy of the held-out users; lowest where it has none."""
    number = np.bincount(log.policy.codes)
    means = dict(zip(log.policy.names, np.bincount(log.policy.codes, log.outcomes) / number, strict=True))
    return np.array([means.get(policy, log.outcomes.min()) for policy in held_out.log.policy.names])


def _best(found: list[Candidate]) -> Candidate:
    """The simplest of candidates whose choices are not clearly worse than the best's."""
    top = max(found, key=lambda one: _mean(one.scores.value))
    return _simplest([one for one in found if _errors(one.scores.value - top.scores.value) > -CLEARLY])


def _simplest(found: list[Candidate]) -> Candidate:
    """The first that, by log score and value together, is not clearly below that of the best log score."""
    best = max(found, key=lambda one: one.scores.log_score.mean()).scores
    for one in found:
        score, value = (_errors(own - other) for own, other in zip(one.scores, best, strict=True))
        alike = one.kind == Kind(one.kind.model, 1) and one.kind.model != "joint-normal"
        if (score + value) / np.sqrt(2) >= -(CLEARLY if alike else TOGETHER):
            break
    return one  # pyright: ignore[reportPossiblyUnboundVariable]


def _errors(differences: Array) -> float:
    """Mean of users' differences in standard errors, NaN left out; 0 where they do not vary."""
    known = differences[~np.isnan(differences)]
    spread = float(known.std(ddof=1)) if len(known) > 1 else 0.0
    return float(known.mean()) / spread * np.sqrt(len(known)) if spread > 0 else 0.0


def _mean(numbers: Array) -> float:
    """Mean of users' numbers, NaN left out; 0 where there is none."""
    known = numbers[~np.isnan(numbers)]
    return float(known.mean()) if known.size else 0.0


def _interval(differences: Array) -> list[float] | None:
    """Mean of users' differences, NaN left out, and the ends of its interval; None for fewer than two users."""
    known = differences[~np.isnan(differences)]
    if len(known) < 2:
        return None
    mean, half = float(known.mean()), 1.96 * float(known.std(ddof=1)) / np.sqrt(len(known))
    return [mean, mean - half, mean + half]
