"""The verb `reuse report`: the gain from choosing by belief over the control group, as numbers, picture and log.

The unit is the user: outcomes of one user hang together, so each user counts once, by the mean of their outcomes.
Intervals are 95 %: Welch's for the difference of the two groups, bias-corrected bootstrap for means (Student's
from more than `MANY` users on).
"""

import csv
import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.agent.reuse.calibration import calibration
from lifelore.agent.reuse.history import Decision, History, histories
from lifelore.agent.reuse.past import Past, PastUser, read_past
from lifelore.agent.reuse.result_folder import write_picture, write_result, write_text
from lifelore.agent.reuse.study import Study
from lifelore.agent.reuse.user_belief import expected_outcomes
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.intervals import LEAST_VALUES, t_interval, welch_interval
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.memory import Memory

COLUMNS = (
    "user", "policy", "outcome", "context", "time", "probability", "group", "decision", "number", "outcome_time",
    "available",
)  # fmt: skip
"""Of the log of decisions, which `reuse fit` reads again."""
SPLITS = ("user", "time", "both")
LONGEST_CURVE = 60
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
) -> dict[str, Any]:
    """Compare those chosen for by belief with the control group, with the best single policy, and the incumbent.

    The best single policy is chosen by the users of the fit. Its outcome, and that of the incumbent, is measured
    on the control group, so neither is chosen and measured on the same outcomes. `split` makes sure of it where
    users of the fit come back.

    Parameters
    ----------
    out : folder, optional
        Gets ``report.json`` and ``report.png``, and ``calibration.png`` where there is an outcome.
    log : file, optional
        Gets every decision as CSV: `COLUMNS`, outcomes not yet known left empty; ``available`` is a JSON list
        of the policies that were available, empty where all were. Features of the study follow, so that a new
        fit can read them.
    incumbent : str, optional
        The policy in place until now; default: the study's incumbent, if it has one.
    split : {"user", "time", "both"}, optional
        Count only users whom the fit did not know, decisions after the fit, or both; default: all. The log has
        all.

    Returns
    -------
    dict
        ``study``; ``decisions``, ``pending``; ``personal`` and ``control``: users and mean outcome (None without
        a user) each as {"value", "median", "ci95", "n"}; ``uplift``: {"value", "ci95", "n"}, personal less
        control; ``best_single`` and ``incumbent``: ``name``, ``outcome`` in the control group and ``uplift``,
        personal less it (None where the control group never got it); ``incumbent`` is None without one;
        ``split``; ``policies``: in the control group each policy's mean outcome over users, fair where it draws
        at random; ``regret``: what the policy of the largest expectation under the user's last belief would have
        brought more, for each group, by the library and not measured; ``by_decision``: both groups' mean outcome
        at each decision; ``calibration``, see `calibration.calibration`.

    Raises
    ------
    InputError, NotFoundError
        There is no such split or policy, or the study does not know when it was fitted.
    StoreError
        The disk refuses.
    """
    incumbent = incumbent or study.incumbent
    if incumbent is not None and incumbent not in study.states:
        raise NotFoundError(f"incumbent must be a policy of the study, got '{incumbent}'")
    known = [history for history in histories(memory, study) if history.decisions]
    past = read_past(memory, study.name)
    document: dict[str, Any] = _document(study, _split(study, known, past, split), past, incumbent)
    document["split"] = split
    if log is not None:
        write_text(Path(log), _log_text(study, known))
    if out is not None:
        from lifelore.figures.reuse_calibration import draw_calibration
        from lifelore.figures.reuse_report import draw_reuse_report

        write_result(Path(out), "report", document, draw_reuse_report)
        if any(document["calibration"].values()):
            write_picture(Path(out) / "calibration.png", document["calibration"], draw_calibration)
    return document


def _split(study: Study, known: list[History], past: Past, split: str | None) -> list[History]:
    """The histories that count: those of users, and with the decisions, that the fit has not seen."""
    if split not in (None, *SPLITS):
        raise InputError(f"split must be one of {', '.join(SPLITS)}, got '{split}'")
    if split in ("user", "both"):
        fitted = past.users_of("fit")
        known = [history for history in known if history.key not in fitted]
    if split in ("time", "both"):
        fitted_at = study.fitted.get("time")
        if fitted_at is None:
            raise InputError("split by time needs a study that knows when it was fitted; fit it anew")
        later = (
            (history, tuple(one for one in history.decisions if one.chosen >= fitted_at)) for history in known
        )
        known = [replace(history, decisions=decisions) for history, decisions in later if decisions]
    return known


