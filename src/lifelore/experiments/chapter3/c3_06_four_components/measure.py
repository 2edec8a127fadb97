"""Measures and rows of claim C3.6."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate
from lifelore.experiments.chapter3 import factory_gains
from lifelore.experiments.chapter3.factory_gains import rows

__all__ = ["measure", "rows"]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The measures of C3.5 for four components, and what is gained beside one component."""
    return {
        **factory_gains.measure(settings, results),
        **factory_gains.against_one_component(settings, results),
    }
