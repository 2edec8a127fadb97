"""Measures and rows of claim C3.1."""

from collections.abc import Mapping, Sequence

import numpy as np

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.experiments.chapter3.c3_01_useful_actions.run import PRINTED
from lifelore.experiments.engine.estimates import quantile_estimate


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Shares over mazes, for each way of making them."""
    found = {}
    for generator in settings["generators"]:
        mazes = [m for r in results if r["generator"] == generator for m in r["mazes"]]
        table = {key: np.array([m[key] for m in mazes], float) for key in mazes[0]}
        suffix = "_" + generator.replace(" ", "_")
        share = table["useful"] / table["actions"]
        found[f"useful_share{suffix}"] = mean_estimate(share)
        found[f"useful_share_2.5_percent_point{suffix}"] = quantile_estimate(share, 0.025)
        found[f"useful_share_97.5_percent_point{suffix}"] = quantile_estimate(share, 0.975)
        for printed in PRINTED:
            # Mid-ranks: of the mazes that have exactly this share, half count as below.
            rank = (share < printed / 76 - 1e-9) + 0.5 * (abs(share - printed / 76) < 1e-9)
            found[f"rank_of_{printed}_of_76{suffix}"] = mean_estimate(rank)
        found[f"passable_found_useful{suffix}"] = mean_estimate(table["useful"] / table["passable"])
        found[f"useful_that_collide{suffix}"] = mean_estimate(table["useful_collisions"] / table["useful"])
        found[f"mazes_where_useful_is_passable{suffix}"] = mean_estimate(table["useful"] == table["passable"])
        found[f"useful_share_goal_rows_counted{suffix}"] = mean_estimate(
            table["useful_with_goal_rows"] / table["actions"]
        )
    return found


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """How many mazes have each number of useful actions, and one maze for each printed share."""
    found = []
    for generator in settings["generators"]:
        mazes = [m for r in results if r["generator"] == generator for m in r["mazes"]]
        pairs = [(m["useful"], m["actions"]) for m in mazes]
        for useful, actions in sorted(set(pairs)):
            count = pairs.count((useful, actions))
            found.append({"generator": generator, "useful": useful, "actions": actions, "mazes": count})
    for printed in map(str, PRINTED):
        examples = (r["examples"][printed] for r in results if printed in r["examples"])
        found += [{"example": int(printed), **example} for example in examples][:1]
    return found
