"""Measures and rows of claim C3.6."""

from collections.abc import Mapping, Sequence

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter3.c3_05_one_component import measure as one_component
from reproduction.chapter3.c3_05_one_component.measure import Series, rows

__all__ = ["measure", "rows"]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The measures of C3.5 for four components, and the difference from one component."""
    many, single = (Series.of(results, k) for k in settings["components"])
    found = {}
    for encoding in settings["encodings"]:
        closed, closed_single = (series.closed(f"exact {encoding}", settings["late"]) for series in (many, single))
        found[f"closed_minus_one_component_{encoding}"] = mean_estimate(closed - closed_single)
    default = found[f"closed_minus_one_component_{settings['default']['encoding']}"]
    return {**one_component.measure(settings, results), "closed_minus_one_component": default, **found}
