"""Target policies of `reuse evaluate`: a single policy, a table of probabilities, or a study that is replayed.

A replay gives before each logged decision the policies' expected outcomes and their probabilities. A study of
memory is replayed on all; those that are fitted to the log itself each on users whom it has not seen.
"""

import csv
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.beliefs import learn_turn, probabilities, start_at_priors
from lifelore.agent.personalise.fitting.fit import FitSettings, study_of_log
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.agent.personalise.study import Study
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.interaction.evaluation.propensity_weights import decision_numbers
from lifelore.interaction.evaluation.reward_models import RewardModel
from lifelore.interaction.reuse.reuse_algorithm import ReuseAlgorithm
from lifelore.interaction.selection.choice import available_mask
from lifelore.memory.study_rows import UserRow

Array = NDArray[np.float64]

USERS_AT_ONCE = 256
"""Number of users who are replayed side by side; more need more memory and are hardly faster."""


class ReplayedChoices(NamedTuple):
    """What a study believes and would do before each logged decision.

    expected : (n, n_policies) float64
        Expected outcome of each policy of the log; NaN where the study does not choose from it.
    probabilities : (n, n_policies) float64
        With which the study would choose each policy of the log.
    unknown : (n,) float64
        Probability of policies that the log does not name.
    """

    expected: Array
    probabilities: Array
    unknown: Array


