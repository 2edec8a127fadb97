"""C3.7: learners in new factories, with priors over features and over states, and without a prior.

Every prior counts the exact optimal policies of the same training factories, in all states alike.
Thesis: §3.4.4, §3.4.5, Figure 3.11.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate
from lifelore.domains.factory.contexts import PHI
from reproduction.chapter3.factory import comparison, modified_tasks
from reproduction.chapter3.factory.comparison import UNIFORM, Comparison, is_default, summary
from reproduction.chapter3.factory.learning import with_pseudo_count
from reproduction.chapter3.learning.schedules import schedule_of
from reproduction.engine.grid import Cell, Grid, run_grid

STATE = "state"
METHODS = (UNIFORM, STATE, *PHI)
PAIRS = {
    "phi3_minus_phi1": ("phi3", "phi1"),
    "phi3_minus_phi2": ("phi3", "phi2"),
    "phi4_minus_phi3": ("phi4", "phi3"),
    "state_minus_uniform": (STATE, UNIFORM),
    **{f"{phi}_minus_state": (phi, STATE) for phi in PHI},
}


def grid_of(settings: Mapping) -> Grid:
    """The grid; only the prior over states reads the code of states."""
    keys = ("schedule", "ties", "encoding", "alpha0", "max_steps", "policies")
    of_features = [key for key in keys if key != "encoding"]
    return comparison.grid_of(settings, keys[:2], keys[2:], dict.fromkeys(PHI, of_features))


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """One run: every method in every cell of the grid."""
    own, grid = (seed, "C3.7", cell["run"]), grid_of(settings)
    conditions = [*PHI, *(f"{STATE} {encoding}" for encoding in settings["encoding"])]
    priors = modified_tasks.exact_priors(settings, (*own, "training"), conditions)
    testing = modified_tasks.problems_of(settings, (*own, "testing"), settings["test_tasks"])

    def numbers(method: str, how: Cell) -> dict:
        name = f"{STATE} {how['encoding']}" if method == STATE else method

        def rows_for(problem: modified_tasks.Problem):
            if method == UNIFORM:
                return None
            prior = with_pseudo_count(priors[name, how["policies"]], how["alpha0"])
            return modified_tasks.rows_of(problem, name, prior.probs, how["ties"])

        schedule = schedule_of({**settings, "max_steps": how["max_steps"]}, how["schedule"])
        curves = modified_tasks.curves_of(testing, rows_for, schedule)
        return summary(curves, settings["early"], is_default(grid, how))

    found = list(run_grid(grid, "method", UNIFORM, METHODS[1:], numbers))
    return {**cell, "optimal": float(np.mean([problem.optimal for problem in testing])), "found": found}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The comparisons at the default, over all episodes."""
    found = Comparison(results, grid_of(settings))
    return {**found.shares(found.grid.default, PAIRS), **found.remarks(METHODS)}


def readings(settings: Mapping, results: Sequence[Mapping]) -> Iterator[tuple[Cell, dict[str, Estimate]]]:
    """The comparisons in every cell of the grid."""
    found = Comparison(results, grid_of(settings))
    for cell in found.grid.cells:
        yield cell, found.shares(cell, PAIRS)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """The curve of each method at the default."""
    found = Comparison(results, grid_of(settings))
    return [found.curve(method, found.grid.default) for method in METHODS]
