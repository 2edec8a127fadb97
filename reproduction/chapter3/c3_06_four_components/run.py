"""C3.6: the same as C3.5 with four components, of whose tasks only a fraction is met.

Thesis: §3.4.3, Figure 3.9.
"""

from collections.abc import Iterator, Mapping, Sequence

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter3.c3_05_one_component import run as one_component
from reproduction.chapter3.c3_05_one_component.run import (
    Sequences,
    cells,
    grid_of,
    of_components,
    rows,
    run_cell,
    shared,
    windows,
)
from reproduction.engine.grid import Cell

__all__ = ["cells", "check", "measure", "readings", "rows", "run_cell", "shared"]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The gains of C3.5 for four components, and how their late share differs from that of one component."""
    similar = _less_one_component(settings, results, grid_of(settings).default)
    return {**one_component.measure(settings, results), **similar}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
    """The same in every cell of the grid."""
    for cell, found in one_component.readings(settings, results):
        yield cell, {**found, **_less_one_component(settings, results, cell)}


def _less_one_component(settings: Mapping, results: Sequence[Mapping], cell: Mapping) -> dict[str, Estimate]:
    grid, late = grid_of(settings), windows(settings)[1]
    many, one = (
        Sequences.of(of_components(results, k), grid, cell).share(late) for k in settings["components"][:2]
    )
    return {"gain_less_one_component": mean_estimate(many - one)}


def check(settings: Mapping) -> None:
    """Refuse settings without a second number of components to compare with."""
    if len(settings["components"]) < 2:
        raise InputError(f"components must be two numbers to compare, got {settings['components']}")
