"""Traffic of a study in its last days, and the alarms that follow from it.

    points     decisions, outcomes and their sums by hour or day, of both groups
    ratio      is the share of users in the control group the share that was set? χ² of one degree of freedom
    missing    decisions older than a day that have no outcome
    drift      mean outcome of users in the second half of the window less that in the first half, by group
    beliefs    of a sample of users: mean entropy, and the share whom no known type fits

Counts are of all decisions in the window; ratio and drift are of at most some `MOST` decisions of whole users.
"""

import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from math import erfc, sqrt
from typing import Any

import numpy as np

from lifelore.agent.personalise.beliefs import open_beliefs, unknown_probability
from lifelore.agent.personalise.calibration import difference
from lifelore.agent.personalise.study import Study
from lifelore.core.errors import InputError
from lifelore.memory import Memory
from lifelore.memory.study_totals import UserHalves

HOUR, DAY = 3_600_000, 86_400_000
MOST = 100_000
"""Decisions that are read by user, about; more take longer and notice smaller differences."""
SAMPLE = 200
"""Users whose beliefs are read; more take longer, and the shares are less noisy."""
LEAST_EXPECTED = 5
"""Expected users in either group below which the χ² approximation is poor."""
RATIO_P, MISSING, UNKNOWN = 0.001, 0.1, 0.05
"""An alarm is a p value below the first, or a share above the second or the third."""


