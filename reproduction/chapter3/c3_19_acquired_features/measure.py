"""Measures and rows of claim C3.19."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, ratio_estimate
from reproduction.chapter3.c3_19_acquired_features.run import (
    ACQUIRED,
    ALL,
    KEYS,
    METHODS,
    NOISE,
    PLAIN,
    POOL,
    START,
    STARTS,
    grid_of,
)
from reproduction.chapter3.factory.modified_tasks import CARDINALS
from reproduction.engine.estimates import exact_share, share_of
from reproduction.engine.results_table import BAND, ResultsTable


def _table(results: Sequence[Mapping]) -> ResultsTable:
    return ResultsTable.nested(results, "found", keys=("method", *KEYS), outer=("run",))


def _has(results: Sequence[Mapping], where: Mapping, feature: str) -> list[bool]:
    """Whether the agent of a cell has a feature at the end, by run."""
    own = [next(f for f in result["found"] if all(f[k] == v for k, v in where.items())) for result in results]
    return [feature in found["features"] for found in own]


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Entropy, surprise and rewards at the default, features acquired there, and the share of the grid."""
    table, grid = _table(results), grid_of(settings)
    at = {method: grid.where(method, grid.default) for method in (PLAIN, *METHODS)}
    measured = {
        "entropy_start_minus_acquired": table.difference("entropy", at[START], at[ACQUIRED]),
        "surprise_start_minus_acquired": table.difference("surprise", at[START], at[ACQUIRED]),
        "reward_acquired_minus_start": table.difference("all", at[ACQUIRED], at[START]),
    }
    measured |= {f"entropy_{method}": table.mean("entropy", **at[method]) for method in METHODS}
    measured |= {f"reward_{method}": table.mean("all", **at[method]) for method in (PLAIN, *METHODS)}
    measured["trials"] = table.mean("trials", **at[ACQUIRED])
    optimal = np.array([result["optimal"] for result in results])
    every = {method: table.values("all", **at[method]) for method in at}
    measured["acquired_minus_all_of_gain"] = ratio_estimate(every[ACQUIRED] - every[ALL], optimal - every[PLAIN])
    shares = {feature: exact_share(_has(results, at[ACQUIRED], feature)) for feature in POOL.names}
    measured["least_share_of_four"] = min((shares[f] for f in CARDINALS), key=lambda share: share.value)
    measured["largest_share_of_noise"] = max((shares[f] for f in NOISE), key=lambda share: share.value)
    better = [
        table.difference("entropy", grid.where(START, cell), grid.where(ACQUIRED, cell)).value > 0
        and table.difference("all", grid.where(ACQUIRED, cell), grid.where(START, cell)).value > 0
        for cell in grid.cells
    ]
    return measured | {"grid_falls_and_faster": share_of(better)}


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """A row for each cell: differences, and the share of runs with each feature; then curves at the default."""
    table, grid = _table(results), grid_of(settings)
    found = []
    for cell in grid.cells:
        start, acquired = grid.where(START, cell), grid.where(ACQUIRED, cell)
        known = STARTS[cell["start"]]
        found.append(
            {
                **cell,
                "entropy_falls": table.difference("entropy", start, acquired).to_dict(),
                "reward_gains": table.difference("all", acquired, start).to_dict(),
                "shares": {
                    name: None if name in known else float(np.mean(_has(results, acquired, name)))
                    for name in POOL.names
                },
            }
        )
    for method in (PLAIN, *METHODS):
        curve = table.curve("mean", digits=2, parts=BAND, **grid.where(method, grid.default))
        found.append({"curve_of": method, **curve})
    return found
