"""The outcome models, P(U | type, policy) for every pair of a type and a policy, by name.

`GaussianOutcomes` (with shrunk deviations) is the default. `StudentTOutcomes` accounts for the uncertainty of a
few samples. `HistogramOutcomes` and `CategoricalOutcomes` are for other distributions. `JointNormalOutcomes` is
fitted to users side by side, not to samples of types: see `joint_normal_fit`. Thesis: §4.3.4, Def. 4.3.4.
"""

from typing import Any

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.joint_normal_outcomes import JointNormalOutcomes
from lifelore.interaction.outcomes.student_t_outcomes import StudentTOutcomes

KINDS: dict[str, Any] = {
    kind.kind: kind for kind in (GaussianOutcomes, StudentTOutcomes, HistogramOutcomes, CategoricalOutcomes)
}
"""Models that are fitted to samples of types."""
STORED: dict[str, Any] = KINDS | {JointNormalOutcomes.kind: JointNormalOutcomes}
"""Models that a library's file can hold."""


def outcome_kind(name: str) -> Any:
    """The class of that name; InputError where there is no such class."""
    if name not in KINDS:
        raise InputError(f"model must be one of {', '.join(sorted(KINDS))}, got {name!r}")
    return KINDS[name]
