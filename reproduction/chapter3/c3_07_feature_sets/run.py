"""C3.7: learners in new factories, with priors over features and over states, and without a prior.

Every prior counts the exact optimal policies of the same training factories, in all states alike.
Thesis: §3.4.4, §3.4.5, Figure 3.11.
"""

from collections.abc import Callable, Mapping
from functools import partial

from lifelore.core.learning.q_learning import Rows
from lifelore.domains.factory.contexts import PHI
from lifelore.figures.style import GREY, VERMILION, colour_of
from reproduction.chapter3.factory import comparison, modified_tasks
from reproduction.chapter3.factory.comparison import UNIFORM
from reproduction.chapter3.factory.figure import one_panel
from reproduction.chapter3.factory.learning import Problem, rows_of, with_pseudo_count
from reproduction.engine.grid import Cell, Grid

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
    own = (seed, "C3.7", cell["run"])
    conditions = [*PHI, *(f"{STATE} {encoding}" for encoding in settings["encoding"])]
    priors = modified_tasks.exact_priors(settings, (*own, "training"), conditions)

    def rows_of_method(method: str, how: Cell) -> Callable[[Problem], Rows]:
        name = f"{STATE} {how['encoding']}" if method == STATE else method
        prior = with_pseudo_count(priors[name, how["policies"]], how["alpha0"])
        return lambda problem: rows_of(problem, name, prior.probs, how["ties"])

    return {**cell, **modified_tasks.compared(settings, grid_of(settings), own, METHODS, rows_of_method)}


measure, readings, rows = comparison.functions_of(grid_of, METHODS, lambda found, cell: found.shares(cell, PAIRS))


LOOKS = {
    "uniform": ("uniform prior", GREY),
    "state": ("state prior", VERMILION),
    "phi1": ("φ1: own cell, Items", colour_of("phi1")),
    "phi2": ("φ2: N, S, E, W", colour_of("phi2")),
    "phi3": ("φ3: φ1 and φ2", colour_of("phi3")),
    "phi4": ("φ4: 3×3 cells, Items", colour_of("phi4")),
}

draw = partial(one_panel, looks=LOOKS, plain=("state", "phi1", "phi2", "phi4"))
"""Figure of claim C3.7: rewards with priors over four sets of features, over states, and without a prior."""
