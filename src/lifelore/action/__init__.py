"""Action: priors over actions, and what they guide (thesis ch. 3).

`priors` counts which actions were best, `features` chooses what to condition on, `search` guides planners,
`demonstrations` learns from people, `advice` advises agents whose goals are unknown.

What users call can be imported from here, and is loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lifelore.action.advice.advisor import AdviceSettings, Advisor
    from lifelore.action.advice.goal_model import GoalModel
    from lifelore.action.features.counted_features import CountedFeatures
    from lifelore.action.features.feature_function import (
        JoinedFeatures,
        LastReward,
        StateFeatures,
        TaskFeature,
        context_codes,
    )
    from lifelore.action.features.feature_rows import feature_rows
    from lifelore.action.features.feature_selection import OnlineFeatureSelection, independent_features
    from lifelore.action.features.feature_set import FeatureSet
    from lifelore.action.features.learnt_contexts import LearntContexts
    from lifelore.action.priors.action_prior import ActionPrior
    from lifelore.action.priors.exploration import prior_rows
    from lifelore.action.search.domain_reduction import (
        MinimisedDomain,
        futile_goal_probability,
        minimised_domain,
        minimised_transitions,
        reachable_states,
    )

__all__ = [
    "ActionPrior",
    "AdviceSettings",
    "Advisor",
    "CountedFeatures",
    "FeatureSet",
    "GoalModel",
    "JoinedFeatures",
    "LastReward",
    "LearntContexts",
    "MinimisedDomain",
    "OnlineFeatureSelection",
    "StateFeatures",
    "TaskFeature",
    "context_codes",
    "feature_rows",
    "futile_goal_probability",
    "independent_features",
    "minimised_domain",
    "minimised_transitions",
    "prior_rows",
    "reachable_states",
]

_HOME = {
    "ActionPrior": "lifelore.action.priors.action_prior",
    "AdviceSettings": "lifelore.action.advice.advisor",
    "Advisor": "lifelore.action.advice.advisor",
    "CountedFeatures": "lifelore.action.features.counted_features",
    "FeatureSet": "lifelore.action.features.feature_set",
    "GoalModel": "lifelore.action.advice.goal_model",
    "JoinedFeatures": "lifelore.action.features.feature_function",
    "LastReward": "lifelore.action.features.feature_function",
    "LearntContexts": "lifelore.action.features.learnt_contexts",
    "MinimisedDomain": "lifelore.action.search.domain_reduction",
    "OnlineFeatureSelection": "lifelore.action.features.feature_selection",
    "StateFeatures": "lifelore.action.features.feature_function",
    "TaskFeature": "lifelore.action.features.feature_function",
    "context_codes": "lifelore.action.features.feature_function",
    "feature_rows": "lifelore.action.features.feature_rows",
    "futile_goal_probability": "lifelore.action.search.domain_reduction",
    "independent_features": "lifelore.action.features.feature_selection",
    "minimised_domain": "lifelore.action.search.domain_reduction",
    "minimised_transitions": "lifelore.action.search.domain_reduction",
    "prior_rows": "lifelore.action.priors.exploration",
    "reachable_states": "lifelore.action.search.domain_reduction",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
