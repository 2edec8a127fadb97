"""Measures and rows of claim C4.11."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS, LossScale
from lifelore.experiments.chapter4.ball_game_settings import NORMALISATIONS, Setting

SLOW, FAST = [0, 1], [3, 4]
"""Speeds 30 and 40, 60 and 70."""
LEAST_DROP = 20
"""Units by which the best speed must fall from the smallest ball to the largest."""


def losses(result: Mapping, normalisation: str) -> NDArray[np.float64]:
    """Losses (n_types, n_speeds, episodes); episodes of one number met the same noise at all speeds."""
    steps, hits = np.array(result["steps"]), np.array(result["hits"])
    scale = LossScale() if normalisation == "fixed" else LossScale.from_episodes(steps, hits)
    return scale.loss(steps, hits)


def best_speeds(loss: NDArray[np.float64]) -> NDArray[np.int64]:
    """The speed of the least mean loss for each size."""
    return np.array(SPEEDS)[loss.mean(axis=-1).argmin(axis=1)]


def gains(loss: NDArray[np.float64]) -> tuple[Estimate, Estimate]:
    """What the smallest ball gains by being fast, and the largest by being slow."""
    slow, fast = loss[:, SLOW].mean(axis=1), loss[:, FAST].mean(axis=1)
    return mean_estimate(slow[0] - fast[0]), mean_estimate(fast[-1] - slow[-1])


def has_transition(loss: NDArray[np.float64]) -> bool:
    """Whether fast is best for the smallest ball and slow for the largest, both for certain."""
    drop = best_speeds(loss)[0] - best_speeds(loss)[-1]
    return bool(drop >= LEAST_DROP and all(g.ci95 and g.ci95[0] > 0 for g in gains(loss)))


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Of the first game under fixed normalisation; and the share of games and normalisations with a transition."""
    loss = losses(results[0], "fixed")
    best, n = best_speeds(loss), loss.shape[-1]
    small, large = gains(loss)
    found = {f"best_speed_b{b}": _plain(z, n) for b, z in zip(SIZES, best, strict=True)}
    found["best_speed_falls_by"] = _plain(best[0] - best[-1], n)
    found["best_speed_rises_by"] = _plain(max(np.diff(best).max(), 0), n)
    found["small_gains_by_fast"], found["large_gains_by_slow"] = small, large
    grid = [has_transition(losses(r, how)) for r in results for how in NORMALISATIONS]
    found["grid_with_transition"] = Estimate(float(np.mean(grid)), float(np.median(grid)), None, len(grid))
    fixed = [has_transition(losses(r, "fixed")) for r in results]
    found["games_with_transition"] = Estimate(float(np.mean(fixed)), float(np.median(fixed)), None, len(fixed))
    return found


def _plain(value: float, n: int) -> Estimate:
    return Estimate(float(value), float(value), None, n)


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """Mean loss, its interval and collisions by size and speed, for every game and normalisation."""
    found = []
    for result in results:
        setting = Setting(*result["game"])
        hits = np.array(result["hits"]).mean(axis=-1)
        for how in NORMALISATIONS:
            loss = losses(result, how)
            error = 1.96 * loss.std(axis=-1) / np.sqrt(loss.shape[-1])
            found.append(
                {
                    "words": setting._replace(normalisation=how).words,
                    "game": list(result["game"])[:3],
                    "blocked": setting.blocked,
                    "normalisation": how,
                    "best": best_speeds(loss).tolist(),
                    "transition": has_transition(loss),
                    "loss": np.round(loss.mean(axis=-1), 4).tolist(),
                    "error": np.round(error, 4).tolist(),
                    "hits": np.round(hits, 2).tolist(),
                }
            )
    return found
