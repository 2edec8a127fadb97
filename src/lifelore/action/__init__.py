"""Action: priors over actions, and what they guide (thesis ch. 3).

`priors` counts which actions were best, `features` chooses what to condition on, `search` guides planners,
`demonstrations` learns from people, `advice` advises agents whose goals are unknown.
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.action.advice.advisor import AdviceSettings as AdviceSettings
    from lifelore.action.advice.advisor import Advisor as Advisor
    from lifelore.action.advice.agent_classes import ClassAdvisor as ClassAdvisor
    from lifelore.action.advice.goal_model import GoalModel as GoalModel
    from lifelore.action.advice.goal_model import Trajectory as Trajectory
    from lifelore.action.advice.outcome_map import OutcomeMap as OutcomeMap
    from lifelore.action.demonstrations.demonstrations import Demonstration as Demonstration
    from lifelore.action.demonstrations.demonstrations import count_demonstrations as count_demonstrations
    from lifelore.action.demonstrations.demonstrations import read_demonstrations as read_demonstrations
    from lifelore.action.features.counted_features import CountedFeatures as CountedFeatures
    from lifelore.action.features.feature_acquisition import FeatureAcquisition as FeatureAcquisition
    from lifelore.action.features.feature_function import AgentClass as AgentClass
    from lifelore.action.features.feature_function import JoinedFeatures as JoinedFeatures
    from lifelore.action.features.feature_function import LastReward as LastReward
    from lifelore.action.features.feature_function import StateFeatures as StateFeatures
    from lifelore.action.features.feature_function import TaskFeature as TaskFeature
    from lifelore.action.features.feature_function import context_codes as context_codes
    from lifelore.action.features.feature_rows import feature_rows as feature_rows
    from lifelore.action.features.feature_selection import OnlineFeatureSelection as OnlineFeatureSelection
    from lifelore.action.features.feature_selection import best_feature_set as best_feature_set
    from lifelore.action.features.feature_selection import independent_features as independent_features
    from lifelore.action.features.feature_set import FeatureSet as FeatureSet
    from lifelore.action.features.learnt_contexts import LearntContexts as LearntContexts
    from lifelore.action.features.uncertainty import why_uncertain as why_uncertain
    from lifelore.action.priors.action_prior import ActionPrior as ActionPrior
    from lifelore.action.priors.exploration import prior_rows as prior_rows
    from lifelore.action.priors.prior_file import load_prior as load_prior
    from lifelore.action.priors.prior_file import save_prior as save_prior
    from lifelore.action.priors.prior_report import prior_report as prior_report
    from lifelore.action.search.domain_reduction import MinimisedDomain as MinimisedDomain
    from lifelore.action.search.domain_reduction import domain_futile_actions as domain_futile_actions
    from lifelore.action.search.domain_reduction import domain_futile_states as domain_futile_states
    from lifelore.action.search.domain_reduction import futile_goal_probability as futile_goal_probability
    from lifelore.action.search.domain_reduction import minimised_domain as minimised_domain
    from lifelore.action.search.domain_reduction import minimised_transitions as minimised_transitions
    from lifelore.action.search.domain_reduction import reachable_states as reachable_states

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
