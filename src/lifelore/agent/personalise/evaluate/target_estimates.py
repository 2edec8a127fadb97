"""Estimates of a target policy's mean outcome from logged decisions, and what the log cannot tell about it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.personalise.evaluate.logged_decisions import CERTAIN, MOST_CERTAIN
from lifelore.agent.personalise.evaluate.target_policies import TargetPolicy
from lifelore.agent.personalise.log.log import ReuseLog
from lifelore.interaction.evaluation.estimate_by_user import ClusteredEstimate
from lifelore.interaction.evaluation.estimators import doubly_robust, inverse_propensity, self_normalised
from lifelore.interaction.evaluation.propensity_weights import (
    WeightSummary,
    decision_numbers,
    importance_weights,
    trajectory_weights,
    weight_summary,
)
from lifelore.interaction.evaluation.reward_models import RewardModel

Array = NDArray[np.float64]

ESTIMATORS = ("ips", "self-normalised", "doubly-robust")
LEAST_EFFECTIVE_USERS = 20.0
"""Below so many effective users, 95 % intervals cover the truth less often."""
LARGEST_SHARE = 0.1
"""Share of a user in all weights above which a warning names it."""
MEAN_WEIGHT_ERRORS = 3.3
"""Standard errors between the mean weight and 1 from which a warning says so; right logs give it once in 1,000."""


def target_estimates(
    target: TargetPolicy, log: ReuseLog, model: RewardModel, logged: ClusteredEstimate, whole: bool
) -> dict[str, Any]:
    """The entry of a target in the document of `evaluate`.

    Parameters
    ----------
    target : TargetPolicy
    log : ReuseLog
        With probabilities.
    model : RewardModel
        Of the doubly robust estimate.
    logged : ClusteredEstimate
        Mean outcome of the log, for the gain.
    whole : bool
        Whether an adaptive target makes all decisions of a user, and not each one after the logged outcomes.
    """
    users, probability = log.user.codes, np.asarray(log.probability)
    weights, before, steps = importance_weights(target.of_logged, probability), None, None
    whole = whole and target.adaptive
    if whole:
        before, weights = trajectory_weights(weights, users)
        steps = decision_numbers(users)
    alone = (probability >= CERTAIN) * (1 - target.of_logged)
    support = 1 - max(float(alone.mean()), target.untried)
    summary = weight_summary(weights, users)
    estimates: dict[str, Any] = dict.fromkeys(ESTIMATORS)
    if support >= 1 - MOST_CERTAIN and weights.any():
        found = {
            "ips": inverse_propensity(log.outcomes, weights, users),
            "self-normalised": _self_normalised(log.outcomes, weights, users, steps),
            "doubly-robust": doubly_robust(
                log.outcomes, weights, model.of_policies(log.policy.codes), target.expected, users, before
            ),
        }
        estimates = {
            name: one and one.to_dict() | {"gain": one.minus(logged).to_dict()} for name, one in found.items()
        }
    return {
        "name": target.name,
        "kind": target.kind,
        "decision": "all" if whole else "next",
        "estimates": estimates,
        "support": support,
        "weights": summary.to_dict(),
        "warnings": _warnings(target, support, summary),
    }


def _self_normalised(
    outcomes: Array, weights: Array, users: NDArray[np.int64], steps: NDArray[np.int64] | None
) -> ClusteredEstimate | None:
    """The estimate; None where no user's decisions agree with the target up to some step."""
    if steps is not None and not (np.bincount(steps, weights) > 0).all():
        return None
    return self_normalised(outcomes, weights, users, steps)


def _warnings(target: TargetPolicy, support: float, weights: WeightSummary) -> list[str]:
    """What the log cannot tell about a target, one sentence each."""
    if support < 1:
        share = f"{1 - support:.1%}".replace("%", " %")
        reason = (
            "the log never chose its policy" if target.untried else "the log had no alternative to another policy"
        )
        end = "not evaluated" if support < 1 - MOST_CERTAIN else "its estimates leave these decisions out"
        said = [f"in {share} of the decisions {reason} (probability 0): {end}"]
        if support < 1 - MOST_CERTAIN:
            return said
    else:
        said = []
    if weights.mean == 0:
        return [*said, "the log never decided as it would: not evaluated"]
    if weights.effective_users < LEAST_EFFECTIVE_USERS:
        said.append(
            f"the weights leave the evidence of {weights.effective_users:.1f} users; do not trust intervals below "
            f"{LEAST_EFFECTIVE_USERS:g}"
        )
    elif weights.largest_share > LARGEST_SHARE:
        said.append(
            f"a single user carries {weights.largest_share:.0%} of the weight".replace("%", " %")
            + f"; the largest weight of a decision is {weights.largest:.3g}"
        )
    if abs(weights.mean - 1) > MEAN_WEIGHT_ERRORS * weights.standard_error > 0:
        said.append(
            f"the mean weight is {weights.mean:.3g} ± {1.96 * weights.standard_error:.2g} and should be 1: the "
            "logged probabilities are wrong, or the log never chooses its policy somewhere"
        )
    return said
