"""Functions behind the verbs of the command line; they take settings and return JSON data.

`life` holds the loop of all lives, `travel` what a building does to a robot. `live`, `perceive`, `reuse` and
`advise` are folders, `teach` and `doctor` files. `external_world` holds `live_in`, which lives in a user's own
world. `compile_kernels` compiles the kernels of the verbs before their first use.
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.agent.any_tasks.comparison import compare_agents as compare_agents
    from lifelore.agent.any_tasks.live_in import live_in as live_in
    from lifelore.agent.any_tasks.long_lived_agent import LongLivedAgent as LongLivedAgent
    from lifelore.agent.any_tasks.stored_prior import BatchContexts as BatchContexts
    from lifelore.agent.any_tasks.stored_prior import prior_from_memory as prior_from_memory
    from lifelore.agent.external_world.gymnasium_world import GymnasiumWorld as GymnasiumWorld
    from lifelore.agent.live.life_settings import LifeSettings as LifeSettings
    from lifelore.agent.live.output.l2_log import L2Log as L2Log
    from lifelore.agent.long_lived.check_family import check_family as check_family
    from lifelore.agent.long_lived.long_life import live_long as live_long
    from lifelore.agent.long_lived.task_family import AgentTask as AgentTask
    from lifelore.agent.long_lived.task_family import Plan as Plan
    from lifelore.agent.long_lived.task_family import Step as Step
    from lifelore.agent.long_lived.task_family import TaskFamily as TaskFamily
    from lifelore.agent.perceive.perceive import PerceiveSettings as PerceiveSettings
    from lifelore.agent.types.type_prior import TypePrior as TypePrior

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
