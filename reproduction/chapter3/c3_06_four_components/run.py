"""C3.6: the same as C3.5 with four components, of whose tasks only a fraction is met.

Thesis: §3.4.3, Figure 3.9.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter3.c3_05_one_component import run as one_component
from reproduction.chapter3.c3_05_one_component.run import Sequences, grid_of, windows
from reproduction.engine.grid import Cell
from reproduction.engine.records import having

cells, run_cell, shared = one_component.cells, one_component.run_cell, one_component.shared
rows, draw = one_component.rows, one_component.draw


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """How many tasks were met, and the late gain of one component."""
    _, one = _late_shares(settings, results, grid_of(settings).default)
    return {**one_component.measure(settings, results), "gain_of_one": mean_estimate(one)}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
    """The gains of C3.5 for four components in every cell of the grid, and how far they are above those of one."""
    for cell, found in one_component.readings(settings, results):
        many, one = _late_shares(settings, results, cell)
        yield cell, {**found, "gain_less_one_component": mean_estimate(many - one)}


def _late_shares(
    settings: Mapping, results: Sequence[Mapping], cell: Mapping
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The late gains as shares of the distance, (n_runs,): of four components, and of one."""
    grid, late = grid_of(settings), windows(settings)[1]
    many, one = (
        Sequences.of(having(results, components=k), grid, cell).share(late) for k in settings["components"][:2]
    )
    return many, one


def check(settings: Mapping) -> None:
    """Refuse settings without a second number of components to compare with."""
    if len(settings["components"]) < 2:
        raise InputError(f"components must be two numbers to compare, got {settings['components']}")
