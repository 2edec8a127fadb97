"""Interaction: choose among known policies by a belief over types (thesis ch. 4).

From the model to the choice: `finite_signals` → `outcomes` → `signals` → `library` and `beliefs` → `selection` →
`reuse` (within it `novelty`: tasks of unknown types). `adaptation` adapts an interface step by step (BEAT),
`baselines` holds bandits and other papers' methods of reuse, `evaluation` estimates the value of other policies
from logged decisions.

What users call can be imported from here, and is loaded when first used.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lifelore.interaction.adaptation.beat import Beat
    from lifelore.interaction.baselines.probabilistic_policy_reuse import ProbabilisticPolicyReuse
    from lifelore.interaction.beliefs.type_dynamics import TypeDynamics
    from lifelore.interaction.library.policy_library import PolicyLibrary
    from lifelore.interaction.reuse.bayesian_policy_reuse import BayesianPolicyReuse
    from lifelore.interaction.reuse.user_beliefs import UserBeliefs
    from lifelore.interaction.signals.transition_signal import TransitionSignal

__all__ = [
    "BayesianPolicyReuse",
    "Beat",
    "PolicyLibrary",
    "ProbabilisticPolicyReuse",
    "TransitionSignal",
    "TypeDynamics",
    "UserBeliefs",
]

_HOME = {
    "BayesianPolicyReuse": "lifelore.interaction.reuse.bayesian_policy_reuse",
    "Beat": "lifelore.interaction.adaptation.beat",
    "PolicyLibrary": "lifelore.interaction.library.policy_library",
    "ProbabilisticPolicyReuse": "lifelore.interaction.baselines.probabilistic_policy_reuse",
    "TransitionSignal": "lifelore.interaction.signals.transition_signal",
    "TypeDynamics": "lifelore.interaction.beliefs.type_dynamics",
    "UserBeliefs": "lifelore.interaction.reuse.user_beliefs",
}


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
