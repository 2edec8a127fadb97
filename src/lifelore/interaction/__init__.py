"""Interaction: choose among known policies by a belief over types (thesis ch. 4).

From the model to the choice: `finite_signals` → `outcomes` → `signals` → `library` and `beliefs` → `selection` →
`reuse` (within it `novelty`: tasks of unknown types). `adaptation` adapts an interface step by step (BEAT),
`baselines` holds bandits and other papers' methods of reuse, `evaluation` estimates the value of other policies
from logged decisions.
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.interaction.adaptation.beat import Beat as Beat
    from lifelore.interaction.baselines.bayes_okr import BayesOKR as BayesOKR
    from lifelore.interaction.baselines.bpr_plus import BPRPlus as BPRPlus
    from lifelore.interaction.baselines.exp3 import EXP3 as EXP3
    from lifelore.interaction.baselines.gp_ucb import GPUCB as GPUCB
    from lifelore.interaction.baselines.interval_estimation import IntervalEstimation as IntervalEstimation
    from lifelore.interaction.baselines.lin_ucb import LinUCB as LinUCB
    from lifelore.interaction.baselines.probabilistic_policy_reuse import (
        ProbabilisticPolicyReuse as ProbabilisticPolicyReuse,
    )
    from lifelore.interaction.baselines.sliding_window_ucb import SlidingWindowUCB as SlidingWindowUCB
    from lifelore.interaction.baselines.thompson import GaussianThompson as GaussianThompson
    from lifelore.interaction.baselines.try_all import TryAll as TryAll
    from lifelore.interaction.baselines.ucb1 import UCB1 as UCB1
    from lifelore.interaction.beliefs.feature_prior import FeaturePrior as FeaturePrior
    from lifelore.interaction.beliefs.type_dynamics import TypeDynamics as TypeDynamics
    from lifelore.interaction.library.policy_library import PolicyLibrary as PolicyLibrary
    from lifelore.interaction.library.task_types import epsilon_types as epsilon_types
    from lifelore.interaction.library.task_types import landmark_library as landmark_library
    from lifelore.interaction.outcomes.joint_normal_fit import joint_normal_fit as joint_normal_fit
    from lifelore.interaction.outcomes.joint_normal_outcomes import JointNormalOutcomes as JointNormalOutcomes
    from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse as BayesianPolicyReuse
    from lifelore.interaction.reuse.novelty.novelty_detector import NoveltyDetector as NoveltyDetector
    from lifelore.interaction.reuse.regret import library_regret as library_regret
    from lifelore.interaction.reuse.reuse_session import load_session as load_session
    from lifelore.interaction.reuse.reuse_session import save_session as save_session
    from lifelore.interaction.reuse.user_beliefs import UserBeliefs as UserBeliefs
    from lifelore.interaction.selection.belief_entropy import BeliefEntropy as BeliefEntropy
    from lifelore.interaction.selection.belief_program import best_plan as best_plan
    from lifelore.interaction.selection.belief_sampling import BeliefSampling as BeliefSampling
    from lifelore.interaction.selection.epsilon_greedy import EpsilonGreedy as EpsilonGreedy
    from lifelore.interaction.selection.expected_improvement import ExpectedImprovement as ExpectedImprovement
    from lifelore.interaction.selection.greedy import Greedy as Greedy
    from lifelore.interaction.selection.information_directed import InformationDirected as InformationDirected
    from lifelore.interaction.selection.knowledge_gradient import KnowledgeGradient as KnowledgeGradient
    from lifelore.interaction.selection.probability_of_improvement import (
        ProbabilityOfImprovement as ProbabilityOfImprovement,
    )
    from lifelore.interaction.selection.rule import Deterministic as Deterministic
    from lifelore.interaction.selection.value_of_perfect_information import (
        ValueOfPerfectInformation as ValueOfPerfectInformation,
    )
    from lifelore.interaction.signals.category_signal import CategorySignal as CategorySignal
    from lifelore.interaction.signals.joint_signal import JointSignal as JointSignal
    from lifelore.interaction.signals.likelihood_signal import LikelihoodSignal as LikelihoodSignal
    from lifelore.interaction.signals.return_signal import ReturnSignal as ReturnSignal
    from lifelore.interaction.signals.reward_signal import RewardSignal as RewardSignal
    from lifelore.interaction.signals.step_reward_signal import StepRewardSignal as StepRewardSignal
    from lifelore.interaction.signals.transition_signal import TransitionSignal as TransitionSignal

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
