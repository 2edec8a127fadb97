"""Measures and rows of claim C3.1."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter3.c3_01_useful_actions.run import PRINTED, PRINTED_OF
from reproduction.engine.results_table import ResultsTable, tally


def _columns(results: Sequence[Mapping], generator: str) -> dict[str, NDArray[np.float64]]:
    """Each count of actions over the mazes of a generator, (n_mazes,)."""
    table = ResultsTable.nested(results, "mazes", keys=(), outer=("generator",)).select(generator=generator)
    return {key: table.values(key) for key in table.records[0] if key != "generator"}


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares over mazes, for each generator."""
    found = {}
    for generator in settings["generators"]:
        counts, suffix = _columns(results, generator), "_" + generator.replace(" ", "_")
        share = counts["useful"] / counts["actions"]
        for printed in PRINTED:
            # Mid-ranks: of the mazes that have exactly this share, half count as below.
            apart = share - printed / PRINTED_OF
            rank = (apart < -1e-9) + 0.5 * (abs(apart) < 1e-9)
            found[f"rank_of_{printed}_of_76{suffix}"] = mean_estimate(rank)
        found[f"passable_found_useful{suffix}"] = mean_estimate(counts["useful"] / counts["passable"])
        found[f"useful_that_collide{suffix}"] = mean_estimate(counts["useful_collisions"] / counts["useful"])
        with_goal_rows = counts["useful_with_goal_rows"] / counts["actions"]
        found[f"useful_share_goal_rows_counted{suffix}"] = mean_estimate(with_goal_rows)
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How many mazes have each number of useful actions, and one maze for each printed share."""
    found = []
    for generator in settings["generators"]:
        mazes = ResultsTable.nested(results, "mazes", keys=(), outer=("generator",)).select(generator=generator)
        found += tally(
            [{key: maze[key] for key in ("generator", "useful", "actions")} for maze in mazes.records], "mazes"
        )
    for printed in map(str, PRINTED):
        examples = (r["examples"][printed] for r in results if printed in r["examples"])
        found += [{"example": int(printed), **example} for example in examples][:1]
    return found
