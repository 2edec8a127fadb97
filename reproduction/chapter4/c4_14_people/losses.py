"""Numbers of Figures 4.18-4.20 from rows of rounds (`ball_round.BallRound.row`).

In Figure 4.19 the best static speed of a population knows the population and is chosen on the training rounds by
which it is judged; both favour it. BEAT starts from all sizes. Thesis: §4.8.5.2.
"""

from collections import defaultdict
from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.ball_game.ball_game import SIZES
from reproduction.chapter4.c4_14_people.ball_round import column
from reproduction.chapter4.c4_14_people.study_plan import BEAT

STEPS = 100
"""Moves of a round that Figure 4.20 shows; shorter rounds stay at their last value."""
Rows = Sequence[dict[str, Any]]


def mean_losses(rounds: Rows) -> dict[tuple[int, Any], float]:
    """Mean loss by size and speed of the pairs that were played; BEAT's rounds have the speed None."""
    losses = defaultdict(list)
    for row in rounds:
        losses[row["size"], row["speed"]].append(row["loss"])
    return {pair: float(np.mean(own)) for pair, own in losses.items()}


def losses_by_speed(training: Rows) -> list[dict[str, Any]]:
    """Figure 4.18: the mean ``loss`` of each size and speed that was played."""
    found = sorted(mean_losses(training).items())
    return [{"size": size, "speed": speed, "loss": loss} for (size, speed), loss in found]


def losses_by_diversity(training: Rows, test: Rows) -> list[dict[str, Any]]:
    """Figure 4.19: mean loss of ``static`` and ``beat`` over all populations of ``types`` sizes.

    Only sizes that were played with BEAT and at every speed of the training take part.
    """
    table, of_beat = mean_losses(training), mean_losses([row for row in test if row["method"] == BEAT])
    speeds, beat = sorted({speed for _, speed in table}), {size: loss for (size, _), loss in of_beat.items()}
    sizes = [size for size in sorted(beat) if all((size, speed) in table for speed in speeds)]
    found = []
    for types in range(1, len(sizes) + 1):
        populations = list(combinations(sizes, types))
        static = [min(np.mean([table[size, z] for size in one]) for z in speeds) for one in populations]
        own = [np.mean([beat[size] for size in one]) for one in populations]
        found.append({"types": types, "static": float(np.mean(static)), "beat": float(np.mean(own))})
    return found


def ratio_by_move(row: dict[str, Any]) -> NDArray[np.float64]:
    """Most likely size / true size after each of the first `STEPS` moves of a BEAT round, (`STEPS`,)."""
    named = np.array(SIZES)[column(row, "named")][:STEPS] / row["size"]
    return np.concatenate([named, np.full(STEPS - len(named), named[-1])])
