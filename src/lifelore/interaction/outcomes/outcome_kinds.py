"""Registry of the outcome models by name."""

from typing import Any

from lifelore.core.errors import InputError
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.outcomes.gaussian_outcomes import GaussianOutcomes
from lifelore.interaction.outcomes.histogram_outcomes import HistogramOutcomes
from lifelore.interaction.outcomes.student_t_outcomes import StudentTOutcomes

KINDS: dict[str, Any] = {
    kind.kind: kind for kind in (GaussianOutcomes, StudentTOutcomes, HistogramOutcomes, CategoricalOutcomes)
}


def outcome_kind(name: str) -> Any:
    """The class of that name; InputError where there is no such class."""
    if name not in KINDS:
        raise InputError(f"model must be one of {', '.join(sorted(KINDS))}, got {name!r}")
    return KINDS[name]
