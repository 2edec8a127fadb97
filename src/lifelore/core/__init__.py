"""Core: errors, random streams, tasks as arrays, fast kernels and metrics; knows no world, prior or file format.

`mdp` defines tasks as tables, `planning` solves them, `learning` learns them, `compiled` compiles kernels.
Rooms exchange the types of `protocols`, `relations` and `labelled_cloud`.
"""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.core.cloud_origin import CloudOrigin as CloudOrigin
    from lifelore.core.errors import InputError as InputError
    from lifelore.core.errors import LifeloreError as LifeloreError
    from lifelore.core.errors import MissingExtraError as MissingExtraError
    from lifelore.core.errors import NotFoundError as NotFoundError
    from lifelore.core.errors import StoreError as StoreError
    from lifelore.core.labelled_cloud import LabelledCloud as LabelledCloud
    from lifelore.core.learning.learning_metrics import learning_gain as learning_gain
    from lifelore.core.learning.q_learner import QLearning as QLearning
    from lifelore.core.learning.transfer import lifetime_transfer as lifetime_transfer
    from lifelore.core.mdp import COLLISION as COLLISION
    from lifelore.core.mdp import NOTHING as NOTHING
    from lifelore.core.mdp import TERMINAL as TERMINAL
    from lifelore.core.mdp import Domain as Domain
    from lifelore.core.mdp import Tables as Tables
    from lifelore.core.mdp import Task as Task
    from lifelore.core.metrics import difference_estimate as difference_estimate
    from lifelore.core.metrics import mean_estimate as mean_estimate
    from lifelore.core.planning.planning import best_actions as best_actions
    from lifelore.core.planning.planning import greedy_policy as greedy_policy
    from lifelore.core.planning.planning import learnt_best_actions as learnt_best_actions
    from lifelore.core.planning.planning import mean_start_value as mean_start_value
    from lifelore.core.planning.planning import optimal_actions as optimal_actions
    from lifelore.core.planning.planning import optimal_q as optimal_q
    from lifelore.core.planning.planning import policy_values as policy_values
    from lifelore.core.protocols import Policy as Policy
    from lifelore.core.protocols import Record as Record
    from lifelore.core.protocols import SignalModel as SignalModel
    from lifelore.core.protocols import World as World
    from lifelore.core.relations import PairLabel as PairLabel
    from lifelore.core.streams import stream as stream

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
