"""The verb `reuse report`: the gain from choosing by belief over the control group, as numbers and pictures.

The unit is the user: outcomes of one user hang together, so each user counts once, by the mean of their outcomes.
Intervals are 95 %: Welch's for the difference of the two groups, bias-corrected bootstrap for means (Student's
from more than `MANY` users on). Means and uplifts are of all users; the curve by decision, regret and calibration
are of a random sample of at most `calibration.SAMPLE` users.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.calibration import (
    History,
    difference,
    lived_again,
    sampled_histories,
)
from lifelore.agent.personalise.decision_log import log_parts
from lifelore.agent.personalise.result_folder import write_picture, write_result
from lifelore.agent.personalise.study import Study
from lifelore.core.atomic_write import atomic_write
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.intervals import LEAST_VALUES, t_interval
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.memory import Memory
from lifelore.memory.study_totals import StudyTotals

Array = NDArray[np.float64]
SPLITS = ("user", "time", "both")
LONGEST_CURVE = 60
DAY = 86_400_000
PERIODS = {"day": (0, DAY), "week": (4 * DAY, 7 * DAY)}
"""Start of a period after 1970-01-01 (a Thursday; weeks begin on Monday) and its length, in milliseconds."""
MANY = 1000
"""Users up to which means are resampled; of more Student's interval says the same, and memory stays small."""


def report(
    memory: Memory,
    study: Study,
    out: str | Path | None = None,
    log: str | Path | None = None,
    *,
    incumbent: str | None = None,
    split: str | None = None,
    by: str | None = None,
) -> dict[str, Any]:
    """Compare users served by belief with the control group, the best single policy and the incumbent.

    The best single policy is chosen by the users of the fit. Its outcome, and that of the incumbent, is measured
    on the control group, so neither is chosen and measured on the same outcomes. `split` makes sure of it where
    users of the fit come back.

    Parameters
    ----------
    out : folder, optional
        Gets ``report.json`` and ``report.png``, and ``calibration.png`` where there is an outcome.
    log : file, optional
        Gets every decision as CSV: ``COLUMNS``, outcomes not yet known left empty; ``available`` is a JSON list
        of the policies that were available, empty where all were. Features of the study follow, so that a new
        fit can read them.
    incumbent : str, optional
        The policy in place until now; default: the study's incumbent, if it has one.
    split : {"user", "time", "both"}, optional
        Count only users whom the fit did not know, decisions after the fit, or both; default: all. The log has
        all.
    by : {"day", "week"}, optional
        Also compare the groups in each day or week (from Monday) of decisions, UTC.

    Returns
    -------
    dict
        ``study``; ``decisions``, ``pending``; ``personal`` and ``control``: users and mean outcome (None without
        a user) each as {"value", "median", "ci95", "n"}; ``uplift``: {"value", "ci95", "n"}, personal less
        control; ``best_single`` and ``incumbent``: ``name``, ``outcome`` in the control group and ``uplift``,
        personal less it (None where the control group never got it); ``incumbent`` is None without one;
        ``split``; ``policies``: in the control group each policy's mean outcome over users, fair where it draws
        at random; ``regret``: what the policy of the largest expectation under the user's last belief would have
        brought more, for each group, by the library and not measured; ``strangers``: number of ``users`` who are
        of no known type with a probability above a half, of ``n`` in the sample with an outcome (None where
        beliefs do not tell: one type, categories, or exact models); ``by_decision``: both groups' mean outcome
        at each decision; ``by_time``: for each period with a decision its start, ``time`` in seconds since 1970,
        ``users``, ``decisions``, and ``personal``, ``control`` and ``uplift`` by the users' mean outcomes in the
        period (None without `by`; decisions of an earlier Lifelore are left out);
        ``calibration`` of ``outcomes`` (None without one), see
        `calibration.calibrated`.

    Raises
    ------
    InputError, NotFoundError
        There is no such split, period or policy, or the study does not know when it was fitted.
    StoreError
        The disk refuses.

    Examples
    --------
    >>> import tempfile
    >>> from lifelore import PolicyLibrary, open_memory
    >>> from lifelore.agent.personalise.registration import register
    >>> library = PolicyLibrary.from_means([[8.0, 2.0], [3.0, 9.0]], 1.0, policies=["calm", "jazz"])
    >>> with tempfile.TemporaryDirectory() as folder, open_memory(f"{folder}/songs.db") as memory:
    ...     study = register(memory, "songs", library)
    ...     report(memory, study)["decisions"]
    0
    """
    incumbent = incumbent or study.incumbent
    if incumbent is not None and incumbent not in study.states:
        raise NotFoundError(f"incumbent must be a policy of the study, got '{incumbent}'")
    if by not in (None, *PERIODS):
        raise InputError(f"by must be one of {', '.join(PERIODS)}, got '{by}'")
    document = _document(memory, study, incumbent, split, by)
    if log is not None:
        with atomic_write(log, "the log") as file:
            file.writelines(log_parts(memory, study))
    if out is not None:
        from lifelore.figures.reuse_calibration import draw_calibration
        from lifelore.figures.reuse_report import draw_reuse_report

        write_result(Path(out), "report", document, draw_reuse_report)
        if calibration := document["calibration"]["outcomes"]:
            write_picture(Path(out) / "calibration.png", calibration, draw_calibration)
    return document


def _counting(study: Study, split: str | None) -> dict[str, Any]:
    """Which users and decisions count: those that the fit has not seen."""
    if split not in (None, *SPLITS):
        raise InputError(f"split must be one of {', '.join(SPLITS)}, got '{split}'")
    since = 0
    if split in ("time", "both"):
        if study.fitted.get("time") is None:
            raise InputError("split by time needs a study that knows when it was fitted; fit it anew")
        since = 1000 * int(study.fitted["time"])
    return {"strangers": split in ("user", "both"), "since": since}


