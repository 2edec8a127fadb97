"""Off-policy evaluation: the value of other policies, estimated from logged decisions with their probabilities.

Read in this order: `estimate_by_user`, `propensity_weights`, `estimators`, `reward_models`. All functions take
plain arrays with one row a decision.
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.interaction.evaluation.estimate_by_user import ClusteredEstimate as ClusteredEstimate
    from lifelore.interaction.evaluation.estimate_by_user import clustered_estimate as clustered_estimate
    from lifelore.interaction.evaluation.estimators import doubly_robust as doubly_robust
    from lifelore.interaction.evaluation.estimators import inverse_propensity as inverse_propensity
    from lifelore.interaction.evaluation.estimators import logged_value as logged_value
    from lifelore.interaction.evaluation.estimators import self_normalised as self_normalised
    from lifelore.interaction.evaluation.propensity_weights import WeightSummary as WeightSummary
    from lifelore.interaction.evaluation.propensity_weights import importance_weights as importance_weights
    from lifelore.interaction.evaluation.propensity_weights import trajectory_weights as trajectory_weights
    from lifelore.interaction.evaluation.propensity_weights import weight_summary as weight_summary
    from lifelore.interaction.evaluation.reward_models import policy_means as policy_means

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
