"""Logged decisions with the probability of each, as `reuse evaluate` reads them."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.agent.personalise.log.log import ReuseLog, read_log
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.past import each_line_once
from lifelore.core.errors import InputError, NotFoundError
from lifelore.interaction.evaluation.propensity_weights import MOST

CERTAIN = 1 - 1e-9
"""Probability from which a decision counts as without alternative."""
MOST_CERTAIN = 0.05
"""Share of decisions without alternative from which no other policy can be evaluated."""
ALL = "all"


def read_decisions(
    paths: Sequence[str | Path], form: LogFormat | None = None, group: str | None = None
) -> tuple[ReuseLog, str | None]:
    """Read logs with a column ``probability``: the rows of a group, a user's in order of time, and its name.

    Parameters
    ----------
    paths : sequence of paths
    form : LogFormat, optional
    group : str, optional
        Read the rows of this group alone; ``all`` reads every row. By default, of a log that `reuse report` wrote
        the control group is read where the rule's own choices had no alternative, else every row. Users are in
        the control group at random, so no bias follows. The name is None for every row.

    Raises
    ------
    InputError
        A probability is missing, or not above 0 and at most 1 (the message has file and line), or `read_log`
        refuses a log.
    NotFoundError
        There is no such file or group.
    """
    log = each_line_once(read_log(paths, replace(form or LogFormat(), probabilities=True)))
    probability: Any = log.probability
    bad = np.flatnonzero(~((probability > 0) & (probability <= MOST)))
    if bad.size:
        row = int(bad[0])
        came = "it is missing" if np.isnan(probability[row]) else f"got {probability[row]:g}"
        raise InputError(
            f"{paths[log.file[row]]} line {log.line[row]}: probability must be a number above 0 and at most 1, "
            f"that with which the log chose '{log.policy.words[row]}'; {came}"
        )
    group = _group(log) if group is None else group
    if group in (None, ALL):
        return log, None
    groups = [name for name in log.group.names if name]
    if group not in groups:
        there = f"there are {', '.join(groups)}" if groups else "the logs have no column 'group'"
        raise NotFoundError(f"group must be one of the logs' or '{ALL}', got '{group}'; {there}")
    return log.keeping(log.group.codes == log.group.names.index(group), "other_groups"), group


def _group(log: ReuseLog) -> str | None:
    """The control group of a log of `reuse report` in which the rule's own choices had no alternative."""
    if set(log.group.names) != {"control", "personal"}:
        return None
    certain: Any = log.probability >= CERTAIN  # pyright: ignore[reportOptionalOperand]
    control = log.group.codes == log.group.names.index("control")
    return "control" if certain[~control].mean() > MOST_CERTAIN >= certain[control].mean() else None
