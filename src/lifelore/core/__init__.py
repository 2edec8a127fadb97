"""Core: errors, random streams, tasks as arrays, fast kernels and metrics; knows no world, prior or file format.

`mdp` defines tasks as tables, `planning` solves them, `learning` learns them, `compiled` compiles kernels.
Rooms exchange the types of `protocols`, `relations` and `labelled_cloud`.

What users call can be imported from here, and is loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lifelore.core.learning.q_learner import QLearning
    from lifelore.core.mdp import Domain, Tables, Task
    from lifelore.core.planning.planning import (
        best_actions,
        learnt_best_actions,
        optimal_actions,
        optimal_q,
        policy_values,
    )
    from lifelore.core.streams import stream

__all__ = [
    "Domain",
    "QLearning",
    "Tables",
    "Task",
    "best_actions",
    "learnt_best_actions",
    "optimal_actions",
    "optimal_q",
    "policy_values",
    "stream",
]

_HOME = {
    "Domain": "lifelore.core.mdp",
    "QLearning": "lifelore.core.learning.q_learner",
    "Tables": "lifelore.core.mdp",
    "Task": "lifelore.core.mdp",
    "best_actions": "lifelore.core.planning.planning",
    "learnt_best_actions": "lifelore.core.planning.planning",
    "optimal_actions": "lifelore.core.planning.planning",
    "optimal_q": "lifelore.core.planning.planning",
    "policy_values": "lifelore.core.planning.planning",
    "stream": "lifelore.core.streams",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
