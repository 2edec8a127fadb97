"""C3.11: action priors as proportions, as draws from a Dirichlet and as a softmax, in the modified factory.

Every prior knows the optimal policies of 80 other factories and lists; learners without one know nothing. The
thesis does not say which observations Figure 3.15 uses, how ε falls, or what the counts in the exponent are
divided by: all are crossed in a grid. The default takes φ3, the thesis's best set, and the softmax as printed.

Here an optimal episode's moves cost about what its task pays, so its reward lies near 0 and "within 5 % of the
optimal return" has no scale. *Comparable* is asked of the distance from learning without a prior to the optimum.
Thesis: §3.2.2.1, §3.4.7, Figure 3.15.
"""

from collections.abc import Mapping

from lifelore.action.priors.exploration import TIES
from lifelore.core.errors import InputError
from lifelore.domains.factory.contexts import PHI
from lifelore.domains.factory.factory import N_COMPONENTS
from lifelore.experiments.chapter3.factory_forms import cells, run_cell
from lifelore.experiments.engine.learning_settings import (
    check_among,
    check_counts,
    check_default,
    check_learning,
    check_windows,
)

__all__ = ["cells", "check", "run_cell"]


def check(settings: Mapping) -> None:
    check_counts(settings, ("runs", "policies", "episodes", "early", "max_steps", "components"))
    check_counts(settings, ("test_tasks",), least=2)  # one task has no deviation across tasks
    check_windows(settings, ("early",))
    check_learning(settings)
    check_among(settings, "features", tuple(PHI))
    check_among(settings, "ties", TIES)
    among = {"ties": "ties", "schedule": "schedules", "features": "features", "alpha0": "alpha0"}
    check_default(settings, {**among, "max_steps": "max_steps", "policies": "policies"})
    if settings["components"] > N_COMPONENTS:
        raise InputError(f"components must be at most {N_COMPONENTS}, got {settings['components']}")
    if min(settings["alpha0"]) <= 0:
        raise InputError(f"alpha0 must be positive, got {settings['alpha0']}")