def traffic(memory: Memory, study: Study, days: int = 14, now: int | None = None) -> dict[str, Any]:
    """What a study decided in its last days.

    Parameters
    ----------
    days : int
        At least 2, the current one included; up to 2 are counted by hour, more by day (UTC).
    now : int, optional
        Milliseconds since 1970.

    Returns
    -------
    dict
        ``study``; ``since``, ``until``, ``step`` in seconds; ``points``: ``time`` and for ``personal`` and
        ``control`` each {"decisions", "outcomes", "sum"}; ``policies``: ``name``, ``state`` (None: none of the
        study any more), ``share`` of the decisions, ``expected`` outcome for a stranger (None: not known);
        ``ratio``, ``missing``, ``drift``, ``beliefs`` (each None where there is too little); ``alarms``:
        ``kind``, one of these four names, and ``message``.
    """
    now = time.time_ns() // 10**6 if now is None else now
    step = HOUR if days <= 2 else DAY
    until = (now // step + 1) * step
    since = until - days * DAY
    with memory.studies.totals(study.number) as totals:
        counts = {at: totals.counts(at, at + step) for at in range(since, until, step)}
        n = sum(row[2] for rows in counts.values() for row in rows)
        # An odd divisor, so that users who were added in turns of two or ten are all drawn from.
        every = n // MOST | 1
        halves = totals.halves(since, (since + until) // 2, version=study.version, every=every)
    checks = {
        "ratio": _ratio(halves, study.control),
        "missing": _missing({at: rows for at, rows in counts.items() if at + step <= now - DAY}),
        "drift": {
            "personal": _drift(halves, 0),
            "control": _drift(halves, 1),
        },
        "beliefs": _beliefs(memory, study, halves),
    }
    return {
        "study": study.name,
        "since": since // 1000,
        "until": until // 1000,
        "step": step // 1000,
        "points": [
            {"time": at // 1000, "personal": _summed(rows, 0), "control": _summed(rows, 1)}
            for at, rows in counts.items()
        ],
        "policies": _policies(study, counts, n),
        **checks,
        "alarms": [{"kind": kind, "message": message} for kind, message in _alarms(checks)],
    }


def ratio_p(control: int, users: int, share: float) -> float | None:
    """The p value of so many users in the control group; None where fewer than 5 are expected in a group.

    Pearson's χ² of two cells: (o − e)² / (n s (1 − s)) with e = n s.
    """
    expected = users * share
    if min(expected, users - expected) < LEAST_EXPECTED:
        return None
    return erfc(sqrt((control - expected) ** 2 / (expected * (1 - share)) / 2))


def _summed(rows: Sequence[tuple[Any, ...]], control: int) -> dict[str, float]:
    own = [row[2:] for row in rows if row[1] == control]
    return {name: sum(row[place] for row in own) for place, name in enumerate(("decisions", "outcomes", "sum"))}


def _policies(study: Study, counts: dict[int, list[tuple[Any, ...]]], n: int) -> list[dict[str, Any]]:
    decided: dict[str, int] = dict.fromkeys(study.states, 0)
    for rows in counts.values():
        for policy, _, decisions, *_ in rows:
            decided[policy] = decided.get(policy, 0) + decisions
    return [
        {
            "name": policy,
            "state": study.states.get(policy),
            "share": decided[policy] / n if n else None,
            "expected": study.expected(policy),
        }
        for policy in sorted(decided)
    ]


def _ratio(halves: UserHalves, share: float) -> dict[str, Any] | None:
    """Users of decisions by the newest version, for an earlier one may have held out another share."""
    users, control = int((halves.current > 0).sum()), int(halves.control[halves.current > 0].sum())
    p = ratio_p(control, users, share)
    return (
        None if p is None else {"users": users, "control": control, "share": control / users, "set": share, "p": p}
    )


def _missing(counts: dict[int, list[tuple[Any, ...]]]) -> dict[str, Any] | None:
    decisions = sum(row[2] for rows in counts.values() for row in rows)
    ended = sum(row[3] for rows in counts.values() for row in rows)
    missing = decisions - ended
    return {"decisions": decisions, "missing": missing, "share": missing / decisions} if decisions else None


def _drift(halves: UserHalves, control: int) -> dict[str, Any] | None:
    """Mean over users of a group after the middle less that before, with Welch's interval."""
    own = halves.control == control
    before, after = own & (halves.before > 0), own & (halves.after > 0)
    means = halves.after_sum[after] / halves.after[after], halves.before_sum[before] / halves.before[before]
    return difference(*means)


def _beliefs(memory: Memory, study: Study, halves: UserHalves) -> dict[str, Any] | None:
    people = np.unique(halves.person[halves.before + halves.after > 0]).astype(np.int64)
    if not len(people):
        return None
    if len(people) > SAMPLE:
        people = np.random.default_rng(0).choice(people, SAMPLE, replace=False)
    with memory.studies.reading(study.number) as rows:
        users = list(rows.numbered(people.tolist()).values())
        evidence = rows.evidence([user.number for user in users])
        algorithm = open_beliefs(rows, study, users).algorithm
    log_belief = algorithm.log_belief.astype(np.float64)
    entropy = -np.where(np.isfinite(log_belief), np.exp(log_belief) * log_belief, 0.0).sum(axis=1)
    unknown = None
    with suppress(InputError):  # there is no broad type for such signals
        unknown = float((unknown_probability(study, users, evidence) > 0.5).mean())
    return {"users": len(users), "entropy": float(entropy.mean()), "unknown": unknown}


def _alarms(checks: dict[str, Any]) -> Iterator[tuple[str, str]]:
    ratio, missing, beliefs = checks["ratio"], checks["missing"], checks["beliefs"]
    if ratio and ratio["p"] < RATIO_P:
        share = f"{ratio['share']:.1%} of {ratio['users']} users are in the control group"
        yield "ratio", f"{share}, {ratio['set']:.1%} were set (p = {ratio['p']:.1g}). Find out why first."
    if missing and missing["share"] > MISSING:
        share = f"{missing['share']:.1%} of {missing['decisions']} decisions"
        yield "missing", f"{share} older than a day have no outcome."
    for group, found in checks["drift"].items():
        low, high = (found and found["ci95"]) or (0, 0)
        if high < 0 or (group == "control" and low > 0):
            change = f"changed by {found['value']:+.3g} (95 % interval {low:.3g} to {high:.3g})"
            yield "drift", f"The mean outcome of the {group} group has {change} between the halves of the window."
    if beliefs and (beliefs["unknown"] or 0) > UNKNOWN:
        share = f"{beliefs['unknown']:.1%} of {beliefs['users']} sampled users"
        yield "beliefs", f"No known type fits {share}. Fit the study anew."
