"""What an agent says for itself: what its signals said of each type, and why it selects as it does."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

KEPT = 16
"""Signals whose evidence an agent keeps."""
MOST_SURPRISE = 745.0
"""Nats that one signal adds to the surprise at most, as the impossible does: −log of the smallest number."""


class Evidence(NamedTuple):
    """What one signal said.

    policy : int
    log_likelihood : (n_types,) float64, log F(σ | τ, π)
    log_evidence : float, log Σ F β before it was absorbed; minus infinity where no type explains the signal
    """

    policy: int
    log_likelihood: Array
    log_evidence: float


@dataclass(frozen=True)
class Explanation:
    """Why the agent stands where it does; everything by name, types with the most belief first.

    Parameters
    ----------
    selected, runner_up : str or None
        Of the last selection; None before it, or where there is one policy only.
    score, runner_up_score : float or None
        By the rule's measure.
    belief : dict of str to float
    evidence : dict of str to list of float
        For each type, log F of each of the last signals less that of the type that explains it best: 0 is best,
        minus infinity impossible. A signal that no type explains says nothing and is 0 for all.
    policies : list of str
        What the last signals were answers to.
    log_evidence : list of float
        How expected each of them was, log Σ F β.
    surprise : float
    unexplained : int
        Signals so far that no type explains.
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

    def to_dict(self) -> dict[str, Any]:
        """Plain data; infinities stay."""
        return asdict(self)


def surprise_of(log_evidence: float) -> float:
    """What a signal of this evidence adds to the surprise, in nats; negative for densities above 1."""
    return min(-log_evidence, MOST_SURPRISE)


def relative_evidence(kept: Sequence[Evidence], n_types: int) -> Array:
    """Log likelihoods less each signal's best, (n_signals, n_types), at most 0."""
    if not kept:
        return np.zeros((0, n_types))
    rows = np.array([one.log_likelihood for one in kept])
    best = rows.max(axis=1, keepdims=True)
    return np.where(best > -np.inf, rows - np.where(best > -np.inf, best, 0.0), 0.0)


def two_best(scores: Array, selected: int) -> tuple[float, int | None, float | None]:
    """Score of the policy selected, and the best of the others with its score (None where there is none)."""
    if len(scores) < 2:
        return float(scores[selected]), None, None
    others = np.array(scores)
    others[selected] = -np.inf
    # Where all others are at minus infinity, any of them but the selected one is next.
    runner_up = int(others.argmax()) if others.max() > -np.inf else int(selected == 0)
    return float(scores[selected]), runner_up, float(scores[runner_up])
