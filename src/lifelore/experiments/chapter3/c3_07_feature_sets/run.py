"""C3.7: in factories that change with each task, priors over features beside a prior over states and none.

Every prior knows the optimal policies of the same 80 other factories and lists; learners without one know nothing.
The thesis does not say how ε falls, how ties are broken, what α⁰ is, when an episode is broken off, or how a
configuration is coded in the prior over states: all are varied. As in C3.11 an optimal episode's moves cost about
what its task pays, so *nearly as good* is asked of the distance from learning without a prior to the optimum.
Thesis: §3.4.4, §3.4.5, Figure 3.11.
"""

from collections.abc import Mapping

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.domains.factory.contexts import ENCODINGS
from lifelore.domains.factory.factory import N_COMPONENTS
from lifelore.experiments.chapter3.feature_priors import KEYS, cells, run_cell
from lifelore.experiments.engine.learning_settings import (
    check_among,
    check_counts,
    check_default,
    check_learning,
    check_windows,
)

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    counts = ("runs", "policies", "test_tasks", "episodes", "early", "max_steps", "components")
    check_counts(settings, counts)
    check_windows(settings, ("early",))
    check_learning(settings)
    check_among(settings, "encodings", ENCODINGS)
    check_among(settings, "ties", TIES)
    among = {"encoding": "encodings", "schedule": "schedules", **{k: k for k in KEYS[2:]}}
    check_default(settings, among)
    check_components(settings)
    if min(settings["alpha0"]) <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")


def check_components(settings: Mapping) -> None:
    """Raise `InputError` for more components than a factory has points for."""
    if settings["components"] > N_COMPONENTS:
        raise InputError(f"components must be at most {N_COMPONENTS}, got {settings['components']}")
