"""The explanation of an agent's state: the evidence of its last signals for each type, and its last selection."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MAX_EVIDENCE = 16
"""Number of last signals whose evidence an agent keeps; more cost memory and longer session files."""
MAX_SURPRISE = 745.0
"""Largest surprise of a single signal in nats, that of an impossible signal: −log of the smallest number."""


class Evidence(NamedTuple):
    """The evidence of a single signal.

    policy : int
    log_likelihood : (n_types,) float64, log F(σ | τ, π)
    log_evidence : float, log Σ F β under the belief before the signal; minus infinity where no type explains it
    """

    policy: int
    log_likelihood: Array
    log_evidence: float

    @property
    def surprise(self) -> float:
        """−log Σ F β in nats, at most `MAX_SURPRISE`; negative for densities above 1."""
        return min(-self.log_evidence, MAX_SURPRISE)


@dataclass(frozen=True)
class Explanation:
    """The state of an agent; policies and types by name, types with the most belief first.

    Parameters
    ----------
    selected, runner_up : str or None
        Of the last selection; None before it. `runner_up` is also None where a single policy was available.
    score, runner_up_score : float or None
        By the rule's measure.
    belief : dict of str to float
    evidence : dict of str to list of float
        For each type, log F of each of the last signals less that of the type that explains it best: 0 is best,
        minus infinity impossible. A signal that no type explains is 0 for all types.
    policies : list of str
        The policies that gave the last signals.
    log_evidence : list of float
        log Σ F β of each of the last signals: how expected it was.
    surprise : float
        Sum of −log Σ F β over all signals, in nats. It depends on the noise, and is no sign of a new type; use
        `interaction.reuse.novelty`.
    unexplained : int
        Number of signals so far that no type explains.
    novelty : float or None
        Probability that no known type fits; None where the agent does not compute it.
    """

    selected: str | None
    runner_up: str | None
    score: float | None
    runner_up_score: float | None
    belief: dict[str, float]
    evidence: dict[str, list[float]]
    policies: list[str]
    log_evidence: list[float]
    surprise: float
    unexplained: int
    novelty: float | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain data; infinities stay."""
        return asdict(self)


def relative_evidence(evidence: Sequence[Evidence], n_types: int) -> Array:
    """Log likelihoods less each signal's best, (n_signals, n_types), at most 0."""
    rows = np.array([signal.log_likelihood for signal in evidence]).reshape(-1, n_types)
    best = rows.max(axis=1, keepdims=True)
    return np.where(best > -np.inf, rows - np.where(best > -np.inf, best, 0.0), 0.0)


def two_best(scores: Array, selected: int) -> tuple[float, int | None, float | None]:
    """Score of the selected policy, and the best other policy with its score; None where there is no other.

    Policies of score minus infinity were not available.
    """
    others = np.flatnonzero(scores > -np.inf)
    others = others[others != selected]
    if not others.size:
        return float(scores[selected]), None, None
    runner_up = int(others[scores[others].argmax()])
    return float(scores[selected]), runner_up, float(scores[runner_up])
