"""C4.11: the best speed for each size, and whether fast is best for small balls and slow for large ones."""

from collections.abc import Mapping, Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.ball_game.ball_game import SPEEDS
from reproduction.chapter4.ball_game.games import NORMALISATIONS, Setting
from reproduction.chapter4.ball_game.play import scale_of
from reproduction.engine.estimates import exact_value, is_above, share_of

SLOW, FAST = [0, 1], [3, 4]
"""Speeds 30 and 40, 60 and 70."""
LEAST_DROP = 20
"""Units by which the best speed must fall from the smallest ball to the largest."""


def losses(result: Mapping, normalisation: str) -> NDArray[np.float64]:
    """Losses (n_types, n_speeds, episodes); episodes of one number met the same noise at all speeds."""
    steps, hits = np.array(result["steps"]), np.array(result["hits"])
    return scale_of(normalisation, steps, hits).loss(steps, hits)


def best_speeds(loss: NDArray[np.float64]) -> NDArray[np.int64]:
    """The speed of the least mean loss for each size."""
    return np.array(SPEEDS)[loss.mean(axis=-1).argmin(axis=1)]


def gains(loss: NDArray[np.float64]) -> tuple[Estimate, Estimate]:
    """Loss that the smallest ball saves by being fast, and that the largest saves by being slow."""
    slow, fast = loss[:, SLOW].mean(axis=1), loss[:, FAST].mean(axis=1)
    return mean_estimate(slow[0] - fast[0]), mean_estimate(fast[-1] - slow[-1])


def has_transition(loss: NDArray[np.float64]) -> bool:
    """Whether the best speed falls by `LEAST_DROP` and both gains lie above 0 with their whole intervals."""
    best = best_speeds(loss)
    return bool(best[0] - best[-1] >= LEAST_DROP and all(is_above(gain, 0.0) for gain in gains(loss)))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The transition in the first game under fixed normalisation, and the share of the grid that shows it."""
    loss = losses(results[0], "fixed")
    best, n = best_speeds(loss), loss.shape[-1]
    small, large = gains(loss)
    return {
        "best_speed_falls_by": exact_value(best[0] - best[-1], n),
        "best_speed_rises_by": exact_value(max(np.diff(best).max(), 0), n),
        "small_gains_by_fast": small,
        "large_gains_by_slow": large,
        "grid_with_transition": share_of(
            [has_transition(losses(*game)) for game in product(results, NORMALISATIONS)]
        ),
    }


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean loss, its interval and collisions by size and speed, for every game and normalisation."""
    found = []
    for result, normalisation in product(results, NORMALISATIONS):
        setting, loss = (
            Setting(*result["game"])._replace(normalisation=normalisation),
            losses(result, normalisation),
        )
        error = 1.96 * loss.std(axis=-1) / np.sqrt(loss.shape[-1])
        row = {"words": setting.words, "game": list(setting[:3]), "blocked": setting.blocked}
        row |= {
            "normalisation": normalisation,
            "best": best_speeds(loss).tolist(),
            "transition": has_transition(loss),
        }
        row |= {"loss": np.round(loss.mean(axis=-1), 4).tolist(), "error": np.round(error, 4).tolist()}
        found.append(row | {"hits": np.round(np.mean(result["hits"], axis=-1), 2).tolist()})
    return found
