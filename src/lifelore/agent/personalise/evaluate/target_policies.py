"""Target policies of `reuse evaluate`: a single policy, a table of probabilities, or a rule that is replayed."""

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.evaluate.replayed_choices import ReplayedChoices
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.core.errors import InputError, NotFoundError, StoreError
from lifelore.interaction.evaluation.reward_models import RewardModel

Array = NDArray[np.float64]
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
