"""Lifelore: an agent that lives long in one kind of world and becomes good at that world.

The public names, each imported when first used, so that ``import lifelore`` costs nothing:

>>> import lifelore
>>> prior = lifelore.ActionPrior(n_actions=4)
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.action.features.learnt_contexts import LearntContexts as LearntContexts
    from lifelore.action.priors.action_prior import ActionPrior as ActionPrior
    from lifelore.agent.any_tasks.comparison import compare_agents as compare_agents
    from lifelore.agent.any_tasks.live_in import live_in as live_in
    from lifelore.agent.any_tasks.long_lived_agent import LongLivedAgent as LongLivedAgent
    from lifelore.agent.any_tasks.stored_prior import BatchContexts as BatchContexts
    from lifelore.agent.any_tasks.stored_prior import prior_from_memory as prior_from_memory
    from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld as GymnasiumWorld
    from lifelore.agent.live.life import live as live
    from lifelore.agent.live.life_settings import LifeSettings as LifeSettings
    from lifelore.agent.live.life_settings import MemorySettings as MemorySettings
    from lifelore.agent.long_lived.check_family import check_family as check_family
    from lifelore.agent.long_lived.long_life import live_long as live_long
    from lifelore.agent.long_lived.task_family import AgentTask as AgentTask
    from lifelore.agent.long_lived.task_family import Plan as Plan
    from lifelore.agent.long_lived.task_family import Step as Step
    from lifelore.agent.long_lived.task_family import TaskFamily as TaskFamily
    from lifelore.agent.perceive.perceive import PerceiveSettings as PerceiveSettings
    from lifelore.agent.perceive.perceive import perceive as perceive
    from lifelore.agent.recognise import recognise as recognise
    from lifelore.agent.way import way as way
    from lifelore.core.cloud_origin import CloudOrigin as CloudOrigin
    from lifelore.core.errors import LifeloreError as LifeloreError
    from lifelore.core.labelled_cloud import LabelledCloud as LabelledCloud
    from lifelore.core.learning.q_learner import QLearning as QLearning
    from lifelore.core.mdp import Domain as Domain
    from lifelore.core.mdp import Tables as Tables
    from lifelore.core.mdp import Task as Task
    from lifelore.core.protocols import Policy as Policy
    from lifelore.core.protocols import Record as Record
    from lifelore.core.protocols import SignalModel as SignalModel
    from lifelore.core.protocols import World as World
    from lifelore.core.relations import PairLabel as PairLabel
    from lifelore.domains.task_stream import TaskStream as TaskStream
    from lifelore.domains.worlds import WorldSettings as WorldSettings
    from lifelore.domains.worlds import make_world as make_world
    from lifelore.figures.lives.prior_table import plot_prior as plot_prior
    from lifelore.interaction.adaptation.beat import Beat as Beat
    from lifelore.interaction.library.policy_library import PolicyLibrary as PolicyLibrary
    from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse as BayesianPolicyReuse
    from lifelore.interaction.reuse.user_beliefs import UserBeliefs as UserBeliefs
    from lifelore.memory import Memory as Memory
    from lifelore.memory import open_memory as open_memory
    from lifelore.perception.clouds.cloud_file import read_cloud as read_cloud
    from lifelore.perception.contacts.contact_network import ContactPointNetwork as ContactPointNetwork
    from lifelore.perception.contacts.contact_settings import ContactSettings as ContactSettings
    from lifelore.perception.contacts.pair_networks import contact_networks as contact_networks
    from lifelore.perception.relations.relation_classifier import RelationClassifier as RelationClassifier
    from lifelore.perception.scene import Scene as Scene
    from lifelore.perception.scene_perception import perceived_scene as perceived_scene
    from lifelore.perception.segmentation.table_frame import to_scene as to_scene
    from lifelore.verbs import learn_from as learn_from

__version__ = "0.2.0"

__all__, __getattr__, __dir__ = lazy_exports(__name__, "__version__")  # pyright: ignore[reportUnsupportedDunderAll]
