"""Measures and rows of claim C3.8."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.factory.contexts import PHI
from reproduction.chapter3.c3_08_feature_importance.run import KEYS, grid_of
from reproduction.chapter3.factory.modified_tasks import CARDINALS, DIAGONALS, ITEMS, OWN_CELL
from reproduction.engine.estimates import exact_share, is_above, share_of
from reproduction.engine.results_table import ResultsTable

Runs = Sequence[Mapping]
"""Results of a cell of the grid, run by run."""


def _runs(results: Sequence[Mapping], cell: Mapping) -> Runs:
    return ResultsTable.nested(results, "found", keys=KEYS, outer=("run",)).select(**cell).records


def _increases(runs: Runs, phi: str, features: Sequence[str]) -> NDArray[np.float64]:
    """Δ of features of a set, (n_features, n_runs)."""
    return np.array([[numbers["increase"][phi][feature] for numbers in runs] for feature in features], float)


def gaps(runs: Runs) -> dict[str, Estimate]:
    """By how much the least of N, S, E, W exceeds the largest other, within φ3 and φ4 and from φ2 to φ1, bits."""
    pairs = {"phi4": ("phi4", "phi4"), "phi3": ("phi3", "phi3"), "phi2_to_phi1": ("phi2", "phi1")}
    found = {}
    for name, (ours, theirs) in pairs.items():
        others = [feature for feature in PHI[theirs] if feature not in CARDINALS]
        largest = _increases(runs, theirs, others).max(axis=0)
        found[f"gap_{name}"] = mean_estimate(_increases(runs, ours, CARDINALS).min(axis=0) - largest)
    return found


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Gaps between features and the features selected at the default, and the share of the grid with such gaps."""
    grid = grid_of(settings)
    runs = _runs(results, grid.default)
    least = _increases(runs, "phi4", CARDINALS).min(axis=0)
    groups = (("diagonal", DIAGONALS), ("own_cell", (OWN_CELL,)), ("items", (ITEMS,)))
    chosen = [set(numbers["chosen"]["phi4"]) == set(CARDINALS) for numbers in runs]
    consistent = [all(is_above(gap, 0.0) for gap in gaps(_runs(results, c)).values()) for c in grid.cells]
    return {
        **{f"entropy_{phi}": mean_estimate([numbers["entropy"][phi] for numbers in runs]) for phi in PHI},
        **{f"{n}_share_phi4": ratio_estimate(_increases(runs, "phi4", g).max(axis=0), least) for n, g in groups},
        "exactly_four_selected": exact_share(chosen),
        **gaps(runs),
        "grid_consistent": share_of(consistent),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row for each cell of the grid: Δ of each feature in each set, shares of runs selected from φ4, gaps."""
    found = []
    for cell in grid_of(settings).cells:
        runs = _runs(results, cell)
        increase = {
            phi: {name: mean_estimate(_increases(runs, phi, [name])[0]).to_dict() for name in names}
            for phi, names in PHI.items()
        }
        chosen = [numbers["chosen"]["phi4"] for numbers in runs]
        selected = {name: float(np.mean([name in names for names in chosen])) for name in PHI["phi4"]}
        own_gaps = {name: gap.to_dict() for name, gap in gaps(runs).items()}
        found.append({**cell, "increase": increase, "selected": selected, **own_gaps})
    return found