def _document(study: Study, known: list[History], past: Past, incumbent: str | None) -> dict[str, Any]:
    decisions = [decision for history in known for decision in history.decisions]
    groups = {
        name: [history for history in known if _ended(history, control)]
        for name, control in (("personal", False), ("control", True))
    }
    means = {
        name: [_mean(_ended(history, name == "control")) for history in group] for name, group in groups.items()
    }
    return {
        "study": study.name,
        "decisions": len(decisions),
        "pending": sum(decision.outcome is None for decision in decisions),
        "personal": _estimate(means["personal"]),
        "control": _estimate(means["control"]),
        "control_gets": study.incumbent or "each policy alike",
        "uplift": _difference(means["personal"], means["control"]),
        "best_single": _beside(study.best_single, means["personal"], groups["control"]),
        "incumbent": None if incumbent is None else _beside(incumbent, means["personal"], groups["control"]),
        "policies": _policies(study, groups["control"]),
        "regret": {
            name: _estimate([_regret(study, history, past, name == "control") for history in group])
            for name, group in groups.items()
        },
        "by_decision": _by_decision(groups),
        "calibration": calibration(study, known, past),
    }


def _ended(history: History, control: bool) -> list[Decision]:
    """Decisions of one group whose outcome is known; a new share of control may move a user between groups."""
    return [one for one in history.decisions if one.outcome is not None and one.control == control]


def _mean(decisions: Iterable[Decision]) -> float:
    return float(np.mean([one.outcome for one in decisions if one.outcome is not None]))


def _estimate(values: Sequence[float]) -> dict[str, Any] | None:
    if not len(values):
        return None
    if len(values) <= MANY:
        return mean_estimate(values).to_dict()
    mean, error = float(np.mean(values)), float(np.std(values, ddof=1)) / len(values) ** 0.5
    low, high = map(float, t_interval(mean, error, len(values) - 1))
    return Estimate(mean, float(np.median(values)), (low, high) if error > 0 else None, len(values)).to_dict()


def _difference(first: Sequence[float], second: Sequence[float]) -> dict[str, Any] | None:
    """Difference of means with Welch's interval, if there are users and spread enough for one."""
    if not first or not second:
        return None
    ci95 = welch_interval(first, second)
    return {
        "value": float(np.mean(first) - np.mean(second)),
        "ci95": list(ci95) if ci95 else None,
        "n": [len(first), len(second)],
    }


def _beside(policy: str, personal: Sequence[float], control: list[History]) -> dict[str, Any]:
    """A single policy's outcome in the control group, and what those chosen for by belief have more."""
    means = _means_of(policy, control)
    return {"name": policy, "outcome": _estimate(means), "uplift": _difference(personal, means)}


def _means_of(policy: str, control: list[History]) -> list[float]:
    """Mean outcome of a policy for each user of the control group who got it."""
    met = ([one for one in _ended(history, True) if one.policy == policy] for history in control)
    return [_mean(decisions) for decisions in met if decisions]


def _policies(study: Study, control: list[History]) -> list[dict[str, Any]]:
    return [
        {"name": policy, "state": study.states[policy], "outcome": _estimate(_means_of(policy, control))}
        for policy in sorted(study.states)
    ]


def _regret(study: Study, history: History, every_past: Past, control: bool) -> float:
    """Mean over decisions of what the best policy under the last belief is expected to bring more."""
    past = every_past.users.get(history.key, PastUser())
    expected = dict(zip(study.library.policies, expected_outcomes(study, history, past), strict=True))
    best = max(expected[policy] for policy in study.active)
    lost = [best - expected[one.policy] for one in _ended(history, control) if one.policy in expected]
    return float(np.mean(lost)) if lost else 0.0


def _by_decision(groups: dict[str, list[History]]) -> list[dict[str, Any]]:
    points = []
    for number in range(LONGEST_CURVE):
        point: dict[str, Any] = {"decision": number + 1}
        for name, group in groups.items():
            ended = [
                one.outcome for history in group for one in _ended(history, name == "control")
                if one.number == number
            ]  # fmt: skip
            point[name] = _estimate(ended) if len(ended) >= LEAST_VALUES else None  # type: ignore[arg-type]
        if point["personal"] or point["control"]:
            points.append(point)
    return points


def _log_text(study: Study, known: list[History]) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    names = () if study.feature_prior is None else study.feature_prior.names
    features = [name for name in names if name.strip().lower() not in COLUMNS]
    writer.writerow([*COLUMNS, *features])
    for history in known:
        for one in history.decisions:
            outcome = "" if one.outcome is None else repr(one.outcome)
            group = "control" if one.control else "personal"
            writer.writerow([
                history.user, one.policy or "", outcome, history.context or "", one.chosen, repr(one.probability),
                group, history.identifier(one), one.number, "" if one.ended is None else one.ended,
                "" if one.available is None else json.dumps(one.available, ensure_ascii=False),
                *((history.features or {}).get(name, "") for name in features),
            ])  # fmt: skip
    return text.getvalue()
