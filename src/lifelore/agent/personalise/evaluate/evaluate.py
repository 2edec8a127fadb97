"""The verb `reuse evaluate`: what other policies would have achieved, estimated from a log with probabilities.

Off-policy evaluation weights each logged decision by how much more probable it is under the target policy. It is
sound where the log gave every policy that the target chooses a probability above 0, and where the logged
probabilities are right. `warnings` of a target name the conditions that the log does not meet.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lifelore.agent.personalise.evaluate.logged_decisions import CERTAIN, read_decisions
from lifelore.agent.personalise.evaluate.target_estimates import target_estimates
from lifelore.agent.personalise.evaluate.target_policies import (
    TargetPolicy,
    choices_of_rule,
    expected_by_library,
    replayed_choices,
    replayed_policy,
    single_policy,
    studies_of_others,
    table_policy,
)
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.agent.personalise.log.log_format import LogFormat
from lifelore.agent.personalise.result_folder import write_result
from lifelore.agent.personalise.study import Study, known_users, open_study
from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.streams import stream
from lifelore.interaction.evaluation.estimators import logged_value
from lifelore.interaction.evaluation.propensity_weights import decision_numbers
from lifelore.interaction.evaluation.reward_models import RewardModel, policy_means, user_folds
from lifelore.interaction.selection import rule_named
from lifelore.memory import Memory

MODELS = ("means", "library")
LEFT_OUT = ("pending", "without_policy", "repeated", "other_groups", "known_to_the_study", "later_decisions")
"""Reasons for which lines of a log do not count."""


@dataclass(frozen=True)
class EvaluateSettings:
    """What to evaluate, and how.

    Parameters
    ----------
    policies : tuple of str
        Single policies of the log to evaluate.
    tables : tuple of paths
        CSV files with the probabilities of a target's choices; see `target_policies.table_policy`.
    rules : tuple of str
        Selection rules, each with libraries learnt from the log without the users whose choices it makes.
    study : str, optional
        A study in memory to replay: its library, rule and exploration.
    first : int, optional
        Evaluate the first so many decisions of each user. Rules and the study then make all of them; without it,
        they make each decision after the outcomes that the log has until then.
    model : {"means", "library"}
        Outcomes that the doubly robust estimate expects: each policy's mean, or those of a library under the
        user's belief; both learnt without the user.
    types : int, optional
        Number of types of those libraries; default: selected by the outcomes.
    explore : float
        Share of exploration of `rules`.
    group : str, optional
        See `logged_decisions.read_decisions`.
    seed : int
        For the parts of the users and for types.
    """

    policies: tuple[str, ...] = ()
    tables: tuple[str | Path, ...] = ()
    rules: tuple[str, ...] = ()
    study: str | None = None
    first: int | None = None
    model: str = "means"
    types: int | None = None
    explore: float = 0.0
    group: str | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        if self.model not in MODELS:
            raise NotFoundError(f"model must be one of {', '.join(MODELS)}, got '{self.model}'")
        if self.first is not None and self.first < 1:
            raise InputError(f"first must be at least 1, got {self.first}")
        if not 0 <= self.explore <= 1:
            raise InputError(f"explore must lie between 0 and 1, got {self.explore}")
        for rule in self.rules:
            rule_named(rule)


def evaluate(
    paths: Sequence[str | Path],
    settings: EvaluateSettings | None = None,
    form: LogFormat | None = None,
    memory: Memory | None = None,
    *,
    out: str | Path | None = None,
) -> dict[str, Any]:
    """Estimate the mean outcome of target policies from logs of other choices.

    Parameters
    ----------
    paths : sequence of paths
        Logs with the columns user, policy, outcome and probability; a user's lines in order of time.
    settings : EvaluateSettings, optional
        By default every single policy of the log is a target.
    form : LogFormat, optional
        How the logs are written.
    memory : Memory, optional
        Holds the study, where the settings name one.
    out : folder, optional
        Gets ``evaluation.json`` and ``evaluation.png``.

    Returns
    -------
    dict
        ``decisions``, ``users``, ``group`` (None: all); ``left_out``: lines by the reason; ``certain``: share of
        decisions with probability 1; ``logged``: mean outcome of the log; ``model``, ``first``, ``seed``;
        ``targets``, each with ``name``, ``kind``, ``decision`` ("next" or "all"), ``estimates`` by estimator
        ({"value", "standard_error", "ci95", "n", "gain"}, where the gain is over the log; None where the log
        cannot tell), ``support`` (share of its choices that the log could have made), ``weights``
        (`WeightSummary`) and ``warnings``.

    Raises
    ------
    InputError, NotFoundError
        A log, target or setting breaks its rule; messages name file and line.
    StoreError
        The disk refuses.
    """
    settings = settings or EvaluateSettings()
    log, group = read_decisions(paths, form, settings.group)
    study = None
    if settings.study is not None:
        if memory is None:
            raise InputError(f"study '{settings.study}' needs the memory that holds it")
        study = open_study(memory, settings.study)
        log = _of_strangers(log, memory, study)
    if settings.first is not None:
        log = log.keeping(decision_numbers(log.user.codes) < settings.first, "later_decisions")
    logged, certain = logged_value(log.outcomes, log.user.codes), np.asarray(log.probability) >= CERTAIN
    targets, model = _targets(log, settings, study)
    document = {
        "decisions": len(log),
        "users": len(log.user.names),
        "group": group,
        "left_out": {reason: log.counts.get(reason, 0) for reason in LEFT_OUT},
        "certain": float(certain.mean()),
        "logged": logged.to_dict(),
        "model": settings.model,
        "first": settings.first,
        "seed": settings.seed,
        "targets": [target_estimates(one, log, model, logged, settings.first is not None) for one in targets],
    }
    if out is not None:
        from lifelore.figures.off_policy_estimates import draw_off_policy_estimates

        write_result(Path(out), "evaluation", document, draw_off_policy_estimates)
    return document


def _of_strangers(log: ReuseLog, memory: Memory, study: Study) -> ReuseLog:
    """The decisions for users whom the study does not know.

    The library has learnt from the outcomes of the users of the fit, so they cannot judge it; a user with a past
    does not start as a stranger. Users with a decision before the fit may have been in its logs.
    """
    fitted_at = 1000 * study.fitted.get("time", np.inf)
    names = list(log.user.names)
    with memory.studies.reading(study.number) as rows:
        users = known_users(rows, study, names)
        numbers = [user.number for user in users.values()]
        past, first = rows.past_of(numbers), rows.first_decisions(numbers)
    known = {
        name
        for name, user in users.items()
        if user.fitted or user.number in past or first.get(user.number, np.inf) < fitted_at
    }
    new = np.array([name not in known for name in names])
    if not new.any():
        raise InputError(
            f"study '{study.name}' was fitted to all users of the log or knows their past, so the log cannot "
            "judge it; give a log of other users, or --rule, which learns without the users that it is judged on"
        )
    return log.keeping(new[log.user.codes], "known_to_the_study")


def _targets(
    log: ReuseLog, settings: EvaluateSettings, study: Study | None
) -> tuple[list[TargetPolicy], RewardModel]:
    folds = user_folds(log.user.codes, stream(settings.seed, "reuse evaluate", "folds"))
    model = policy_means(log.outcomes, log.policy.codes, len(log.policy.names), folds)
    studies = []
    if settings.rules or settings.model == "library":
        studies = studies_of_others(log, folds, settings.types, settings.seed)
    if settings.model == "library":
        model = expected_by_library(log, folds, studies, model)
    named = settings.policies or settings.tables or settings.rules or study
    singles = settings.policies if named else log.policy.names
    targets = [single_policy(log, name, model) for name in singles]
    targets += [table_policy(log, path, model) for path in settings.tables]
    for rule in settings.rules:
        choices = choices_of_rule(log, folds, studies, rule, settings.explore)
        targets.append(replayed_policy(log, rule, "rule", choices, model))
    if study is not None:
        choices = replayed_choices(study, log, np.arange(len(log)))
        targets.append(replayed_policy(log, f"study {study.name}", "study", choices, model))
    return targets, model