def replayed_choices(
    study: Study, log: ReuseLog, rows: NDArray[np.int64], *, choose: bool = True
) -> ReplayedChoices:
    """Replay some rows of a log: each user starts as a stranger and learns from the logged outcomes.

    Parameters
    ----------
    study : Study
    log : ReuseLog
    rows : (n,) int64
        Places in the log; those of a user are in order of time. The belief learns from each outcome before the
        user's next decision.
    choose : bool
        Whether to compute the probabilities of the choices; they stay 0 otherwise.
    """
    numbers = {policy: number for number, policy in enumerate(study.library.policies)}
    to_library = np.array([numbers.get(policy, -1) for policy in log.policy.names], np.int64)
    usable = available_mask(study.active, study.library.policies)
    users, user_of = np.unique(log.user.codes[rows], return_inverse=True)
    policies, outcomes, turn = to_library[log.policy.codes[rows]], log.outcomes[rows], decision_numbers(user_of)
    # By policy of the library; users take their turns side by side.
    expected, probs = np.zeros((2, len(rows), study.library.n_policies))
    for first in range(0, len(users), USERS_AT_ONCE):
        algorithm = _strangers(study, log, users[first : first + USERS_AT_ONCE].tolist())
        inside = np.flatnonzero(user_of // USERS_AT_ONCE == first // USERS_AT_ONCE)
        for number in range(turn[inside].max() + 1):
            at = inside[turn[inside] == number]
            own = user_of[at] - first
            expected[at] = algorithm.known(own).performance.expected(algorithm.belief(own))
            if choose:
                probs[np.ix_(at, np.array(study.active_numbers))] = probabilities(study, algorithm, own)
            learn_turn(algorithm, own, policies[at], outcomes[at])
    return _by_policy_of_log(expected, probs, np.where(np.append(usable, False)[to_library], to_library, -1))


def _by_policy_of_log(expected: Array, probs: Array, to_library: NDArray[np.int64]) -> ReplayedChoices:
    """The choices by policy of the log; `to_library` is -1 where the study does not choose from it."""
    shared = to_library >= 0
    by_log = ReplayedChoices(
        np.full((len(probs), len(to_library)), np.nan),
        np.zeros((len(probs), len(to_library))),
        np.delete(probs, to_library[shared], axis=1).sum(axis=1),
    )
    by_log.expected[:, shared] = expected[:, to_library[shared]]
    by_log.probabilities[:, shared] = probs[:, to_library[shared]]
    return by_log


def _strangers(study: Study, log: ReuseLog, users: list[int]) -> ReuseAlgorithm:
    """Rows of users of whom only context and features are known."""
    algorithm = study.algorithm.new_rows(len(users))
    strangers = [UserRow(0, "", _context(log, user), _features(log, user), None, False, 0, None) for user in users]
    start_at_priors(algorithm, study, strangers)
    return algorithm


def _context(log: ReuseLog, user: int) -> str | None:
    place = int(log.context_of_user[user])
    return log.context.names[place] if place >= 0 else None


def _features(log: ReuseLog, user: int) -> dict[str, float] | None:
    """The numbers known of a user; None unless all are."""
    row = log.features_of_user[user]
    if not row.size or np.isnan(row).any():
        return None
    return dict(zip(log.feature_names, row.tolist(), strict=True))


def studies_of_others(log: ReuseLog, folds: NDArray[np.int64], types: int | None, seed: int) -> list[Study]:
    """For each part of the users, a study fitted to all other parts.

    Parameters
    ----------
    folds : (n,) int64
        Part of the users of each row.
    types : int, optional
        Number of types; default: selected by the outcomes.
    """
    settings = FitSettings(types=types, seed=seed)
    parts = range(int(folds.max()) + 1)
    return [study_of_log(log.take(np.flatnonzero(folds != part)), settings)[0] for part in parts]


def expected_by_library(
    log: ReuseLog, folds: NDArray[np.int64], studies: Sequence[Study], means: RewardModel
) -> RewardModel:
    """Each policy's expected outcome under the user's belief, by the library of the user's part.

    Policies that the library does not know have their expectation in `means`.
    """
    expected = _replayed(log, folds, studies, choose=False).expected
    table = np.where(np.isnan(expected), means.table[means.row], expected)
    return RewardModel(table, np.arange(len(log)))


def choices_of_rule(
    log: ReuseLog, folds: NDArray[np.int64], studies: Sequence[Study], rule: str, explore: float
) -> ReplayedChoices:
    """The choices of a rule, each by the library of the user's part; `explore` of them from all policies."""
    return _replayed(
        log, folds, [replace(study, rule=rule, rule_settings={}, explore=explore) for study in studies]
    )


def _replayed(
    log: ReuseLog, folds: NDArray[np.int64], studies: Sequence[Study], choose: bool = True
) -> ReplayedChoices:
    rows = [np.flatnonzero(folds == part) for part in range(len(studies))]
    parts = [replayed_choices(study, log, own, choose=choose) for study, own in zip(studies, rows, strict=True)]
    order = np.argsort(np.concatenate(rows))
    return ReplayedChoices(*(np.concatenate(column)[order] for column in zip(*parts, strict=True)))


Kind = Literal["policy", "table", "rule", "study"]

SUMS_TO_1 = 1e-6
"""Tolerance of the sum of a table's probabilities."""


@dataclass(frozen=True, eq=False)
class TargetPolicy:
    """A policy to evaluate, before each of n logged decisions.

    Parameters
    ----------
    name : str
    kind : {"policy", "table", "rule", "study"}
    of_logged : (n,) float64
        Probability with which it would choose the logged policy.
    expected : (n,) float64
        The model's expected outcome of its choice.
    untried : float
        Mean probability of policies that the log never chose.
    adaptive : bool
        Whether its choices depend on earlier outcomes of the user.
    """

    name: str
    kind: Kind
    of_logged: Array
    expected: Array
    untried: float = 0.0
    adaptive: bool = False


def single_policy(log: ReuseLog, name: str, model: RewardModel) -> TargetPolicy:
    """The target that always chooses one policy of the log.

    Parameters
    ----------
    model : RewardModel
        Of the log's policies.

    Raises
    ------
    NotFoundError
        The log never chose it.
    """
    if name not in log.policy.names:
        raise NotFoundError(
            f"policy '{name}' was never chosen in the log, so nothing is known of it; it has "
            f"{', '.join(log.policy.names[:20])}"
        )
    place = log.policy.names.index(name)
    return TargetPolicy(name, "policy", (log.policy.codes == place).astype(np.float64), model.of_policies(place))


def table_policy(log: ReuseLog, path: str | Path, model: RewardModel) -> TargetPolicy:
    """The target that draws policies with the probabilities of a CSV file.

    The file has the columns ``policy`` and ``probability``, and perhaps ``context``: then each context of the log
    has probabilities of its own. Probabilities of a context sum to 1.

    Raises
    ------
    NotFoundError
        There is no such file.
    InputError
        A line breaks its rule, probabilities do not sum to 1, or a context of the log is missing.
    """
    table = _read_table(Path(path))
    place = {policy: number for number, policy in enumerate(log.policy.names)}
    contexts = log.context.names if next(iter(table)) or len(table) > 1 else ("",)
    probs, untried = np.zeros((len(contexts), len(place))), np.zeros(len(contexts))
    for number, context in enumerate(contexts):
        if context not in table:
            raise InputError(f"{path} must have probabilities of each context of the log, '{context}' has none")
        for policy, probability in table[context].items():
            if policy in place:
                probs[number, place[policy]] = probability
            else:
                untried[number] += probability
    row = log.context.codes if len(contexts) == len(log.context.names) else np.zeros(len(log), np.int64)
    known = probs[row]
    return TargetPolicy(
        Path(path).stem, "table", known[np.arange(len(log)), log.policy.codes],
        model.of_choices(known), float(untried[row].mean()),
    )  # fmt: skip


def _read_table(path: Path) -> dict[str, dict[str, float]]:
    if not path.is_file():
        raise NotFoundError(f"target '{path}' is no file; give a CSV file with columns policy,probability")
    try:
        text = path.read_text("utf-8-sig")
    except UnicodeError:
        raise InputError(f"{path} must be CSV in UTF-8, got bytes that are not") from None
    except OSError as error:
        raise StoreError(f"cannot read {path}: {error.strerror}") from None
    reader = csv.DictReader(text.splitlines(), strict=True)
    if not {"policy", "probability"} <= set(reader.fieldnames or ()):
        raise InputError(f"{path} must have the columns policy,probability[,context], got {reader.fieldnames}")
    table: dict[str, dict[str, float]] = {}
    try:
        for row in reader:
            own = table.setdefault((row.get("context") or "").strip(), {})
            policy = (row["policy"] or "").strip()
            if not policy or policy in own:
                raise InputError(f"{path} line {reader.line_num}: policy must be named once in each context")
            own[policy] = _probability(row["probability"], f"{path} line {reader.line_num}")
    except csv.Error as error:
        raise InputError(f"{path} line {reader.line_num}: not CSV ({error})") from None
    if not table:
        raise InputError(f"{path} must have at least one line with a policy and its probability, got none")
    for context, own in table.items():
        if abs(sum(own.values()) - 1) > SUMS_TO_1:
            of = f" of context '{context}'" if context else ""
            raise InputError(f"{path}: probabilities{of} must sum to 1, got {sum(own.values()):g}")
    return table


def _probability(word: str | None, where: str) -> float:
    try:
        probability = float(word or "")
    except ValueError:
        probability = np.nan
    if not 0 <= probability <= 1:
        raise InputError(f"{where}: probability must be a number from 0 to 1, got {word!r}")
    return probability


def replayed_policy(
    log: ReuseLog, name: str, kind: Kind, choices: ReplayedChoices, model: RewardModel
) -> TargetPolicy:
    """The target that chooses by the belief that follows from the logged outcomes."""
    of_logged = choices.probabilities[np.arange(len(log)), log.policy.codes]
    expected = model.of_choices(choices.probabilities)
    return TargetPolicy(name, kind, of_logged, expected, float(choices.unknown.mean()), adaptive=True)
