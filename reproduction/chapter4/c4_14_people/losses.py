"""Numbers of Figures 4.18-4.20 from rows of rounds (`ball_round.BallRound.row`).

In Figure 4.19 the best static speed of a population knows the population and is chosen on the training rounds by
which it is judged; both favour it. BEAT starts from all sizes. Thesis: §4.8.5.2.
"""

from collections.abc import Sequence
from itertools import combinations, product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from reproduction.chapter4.c4_14_people.ball_round import column
from reproduction.chapter4.c4_14_people.study_plan import BEAT

STEPS = 100
"""Moves of a round that Figure 4.20 shows; shorter rounds stay at their last value."""
Rows = Sequence[dict[str, Any]]


def losses_by_speed(training: Rows) -> list[dict[str, Any]]:
    """Figure 4.18: the mean ``loss`` of each size and speed that was played."""
    found = []
    for size, speed in product(SIZES, SPEEDS):
        losses = [row["loss"] for row in training if (row["size"], row["speed"]) == (size, speed)]
        if losses:
            found.append({"size": size, "speed": speed, "loss": float(np.mean(losses))})
    return found


def losses_by_diversity(training: Rows, test: Rows) -> list[dict[str, Any]]:
    """Figure 4.19: mean loss of ``static`` and ``beat`` over all populations of ``types`` sizes.

    Only sizes that were played with BEAT and at every speed of the training take part.
    """
    speeds = sorted({row["speed"] for row in training})
    table = {
        size: [
            _mean([row["loss"] for row in training if (row["size"], row["speed"]) == (size, speed)])
            for speed in speeds
        ]
        for size in sorted({row["size"] for row in training})
    }
    beat = {
        size: _mean([row["loss"] for row in test if row["method"] == BEAT and row["size"] == size])
        for size in table
    }
    sizes = [size for size, losses in table.items() if np.isfinite([*losses, beat[size]]).all()]
    found = []
    for types in range(1, len(sizes) + 1):
        populations = list(combinations(sizes, types))
        static = np.mean([np.mean([table[size] for size in one], axis=0).min() for one in populations])
        own = np.mean([np.mean([beat[size] for size in one]) for one in populations])
        found.append({"types": types, "static": float(static), "beat": float(own)})
    return found


def ratio_by_move(row: dict[str, Any]) -> NDArray[np.float64]:
    """Most likely size / true size after each of the first `STEPS` moves of a BEAT round, (`STEPS`,)."""
    named = np.array(SIZES)[column(row, "named")][:STEPS] / row["size"]
    return np.concatenate([named, np.full(STEPS - len(named), named[-1])])


def _mean(losses: Sequence[float]) -> float:
    return float(np.mean(losses)) if losses else float("nan")