def _document(
    memory: Memory, study: Study, incumbent: str | None, split: str | None, by: str | None
) -> dict[str, Any]:
    counting = _counting(study, split)
    with memory.studies.totals(study.number) as totals:
        if not totals.any_before(counting["since"]):
            counting["since"] = 0  # all decisions count, which takes no look at each
        decisions, pending = totals.n_decisions(**counting)
        users = totals.by_user(**counting)
        by_policy = {policy: np.sort(totals.control_means(policy, **counting)) for policy in study.states}
        personal, control = _means(users.personal, users.personal_sum), _means(users.control, users.control_sum)
        by_time = None if by is None else _by_time(totals, by, **counting)
    histories = sampled_histories(memory, study, users.person, since=counting["since"])
    algorithm, of_outcomes = lived_again(study, histories)
    return {
        "study": study.name,
        "decisions": decisions,
        "pending": pending,
        "personal": _estimate(personal),
        "control": _estimate(control),
        "control_gets": study.incumbent or "each policy alike",
        "uplift": difference(personal, control),
        "best_single": _beside(study.best_single, personal, by_policy),
        "incumbent": None if incumbent is None else _beside(incumbent, personal, by_policy),
        "policies": [
            {"name": policy, "state": state, "outcome": _estimate(by_policy[policy])}
            for policy, state in sorted(study.states.items())
        ],
        "regret": _regret(study, histories, algorithm),
        "strangers": _strangers(histories, algorithm),
        "by_decision": _by_decision(histories),
        "by_time": by_time,
        "calibration": {"outcomes": of_outcomes},
        "sample": len(histories),
        "split": split,
    }


def _means(number: Array, total: Array) -> Array:
    """Mean outcome of each user with one, sorted, so that sums of them do not depend on the order of rows."""
    return np.sort(total[number > 0] / number[number > 0])


def _estimate(values: Sequence[float] | Array) -> dict[str, Any] | None:
    if not len(values):
        return None
    if np.ptp(values) == 0:  # such as no click of 24 users: nothing says how far the mean may be off
        return Estimate(float(values[0]), float(values[0]), None, len(values)).to_dict()
    if len(values) <= MANY:
        return mean_estimate(values).to_dict()
    mean, error = float(np.mean(values)), float(np.std(values, ddof=1)) / len(values) ** 0.5
    low, high = map(float, t_interval(mean, error, len(values) - 1))
    return Estimate(mean, float(np.median(values)), (low, high), len(values)).to_dict()


def _by_time(totals: StudyTotals, by: str, *, since: int, strangers: bool) -> list[dict[str, Any]]:
    """Both groups in each period with a decision."""
    first, step = PERIODS[by]
    periods = []
    while (time := totals.next_time(since, strangers=strangers)) is not None:
        start = time - (time - first) % step
        held, decisions, number, total = totals.within(max(start, since), start + step, strangers=strangers)
        personal, control = (_means(number[held == group], total[held == group]) for group in (0, 1))
        periods.append({
            "time": start // 1000,
            "users": len(held),
            "decisions": int(decisions.sum()),
            "personal": _estimate(personal),
            "control": _estimate(control),
            "uplift": difference(personal, control),
        })  # fmt: skip
        since = start + step
    return periods


def _beside(policy: str, personal: Array, by_policy: dict[str, Array]) -> dict[str, Any]:
    """A single policy's outcome in the control group, and what those chosen for by belief have more."""
    means = by_policy[policy]
    return {"name": policy, "outcome": _estimate(means), "uplift": difference(personal, means)}


def _regret(study: Study, histories: Sequence[History], algorithm: ReuseAlgorithm) -> dict[str, Any]:
    """Of each group the mean over decisions of what the best policy under the last belief is expected to add."""
    lost: dict[str, list[float]] = {"personal": [], "control": []}
    if histories:
        every = np.arange(len(histories))
        expected = algorithm.known(every).performance.expected(algorithm.belief(every))
        best = expected[:, study.active_numbers].max(axis=1)
        number_of = {policy: number for number, policy in enumerate(study.library.policies)}
        for row, history in enumerate(histories):
            for name, control in (("personal", False), ("control", True)):
                own = [one for one in history.ended if one.control == control]
                known = [number_of[one.policy] for one in own if one.policy in number_of]
                if own:
                    lost[name].append(float(np.mean(best[row] - expected[row, known])) if known else 0.0)
    return {name: _estimate(values) for name, values in lost.items()}


def _strangers(histories: Sequence[History], algorithm: ReuseAlgorithm) -> dict[str, int] | None:
    """Users of the sample with an outcome who are probably of no known type; None where beliefs do not tell."""
    ended = [row for row, history in enumerate(histories) if history.ended]
    if algorithm.unknown is None or not ended:
        return None
    return {"users": int((algorithm.unknown.probability(np.array(ended)) > 0.5).sum()), "n": len(ended)}


def _by_decision(histories: Sequence[History]) -> list[dict[str, Any]]:
    """Both groups' mean outcome at each decision."""
    points = []
    for number in range(LONGEST_CURVE):
        own = [one.decisions[number] for one in histories if len(one.decisions) > number]
        ended = [one for one in own if one.outcome is not None]
        point: dict[str, Any] = {"decision": number + 1}
        for name, control in (("personal", False), ("control", True)):
            values = np.array([one.outcome for one in ended if one.control == control], np.float64)
            point[name] = _estimate(values) if len(values) >= LEAST_VALUES else None
        if point["personal"] or point["control"]:
            points.append(point)
    return points
