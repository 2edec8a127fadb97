"""Logged decisions with the probability of each, as `reuse evaluate` reads them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.log.log import ReuseLog, read_log
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.evaluation.propensity_weights import MOST

CERTAIN = 1 - 1e-9
"""Probability from which a decision counts as without alternative."""
MOST_CERTAIN = 0.05
"""Share of decisions without alternative from which no other policy can be evaluated."""
ALL = "all"


@dataclass(frozen=True, eq=False)
class LoggedDecisions:
    """Decisions with a known outcome, one a row, a user's in order of time.

    Parameters
    ----------
    log : ReuseLog
    probability : (n,) float64
        Of the logged policy, above 0 and at most 1.
    group : str, optional
        The group that the rows are from; None for all.
    left_out : int
        Rows of other groups.
    """

    log: ReuseLog
    probability: NDArray[np.float64]
    group: str | None = None
    left_out: int = 0

    def take(self, rows: NDArray[np.int64]) -> "LoggedDecisions":
        """The decisions at some places alone."""
        return replace(self, log=self.log.take(rows), probability=self.probability[rows])


def read_decisions(
    paths: Sequence[str | Path], form: LogFormat | None = None, group: str | None = None
) -> LoggedDecisions:
    """Read logs with a column ``probability``.

    Parameters
    ----------
    paths : sequence of paths
    form : LogFormat, optional
    group : str, optional
        Read the rows of this group alone; ``all`` reads every row. By default, of a log that `reuse report` wrote
        the control group is read where the rule's own choices had no alternative, else every row. Users are in
        the control group at random, so no bias follows.

    Raises
    ------
    InputError
        A probability is missing, or not above 0 and at most 1 (the message has file and line), or `read_log`
        refuses a log.
    NotFoundError
        There is no such file or group.
    """
    form = replace(form or LogFormat(), probabilities=True)
    log = read_log(paths, form)
    probability = _probabilities(log, paths, form.decimal_comma)
    group = _group(log, probability) if group is None else group
    if group in (None, ALL):
        return LoggedDecisions(log, probability)
    groups = [name for name in log.group.names if name]
    if group not in groups:
        there = f"there are {', '.join(groups)}" if groups else "the logs have no column 'group'"
        raise NotFoundError(f"group must be one of the logs' or '{ALL}', got '{group}'; {there}")
    rows = np.flatnonzero(log.group.codes == log.group.names.index(group))
    return LoggedDecisions(log.take(rows), probability[rows], group, len(log) - len(rows))


def _probabilities(log: ReuseLog, paths: Sequence[str | Path], decimal_comma: bool) -> NDArray[np.float64]:
    by_word = np.array([_probability(word, decimal_comma) for word in log.probability.names])
    found = by_word[log.probability.codes]
    bad = np.flatnonzero(~((found > 0) & (found <= MOST)))
    if bad.size:
        row = int(bad[0])
        where = f"{paths[log.file[row]]} line {log.line[row]}"
        word = log.probability.names[log.probability.codes[row]]
        came = f"got {word[:60]!r}" if word else "it is missing"
        raise InputError(
            f"{where}: probability must be a number above 0 and at most 1, that with which the log chose "
            f"'{log.policy.names[log.policy.codes[row]]}'; {came}"
        )
    return found


def _probability(word: str, decimal_comma: bool) -> float:
    """The number, or NaN."""
    try:
        return float(word.replace(",", ".") if decimal_comma else word)
    except ValueError:
        return np.nan


def _group(log: ReuseLog, probability: NDArray[np.float64]) -> str | None:
    """The control group of a log of `reuse report` in which the rule's own choices had no alternative."""
    if set(log.group.names) != {"control", "personal"}:
        return None
    certain = probability >= CERTAIN
    control = log.group.codes == log.group.names.index("control")
    return "control" if certain[~control].mean() > MOST_CERTAIN >= certain[control].mean() else None
